"""What a stranger installs: the wheel and the sdist of a clean tree, in an empty environment, used in an empty folder.

Everywhere else tests see an editable install, which has every file of the tree whether it is packaged or not. Here the
tracked files alone are copied, built and installed without --editable, and the shortest form of every command is run.
`make test` does this for the wheel; `make wheel` (HYPCHECK_WHEEL=all) also for a wheel built from the sdist, and for
both on a machine without a C compiler, built in isolation.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import tarfile
import zipfile
from pathlib import Path

import pytest

from hypcheck.cli.commands import COMMANDS
from hypcheck.cli.scene import LANGUAGES
from tests.support.installed import ALL, ROOT, VARIANTS, installation, make_environment, quietly, tracked

_FOR_COMPILERS = "kernel/core/(parts/|binding.c|at_once.h|columns.h)|isolation/.*[.][ch]$|implementations/.*[.]c$"
SOURCES = f"hypcheck/({_FOR_COMPILERS}|proofs/header/)"
"""What compilers and Coq read, and those who change it; a wheel has none of it."""

LARGEST = 5_000_000
"""Bytes of a wheel."""


@pytest.fixture(scope="session", params=VARIANTS, ids=str)
def installed(request, tmp_path_factory):
    """The installed package."""
    return installation(request.param, tmp_path_factory)


def test_the_wheel_has_every_file_of_the_package_and_no_other(installed):
    (wheel,) = (installed.home / "dist").glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        packed = {name for name in archive.namelist() if not re.match(r"hypcheck-[^/]*\.dist-info/", name)}
    made = r"hypcheck/((kernel/_compiled|implementations/_calls)\.[^/]*\.so|isolation/launcher)"
    compiled = {name for name in packed if re.fullmatch(made, name)}
    assert len(compiled) == (3 if installed.variant.compiler else 0)
    wanted = {name for name in tracked() if name.startswith("hypcheck/") and not re.match(SOURCES, name)}
    vectors = {name: re.fullmatch(r"cases/[^/]*\.json", name) for name in tracked() if name.startswith("cases/")}
    wanted |= {f"hypcheck/{name}{'.xz' if packed else ''}" for name, packed in vectors.items()}
    assert sorted(wanted - packed) == []
    assert sorted(packed - compiled - wanted) == []


def test_the_wheel_has_at_most_five_megabytes(installed):
    (wheel,) = (installed.home / "dist").glob("*.whl")
    assert wheel.stat().st_size <= LARGEST


def test_the_sdist_has_every_file_of_the_repository_and_no_other(installed):
    (sdist,) = (installed.home / "dist").glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        packed = {member.name.partition("/")[2] for member in archive.getmembers() if member.isfile()}
    made = {name for name in packed if name in {"PKG-INFO", "setup.cfg"} or name.startswith("hypcheck.egg-info/")}
    assert sorted(tracked() - packed) == []
    assert sorted(packed - made - tracked()) == []


def test_info_of_the_installed_wheel_names_the_kernel_that_was_built(installed, tmp_path):
    found = json.loads(installed.run("info --json", tmp_path).stdout)
    assert found["kernel"]["name"] == ("compiled" if installed.variant.compiler else "numpy")
    where = quietly(installed.python, "-c", "import hypcheck; print(hypcheck.__file__)", cwd=tmp_path)
    assert Path(where).is_relative_to(installed.home)


def test_the_python_sessions_of_the_pages_on_python_run_with_the_installed_wheel(installed, tmp_path):
    pages = [ROOT / "docs" / name for name in ("api.md", "calls.md")]
    quietly(installed.python, "-m", "doctest", *pages, cwd=tmp_path)


GATED = "verify builtin:fast --families tower-body --count 2"
COMPARED = "bench --quick --methods table-2-float64,table-2-float64-c --workloads uniform --processes 1 --rounds 1"
STEPS: dict[str, list[tuple[str, int, str]]] = {
    "verify": [("verify --self --families tower-body --count 2 --judged 2 --roots 2 --meshes 1", 0, "HELD")],
    "verify-spec": [
        (f"{GATED} --out run", 0, "HELD"),
        ("report run", 0, "HELD"),
        ("record check run", 0, "it is complete"),
        ("replay tower-body/1/1/0 builtin:fast --values", 0, "the answer of "),
    ],
    "bench": [(f"{COMPARED} --out quick", 0, "HELD")],
    "bench-scene": [("bench --scene tower --out scene", 0, "HELD: 1 scene")],
    "plan": [("plan tower", 0, "cooling tower"), ("plan tower --measure", 0, "Table 2 as printed")],
    "emit": [(f"emit --scene tower --language {language} --output kernel", 0, "") for language in LANGUAGES],
    "derive": [("derive --only costs", 0, "COSTS")],
    "derive-claim": [("derive --claim 12", 0, "12")],
    "simulate": [("simulate forest --steps 2", 0, "2 steps"), ("simulate tower", 0, "rotors")],
    "cases": [
        ("cases list", 0, "together"),
        ("cases show ring-0007", 0, "exterior"),
        ("cases generate ring --count 2 --output ring.json", 0, ""),
        ("cases check ring.json", 0, "none with a wrong label"),
    ],
    "hunt": [
        ("hunt builtin:table-2-float64 --queries 500", 0, "500 rows asked"),
        ("minimise builtin:table-2-float64 ring/1/0/3", 0, "rows asked"),
    ],
    "small": [
        ("info", 0, "oracles"),
        ("classify --alpha 1 --gamma 2 --b 1 --d 1 --center 2.5 0 0", 0, "exterior"),
        ("init --language c", 0, "Type next"),
        ("init --language go --from 1.2.0", 0, "added to"),
        ("completion bash", 0, "complete -o"),
        ("explain ring", 0, "A < B²"),
        ("engines list", 0, "python-fcl"),
        ("show tower --out view.html", 0, "wrote view.html"),
        ("flight tower nowhere.csv", 2, "nowhere.csv"),
    ],
}
"""Command lines in the order in which they are run in one empty folder, with the exit code and a part of the output."""

WITHOUT_A_COMPILER = {
    "plan tower --measure": (2, "does not compile"),
    "bench --scene tower --out scene": (2, "no scene was measured"),
}


@pytest.mark.thorough
@pytest.mark.parametrize("name", STEPS)
def test_every_command_of_the_installed_package_ends_with_its_code_in_an_empty_folder(installed, name, tmp_path):
    for command, code, part in STEPS[name]:
        if not installed.variant.compiler:
            code, part = WITHOUT_A_COMPILER.get(command, (code, part))  # noqa: PLW2901 - the same step, elsewhere
        done = installed.run(command, tmp_path)
        said = done.stdout + done.stderr
        assert done.returncode == code, f"hypcheck {command}\n{said}"
        assert part in said, f"hypcheck {command}\n{said}"


TYPED = """
import shlex, sys
from hypcheck.cli.main import main
print([int(main(shlex.split(each))) for each in sys.argv[1:]])
"""


def test_commands_of_the_installed_package_need_nothing_that_is_not_declared(installed, tmp_path):
    """In one process; tests/test_page_commands.py types commands as a user does, who has all extras."""
    steps = STEPS["verify-spec"] + STEPS["small"]
    words = [installed.python, "-c", TYPED, *(command for command, _, _ in steps)]
    done = subprocess.run(
        words, cwd=tmp_path, env=installed.variant.environment, capture_output=True, text=True, check=False
    )
    assert done.stdout.endswith(f"{[code for _, code, _ in steps]}\n"), done.stdout + done.stderr
    assert [part for _, _, part in steps if part not in done.stdout + done.stderr] == []


@pytest.mark.thorough
def test_the_installed_package_with_the_report_extra_writes_an_html_report_with_plots(installed, tmp_path):
    done = installed.run(f"{GATED} --out run", tmp_path, installed.user)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "</svg>" in (tmp_path / "run/report.html").read_text(encoding="utf-8")


@pytest.mark.thorough
@pytest.mark.parametrize("source", ["wheel", "git"] if ALL else ["wheel"])
def test_the_workflow_that_init_writes_runs_in_a_fresh_clone_for_two_languages(installed, source, tmp_path):
    """Its command lines, in an environment without hypcheck. The stubs are right in the family that is asked here."""
    repository, clone, environment = tmp_path / "engine", tmp_path / "clone", tmp_path / "environment"
    repository.mkdir()
    (wheel,) = (installed.home / "dist").glob("*.whl")
    named = f"file://{ROOT}"
    if source == "wheel":
        named = f"./{Path(shutil.copy(wheel, repository)).name}"
    for language in ("python", "c") if installed.variant.compiler else ("python",):
        done = installed.run(f"init --language {language} --from {named}", repository)
        assert done.returncode == 0, done.stderr
    settings = repository / "hypcheck.toml"
    settings.write_text(settings.read_text() + 'families = ["forest-type-1"]\ncount = 10\n')
    commit(repository, clone)
    python = make_environment(environment, "pip")
    variables = installed.variant.environment | {
        "PATH": f"{python.parent}{os.pathsep}{os.environ['PATH']}",
        "CI": "true",
    }
    lines = re.findall(r"run: \|\n +(.*)\n", (clone / ".github/workflows/hypcheck.yml").read_text())
    assert len(lines) == 1 + 2 * len(list(clone.glob("hypcheck-*/")))
    for line in [*lines, "hypcheck verify"]:
        said = quietly("/bin/sh", "-e", "-c", line, cwd=clone, env=variables)
        assert "HELD" in said or "verify" not in line
    assert Path(quietly(python, "-c", "import hypcheck; print(hypcheck.__file__)", cwd=tmp_path)).is_relative_to(
        environment
    )
    assert {path.name for path in clone.iterdir()} >= {"reports", "hypcheck-report"}
    assert quietly("git", "-C", clone, "status", "--porcelain") == ""


def commit(repository: Path, clone: Path) -> None:
    """Commit everything in a folder, and clone it."""
    quietly("git", "-C", repository, "init", "--quiet")
    quietly("git", "-C", repository, "add", ".")
    who = ["-c", "user.name=A", "-c", "user.email=a@example.org"]
    quietly("git", "-C", repository, *who, "commit", "--quiet", "-m", "Gate the predicates")
    quietly("git", "clone", "--quiet", repository, clone)


def test_the_steps_for_the_installed_package_include_every_command():
    assert {command.split()[0] for steps in STEPS.values() for command, _, _ in steps} == set(COMMANDS)
