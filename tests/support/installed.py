"""An installed wheel, as a stranger has it: built from the tracked files alone, installed into an empty environment."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
import sysconfig
import venv
from dataclasses import dataclass
from functools import cache
from importlib import metadata
from pathlib import Path

import pytest

from tests.support.shared_folders import made_once

ROOT = Path(__file__).resolve().parents[2]
ALL = os.environ.get("HYPCHECK_WHEEL") == "all"
GIT = (shutil.which("git") or "git", "ls-files", "-z")
USER = ("hypcheck[report]", "hypcheck[cluster]", "pytest")
"""What a user installs who leaves nothing out."""
OWN = ("HYPCHECK", "PYTHON", "PYTEST", "CI", "GITHUB_")
"""How variables begin that a stranger does not have."""


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
        own = {name: text for name, text in os.environ.items() if not name.startswith(OWN)}
        return own if self.compiler else own | {"CC": "false"}


VARIANTS = [Variant(source, compiler) for compiler in (True, False) for source in ("wheel", "sdist")][: 4 if ALL else 1]


@dataclass(frozen=True)
class Installed:
    """Two environments with the wheel: one has its declared dependencies and nothing else, one all of a user."""

    variant: Variant
    home: Path

    @property
    def python(self) -> Path:
        """The interpreter of the environment with the declared dependencies alone."""
        return self.home / "environment/bin/python"

    @property
    def user(self) -> Path:
        """The environment with all extras and pytest."""
        return self.home / "user"

    def run(self, command: str, folder: Path, environment: Path | None = None) -> subprocess.CompletedProcess[str]:
        """Run a command line of hypcheck as the installed script, where no other is named of the first environment."""
        words = [(environment or self.home / "environment") / "bin/hypcheck", *shlex.split(command)]
        own = self.variant.environment
        return subprocess.run(words, cwd=folder, env=own, capture_output=True, text=True, check=False)


def quietly(*words: object, **options: object) -> str:
    """What a program prints; where it fails, what it said."""
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


BUILD = """
import sys
from setuptools import build_meta
dist = sys.argv[1]  # which building changes
build_meta.build_sdist(dist)
build_meta.build_wheel(dist)
"""
"""What `python -m build` has four processes do."""


def build(variant: Variant, home: Path) -> None:
    """Build the wheel and the sdist of a clean tree into home/dist; of an sdist, a wheel from it alone."""
    tree, dist = home / "tree", home / "dist"
    for name in tracked():
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / name, tree / name)
    if not ALL:
        take_what_is_compiled(tree)
        dist.mkdir()
        quietly(sys.executable, "-c", BUILD, dist, cwd=tree, env=variant.environment)
        return
    forms = ["--sdist", "--wheel"] if variant.source == "wheel" else []  # without a form the wheel is made of the sdist
    quietly(sys.executable, "-m", "build", "--outdir", dist, *forms, tree, env=variant.environment)


def take_what_is_compiled(tree: Path) -> None:
    """Put the modules and the launcher that were compiled for these tests where the build looks for its own.

    They are younger than their sources, and so are not compiled again; `make wheel` compiles them.
    """
    built = tree / f"build/lib.{sysconfig.get_platform()}-{sys.implementation.cache_tag}"
    for path in (*ROOT.glob("hypcheck/*/_c*.so"), ROOT / "hypcheck/isolation/launcher"):
        if path.exists():
            target = built / path.relative_to(ROOT)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, target)
            shutil.copymode(path, target)


def make_environment(folder: Path, *wanted: str) -> Path:
    """Make an environment of what these requirements and hypcheck need, linked from ours; return its interpreter.

    They are linked by name, not seen through --system-site-packages: what is not declared cannot be imported.
    """
    venv.create(folder, symlinks=True)
    python = folder / "bin/python"
    site = site_packages(python)
    for name in dependencies("hypcheck", *wanted):
        link(metadata.distribution(name), site)
        write_scripts(metadata.distribution(name), python)
    return python


def site_packages(python: Path) -> Path:
    """Where the interpreter looks for what is installed."""
    return Path(quietly(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").strip())


def install(home: Path) -> None:
    """Install the wheel into both environments; `make test` links what is installed in the first into the other."""
    (wheel,) = (home / "dist").glob("*.whl")
    bare, user = make_environment(home / "environment"), make_environment(home / "user", *USER)
    for python in (bare, user) if ALL else (bare,):
        pip = (sys.executable, "-m", "pip", "--python", python)
        quietly(*pip, "install", "--no-compile", "--no-deps", "--quiet", "--disable-pip-version-check", wheel)
        if ALL:  # else both environments are linked from one whose requirements pip has met
            quietly(*pip, "check", "--disable-pip-version-check")
    if not ALL:
        (hypcheck,) = metadata.distributions(name="hypcheck", path=[str(site_packages(bare))])
        link(hypcheck, site_packages(user))
        write_scripts(hypcheck, user)


def dependencies(*wanted: str) -> set[str]:
    """The distributions that these requirements name, and all that these need; hypcheck itself is left out."""
    from packaging.requirements import Requirement
    from packaging.utils import canonicalize_name

    names: set[str] = set()
    waiting = [Requirement(text) for text in wanted]
    while waiting:
        named = waiting.pop()
        names.add(canonicalize_name(named.name))
        for needed in map(Requirement, metadata.requires(named.name) or ()):
            extras = named.extras or {""}
            applies = needed.marker is None or any(needed.marker.evaluate({"extra": extra}) for extra in extras)
            if applies and canonicalize_name(needed.name) not in names:
                waiting.append(needed)
    return names - {"hypcheck"}


def link(distribution: metadata.Distribution, folder: Path) -> None:
    """Link what the distribution has at the top of its folder into this one."""
    tops = {path.parts[0] for path in distribution.files or ()} - {"..", "__pycache__"}
    for top in tops:
        (folder / top).symlink_to(Path(str(distribution.locate_file(top))).resolve())


def write_scripts(distribution: metadata.Distribution, python: Path) -> None:
    """Write the commands of the distribution beside the interpreter, as pip would."""
    for entry in distribution.entry_points.select(group="console_scripts"):
        call = f"import sys\n    from {entry.module} import {entry.attr}\n    sys.exit({entry.attr}())"
        lines = f"if __name__ == '__main__':  # processes that it starts read it, too\n    {call}\n"
        script = python.parent / entry.name
        script.write_text(f"#!{python}\n{lines}", encoding="utf-8")
        script.chmod(0o755)


def installation(variant: Variant, tmp_path_factory: pytest.TempPathFactory) -> Installed:
    """The installed wheel; built once in a run of the tests, whatever number of processes run them."""

    def make(home: Path) -> None:
        build(variant, home)
        install(home)

    return Installed(variant, made_once(tmp_path_factory, f"installed-{variant}", make))
