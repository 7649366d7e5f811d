"""The tests run in the environment in which they were started: they see what a user sees."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from hypcheck.isolation.launch import Isolation

ROOT = Path(__file__).parents[1]
OURS = re.compile(r"HYPCHECK_\w+")


def given() -> dict[str, str]:
    """The environment in which the command that runs the tests was started, as the system keeps it."""
    started = os.getppid() if "PYTEST_XDIST_WORKER" in os.environ else os.getpid()
    entries = Path(f"/proc/{started}/environ").read_bytes().split(b"\0")
    return dict(os.fsdecode(entry).split("=", 1) for entry in entries if b"=" in entry)


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux keeps the environment in which a process was started")
def test_no_variable_of_hypcheck_is_set_by_the_tests_themselves():
    before = given()
    changed = {name: value for name, value in os.environ.items() if OURS.match(name) and before.get(name) != value}
    assert changed == {}


@pytest.mark.parametrize("path", sorted((ROOT / "tests").rglob("conftest.py")), ids=lambda path: path.parent.name)
def test_no_settings_of_tests_name_a_variable_of_hypcheck(path):
    assert OURS.findall(path.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("target", ["check", "test", "thorough"])
def test_make_sets_no_variable_of_hypcheck_for_the_tests(target):
    said = subprocess.run(["make", "--dry-run", target], cwd=ROOT, capture_output=True, text=True, check=True)  # noqa: S607
    assert "pytest" in said.stdout
    assert OURS.findall(said.stdout) == []


@pytest.mark.skipif("HYPCHECK_ISOLATE" in os.environ, reason="HYPCHECK_ISOLATE is set where the tests were started")
def test_implementations_are_isolated_in_tests_as_far_as_the_system_allows():
    assert Isolation().mode == "auto"
