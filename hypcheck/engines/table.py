"""The engines: name, pinned version, where they come from, and the shapes that they are given.

Each has a folder of its name beside this file, with the adapter that we wrote: an ordinary command of the protocol
(docs/protocol.md), started with the folder of a scene (scene.py). Its first comment says what it asks of the engine.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from hypcheck.errors import InputError
from hypcheck.messages import suggestion

FOLDER = Path(__file__).parent

Manager = Literal["pip", "npm", "cargo"]


@dataclass(frozen=True, slots=True)
class Engine:
    """An engine; `package` is its name for the package manager.

    `body` is what stands for a spheroid that is no ball: the engine's own ellipsoid, the convex hull of points on it,
    or the engine's ball in a space that is scaled for it, in which case no spheroid leans. A ball is always the
    engine's own. `single` says that it computes in float32. `files` are the adapter's, from this folder.
    """

    name: str
    package: str
    version: str
    manager: Manager
    body: Literal["ellipsoid", "hull", "scaled ball"]
    files: tuple[str, ...]
    single: bool = False

    @property
    def tilts(self) -> bool:
        """Whether it can be asked about spheroids that lean."""
        return self.body != "scaled ball"


def _in_python(name: str, version: str, body: Literal["ellipsoid", "hull"]) -> Engine:
    return Engine(name, name, version, "pip", body, (f"{name}/adapter.py", "speaking/speak.py"))


def _in_javascript(name: str, version: str, body: Literal["hull", "scaled ball"], package: str = "") -> Engine:
    files = (f"{name}/adapter.mjs", "speaking/speak.mjs")
    return Engine(name, package or name, version, "npm", body, files, single=name != "cannon-es")


def _in_rust(name: str, version: str, *, single: bool) -> Engine:
    files = (f"{name}/Cargo.toml", "parry3d-f64/adapter.rs", "speaking/speak.rs")
    return Engine(name, name, version, "cargo", "hull", files, single)


ENGINES = {
    engine.name: engine
    for engine in (
        _in_python("python-fcl", "0.7.0.11", "ellipsoid"),
        _in_python("coal", "3.0.3", "ellipsoid"),
        _in_python("mujoco", "4.0.0", "ellipsoid"),
        _in_python("pybullet", "3.2.7", "hull"),
        _in_rust("parry3d-f64", "0.31.1", single=False),
        _in_rust("parry3d", "0.31.1", single=True),
        _in_javascript("jolt-physics", "1.1.0", "hull"),
        _in_javascript("rapier3d", "0.21.0", "hull", "@dimforge/rapier3d-compat"),
        _in_javascript("ammo.js", "0.0.10", "hull"),
        _in_javascript("cannon-es", "0.20.0", "scaled ball"),
    )
}


def engines_of(names: Iterable[str]) -> list[Engine]:
    """The engines of these names, all without any. Raises InputError for a name that is none."""
    for name in names:
        if name not in ENGINES:
            raise InputError(f"there is no engine {name!r}; {suggestion(name, ENGINES)}")
    return [ENGINES[name] for name in (dict.fromkeys(names) or ENGINES)]
