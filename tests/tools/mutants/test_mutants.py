"""The collection is whole and told as it is; the gate rejects a sample of it, and passes what is right."""

from __future__ import annotations

import csv
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import hypcheck
from hypcheck.geometry.rows import SWEEPS, with_axis, with_heights
from hypcheck.runs.judge import exact_positions
from hypcheck.vectors.families import TILTED_FAMILIES, select
from tests.tools.mutants import __main__, dual, exactly, table
from tests.tools.mutants.collection import MODULES, Mutant, imported, mutants, public_functions, sentence
from tests.tools.mutants.expectation import Expectation, expectation_of
from tests.tools.mutants.gating import Result, Ruling, gate

HERE = Path(__file__).parent
PAGE = HERE / "README.md"
MACHINERY = {"__init__", "__main__", "collection", "dual", "exactly", "expectation", "gating", "table", "test_mutants"}
BY_NAME = {mutant.name: mutant for mutant in mutants()}

SAMPLE = {
    "signs.c0": "uniform,forest-type-1",
    "slips.equation_12_as_printed": "near-tangent-outside",
    "lengths.z_ignored": "out-of-regime",
    "shapes.many_points": "tangent-ladder",
    "answers.cannot_say_when_it_is_hard": "tower-body",
    "regimes.without_the_ring": "ring,waist",
    "regimes.procedure_2a_as_printed": "coefficient-zero",
    "thresholds.double_root_is_clear": "degenerate-crossing",
    "thresholds.tangency_is_clear": "tangent",
    "rounding.shrunk_by_64_u": "near-axis",
    "floats.nan_is_contact": "tiny-spheroids",
    "ranges.no_negative_zero": "symmetric-images",
    "lookups.frozen_vectors": "flight",
    "memory.question_before": "flight,tower-body",
    "batches.rounds_at_random": "tangent",
    "refusals.forgets_nan": "axis",
    "tilted.transposed_rotation": "tilted-uniform",
    "tilted.kernel": "tilted-uniform,uniform",
    "passages.late_times": "way-still",
    "passages.ring_is_contact": "way-ring",
    "passages.exact_from_above": "way-short",
    "ended.height_of_the_centre_alone": "ended-rim",
    "ended.discs_ignored": "ended-disc",
    "ended.kernel": "ended-disc,tilted-ended-rim",
    "ended_sweeps.while_the_centre_is_between_the_heights": "ended-way-landing,ended-way-over",
    "ended_sweeps.time_without_ends": "ended-way-uniform,ended-way-opening",
    "ended_sweeps.exact": "ended-way-touch,tilted-ended-way-over",
    "correct.whole_numbers": "ring,tangent,waist,osculation",
    "correct.dual_form_in_float32": "ring,tangent,tiny-spheroids",
    "correct.procedure_1_mended": "ring,regime-borders",
    "refusals.refuses_what_is_invalid": "axis",
}
"""What the test suite gates, and the families that suffice for it."""

FEW = {
    "signs.c0": "uniform",
    "passages.late_times": "way-still",
    "correct.whole_numbers": "ring",
}
"""What `make test` gates of them, with the frozen vectors of a family; `make thorough` gates all."""


@pytest.mark.parametrize(
    ("name", "count", "families"),
    [
        *((name, "0", family) for name, family in FEW.items()),
        *(pytest.param(name, "60", families, marks=pytest.mark.thorough) for name, families in SAMPLE.items()),
    ],
)
def test_verify_kills_or_passes_a_sample_of_each_mutant_as_expected_and_not_otherwise(name, count, families):
    right = BY_NAME[name].expectation.right
    result = gate(BY_NAME[name], ("--count", count, "--seed", "2", "--families", families))
    assert result.as_expected, result.ruling.said
    assert not replace(result, mutant=replace(BY_NAME[name], expectation=Expectation(right=not right))).as_expected
    assert bool(result.ruling.killed_by) is not right or name == "batches.rounds_at_random"
    assert result.ruling.judged > 50


def test_unchanged_base_of_the_mutants_answers_every_family_rightly():
    for family in select(["*", "extreme"]):
        rows = family.rows(3, 25)
        assert exactly.position(rows).tolist() == hypcheck.classify(rows).tolist(), family.name


def test_unchanged_base_of_the_matrix_mutants_is_right_on_95_percent_of_tilted_rows():
    for name in ("tilted-uniform", "tilted-tower"):
        rows = TILTED_FAMILIES[name].rows(3, 60)
        assert (dual.dual_positions(rows, lambda M: M) == exact_positions(rows)).mean() > 0.95, name


def test_every_module_in_the_mutants_folder_is_in_the_collection():
    assert {path.stem for path in HERE.glob("*.py")} - MACHINERY == set(MODULES)
    assert len(set(MODULES)) == len(MODULES)


@pytest.mark.parametrize("name", MODULES)
def test_every_mutant_function_has_an_expectation_and_a_sentence(name):
    module = imported(name)
    assert sentence(module).endswith(".")
    for function, value in public_functions(module).items():
        assert expectation_of(value) is not None, f"{name}.{function} says not what must become of it"
        assert sentence(value).endswith("."), f"{name}.{function} has no sentence"


def test_there_are_at_least_40_wrong_and_10_right_mutants_with_different_names():
    assert len(BY_NAME) == len(mutants())
    assert sum(not mutant.expectation.right for mutant in BY_NAME.values()) >= 40
    assert sum(mutant.expectation.right for mutant in BY_NAME.values()) >= 10


@pytest.mark.thorough
def test_every_mutant_gives_one_answer_for_each_row():
    row = np.array([[2.0, 17.8, 0.25, 0.15, 1.0, 0.5, 3.0]])
    way = np.array([[2.0, 17.8, 0.25, 0.15, 1.0, 0.5, 3.0, 4.0, 0.5, 3.0]])
    for name, mutant in BY_NAME.items():
        asked = {
            "tilted": with_axis(row),
            "passages": way,
            "ended": with_heights(row),
            "ended_sweeps": with_heights(way, SWEEPS),
        }.get(mutant.module, row)
        answers = getattr(imported(mutant.module), mutant.function)(asked.copy())
        for each in answers if mutant.module in {"passages", "ended_sweeps"} else (answers,):
            assert np.asarray(each).shape == (1,), name


def test_rulings_list_this_collection():
    with (HERE / table.RULINGS).open(encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    assert tuple(head) == table.HEAD
    cells = [table.stable_cells(mutant) for mutant in mutants()]
    assert [tuple(row[: len(cells[0])]) for row in rows] == cells


def test_page_counts_the_rulings_beside_it_by_module():
    with (HERE / table.RULINGS).open(encoding="utf-8", newline="") as file:
        counts = Counter(
            (row["implementation"].partition(".")[0], row["was"].split(";")[0]) for row in csv.DictReader(file)
        )
    page = PAGE.read_text(encoding="utf-8")
    for module in MODULES:
        line = next(line for line in page.splitlines() if line.startswith(f"| [{module}]("))
        assert line.endswith(f" | {counts[module, 'rejected']} | {counts[module, 'passed']} |")


def test_rejections_name_implementations_of_the_rulings_and_the_families_of_the_page():
    with (HERE / table.REJECTIONS).open(encoding="utf-8", newline="") as file:
        rejections = list(csv.DictReader(file))
    assert {line["implementation"] for line in rejections} <= set(BY_NAME)
    rejecting, page = Counter(line["family"] for line in rejections), PAGE.read_text(encoding="utf-8")
    for family, number in rejecting.items():
        assert f" | {family} | {number} | " in page


WRONG = Mutant("signs", "c0", "It is wrong.", Expectation(right=False))
RIGHT = replace(WRONG, expectation=Expectation(right=True))
MORE = replace(WRONG, expectation=Expectation(right=False, asked=("--tolerance", "0")))
PASSED, REJECTED, NOT_JUDGED = Ruling(0, {}, 9), Ruling(1, {"ring": 4}, 9), Ruling(5, {}, 0)


@pytest.mark.parametrize(
    ("result", "expected"),
    [
        (Result(WRONG, REJECTED), True),
        (Result(WRONG, PASSED), False),
        (Result(WRONG, NOT_JUDGED), False),
        (Result(RIGHT, PASSED), True),
        (Result(RIGHT, REJECTED), False),
        (Result(RIGHT, NOT_JUDGED), False),
        (Result(MORE, REJECTED, without=PASSED), True),
        (Result(MORE, REJECTED, without=REJECTED), False),
        (Result(MORE, PASSED, without=PASSED), False),
    ],
)
def test_escaped_mutant_is_reported_by_exit_code_output_and_table(monkeypatch, result, expected):
    assert result.as_expected is expected
    monkeypatch.setattr(__main__, "gated", lambda some, jobs: iter([result]))
    said = CliRunner().invoke(__main__.main, ["signs.c0"])
    assert said.exit_code == (0 if expected else 1)
    assert ("✗" in said.output) is not expected
    assert ("✗" in table.rulings([result])) is not expected
    assert ("not as they must" in table.render([result])) is not expected


@pytest.mark.parametrize("arguments", [["nothing"], ["signs", "--out", "page.md"]])
def test_mutants_command_with_wrong_usage_ends_with_2(arguments):
    assert CliRunner().invoke(__main__.main, arguments).exit_code == 2
