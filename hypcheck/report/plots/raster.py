"""Pictures of a half plane, a dot a grid point, which lie under a plot's axes: r across, z up."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Interval = tuple[float, float]

FAINT = "#8a94a066"
"""Where nothing is wrong: seen on light ground and on dark."""


def show(axes: Axes, letters: Sequence[str], colours: Mapping[str, str], r: Interval, z: Interval) -> None:
    """Paint the letters, the first text lowest. A grid point is a cell's middle; a letter without a colour is empty."""
    import numpy as np  # noqa: PLC0415
    from matplotlib.colors import to_rgba  # noqa: PLC0415

    grid = np.array([list(text) for text in letters])
    image = np.zeros((*grid.shape, 4))
    for letter, name in colours.items():
        image[grid == letter] = to_rgba(name)
    extent = outer(r, z, grid.shape)
    axes.imshow(image, extent=extent, origin="lower", interpolation="nearest", aspect="auto")
    axes.set(xlim=extent[:2], ylim=extent[2:])
    axes.grid(visible=False)
    axes.ticklabel_format(useOffset=False)


def outer(r: Interval, z: Interval, shape: tuple[int, ...]) -> Any:  # noqa: ANN401 - what matplotlib takes
    """The limits of the picture: half a cell beyond the first and the last grid points."""
    up, across = shape
    half_r, half_z = ((high - low) / max(1, count - 1) / 2 or 0.5 for (low, high), count in ((r, across), (z, up)))
    return (r[0] - half_r, r[1] + half_r, z[0] - half_z, z[1] + half_z)


def mark(axes: Axes, letters: Sequence[str], colours: Mapping[str, str], r: Interval, z: Interval) -> None:
    """Draw the grid points of these letters again as dots, which are seen where a cell is too small."""
    import numpy as np  # noqa: PLC0415

    grid = np.array([list(text) for text in letters])
    rs, zs = np.linspace(*r, grid.shape[1]), np.linspace(*z, grid.shape[0])
    for letter, name in colours.items():
        across, up = np.nonzero((grid == letter).T)
        if len(across):
            axes.scatter(rs[across], zs[up], s=3, marker="s", color=name, linewidths=0, rasterized=True, zorder=3)


def surface(axes: Axes, sizes: tuple[float, float], r: Interval, z: Interval, line: str) -> None:
    """The hyperboloid's meridian r = α √(1 + z²/γ²), where the picture shows it, in a colour."""
    alpha, gamma = sizes
    heights = [z[0] + (z[1] - z[0]) * step / 200 for step in range(201)]
    radii = [alpha * math.hypot(1, height / gamma) for height in heights]
    if min(radii) <= r[1] and max(radii) >= r[0]:
        axes.plot(radii, heights, color=line, linewidth=0.9, zorder=2)
