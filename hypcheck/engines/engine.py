"""The engines: name, pinned version, where they come from, and the shapes that they are given; how each is installed.

Each has a folder of its name beside this file, with the adapter that we wrote: an ordinary command of the protocol
(docs/protocol.md), started with the folder of a scene (scene.py). Its first comment says what it asks of the engine.

Each is installed in an environment of its own, in a cache folder, by the ordinary package managers; ours is never
touched. The adapter's files are copied there, since npm and cargo find packages beside the files that use them. What
has been installed carries the digest of these files and the version: another hypcheck installs anew.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Literal

from hypcheck.errors import InputError, UnavailableError
from hypcheck.messages import escaped, suggestion

FOLDER = Path(__file__).parent

Manager = Literal["pip", "npm", "cargo"]


@dataclass(frozen=True, slots=True)
class Setting:
    """A setting of an engine's accuracy: in the engine's words, and as a length in its unit, None if it states none."""

    words: str
    tolerance: float | None


NOT_OFFERED = Setting("it offers no setting", None)


@dataclass(frozen=True, slots=True)
class Engine:
    """An engine; `package` is its name for the package manager.

    `body` is the shape that represents a spheroid that is not a ball: the engine's own ellipsoid, the convex hull of
    points on the spheroid, or the engine's ball in a scaled space, in which no spheroid can be tilted. A ball is always
    the engine's own. `single` is true if it computes in float32. `files` are the adapter's, from this folder. An
    adapter leaves the engine at its `default` settings, or takes the `tightest` that the engine offers. `tightens` is
    False if the other setting selects another method that is not more accurate; then the engine is judged by its
    default.
    """

    name: str
    package: str
    version: str
    manager: Manager
    body: Literal["ellipsoid", "hull", "scaled ball"]
    files: tuple[str, ...]
    single: bool = False
    default: Setting = NOT_OFFERED
    tightest: Setting = NOT_OFFERED
    tightens: bool = True

    @property
    def tilts(self) -> bool:
        """Whether it can be asked about tilted spheroids."""
        return self.body != "scaled ball"

    @property
    def adjustable(self) -> bool:
        """Whether it offers a setting that changes its accuracy."""
        return self.tightest != self.default

    @property
    def judged(self) -> Setting:
        """The setting that it is judged by."""
        return self.tightest if self.tightens else self.default

    @property
    def other(self) -> str:
        """The words for the setting other than the default."""
        return "tightest" if self.tightens else "other solver"


def _in_python(
    name: str,
    version: str,
    body: Literal["ellipsoid", "hull"],
    default: Setting,
    tightest: Setting,
    *,
    tightens: bool = True,
) -> Engine:
    files = (f"{name}/adapter.py", "speaking/speak.py")
    return Engine(name, name, version, "pip", body, files, default=default, tightest=tightest, tightens=tightens)


def _in_javascript(
    name: str,
    version: str,
    body: Literal["hull", "scaled ball"],
    package: str = "",
    default: Setting = NOT_OFFERED,
    tightest: Setting = NOT_OFFERED,
) -> Engine:
    files = (f"{name}/adapter.mjs", "speaking/speak.mjs")
    single = name != "cannon-es"
    return Engine(name, package or name, version, "npm", body, files, single, default, tightest)


def _in_rust(name: str, version: str, *, single: bool) -> Engine:
    files = (f"{name}/Cargo.toml", "parry3d-f64/adapter.rs", "speaking/speak.rs")
    return Engine(name, name, version, "cargo", "hull", files, single)


_LIBCCD = Setting("solver GST_LIBCCD, whose tolerance 1e-6 it does not expose", 1e-6)
_INDEP = Setting("GST_INDEP, whose tolerance 1e-6 it does not expose", 1e-6)

ENGINES = {
    engine.name: engine
    for engine in (
        _in_python("python-fcl", "0.7.0.11", "ellipsoid", _LIBCCD, _INDEP, tightens=False),
        _in_python(
            "coal", "3.0.3", "ellipsoid",
            Setting("gjk_tolerance and epa_tolerance 1e-6", 1e-6),
            Setting("gjk_tolerance and epa_tolerance 1e-10", 1e-10),
        ),
        _in_python(
            "mujoco", "4.0.0", "ellipsoid",
            Setting("ccd_tolerance 1e-6", 1e-6),
            Setting("ccd_tolerance 1e-12", 1e-12),
        ),
        _in_python(
            "pybullet", "3.2.7", "hull",
            Setting("collisionMargin 0.001 for both bodies", 0.002),
            Setting("collisionMargin 0 for both bodies", 0.0),
        ),
        _in_rust("parry3d-f64", "0.31.1", single=False),
        _in_rust("parry3d", "0.31.1", single=True),
        _in_javascript(
            "jolt-physics", "1.1.0", "hull",
            default=Setting("convex radius 0.05, hull tolerance 1e-3, other tolerances 1e-4", 1e-3),
            tightest=Setting("convex radius 0, hull tolerance 1e-5, other tolerances 1e-6", 1e-5),
        ),
        _in_javascript("rapier3d", "0.21.0", "hull", "@dimforge/rapier3d-compat"),
        _in_javascript(
            "ammo.js", "0.0.10", "hull",
            default=Setting("margin 0.04 of the hull", 0.04),
            tightest=Setting("margin 0 of the hull", 0.0),
        ),
        _in_javascript("cannon-es", "0.20.0", "scaled ball"),
    )
}  # fmt: skip


def engines_of(names: Iterable[str]) -> list[Engine]:
    """Return the engines of these names, or all if there are no names. Raises InputError for an unknown name."""
    for name in names:
        if name not in ENGINES:
            raise InputError(f"there is no engine {name!r}; {suggestion(name, ENGINES)}")
    return [ENGINES[name] for name in (dict.fromkeys(names) or ENGINES)]


VARIABLE = "HYPCHECK_ENGINES"
_READY = "ready"

_TOOLS = {
    "pip": (),
    "npm": (("node", "Node.js"), ("npm", "npm, which comes with Node.js")),
    "cargo": (("cargo", "Rust and its cargo"),),
}
"""The programs that each package manager needs in addition to Python, and what to install for them."""


def cache_folder() -> Path:
    """Return the folder in which engines are installed: HYPCHECK_ENGINES, else hypcheck/engines in XDG_CACHE_HOME."""
    if os.environ.get(VARIABLE):
        return Path(os.environ[VARIABLE])
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "hypcheck" / "engines"


def missing_tool(engine: Engine) -> str | None:
    """Return a sentence about a program that the engine needs and this machine lacks, or None if nothing is missing."""
    for program, wanted in _TOOLS[engine.manager]:
        if shutil.which(program) is None:
            return f"{engine.name} needs the program {program}, which is not installed; install {wanted}"
    return None


def is_installed(engine: Engine, cache: Path) -> bool:
    """Decide whether this version of the engine is installed, with this version of its adapter."""
    ready = cache / engine.name / _READY
    return ready.is_file() and ready.read_text() == _digest(engine)


def install(engine: Engine, cache: Path) -> None:
    """Install the engine in a new environment. Raises UnavailableError where a program or the network is missing."""
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
            last_words = escaped(last[0].strip(), 200)
            raise UnavailableError(f"{engine.name} could not be installed: {engine.manager} ended with: {last_words}")
    (folder / _READY).write_text(_digest(engine))


def command(engine: Engine, cache: Path, scene: Path, *, tightest: bool = False) -> tuple[str, ...]:
    """Return the command line that starts the engine's adapter on a scene. Raises InputError if it is not installed."""
    if not is_installed(engine, cache):
        raise InputError(f"{engine.name} is not installed; type: hypcheck engines install {engine.name}")
    folder = (cache / engine.name).absolute()
    starts = {
        "pip": (str(_python_of(folder)), str(folder / "adapter.py")),
        "npm": ("node", str(folder / "adapter.mjs")),
        "cargo": (str(folder / "target" / "release" / "adapter"),),
    }
    return (*starts[engine.manager], str(scene), *(["tightest"] if tightest else []))


def _python_of(folder: Path) -> Path:
    """Return the Python of an engine's environment, or ours if it has none."""
    own = folder / "venv" / "bin" / "python"
    return own if own.is_file() else Path(sys.executable)


def _steps(engine: Engine, folder: Path) -> list[list[str]]:
    """Return the command lines that install the engine in the folder."""
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
    """Decide whether our own Python has exactly this version; then nothing is installed, and the adapter uses ours."""
    try:
        return metadata.version(engine.package) == engine.version
    except metadata.PackageNotFoundError:
        return False


def _digest(engine: Engine) -> str:
    """Return the digest of the engine's version and its adapter's files."""
    digest = hashlib.sha256(f"{engine.package} {engine.version}".encode())
    for file in engine.files:
        digest.update((FOLDER / file).read_bytes())
    return digest.hexdigest()
