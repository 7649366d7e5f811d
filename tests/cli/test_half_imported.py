"""A signal that comes while a module is half imported ends the program like any other signal."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import pytest

INTERRUPTED_CLICK = """
import os, signal, sys
sys.path.remove(os.path.dirname(__file__))  # whoever imports it next finds the real one
os.kill(os.getpid(), signal.{name})
"""


CODES = {"SIGINT": 130, "SIGTERM": 143, "SIGHUP": 143}


@pytest.mark.parametrize(("name", "code"), [each for each in CODES.items() if hasattr(signal, each[0])])
def test_a_signal_during_the_import_of_click_ends_with_its_exit_code_and_one_line(tmp_path, name, code):
    (tmp_path / "click.py").write_text(INTERRUPTED_CLICK.format(name=name), encoding="utf-8")
    command = [sys.executable, "-m", "hypcheck", "--help"]
    done = subprocess.run(
        command, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": str(tmp_path)}, check=False
    )
    word = "interrupted" if code == 130 else "terminated"
    assert (done.returncode, done.stdout, done.stderr) == (code, "", f"hypcheck: {word}\n")
