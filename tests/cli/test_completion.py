"""Completion by bash, zsh and fish: the scripts, and the answers to each shell."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import click
import pytest

from hypcheck.cli import COMPLETE
from hypcheck.cli.commands import SHELLS, hypcheck
from hypcheck.cli.main import main
from hypcheck.cli.options import Names

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
    "hypcheck verify --families tilted-t": {"tilted-t" + name for name in ("ower", "angent", "wins")},
    "hypcheck plan tower-": {"tower-simplest"},
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


def test_completion_refuses_a_place_in_the_line_that_is_not_a_number(monkeypatch, capsys):
    for name, value in (asked("bash", "hypcheck verify", {}) | {"COMP_CWORD": "second"}).items():
        monkeypatch.setenv(name, value)
    assert main([]) == 2
    assert "but COMP_CWORD is not a number; the shell sets it" in capsys.readouterr().err


@pytest.fixture
def offers(monkeypatch, capsys):
    """The types and values that a shell is answered for the last word of a line."""

    def answer(shell, line):
        for name, value in asked(shell, line, {}).items():
            monkeypatch.setenv(name, value)
        assert main([]) == 0
        lines = capsys.readouterr().out.splitlines()
        if shell == "zsh":
            return list(zip(lines[::3], lines[1::3], strict=True))
        return [tuple(line.split("\t")[0].split(",", 1)) for line in lines]

    return answer


NAMES = {
    "hypcheck verify --families extreme-ma": ["extreme-magnitude"],
    "hypcheck verify --families ring,extreme-ma": ["ring,extreme-magnitude"],
    "hypcheck verify --families=extreme-ma": ["--families=extreme-magnitude"],
    "hypcheck verify builtin:fast-": ["builtin:fast-numpy"],
    "hypcheck hunt builtin:fast-": ["builtin:fast-numpy"],
    "hypcheck bench builtin:fast-": ["builtin:fast-numpy"],
    "hypcheck replay ring-000": [f"ring-000{digit}" for digit in range(10)],
    "hypcheck replay tower": ["tower-body-", "tower-rotors-"],
    "hypcheck replay way-rin": [f"way-ring-{number:04}" for number in range(111)],
    "hypcheck minimise builtin:fast ring-001": [f"ring-001{digit}" for digit in range(10)],
    "hypcheck bench --methods fast,nearest": ["fast,nearest-point"],
    "hypcheck bench --tilted --methods eig": ["eigh"],
    "hypcheck bench --question passage --methods passage-cap": ["passage-capsule"],
    "hypcheck bench --workloads uniform,ri": ["uniform,ring"],
    "hypcheck bench --scene fo": ["forest"],
    "hypcheck emit --scene fo": ["forest"],
    "hypcheck emit --method e": ["exact"],
    "hypcheck simulate tower --scene tower-": ["tower-simplest"],
    "hypcheck explain thro": ["throat"],
    "hypcheck cases show ring-023": [f"ring-023{digit}" for digit in range(10)],
    "hypcheck cases generate extreme-ma": ["extreme-magnitude"],
    "hypcheck cases freeze ring tower-b": ["tower-body"],
    "hypcheck engines verify rapier": ["rapier3d"],
}


@pytest.mark.parametrize("line", NAMES)
@pytest.mark.parametrize("shell", SHELLS)
def test_completion_offers_the_names_that_a_value_may_have(shell, line, offers):
    assert offers(shell, line) == [("plain", name) for name in NAMES[line]]


@pytest.mark.parametrize("shell", SHELLS)
def test_completion_offers_no_file_where_a_name_is_wanted(shell, offers):
    for line in ("hypcheck verify --families zz", "hypcheck explain zz", "hypcheck replay zz"):
        assert [kind for kind, _ in offers(shell, line)] == ["nothing"], line


@pytest.mark.parametrize("shell", SHELLS)
def test_completion_offers_files_where_a_scene_or_a_spec_may_be_one(shell, offers):
    for line in ("hypcheck plan zz", "hypcheck verify python:zz", "hypcheck verify library:./zz"):
        assert offers(shell, line) == [("file", line.split()[-1])], line


@pytest.mark.parametrize(
    ("words", "kind", "value"),
    [
        ("builtin : fast-", "plain", "fast-numpy"),
        ("--families = extreme-ma", "plain", "extreme-magnitude"),
        ("python : zz", "file", "zz"),
        ("library :", "file", ":"),
    ],
)
def test_completion_of_bash_offers_the_part_behind_the_colons_that_it_splits_words_at(words, kind, value, offers):
    assert offers("bash", f"hypcheck verify {words}") == [(kind, value)]


def test_every_value_with_a_table_of_names_is_completed_from_it():
    """An option or argument of these names, in any command, is none that completes files."""
    tables = {"specs", "spec", "case", "families", "family", "methods", "method", "workloads", "scene", "names"}
    for path, command in every_command(hypcheck, ()):
        for parameter in command.params:
            if parameter.name in tables:
                assert isinstance(parameter.type, Names), (path, parameter.name)


def every_command(command, path):
    if isinstance(command, click.Group):
        context = click.Context(command)
        for name in command.list_commands(context):
            yield from every_command(command.get_command(context, name), (*path, name))
    else:
        yield path, command
