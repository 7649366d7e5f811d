"""What is no record of an interrupted run of just this kind is refused in a sentence, and nothing changes."""

from __future__ import annotations

import json
import time

import pytest

from hypcheck.cli.main import main
from hypcheck.record.reading import GROWING
from tests.gate.interrupted import started, wait_for, words
from tests.records import resealed


@pytest.fixture(scope="module")
def paused(tmp_path_factory):
    """The bytes of the record of a run that was killed within its second implementation."""
    out = tmp_path_factory.mktemp("paused")
    process = started(out)
    wait_for(process, out, b'"number": 1')
    time.sleep(0.05)
    process.kill()
    process.communicate()
    return (out / GROWING).read_bytes()


def refused(out, capsys, *more):
    """The sentence with which the run is refused."""
    before = {path: path.read_bytes() for path in out.rglob("*") if path.is_file()}
    assert main(words(out, *more)) == 2
    assert {path: path.read_bytes() for path in out.rglob("*") if path.is_file()} == before
    said, errors = capsys.readouterr()
    assert said == ""
    (line,) = errors.splitlines()
    return line


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda lines: lines[0]["options"].update(seed=2), "--seed was 2, and is 1 now"),
        (lambda lines: lines[0]["options"].update(families=["ring"]), '--families was ["ring"], and is'),
        (lambda lines: lines[0]["options"].update(specs=["builtin:fast"]), 'specs was ["builtin:fast"], and is'),
        (lambda lines: lines[0].update(hypcheck="0.0.1"), 'hypcheck was "0.0.1", and is'),
        (lambda lines: lines[0]["versions"].update(numpy="1.0"), 'numpy was "1.0", and is'),
        (lambda lines: lines[-1].update(cases=7), "the number of cases was 7, and is"),
        (lambda lines: lines[-1]["declared"].update(version="9"), "the version that python:tests.gate.subjects"),
        (lambda lines: lines[-1]["files"].update(dict.fromkeys(lines[-1]["files"], "00")), "the sha256 of "),
        (lambda lines: lines[-1].pop("state"), "its line of progress says nothing to go on from"),
    ],
)
def test_another_run(paused, tmp_path, capsys, change, said):
    lines = [json.loads(line) for line in paused.splitlines()]
    change(lines)
    (tmp_path / GROWING).write_bytes(resealed(lines))
    assert said in refused(tmp_path, capsys, "--resume", str(tmp_path))


def test_a_damaged_record(paused, tmp_path, capsys):
    (tmp_path / "other.jsonl").write_bytes(paused.replace(b'"number": 1', b'"number": 0'))
    assert "is damaged in line" in refused(tmp_path, capsys, "--resume", str(tmp_path / "other.jsonl"))


def test_a_finished_record_says_so_and_stays(tmp_path, capsys):
    words = ["verify", "builtin:fast", "--families", "ring", "--count", "3", "--out", str(tmp_path)]
    assert main(words) == 0
    before = {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in tmp_path.iterdir()}
    capsys.readouterr()
    assert main([*words, "--resume", str(tmp_path)]) == 0
    assert "is the record of a finished run, which ended with 0" in capsys.readouterr().out
    assert {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in tmp_path.iterdir()} == before
    (tmp_path / "summary.json").unlink()
    assert main([*words, "--resume", str(tmp_path)]) == 0
    assert (tmp_path / "summary.json").is_file()
