"""An interrupted self-check keeps its finished part, says that it did not pass, and ends by the signal."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import pytest

from hypcheck.record import read
from hypcheck.record.lines import ProofLine

PROVED = """
import sys
sys.modules.update(matplotlib=None, jinja2=None)
from hypcheck.derivation import printed_equations, proofs
printed_equations.check_equations = tuple
proofs.prove_formulas = lambda: (proofs.Proof("hessian", "delta", True, "as if it had been proved"),)
from hypcheck.cli.main import process
process()
"""
"""The command line, whose derivation is over at once: it is interrupted while processes of its own ask oracles."""


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_interrupted_self_check_records_the_finished_part(tmp_path, number, code):
    words = ["verify", "--self", "--out", str(tmp_path), "--count", "400"]
    command = [sys.executable, "-c", PROVED, *words, "--workers", "2"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, start_new_session=True)
    part = tmp_path / "record.jsonl.part"
    deadline = time.monotonic() + 60
    while not (part.exists() and '"proof"' in part.read_text(encoding="utf-8")):
        assert time.monotonic() < deadline
        time.sleep(0.05)
    os.killpg(process.pid, number)  # as a terminal and a supervisor do, to all its processes
    _, errors = process.communicate(timeout=60)
    assert process.returncode == code
    assert b"Traceback" not in errors
    record = read(tmp_path / "record.jsonl")
    assert record.footer is None
    assert record.of(ProofLine)
    assert "TRUNCATED" in (tmp_path / "report.md").read_text(encoding="utf-8")
    assert not part.exists()
