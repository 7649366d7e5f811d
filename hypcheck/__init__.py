"""Where a spheroid stands to a circular hyperboloid of one sheet: exactly, and with a proof.

    hypcheck.classify(rows) -> int8 (n,)
    hypcheck.classify_scene((alpha, gamma, b, d), x, y, z) -> int8 (n,)
    hypcheck.Scene.from_toml(path).classify(x, y, z) -> int8 (n,)

All are loaded, and numpy with them, when first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from hypcheck.kernel.classify import classify, classify_scene
    from hypcheck.kernel.world.scene import Scene
    from hypcheck.version import VERSION as __version__  # noqa: N811 - the name that everyone expects

__all__ = ["Scene", "__version__", "classify", "classify_scene"]


def __getattr__(name: str) -> object:
    """Load a public name when it is first asked for."""
    if name == "__version__":
        from hypcheck import version  # noqa: PLC0415

        return version.VERSION
    if name == "Scene":
        from hypcheck.kernel.world import scene  # noqa: PLC0415

        return scene.Scene
    if name in __all__:
        from hypcheck.kernel import classify as module  # noqa: PLC0415

        return getattr(module, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
