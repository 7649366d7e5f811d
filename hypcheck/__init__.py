"""The position of a spheroid relative to a circular hyperboloid of one sheet: exact, and with a proof.

    hypcheck.classify(rows) -> int8 (n,)
    hypcheck.classify_scene((alpha, gamma, b, d), x, y, z, axis=...) -> int8 (n,)
    hypcheck.Prepared(sizes, axis=...): what classify_scene keeps between calls, given to it in the place of the sizes
    hypcheck.position(alpha, gamma, b, d, x, y, z, axis=...) -> int
    hypcheck.clearance(rows) -> hypcheck.Clearance: .lower, .upper, .distance_lower, .distance_upper, .nearest, .touch
    hypcheck.passage((alpha, gamma, b, d), start, end, axis=None) -> .hit, .first_lower, .first_upper
    hypcheck.Scene.from_toml(path).classify(x, y, z) -> int8 (n,); .passage(start, end) -> int8 (n,)
    hypcheck.InputError: what they raise about invalid rows, scenes and files, with a sentence

They are loaded when first used; all but position and passage load numpy.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from hypcheck.float_environment import in_default_environment

if TYPE_CHECKING:
    from hypcheck.errors import InputError
    from hypcheck.kernel.classify import Prepared, classify, classify_scene
    from hypcheck.kernel.clearance import Clearance, clearance
    from hypcheck.kernel.passage import passage
    from hypcheck.kernel.scalar import position
    from hypcheck.kernel.scene import Scene
    from hypcheck.version import VERSION as __version__  # noqa: N811 - the name that everyone expects

__all__ = [
    "Clearance",
    "InputError",
    "Prepared",
    "Scene",
    "__version__",
    "classify",
    "classify_scene",
    "clearance",
    "passage",
    "position",
]

_HOMES = {
    "__version__": ("hypcheck.version", "VERSION"),
    "Clearance": ("hypcheck.kernel.clearance", "Clearance"),
    "InputError": ("hypcheck.errors", "InputError"),
    "Prepared": ("hypcheck.kernel.classify", "Prepared"),
    "Scene": ("hypcheck.kernel.scene", "Scene"),
    "classify": ("hypcheck.kernel.at_once", "classify"),
    "classify_scene": ("hypcheck.kernel.at_once", "classify_scene"),
    "clearance": ("hypcheck.kernel.clearance", "clearance"),
    "passage": ("hypcheck.kernel.passage", "passage"),
    "position": ("hypcheck.kernel.scalar", "position"),
}


@in_default_environment  # numbers in a module are read, and computed, as it is loaded
def __getattr__(name: str) -> object:
    """Load a public name when it is first asked for, and keep it: a call of position is shorter than a look-up here."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, attribute = _HOMES[name]
    value: object = getattr(import_module(module), attribute)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
