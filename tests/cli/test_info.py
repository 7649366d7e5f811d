"""`hypcheck info`: this installation as text and as JSON, and invalid environment variables."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import hypcheck
from hypcheck.cli.main import main
from hypcheck.kernel.choice import choice


@pytest.fixture
def run(monkeypatch, capsys):
    """Runs the command with environment variables, which choose the kernel anew: its exit code and what it said."""

    def info(*words, **environment):
        with monkeypatch.context() as patch:
            for name, value in environment.items():
                patch.setenv(name, value)
            choice.cache_clear()
            code = main(["info", *words])
        choice.cache_clear()
        return code, *capsys.readouterr()

    return info


def test_info_json_has_the_kernel_the_header_and_the_oracles(run):
    _, said, _ = run("--json", HYPCHECK_KERNEL="numpy", HYPCHECK_THREADS="3")
    found = json.loads(said)
    assert found["hypcheck"] == hypcheck.__version__
    assert found["kernel"] == {"name": "numpy", "level": None, "reason": "HYPCHECK_KERNEL asks for it", "threads": 1}
    assert Path(found["header"]).read_text(encoding="utf-8").startswith("/* The position of a spheroid")
    assert list(found["oracles"]) == ["exact", "nearest", "roots", "mesh"]
    assert found["oracles"]["exact"] == {"available": True, "reason": None}
    assert set(found["versions"]) >= {"numpy", "sympy", "click"}


def test_info_as_text_shows_the_same_facts_as_json(run):
    code, said, _ = run(HYPCHECK_KERNEL="numpy")
    assert code == 0
    assert "kernel     numpy, up to 1 thread: HYPCHECK_KERNEL asks for it\n" in said
    assert "mesh: available\n" in said or "mesh: not available: " in said


def test_info_with_an_invalid_environment_variable_ends_2(run):
    for name, value in (("HYPCHECK_KERNEL", "fast"), ("HYPCHECK_THREADS", "-1"), ("HYPCHECK_THREADS", "two")):
        code, said, errors = run(**{name: value})
        assert (code, said) == (2, "")
        assert errors.startswith(f"hypcheck: error: {name} is {value!r}; it must be ")
        assert len(errors.splitlines()) == 1
