"""`hypcheck info`: this installation as text and as JSON, and invalid environment variables."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import hypcheck


def run(*words, **environment):
    return subprocess.run(
        [sys.executable, "-m", "hypcheck", "info", *words],
        env=os.environ | environment,
        capture_output=True,
        text=True,
        check=False,
    )


def test_info_json_has_the_kernel_the_header_and_the_oracles():
    done = run("--json", HYPCHECK_KERNEL="numpy", HYPCHECK_THREADS="3")
    found = json.loads(done.stdout)
    assert found["hypcheck"] == hypcheck.__version__
    assert found["kernel"] == {"name": "numpy", "level": None, "reason": "HYPCHECK_KERNEL asks for it", "threads": 1}
    assert Path(found["header"]).read_text(encoding="utf-8").startswith("/* Where a spheroid stands")
    assert list(found["oracles"]) == ["exact", "nearest", "roots", "mesh"]
    assert found["oracles"]["exact"] == {"available": True, "reason": None}
    assert set(found["versions"]) >= {"numpy", "sympy", "click"}


def test_info_text_shows_the_same_as_json():
    done = run(HYPCHECK_KERNEL="numpy")
    assert done.returncode == 0
    assert "kernel     numpy, up to 1 thread: HYPCHECK_KERNEL asks for it\n" in done.stdout
    assert "mesh: available\n" in done.stdout or "mesh: not available: " in done.stdout


def test_info_with_an_invalid_environment_variable_ends_2():
    for name, value in (("HYPCHECK_KERNEL", "fast"), ("HYPCHECK_THREADS", "-1"), ("HYPCHECK_THREADS", "two")):
        done = run(**{name: value})
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr.startswith(f"hypcheck: error: {name} is {value!r}; it must be ")
        assert len(done.stderr.splitlines()) == 1
