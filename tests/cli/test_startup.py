"""What a command loads: nothing that its run does not use."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from hypcheck.cli.main import main

LIBRARIES = ("msgspec", "numpy", "sympy", "mpmath", "fcl")
HEAVY = (*LIBRARIES, "matplotlib", "jinja2", "distributed", "dask", "importlib.metadata")
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


def after(arguments: list[str], before: str = "") -> set[str]:
    return loaded(f"{before}\nfrom hypcheck.cli.main import main; assert main({arguments!r}) == 0")


@pytest.mark.parametrize(
    "arguments", [["--help"], ["--version"], ["classify", "--help"], ["verify", "--help"], ["bench", "--help"]]
)
def test_help_and_version_load_no_large_modules(arguments):
    assert after(arguments) == set()


def test_help_of_any_command_loads_no_large_modules():
    each = "from hypcheck.cli.commands import COMMANDS; from hypcheck.cli.main import main"
    assert loaded(f"{each}; assert not any([main([name, '--help']) for name in COMMANDS])") == set()


def test_classify_of_one_pair_loads_neither_numpy_nor_mpmath():
    assert after(PAIR) == set()


@pytest.mark.parametrize(
    ("arguments", "allowed"),
    [
        (["cases", "list"], {"numpy"}),
        (["emit", "--scene", "tower", "--language", "c"], {"numpy"}),
        (["plan", "tower"], {"numpy"}),
        (["simulate", "forest"], {"numpy", "mpmath"}),
        (["replay", "tower-body/1/1/3", "builtin:fast"], {"msgspec", "numpy"}),
        (["verify", "builtin:hessian-float64", "--families", "tower-body", "--count", "9"], {"msgspec", "numpy"}),
        pytest.param(
            ["verify", "--self", "--oracles", "exact,roots", "--families", "tower-body", "--count", "9"],
            {"msgspec", "numpy", "sympy", "mpmath"},
            marks=pytest.mark.thorough,
        ),
    ],
)
def test_a_command_loads_only_libraries_that_it_uses(arguments, allowed, tmp_path):
    """A table of cases needs no oracle, a gate no derivation, and two oracles of four no mesh."""
    out, before = (["--out", str(tmp_path)], UNDRAWN) if arguments[0] == "verify" else ([], "")
    assert after([*arguments, *out], before) <= allowed | {"importlib.metadata"}


def test_a_text_report_does_not_load_the_plotting_modules(tmp_path, text_reports):
    assert main(["verify", "builtin:fast", "--families", "tower-body", "--count", "9", "--out", str(tmp_path)]) == 0
    for form in ([], ["--format", "markdown"], ["--format", "junit"]):
        assert after(["report", str(tmp_path), *form]) <= {"msgspec", "numpy", "importlib.metadata"}


def test_importing_the_package_loads_no_large_modules():
    assert loaded("import hypcheck; hypcheck.__version__") == set()


def test_calling_classify_from_python_loads_numpy_alone():
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
