"""`hypcheck plan --measure`: the savings of each pair of sizes, in sentences and for programs."""

from __future__ import annotations

import json
import shutil

import pytest

from hypcheck.bench import scene
from hypcheck.cli.main import main

COMPILER = pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")


@pytest.fixture
def few(monkeypatch):
    """Few rounds."""
    monkeypatch.setattr(scene, "KERNEL_ROUNDS", 2)


@COMPILER
def test_plan_measure_times_each_pair_of_sizes_in_batches_and_one_by_one(few, capsys):
    assert main(["plan", "tower", "--measure", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert [each["sizes"] for each in told["measured"]] == [each["sizes"] for each in told["settings"]]
    for each in told["measured"]:
        assert each["says"].startswith("In C, many by a call: ")
        for mode in ("batch", "single"):
            low, high = each[mode]["ratio_ci95"]
            assert low <= each[mode]["ratio"] <= high
            assert min(each[mode]["kernel_ns"], each[mode]["printed_ns"]) > 0


@COMPILER
def test_plan_measure_prints_one_sentence_for_each_setting_below_the_plan(few, capsys):
    assert main(["plan", "tower", "--precision", "float32", "--measure"]) == 0
    *plan, body, rotors = capsys.readouterr().out.splitlines()
    assert plan[0] == "cooling tower: interior or not, in float32"
    assert body.startswith("1. In C")
    assert rotors.startswith("2. In C")


def test_plan_measure_without_a_compiler_ends_2_with_one_sentence(monkeypatch, capsys):
    monkeypatch.setenv("PATH", "")
    monkeypatch.delenv("CC", raising=False)
    assert main(["plan", "tower", "--measure"]) == 2
    assert "no C compiler is found" in capsys.readouterr().err
