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
import shlex
import shutil
import subprocess
import sys
import tarfile
import venv
import zipfile
from dataclasses import dataclass
from functools import cache
from importlib import metadata
from pathlib import Path

import pytest

from hypcheck.cli.commands import COMMANDS
from hypcheck.cli.scene import LANGUAGES
from tests.support.shared_folders import made_once

ROOT = Path(__file__).resolve().parents[1]
ALL = os.environ.get("HYPCHECK_WHEEL") == "all"
GIT = (shutil.which("git") or "git", "ls-files", "-z")
REPORT = "report"
"""The extra whose templates are package data."""


@cache
def tracked() -> frozenset[str]:
    """The files of the repository, as git has them."""
    try:
        done = subprocess.run(GIT, cwd=ROOT, capture_output=True, check=True, text=True)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("this is no git checkout, so nobody knows which files are to be packaged")
    return frozenset(name for name in done.stdout.split("\0") if name and (ROOT / name).exists())


@dataclass(frozen=True)
class Variant:
    """What is installed, and whether building and running find a C compiler."""

    source: str
    compiler: bool

    def __str__(self) -> str:
        return f"{self.source}-{'compiled' if self.compiler else 'no-compiler'}"

    @property
    def environment(self) -> dict[str, str]:
        """Of a user who has nothing of ours."""
        own = {name: text for name, text in os.environ.items() if not name.startswith(("HYPCHECK", "PYTHON", "CI"))}
        return own if self.compiler else own | {"CC": "false"}


VARIANTS = [Variant(source, compiler) for compiler in (True, False) for source in ("wheel", "sdist")][: 4 if ALL else 1]


@dataclass(frozen=True)
class Installed:
    """An environment with the package and its declared dependencies, and nothing else."""

    variant: Variant
    home: Path

    @property
    def python(self) -> Path:
        """Its interpreter."""
        return self.home / "environment/bin/python"

    @property
    def report_extra(self) -> Path:
        """A folder with what the extra adds."""
        return self.home / "report-extra"

    def run(self, command: str, folder: Path, *paths: Path) -> subprocess.CompletedProcess[str]:
        """Run a command line of hypcheck as the installed script."""
        environment = self.variant.environment | ({"PYTHONPATH": os.pathsep.join(map(str, paths))} if paths else {})
        words = [self.python.parent / "hypcheck", *shlex.split(command)]
        return subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True, check=False)


def quietly(*words: object, **options: object) -> str:
    """What a program prints; where it fails, what it said."""
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def build(variant: Variant, home: Path) -> None:
    """Build the wheel and the sdist of a clean tree into home/dist; of an sdist, a wheel from it alone."""
    tree, dist = home / "tree", home / "dist"
    for name in tracked():
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / name, tree / name)
    build = [sys.executable, "-m", "build", *([] if ALL else ["--no-isolation"]), "--outdir", dist]
    forms = (
        ["--sdist", "--wheel"] if variant.source == "wheel" else []
    )  # without a form the wheel is made from the sdist
    quietly(*build, *forms, tree, env=variant.environment)


def make_environment(folder: Path, *, with_pip: bool) -> Path:
    """Make an environment of the declared dependencies, linked from ours, and return its interpreter.

    They are linked by name, not seen through --system-site-packages: what is not declared cannot be imported.
    """
    venv.create(folder, symlinks=True)
    python = folder / "bin/python"
    site = Path(quietly(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").strip())
    link(dependencies("") | ({"pip"} if with_pip else set()), site)
    return python


def install(home: Path) -> None:
    """Install the wheel into an environment that has its dependencies alone, and lay the extra's beside it."""
    pip = (sys.executable, "-m", "pip", "--python", make_environment(home / "environment", with_pip=False))
    (wheel,) = (home / "dist").glob("*.whl")
    quietly(*pip, "install", "--no-deps", "--quiet", "--disable-pip-version-check", wheel)
    quietly(*pip, "check", "--disable-pip-version-check")
    (home / "report-extra").mkdir()
    link(dependencies(REPORT) - dependencies(""), home / "report-extra")


def dependencies(extra: str) -> set[str]:
    """The distributions that an installation of the extra needs, with theirs."""
    from packaging.requirements import Requirement

    found: set[str] = set()
    waiting = [("hypcheck", extra)]
    while waiting:
        name, wanted = waiting.pop()
        needed = [Requirement(text) for text in metadata.requires(name) or ()]
        for each in needed:
            if each.name not in found and (each.marker is None or each.marker.evaluate({"extra": wanted})):
                found.add(each.name)
                waiting.append((each.name, ""))
    return found


def link(names: set[str], folder: Path) -> None:
    for name in names:
        distribution = metadata.distribution(name)
        tops = {path.parts[0] for path in distribution.files or ()} - {"..", "__pycache__"}
        for top in tops:
            (folder / top).symlink_to(Path(str(distribution.locate_file(top))).resolve())


@pytest.fixture(scope="session", params=VARIANTS, ids=str)
def installed(request, tmp_path_factory):
    """The installed package; made once, whatever number of processes run the tests."""

    def make(home):
        build(request.param, home)
        install(home)

    return Installed(request.param, made_once(tmp_path_factory, f"installed-{request.param}", make))


def test_the_wheel_has_every_file_of_the_package_and_no_other(installed):
    (wheel,) = (installed.home / "dist").glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        packed = {name for name in archive.namelist() if not re.match(r"hypcheck-[^/]*\.dist-info/", name)}
    made = r"hypcheck/((kernel/_compiled|implementations/_calls)\.[^/]*\.so|isolation/launcher)"
    compiled = {name for name in packed if re.fullmatch(made, name)}
    assert len(compiled) == (3 if installed.variant.compiler else 0)
    wanted = {name for name in tracked() if name.startswith("hypcheck/")}
    wanted |= {f"hypcheck/{name}" for name in tracked() if name.startswith("cases/")}
    assert sorted(wanted - packed) == []
    assert sorted(packed - compiled - wanted) == []


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


GATED = "verify builtin:fast --families tower-body --count 2"
COMPARED = "bench --quick --methods table-2-float64,table-2-float64-c --workloads uniform --processes 1 --rounds 1"
STEPS: dict[str, list[tuple[str, int, str]]] = {
    "verify": [("verify --self --families tower-body --count 2 --judged 2 --roots 2 --meshes 1", 0, "HELD")],
    "verify-spec": [
        (f"{GATED} --out run", 0, "HELD"),
        ("report run", 0, "HELD"),
        ("record check run", 0, "it is complete"),
        ("replay tower-body/1/1/0 builtin:fast", 0, "the answer of "),
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
        ("engines list", 0, "python-fcl"),
    ],
}
"""Command lines in the order in which they are run in one empty folder, with the exit code and a part of the output."""

WITHOUT_A_COMPILER = {
    "plan tower --measure": (2, "does not compile"),
    "bench --scene tower --out scene": (2, "no scene was measured"),
}


FEW = ("verify", "verify-spec", "small")
"""What `make test` types; `make thorough` types the others, too."""


@pytest.mark.parametrize(
    "name", [name if name in FEW else pytest.param(name, marks=pytest.mark.thorough) for name in STEPS]
)
def test_every_command_of_the_installed_package_ends_with_its_code_in_an_empty_folder(installed, name, tmp_path):
    for command, code, part in STEPS[name]:
        if not installed.variant.compiler:
            code, part = WITHOUT_A_COMPILER.get(command, (code, part))  # noqa: PLW2901 - the same step, elsewhere
        done = installed.run(command, tmp_path)
        said = done.stdout + done.stderr
        assert done.returncode == code, f"hypcheck {command}\n{said}"
        assert part in said, f"hypcheck {command}\n{said}"


def test_the_installed_package_with_the_report_extra_writes_an_html_report_with_plots(installed, tmp_path):
    done = installed.run(f"{GATED} --out run", tmp_path, installed.report_extra)
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
    python = make_environment(environment, with_pip=True)
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
