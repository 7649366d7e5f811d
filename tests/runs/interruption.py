"""A conformance run of many small steps that writes its progress after each, to be interrupted and resumed."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from contextlib import suppress
from functools import partial

from hypcheck.cli.main import main
from hypcheck.record import read
from hypcheck.record.reader import FILE, GROWING
from hypcheck.runs import cases, plan
from tests.support.shared_folders import made_once

SPECS = ("builtin:hessian-float32", "python:tests.runs.faulty:dies_on_the_axis")
WORDS = ("--families", "tower-body,axis", "--count", "300", "--restarts", "1", "--precision", "float32")
CODE = 1
"""How it ends: the first is wrong beyond the tolerance, and the second dies more often than it may."""

SECONDS = "seconds.json"
"""Beside the record of the unbroken run: how long it took."""


def in_small_steps(put, single_rows=1100):
    """Let `put(owner, name, value)` make the steps of runs small, and their progress kept at each."""
    pace = cases.Pace(chunk_rows=64, retest_after=600, single_rows=single_rows, progress_s=0.0, progress_share=0)
    put(plan, "ConformancePlan", partial(plan.ConformancePlan, pace=pace))


def with_little_patience(put):
    """Let it be soon lost when a scheduler is silent."""
    from hypcheck.runs import dask_executor

    put(dask_executor, "CONNECT", 1)
    put(dask_executor, "SILENCES", 2)


def words(out, *more):
    return ["verify", *SPECS, *WORDS, "--out", str(out), *more]


def started(out, *more, **how):
    """A process that performs the run."""
    command = [sys.executable, "-m", "tests.runs.interruption", *words(out, *more)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **how)


def ended(out, *more, **how):
    """Its exit code and what it said."""
    process = started(out, *more, **how)
    said = "".join(process.communicate())
    assert "Traceback" not in said
    return process.returncode, said


def kept(out):
    """The bytes of the record that grows in a folder, none before there is one."""
    with suppress(FileNotFoundError):
        return (out / GROWING).read_bytes()
    return b""


def wait_for(process, out, what, patience=120.0):
    """Wait until `what` is in the growing record, or its process has ended."""
    until = time.monotonic() + patience
    while what not in kept(out) and process.poll() is None:
        assert time.monotonic() < until
        time.sleep(0.002)


def paused_bytes(tmp_path_factory):
    """The bytes of the record of a run that was killed within its second implementation."""
    return (made_once(tmp_path_factory, "paused-run", _pause) / GROWING).read_bytes()


def _pause(out):
    process = started(out)
    wait_for(process, out, b'"number": 1')
    time.sleep(0.05)
    process.kill()
    process.communicate()


def unbroken_run(tmp_path_factory):
    """What a run comes to that is never interrupted, and how many seconds it takes to begin and then to end."""
    out = made_once(tmp_path_factory, "unbroken-run", _perform)
    return came_to(out), *json.loads((out / SECONDS).read_text())


def _perform(out):
    start = time.monotonic()
    process = started(out)
    wait_for(process, out, b"header")
    begun = time.monotonic()
    process.communicate()
    assert process.returncode == CODE
    (out / SECONDS).write_text(json.dumps([begun - start, time.monotonic() - begun]))


def came_to(out):
    """What a run came to: the lines of its record and its summary as they are written, but for times and workers."""
    assert not list(out.glob("*.part*"))
    assert read(out / FILE).footer
    lines = [json.loads(line) for line in (out / FILE).read_text(encoding="utf-8").splitlines()]
    for line in lines:
        del line["crc32"]
    del lines[0]["started"], lines[0]["options"]["workers"], lines[0]["options"]["cluster"], lines[-1]["seconds"]
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    del summary["started"], summary["seconds"]
    return [json.dumps(line).encode() for line in (*lines, summary)]


if __name__ == "__main__":
    sys.modules["matplotlib"] = sys.modules["jinja2"] = None  # whose reports are no part of what is looked at
    in_small_steps(setattr)
    if "--cluster" in sys.argv:
        with_little_patience(setattr)
    sys.exit(main())
