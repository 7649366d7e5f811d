"""Engines in environments of their own, in a cache folder, by the ordinary package managers; ours is never touched.

The adapter's files are copied there, since npm and cargo find packages beside the files that use them. What has been
installed carries the digest of these files and the version: another hypcheck installs anew.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
from importlib import metadata
from pathlib import Path

from hypcheck.engines.table import FOLDER, Engine
from hypcheck.errors import InputError, UnavailableError
from hypcheck.messages import escaped

VARIABLE = "HYPCHECK_ENGINES"
_READY = "ready"

_TOOLS = {
    "pip": (),
    "npm": (("node", "Node.js"), ("npm", "npm, which comes with Node.js")),
    "cargo": (("cargo", "Rust and its cargo"),),
}
"""The programs that each manager needs beside Python, and what to install for them."""


def cache_folder() -> Path:
    """Where engines are installed: HYPCHECK_ENGINES, or hypcheck/engines in the user's cache (XDG_CACHE_HOME)."""
    if os.environ.get(VARIABLE):
        return Path(os.environ[VARIABLE])
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "hypcheck" / "engines"


def missing_tool(engine: Engine) -> str | None:
    """The sentence about a program that installing or running the engine needs and this machine has not, or None."""
    for program, wanted in _TOOLS[engine.manager]:
        if shutil.which(program) is None:
            return f"{engine.name} needs the program {program}, which is not installed; install {wanted}"
    return None


def is_installed(engine: Engine, cache: Path) -> bool:
    """Whether this version of the engine is there, with this version of its adapter."""
    ready = cache / engine.name / _READY
    return ready.is_file() and ready.read_text() == _digest(engine)


def install(engine: Engine, cache: Path) -> None:
    """Make the engine's environment anew. Raises UnavailableError where a program or the network is missing."""
    trouble = missing_tool(engine)
    if trouble is not None:
        raise UnavailableError(trouble)
    folder = (cache / engine.name).absolute()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for file in engine.files:
        shutil.copyfile(FOLDER / file, folder / Path(file).name)
    for step in _steps(engine, folder):
        done = subprocess.run(step, cwd=folder, capture_output=True, text=True, check=False, errors="replace")  # noqa: S603
        if done.returncode != 0:
            shutil.rmtree(folder, ignore_errors=True)
            last = [line for line in (done.stderr or done.stdout).splitlines() if line.strip()][-1:] or ["nothing"]
            said = escaped(last[0].strip(), 200)
            raise UnavailableError(f"{engine.name} could not be installed: {engine.manager} ended with: {said}")
    (folder / _READY).write_text(_digest(engine))


def command(engine: Engine, cache: Path, scene: Path) -> tuple[str, ...]:
    """The words that start the engine's adapter on a scene. Raises InputError where it is not installed."""
    if not is_installed(engine, cache):
        raise InputError(f"{engine.name} is not installed; type: hypcheck engines install {engine.name}")
    folder = (cache / engine.name).absolute()
    starts = {
        "pip": (str(_python_of(folder)), str(folder / "adapter.py")),
        "npm": ("node", str(folder / "adapter.mjs")),
        "cargo": (str(folder / "target" / "release" / "adapter"),),
    }
    return (*starts[engine.manager], str(scene))


def _python_of(folder: Path) -> Path:
    own = folder / "venv" / "bin" / "python"
    return own if own.is_file() else Path(sys.executable)


def _steps(engine: Engine, folder: Path) -> list[list[str]]:
    if engine.manager == "npm":
        quiet = ["--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error"]
        return [["npm", "install", "--prefix", str(folder), *quiet, f"{engine.package}@{engine.version}"]]
    if engine.manager == "cargo":
        return [["cargo", "build", "--release", "--quiet", "--manifest-path", str(folder / "Cargo.toml")]]
    if _have(engine):
        return []
    pip = [str(folder / "venv" / "bin" / "python"), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    wanted = [f"{engine.package}=={engine.version}", "numpy"]
    return [[sys.executable, "-m", "venv", str(folder / "venv")], [*pip, "--only-binary", ":all:", *wanted]]


def _have(engine: Engine) -> bool:
    """Whether our own Python has this very version: then nothing is installed, and the adapter runs with ours."""
    try:
        return metadata.version(engine.package) == engine.version
    except metadata.PackageNotFoundError:
        return False


def _digest(engine: Engine) -> str:
    found = hashlib.sha256(f"{engine.package} {engine.version}".encode())
    for file in engine.files:
        found.update((FOLDER / file).read_bytes())
    return found.hexdigest()
