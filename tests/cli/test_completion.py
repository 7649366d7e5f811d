"""Completion by bash, zsh and fish: the scripts, and the answers to each shell."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from hypcheck.cli import COMPLETE
from hypcheck.cli.commands import SHELLS

BASH = """
eval "$(hypcheck completion bash)"
COMP_WORDS=({words}) COMP_CWORD={place} COMPREPLY=()
compopt() {{ echo files; }}
_hypcheck_completion hypcheck
(IFS=$'\\n'; echo "${{COMPREPLY[*]}}")
"""
ZSH = """
compdef() {{ :; }}
eval "$(hypcheck completion zsh)"
words=({words}) CURRENT=$(({place} + 1))
compadd() {{ print -rl -- $completions; }}
_describe() {{ print -rl -- $completions_with_descriptions; }}
_path_files() {{ echo files; }}
_hypcheck_completion
"""
FISH = """
hypcheck completion fish | source
complete --do-complete '{line}'
"""
LINES = {
    "hypcheck mini": {"minimise"},
    "hypcheck verify --f": {"--families", "--fail-on", "--fresh"},
    "hypcheck verify --fail-on w": {"wrong"},
    "hypcheck simulate ''": {"forest", "tower"},
    "hypcheck completion z": {"zsh"},
}


@pytest.fixture
def environment(tmp_path):
    """Of a shell whose PATH has a hypcheck."""
    script = tmp_path / "bin" / "hypcheck"
    script.parent.mkdir()
    script.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m hypcheck "$@"\n')
    script.chmod(0o755)
    path = f"{script.parent}{os.pathsep}{os.environ['PATH']}"
    return os.environ | {"PATH": path, "PYTHONPATH": str(Path(__file__).parents[2]), "HOME": str(tmp_path)}


def completed(shell: str, line: str, environment: dict[str, str]) -> list[str]:
    """What a real shell offers for the last word of a line."""
    program = shutil.which(shell)
    if program is None:
        pytest.skip(f"{shell} is not on the PATH")
    place = len(line.split()) - 1
    text = {"bash": BASH, "zsh": ZSH, "fish": FISH}[shell].format(words=line, place=place, line=line.replace("''", ""))
    words = [program, *{"bash": ["--norc"], "zsh": ["-f"], "fish": ["--no-config"]}[shell], "-c", text]
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=True)
    assert done.stderr == ""
    return [offered.split("\t")[0].split(":")[0] for offered in done.stdout.split("\n") if offered]


@pytest.mark.parametrize("shell", SHELLS)
def test_completion_in_a_shell_offers_commands_options_and_values(shell, environment):
    for line, expected in LINES.items():
        assert set(completed(shell, line, environment)) == expected, line


@pytest.mark.parametrize("shell", ["bash", "zsh"])
def test_completion_in_a_shell_offers_files_where_a_value_is_free_text(shell, environment):
    for line in ("hypcheck classify --input tab", "hypcheck classify --input ''"):
        assert completed(shell, line, environment) == ["files"]


def test_completion_in_fish_offers_files_where_a_value_is_free_text(environment, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "table.csv").touch()
    assert completed("fish", "hypcheck classify --input tab", environment) == ["table.csv"]


def asked(shell: str, line: str, environment: dict[str, str]) -> dict[str, str]:
    """The variables by which a shell asks, in click's protocol."""
    words = line.split()
    place = words[-1] if shell == "fish" else str(len(words) - 1)
    return environment | {COMPLETE: f"{shell}_complete", "COMP_WORDS": line, "COMP_CWORD": place}


def test_completion_loads_neither_numpy_nor_other_large_modules(environment):
    heavy = ("numpy", "sympy", "mpmath", "fcl", "matplotlib", "jinja2", "importlib.metadata")
    code = f"""
import json, sys
from hypcheck.cli.main import main
assert main([]) == 0
print(json.dumps([name for name in {heavy!r} if name in sys.modules]), file=sys.stderr)
"""
    for line in ("hypcheck verify --f", "hypcheck emit --language r"):
        variables = asked("bash", line, environment)
        done = subprocess.run([sys.executable, "-c", code], env=variables, capture_output=True, check=True)
        assert json.loads(done.stderr) == [], line
