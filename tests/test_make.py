"""`make test` runs what failed once more only where every test ran: nothing that did not run passes."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PYTHON = """#!/bin/sh
case "$*" in
*--last-failed*) echo ONCE MORE ;;
*"--assert plain"*) exit CODE ;;
esac
"""
"""In place of the interpreter: pytest ends with CODE, and what failed passes when it runs alone."""


@pytest.mark.skipif(shutil.which("make") is None, reason="there is no make")
@pytest.mark.parametrize(
    ("code", "again", "passes"), [(0, False, True), (1, True, True), (2, False, False), (3, False, False)]
)
def test_make_test_repeats_failed_tests_and_fails_after_an_interrupt_or_an_internal_error(
    code, again, passes, tmp_path
):
    (tmp_path / "bin").mkdir()
    for name in ("python", "ruff", "mypy", "lint-imports"):
        program = tmp_path / "bin" / name
        program.write_text(PYTHON.replace("CODE", str(code)), encoding="utf-8")
        program.chmod(0o755)
    (tmp_path / "ready-dev").touch()
    done = subprocess.run(
        ["make", "--silent", "test", f"VENV={tmp_path}"],  # noqa: S607 - the make of whoever runs the tests
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert ("ONCE MORE" in done.stdout) == again
    assert (done.returncode == 0) == passes
