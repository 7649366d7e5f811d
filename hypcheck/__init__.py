"""The position of a spheroid relative to a circular hyperboloid of one sheet: exact, and with a proof.

    hypcheck.position(alpha, gamma, b, d, x, y, z, axis=..., margin=...) -> int
    hypcheck.classify((alpha, gamma, b, d), points, axis=..., margin=...) -> int8 (n,); or rows, or a table of columns
    hypcheck.classify_scene((alpha, gamma, b, d), x, y, z, axis=...) -> int8 (n,)
    hypcheck.Prepared(sizes, axis=...): sizes prepared once for many calls of classify_scene
    hypcheck.clearance((alpha, gamma, b, d), points, axis=...) -> hypcheck.Clearance: distance, nearest point, normal
    hypcheck.passage((alpha, gamma, b, d), start, end, axis=...) -> .hit, .first_lower, .first_upper
    hypcheck.Scene.from_toml(path), .from_arrays(alpha, gamma, center, mover=hypcheck.Mover(b, d)): many hyperboloids;
        .classify(points), .passage(start, end), .first_contact(path), .nearest(points);
        .with_hyperboloid(…), .moved(…), .without(…)
    hypcheck.InputError: raised for invalid rows, scenes and files, with a sentence

They are loaded when first used; all but position and passage load numpy.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from hypcheck.float_environment import in_default_environment

if TYPE_CHECKING:
    from hypcheck.errors import InputError
    from hypcheck.kernel.classify import Prepared, classify, classify_scene
    from hypcheck.kernel.clearance import clearance
    from hypcheck.kernel.clearance_bounds import Clearance
    from hypcheck.kernel.passage import passage
    from hypcheck.kernel.passages import Passages
    from hypcheck.kernel.scalar import position
    from hypcheck.kernel.scene import Scene
    from hypcheck.kernel.scene_flights import FirstContact
    from hypcheck.kernel.scene_least import LeastDistance
    from hypcheck.kernel.scene_nearest import Nearest
    from hypcheck.scene.model import Hyperboloid, Mover, MoverPart, Region, SceneModel, Span
    from hypcheck.truth.swept import Passage
    from hypcheck.version import VERSION as __version__  # noqa: N811 - the name that everyone expects

__all__ = [
    "Clearance",
    "FirstContact",
    "Hyperboloid",
    "InputError",
    "LeastDistance",
    "Mover",
    "MoverPart",
    "Nearest",
    "Passage",
    "Passages",
    "Prepared",
    "Region",
    "Scene",
    "SceneModel",
    "Span",
    "__version__",
    "classify",
    "classify_scene",
    "clearance",
    "passage",
    "position",
]

_HOMES = {
    "__version__": ("hypcheck.version", "VERSION"),
    "Clearance": ("hypcheck.kernel.clearance_bounds", "Clearance"),
    "FirstContact": ("hypcheck.kernel.scene_flights", "FirstContact"),
    "Hyperboloid": ("hypcheck.scene.model", "Hyperboloid"),
    "InputError": ("hypcheck.errors", "InputError"),
    "LeastDistance": ("hypcheck.kernel.scene_least", "LeastDistance"),
    "Mover": ("hypcheck.scene.model", "Mover"),
    "MoverPart": ("hypcheck.scene.model", "MoverPart"),
    "Nearest": ("hypcheck.kernel.scene_nearest", "Nearest"),
    "Passage": ("hypcheck.truth.swept", "Passage"),
    "Passages": ("hypcheck.kernel.passages", "Passages"),
    "Prepared": ("hypcheck.kernel.classify", "Prepared"),
    "Region": ("hypcheck.scene.model", "Region"),
    "Scene": ("hypcheck.kernel.scene", "Scene"),
    "SceneModel": ("hypcheck.scene.model", "SceneModel"),
    "Span": ("hypcheck.scene.model", "Span"),
    "classify": ("hypcheck.kernel.classify", "classify_at_once"),
    "classify_scene": ("hypcheck.kernel.classify", "classify_scene_at_once"),
    "clearance": ("hypcheck.kernel.clearance", "clearance"),
    "passage": ("hypcheck.kernel.passage", "passage"),
    "position": ("hypcheck.kernel.scalar", "position"),
}


@in_default_environment  # numbers in a module are read, and computed, as it is loaded
def __getattr__(name: str) -> object:
    """Load a public name at its first use, and keep it: a call of position takes less time than a look-up here."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, attribute = _HOMES[name]
    value: object = getattr(import_module(module), attribute)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
