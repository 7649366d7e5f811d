"""What a command loads: nothing that its run does not use."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from hypcheck.cli.main import main

LIBRARIES = ("msgspec", "numpy", "sympy", "mpmath", "fcl")
STUDIES = (
    "hypcheck.engines",
    "hypcheck.proofs",
    "hypcheck.paper.forest",
    "hypcheck.paper.ledger",
    "hypcheck.paper.tower",
)
HEAVY = (*LIBRARIES, *STUDIES, "matplotlib", "jinja2", "distributed", "dask", "importlib.metadata")
UNDRAWN = "sys.modules.update(matplotlib=None, jinja2=None)"
"""For runs whose reports are not tested: drawing them takes longer than the run."""

PAIR = ["classify", "--alpha", "1", "--gamma", "2", "--b", "1", "--d", "1", "--center", "2.5", "0", "0"]


def loaded(code: str) -> set[str]:
    """Which of HEAVY a fresh interpreter holds after running `code`."""
    report = (
        f"import json, sys; {code}; print(json.dumps([n for n in {HEAVY!r} if sys.modules.get(n)]), file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", report], capture_output=True, check=True)
    return set(json.loads(done.stderr.splitlines()[-1]))


def after(*commands: list[str], before: str = "") -> set[str]:
    """Which of HEAVY a fresh interpreter holds after these commands."""
    return loaded(f"{before}\nfrom hypcheck.cli.main import main; assert not any(map(main, {list(commands)!r}))")


def test_help_of_any_command_and_version_load_no_large_modules():
    helps = "from hypcheck.cli.commands import COMMANDS; from hypcheck.cli.main import main"
    words = "[['--help'], ['--version'], *([name, '--help'] for name in COMMANDS)]"
    assert loaded(f"{helps}; assert not any(map(main, {words}))") == set()


def test_classify_of_one_pair_loads_neither_numpy_nor_mpmath():
    assert after(PAIR) == set()


@pytest.mark.parametrize(
    ("commands", "allowed"),
    [
        ([["cases", "list"], ["emit", "--scene", "tower", "--language", "c"], ["plan", "tower"]], {"numpy"}),
        ([["simulate", "forest", "--steps", "20"]], {"numpy", "mpmath", "hypcheck.paper.forest"}),
        (
            [
                ["replay", "tower-body/1/1/3", "builtin:fast"],
                ["hunt", "python:tests.runs.faulty:exact", "--queries", "300"],
                ["verify", "builtin:hessian-float64", "--families", "tower-body", "--count", "9"],
            ],
            {"msgspec", "numpy"},
        ),
        pytest.param(
            [["verify", "--self", "--oracles", "exact,roots", "--families", "tower-body", "--count", "9"]],
            {"msgspec", "numpy", "sympy", "mpmath"},
            marks=pytest.mark.thorough,
        ),
    ],
)
def test_commands_load_only_libraries_and_studies_that_they_use(commands, allowed, tmp_path, monkeypatch):
    """A table of cases needs no oracle, a gate no derivation and no study, and two oracles of four no mesh."""
    monkeypatch.chdir(tmp_path)
    before = UNDRAWN if commands[-1][0] == "verify" else ""
    assert after(*commands, before=before) <= allowed | {"importlib.metadata"}


def test_a_text_report_does_not_load_the_plotting_modules(tmp_path, text_reports):
    assert main(["verify", "builtin:fast", "--families", "tower-body", "--count", "9", "--out", str(tmp_path)]) == 0
    forms = ([], ["--format", "markdown"], ["--format", "junit"])
    commands = [["report", str(tmp_path), *form] for form in forms]
    assert after(*commands) <= {"msgspec", "numpy", "importlib.metadata"}


def test_importing_the_package_loads_no_large_modules():
    assert loaded("import hypcheck; hypcheck.__version__") == set()


def test_calling_classify_from_python_loads_numpy_and_no_other_large_module():
    assert loaded("import hypcheck; hypcheck.classify([[1, 2, 1, 1, 2.5, 0, 0]])") <= {"numpy", "importlib.metadata"}


def test_dir_of_the_package_lists_its_public_names_and_each_can_be_used():
    import hypcheck

    assert {"classify", "classify_scene", "__version__"} <= set(dir(hypcheck))
    assert callable(hypcheck.classify)
    assert callable(hypcheck.classify_scene)
    with pytest.raises(hypcheck.InputError, match="row 0: b is -1"):
        hypcheck.classify([[1, 2, -1, 1, 2.5, 0, 0]])
    assert all(hasattr(hypcheck, name) for name in hypcheck.__all__)
    with pytest.raises(AttributeError, match="clasify"):
        hypcheck.clasify  # noqa: B018 - the look-up is the test


def test_python_m_hypcheck_is_the_same_program_as_the_script():
    done = subprocess.run([sys.executable, "-m", "hypcheck", "--version"], capture_output=True, check=True, text=True)
    import hypcheck

    assert done.stdout == f"hypcheck {hypcheck.__version__}\n"


def test_every_command_in_the_table_loads_and_has_a_help_text():
    import click

    from hypcheck.cli.commands import COMMANDS, hypcheck

    context = click.Context(hypcheck)
    for name in COMMANDS:
        command = hypcheck.get_command(context, name)
        assert command is not None
        assert command.name == name
        assert command.get_short_help_str(200).endswith(".")
