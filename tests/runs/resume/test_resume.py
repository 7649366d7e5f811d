"""A resumed run gives the result of an unbroken run, whenever and however it was interrupted."""

from __future__ import annotations

import json
import os
import random
import resource
import shutil
import signal
import subprocess
import tempfile
import time
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.cli.main import main
from hypcheck.record import read
from hypcheck.record.fields import as_json
from hypcheck.record.progress import ProgressLine
from hypcheck.record.reader import FILE, GROWING
from hypcheck.runs.resume import ProgressWriter, finished_part
from tests.report.test_schemas import RECORD
from tests.runs.interruption import (
    CODE,
    SPECS,
    came_to,
    ended,
    in_small_steps,
    paused_bytes,
    started,
    unbroken_run,
    wait_for,
    words,
)
from tests.support.records import resealed, violations

MOMENTS = int(os.environ.get("HYPCHECK_MOMENTS", "3"))
"""Random moments to interrupt a run at; fifty are for whoever changes how progress is kept."""

SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)


@pytest.fixture
def here(monkeypatch, capsys, text_reports):
    """Performs the run in this process, which saves the time to load everything; its exit code and what it said."""
    in_small_steps(monkeypatch.setattr)

    def run(out, *more):
        code = main(words(out, *more))
        return code, "".join(capsys.readouterr())

    return run


@pytest.mark.usefixtures("text_reports")
def test_a_finished_run_of_another_folder_is_named_and_makes_no_reports(tmp_path, capsys):
    run = ["verify", "builtin:fast", "--families", "tower-body", "--count", "0", "--out"]
    assert main([*run, str(tmp_path / "out")]) == 0
    capsys.readouterr()
    assert main([*run, str(tmp_path / "other"), "--resume", str(tmp_path / "out")]) == 0
    finished = f"{tmp_path / 'out' / FILE} is the record of a finished run, which ended with 0\n"
    assert capsys.readouterr().out == finished
    assert not (tmp_path / "other").exists()


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """What a run comes to that is never interrupted, and how many seconds it takes to begin and then to end."""
    found, *seconds = unbroken_run(tmp_path_factory)
    kinds = [json.loads(line)["type"] for line in found[:-1]]
    assert (kinds.count("group"), kinds.count("implementation"), kinds.count("progress")) == (4, 2, 0)
    assert json.loads(found[-1])["implementations"][1]["statuses"]["not-run"] > 100
    return found, *seconds


@pytest.fixture(scope="module")
def paused(tmp_path_factory):
    return paused_bytes(tmp_path_factory)


def interrupted(out, whole, dice, number, *more):
    """Begin a run and send it a signal: now and then before it has a record, else at any moment of it."""
    process = started(out, *more)
    if dice.random() < 0.15:
        time.sleep(dice.uniform(0, whole[1]))
    else:
        wait_for(process, out, b"header")
        time.sleep(dice.uniform(0, whole[2]))
    process.send_signal(number)
    said = "".join(process.communicate())
    assert process.returncode in (CODE, -number, 128 + number)
    assert "Traceback" not in said or number == signal.SIGINT  # Python itself may still be starting
    if process.returncode > CODE and (out / FILE).exists():
        record = read(out / FILE)
        goes_on = f"the same command {f'with --resume {out} continues' if record.of(ProgressLine) else ''}"
        assert (f"hypcheck report {out} --out {out} makes its reports" if record.footer else goes_on) in said


@pytest.mark.parametrize("moment", range(MOMENTS))
def test_run_killed_at_any_moment_can_be_resumed(whole, tmp_path, moment, here):
    dice = random.Random(moment)  # noqa: S311
    interrupted(tmp_path, whole, dice, SIGNALS[moment % 3], *["--workers", "2"][: 2 * (moment % 7 == 1)])
    resume = ["--resume", str(tmp_path)] if any(tmp_path.glob("record.jsonl*")) else []
    code, said = here(tmp_path, *resume, *["--workers", "2"][: 2 * (moment % 7 == 2)])
    assert code == CODE, said
    assert came_to(tmp_path) == whole[0]


def test_run_interrupted_during_its_reports_prints_the_command_that_makes_them(tmp_path, here, monkeypatch):
    def interrupts(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr("hypcheck.report.write.write_reports", interrupts)
        code, said = here(tmp_path)
    assert code == 130
    assert f"{tmp_path / FILE} is complete; hypcheck report {tmp_path} --out {tmp_path} makes its reports" in said
    assert read(tmp_path / FILE).footer
    assert main(["report", str(tmp_path), "--out", str(tmp_path)]) == 0
    assert (tmp_path / "summary.json").exists()


def test_second_interrupt_loses_nothing_and_the_resume_command_is_printed(whole, tmp_path, here, monkeypatch):
    def keeps_late(*some):
        signal.raise_signal(signal.SIGINT)
        return keep(*some)

    def interrupted(*_):
        raise KeyboardInterrupt

    keep = ProgressWriter.keep
    with monkeypatch.context() as patch:
        patch.setattr(ProgressWriter, "offer", interrupted)
        patch.setattr(ProgressWriter, "keep", keeps_late)
        code, said = here(tmp_path)
    assert code == 130
    assert f"the same command with --resume {tmp_path} continues" in said
    assert read(tmp_path / FILE).of(ProgressLine)
    assert here(tmp_path, "--resume", str(tmp_path))[0] == CODE
    assert came_to(tmp_path) == whole[0]


def test_run_killed_twice_can_be_resumed(whole, tmp_path, here):
    for more in ([], ["--resume", str(tmp_path)]):
        process = started(tmp_path, *more)
        wait_for(process, tmp_path, b'"number": 1' if more else b'"progress"')
        process.kill()
        process.communicate()
    assert here(tmp_path, "--resume", str(tmp_path))[0] == CODE
    assert came_to(tmp_path) == whole[0]


def test_record_of_a_killed_run_fits_the_schema_and_is_resumed_within_an_implementation(paused, whole, tmp_path, here):
    path = tmp_path / FILE
    path.write_bytes(paused)
    kept = read(path).lines[-1]
    assert kept.number == 1
    assert kept.state.done > 0
    assert violations(as_json(kept), RECORD, closed=True) == []
    assert here(tmp_path, "--resume", str(path))[0] == CODE
    assert came_to(tmp_path) == whole[0]


def test_record_cut_at_any_byte_is_resumed_or_refused(paused, whole, tmp_path, here):
    dice = random.Random(7)  # noqa: S311
    last = paused.rindex(b"\n", 0, -1) + 1
    for cut in (5, last, *(dice.randrange(len(paused)) for _ in range(max(1, MOMENTS // 5)))):
        (tmp_path / "cut.jsonl").write_bytes(paused[:cut])
        code, said = here(tmp_path / str(cut), "--resume", str(tmp_path / "cut.jsonl"))
        if b"\n" not in paused[:cut]:
            assert (code, "first line" in said) == (2, True)
            assert not (tmp_path / str(cut)).exists()
        else:
            assert code == CODE, said
            assert came_to(tmp_path / str(cut)) == whole[0]
        assert (tmp_path / "cut.jsonl").read_bytes() == paused[:cut]


def test_damaged_record_is_resumed_after_its_repair(paused, whole, tmp_path, here):
    damaged, good = tmp_path / "damaged.jsonl", tmp_path / "good.jsonl"
    damaged.write_bytes(paused.replace(b'"number": 1', b'"number": 0'))
    code, said = here(tmp_path / "out", "--resume", str(damaged))
    assert (code, f"is damaged in line {len(paused.splitlines())}, at byte" in said) == (2, True)
    assert main(["record", "repair", str(damaged), "--out", str(good)]) == 0
    assert here(tmp_path / "out", "--resume", str(good))[0] == CODE
    assert came_to(tmp_path / "out") == whole[0]


@given(st.data())
def test_finished_implementations_of_a_cut_record_are_kept(paused, data):
    """Also of a finished record, and of one that was interrupted with lines of an unfinished implementation."""
    lines = [
        {name: value for name, value in json.loads(line).items() if name != "crc32"} for line in paused.splitlines()
    ]
    header, (*groups, first), progress = lines[0], lines[1:-1], lines[-1]
    second = [{**line, "spec": SPECS[1]} for line in (*groups, first)]
    behind = [*second[:-1], {**second[-1], "finished": False}]
    footer = {"type": "footer", "lines": 1 + 2 * len(second), "exit_code": 1, "seconds": 1.0}
    form = data.draw(st.sampled_from([[progress], [progress, *behind], [*second, footer], [progress, *second]]))
    content = resealed([header, *groups, first, *form])
    start = len(resealed([header, *groups, first]))
    cut = data.draw(st.integers(start, len(content) - 1))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / FILE
        path.write_bytes(content[:cut])
        record = read(path)
        carried, kept = finished_part(record)
    told = len(record.lines) - len(record.of(ProgressLine))
    whole_second = told >= 2 * len(second) and form[-1].get("finished", True)
    assert [as_json(line) for line in carried] == [*groups, first, *(second if whole_second else [])]
    assert (kept and as_json(kept)) == (progress if record.of(ProgressLine) and not whole_second else None)


@pytest.mark.parametrize(("most", "more"), [(3000, ()), (12000, ("--resume",))])
def test_run_whose_files_cannot_grow_ends_with_an_error_and_keeps_what_it_wrote(whole, tmp_path, here, most, more):
    code, said = ended(tmp_path, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most)))
    assert (code, f"cannot write {tmp_path / GROWING}: file too large" in said) == (2, True)
    assert (tmp_path / FILE).exists() == any(tmp_path.iterdir()) == bool(more)  # 3000 bytes hold no result
    assert here(tmp_path, *more, *(str(tmp_path) for _ in more))[0] == CODE
    assert came_to(tmp_path) == whole[0]


@pytest.fixture
def small_disk(tmp_path):
    """A folder on a disk of 24 KiB."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mount, umount = shutil.which("mount"), shutil.which("umount")
    words = [mount, "-t", "tmpfs", "-o", "size=24k", "tmpfs", disk]
    if not (mount and umount) or subprocess.run(words, capture_output=True, check=False).returncode:
        pytest.skip("only root of a Linux may mount a disk")
    yield disk
    subprocess.run([umount, "--lazy", disk], check=True)


def test_run_on_a_full_disk_ends_with_an_error_and_can_be_resumed(whole, small_disk, tmp_path, here):
    code, said = ended(small_disk)
    assert (code, f"cannot write {small_disk / GROWING}: no space left on device" in said) == (2, True)
    assert here(tmp_path, "--resume", str(small_disk))[0] == CODE
    assert came_to(tmp_path) == whole[0]
