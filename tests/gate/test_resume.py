"""A run that was interrupted, whenever and however, comes to the same as one that was not."""

from __future__ import annotations

import json
import os
import random
import resource
import signal
import subprocess
import sys
import time

import pytest

from hypcheck.cli.main import main
from hypcheck.record import read
from hypcheck.report.json_schema import violations
from tests.records import resealed
from tests.test_report_schemas import RECORD

MOMENTS = int(os.environ.get("HYPCHECK_MOMENTS", "3"))
"""How many random moments to interrupt a run at: `make soak` has many more."""

SPECS = ("python:tests.gate.subjects:too_clear", "python:tests.gate.subjects:dies_on_the_axis")
WORDS = ("--families", "tower-body,axis,flight", "--count", "3000", "--restarts", "3", "--precision", "float32")
CODE = 1


def started(out, *more, **how):
    words = [sys.executable, "-m", "tests.gate.interrupted", "verify", *SPECS, *WORDS, "--out", str(out), *more]
    return subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **how)


def ended(out, *more, **how):
    process = started(out, *more, **how)
    said = "".join(process.communicate())
    assert "Traceback" not in said
    return process.returncode, said


def came_to(out):
    """What a run came to, without times; and the lines of its record."""
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    record = read(out / "record.jsonl")
    assert record.footer
    assert not list(out.glob("*.part*"))
    return {key: value for key, value in summary.items() if key not in ("started", "seconds")}, record.lines


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A run that is never interrupted, and the seconds it takes."""
    out = tmp_path_factory.mktemp("whole")
    began = time.monotonic()
    assert ended(out)[0] == CODE
    found = came_to(out)
    assert {line["type"] for line in found[1]} == {"group", "implementation"}
    assert found[0]["implementations"][0]["wrong"] > 50
    return found, time.monotonic() - began


@pytest.fixture(scope="module")
def paused(tmp_path_factory):
    """The bytes of the record of a run that was killed well within its second implementation."""
    out = tmp_path_factory.mktemp("paused")
    process = started(out)
    part = out / "record.jsonl.part"
    while process.poll() is None and not (part.is_file() and b'"number": 1' in part.read_bytes()):
        time.sleep(0.01)
    time.sleep(0.2)
    process.kill()
    process.communicate()
    return part.read_bytes()


@pytest.mark.parametrize("moment", range(MOMENTS))
def test_killed_at_any_moment(whole, tmp_path, moment):
    dice = random.Random(moment)  # noqa: S311
    process = started(tmp_path)
    time.sleep(dice.uniform(0.05, whole[1]))
    process.send_signal((signal.SIGKILL, signal.SIGTERM, signal.SIGINT)[moment % 3])
    process.communicate()
    words = ["--resume", str(tmp_path)] if any(tmp_path.glob("record.jsonl*")) else []
    code, said = ended(tmp_path, *words, *["--workers", "2"][: 2 * (moment % 2)])
    if "first line" in said or "is empty" in said:  # it had not begun
        assert code == 2
        code, said = ended(tmp_path)
    assert code == CODE, said
    assert came_to(tmp_path) == whole[0]


def test_killed_again_and_again(whole, tmp_path):
    words = []
    for _ in range(3):
        process = started(tmp_path, *words)
        time.sleep(whole[1] * 0.5)
        process.kill()
        process.communicate()
        words = ["--resume", str(tmp_path)]
    assert ended(tmp_path, *words)[0] == CODE
    assert came_to(tmp_path) == whole[0]


def test_what_a_killed_run_leaves_fits_the_schema_and_goes_on_from_within(paused, whole, tmp_path):
    path = tmp_path / "record.jsonl"
    path.write_bytes(paused)
    record = read(path)
    progress = record.lines[-1]
    assert progress["number"] == 1
    assert progress["state"]["done"] > 0
    assert violations(progress, RECORD["$defs"]["progress"], RECORD, closed=True) == []
    assert ended(tmp_path, "--resume", str(path))[0] == CODE
    assert came_to(tmp_path) == whole[0]


def test_a_record_cut_at_any_byte_goes_on_or_is_refused(paused, whole, tmp_path):
    dice = random.Random(7)  # noqa: S311
    for cut in (5, *(dice.randrange(len(paused)) for _ in range(max(2, MOMENTS // 2)))):
        (tmp_path / "cut.jsonl").write_bytes(paused[:cut])
        code, said = ended(tmp_path / str(cut), "--resume", str(tmp_path / "cut.jsonl"))
        if b"\n" not in paused[:cut]:
            assert (code, "first line" in said) == (2, True)
            assert not (tmp_path / str(cut)).exists()
        else:
            assert code == CODE, said
            assert came_to(tmp_path / str(cut)) == whole[0]
        assert (tmp_path / "cut.jsonl").read_bytes() == paused[:cut]


def test_a_full_disk(paused, whole, tmp_path):
    """The files of the process may not grow beyond what it has after its first progress."""

    def little():
        resource.setrlimit(resource.RLIMIT_FSIZE, (8000, 8000))

    code, said = ended(tmp_path, preexec_fn=little)
    assert code == 2
    assert "too large" in said
    assert ended(tmp_path, "--resume", str(tmp_path))[0] == CODE
    assert came_to(tmp_path) == whole[0]


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
def test_another_run_is_refused_and_nothing_changes(paused, tmp_path, change, said):
    lines = [json.loads(line) for line in paused.splitlines()]
    for line in lines:
        del line["crc32"]
    change(lines)
    part = tmp_path / "record.jsonl.part"
    part.write_bytes(resealed(lines))
    before = part.read_bytes()
    code, told = ended(tmp_path, "--resume", str(tmp_path))
    assert (code, said in told) == (2, True), told
    assert [path.name for path in tmp_path.iterdir()] == [part.name]
    assert part.read_bytes() == before


def test_a_damaged_record_is_refused(paused, tmp_path):
    path = tmp_path / "record.jsonl"
    path.write_bytes(paused.replace(b'"number": 1', b'"number": 0'))
    code, said = ended(tmp_path, "--resume", str(path))
    assert (code, "is damaged in line" in said) == (2, True)
