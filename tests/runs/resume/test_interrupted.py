"""An interrupted conformance run keeps its finished part, reports failures to GitHub, and leaves no process behind."""

from __future__ import annotations

import os
import signal
import subprocess
import time

import pytest

from hypcheck.record import read
from hypcheck.record.lines import GroupLine, ImplementationLine
from tests.support.without_drawing import COMMAND
from tests.tools.miniatures import all_gone, needs_proc, token  # noqa: F401


@pytest.mark.thorough
@needs_proc
@pytest.mark.parametrize(("number", "code", "workers"), [(signal.SIGINT, 130, "2"), (signal.SIGTERM, 143, "1")])
def test_interrupted_run_says_which_part_is_finished(tmp_path, token, number, code, workers):  # noqa: F811
    out, summary = tmp_path / "out", tmp_path / "summary.md"
    spec = "python:tests.runs.faulty:wrong_now_and_then"
    options = ["--families", "tower-body", "--count", "1000000000", "--workers", workers]
    options += ["--isolate", "off"]  # it writes a file, to tell that it was asked
    command = [*COMMAND, "verify", spec, "--out", str(out), *options]
    sign = tmp_path / "sign"
    github = {"GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": str(summary), "GATE_TEST_SIGN": str(sign)}
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True, env={**os.environ, **github}
    )
    deadline = time.monotonic() + 60
    while not sign.exists():
        assert time.monotonic() < deadline
        time.sleep(0.05)
    time.sleep(1)
    os.killpg(process.pid, number)  # as a terminal and a supervisor do, to all its processes
    said, errors = process.communicate(timeout=60)
    assert process.returncode == code
    assert b"Traceback" not in errors
    record = read(out / "record.jsonl")
    assert record.footer is None
    (group,) = record.of(GroupLine)
    assert group.counts["wrong"] > 0
    assert group.asked == sum(group.counts.values()) >= 120
    assert record.of(ImplementationLine)[0].started is True
    assert "TRUNCATED" in summary.read_text(encoding="utf-8")
    assert "TRUNCATED" in (out / "report.md").read_text(encoding="utf-8")
    assert b"::error" in said
    assert all_gone(token) == []


@needs_proc
def test_no_process_outlives_a_run_that_is_killed(tmp_path, token):  # noqa: F811
    """Its workers have 60 s to wait for a slow implementation, and nobody to tell the answers to."""
    sign = tmp_path / "sign"
    words = ["verify", "python:tests.runs.faulty:sleeps", "--out", str(tmp_path / "out"), "--families", "tower-body"]
    process = subprocess.Popen(
        [*COMMAND, *words, "--workers", "2", "--timeout", "60", "--isolate", "off"],  # it writes a file, as above
        env={**os.environ, "GATE_TEST_SIGN": str(sign)},
    )
    until = time.monotonic() + 60
    while not sign.exists():
        assert time.monotonic() < until
        time.sleep(0.05)
    process.kill()
    process.wait()
    assert all_gone(token) == []
