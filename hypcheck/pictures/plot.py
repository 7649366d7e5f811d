"""A scene, and a flight through it, as plan and elevation, drawn by matplotlib.

A body is cut into slices between rings of points. The projection of a slice is nearly the convex hull of its two
rings', and the projection of what a spheroid sweeps on a segment is the hull of those at both its ends.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from hypcheck.errors import UnavailableError
from hypcheck.pictures.page import Numbers, ShownFlight, drawn_bodies
from hypcheck.scene.model import Mover, SceneModel

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_VIEWS = (("plan", 0, 1, "x", "y"), ("elevation", 0, 2, "x", "z"))
_MOST = 400
"""Bodies that are drawn, those nearest to the middle of the flight."""

_TURNS = np.linspace(0, 2 * np.pi, 33)[:-1]


def plot_of(model: SceneModel, flight: ShownFlight | None) -> Figure:
    """The figure. Raises UnavailableError where matplotlib is missing."""
    try:
        from matplotlib.collections import PolyCollection  # noqa: PLC0415 - an extra, which takes half a second
        from matplotlib.figure import Figure  # noqa: PLC0415
    except ModuleNotFoundError:
        raise UnavailableError("a plot needs matplotlib; install it, or hypcheck with its extra [report]") from None
    bodies = drawn_bodies(model, flight)
    middle = bodies[:, 4:7].mean(axis=0) if flight is None else flight.points.mean(axis=0)
    near = np.argsort(((bodies[:, 4:6] - middle[:2]) ** 2).sum(axis=1), kind="stable")[:_MOST]
    rings = [_rings(body, 12 if len(near) <= 40 else 3) for body in bodies[near]]
    figure = Figure(figsize=(11, 5), layout="constrained")
    axes = figure.subplots(1, 2)
    for panel, (title, across, up, x, y) in zip(axes, _VIEWS, strict=True):
        for touched, colour in ((0, "#8a9a7b"), (1, "#c2161d")):
            chosen = [ring for place, ring in zip(near, rings, strict=True) if bodies[place, 11] == touched]
            slices = [hull for ring in chosen for hull in _hulls(ring[:, :, [across, up]])]
            panel.add_collection(PolyCollection(slices, facecolors=colour, edgecolors="none", alpha=0.55, zorder=1))
        if flight is not None:
            _draw_flight(panel, PolyCollection, model.mover, flight, (across, up))
        panel.set(title=title, xlabel=x, ylabel=y, aspect="equal")
        panel.autoscale_view()
    return figure


def _draw_flight(axes: Any, collection: Any, mover: Mover, flight: ShownFlight, columns: tuple[int, int]) -> None:  # noqa: ANN401 - matplotlib's
    """The swept spheroid, segments with contact in red, the centre's line, and the first places of contact."""
    chosen = list(columns)
    for hit, colour in ((False, "#4c93d6"), (True, "#c2161d")):
        hulls = []
        for segment in np.flatnonzero(flight.hits == hit).tolist():
            outline = _spheroid(mover, flight.axes[segment])[:, chosen]
            ends = flight.points[segment : segment + 2, chosen]
            hulls.append(_hull(np.concatenate([outline + end for end in ends])))
        axes.add_collection(collection(hulls, facecolors=colour, edgecolors="none", alpha=0.5, zorder=2))
    axes.plot(*flight.points[:, chosen].T, color="#0b5cad", linewidth=0.8, zorder=3)
    contacts = np.array([contact.center for contact in flight.contacts]).reshape(-1, 3)
    axes.plot(*contacts[:, chosen].T, "x", color="#c2161d", zorder=4)


def _frame(axis: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    along = axis / np.linalg.norm(axis)
    across = np.cross(np.eye(3)[np.abs(along).argmin()], along)
    across /= np.linalg.norm(across)
    return across, np.cross(along, across), along


def _rings(body: Numbers, slices: int) -> Numbers:
    """Points (slices + 1, 32, 3) of a body as page.py lists it."""
    alpha, gamma, low, high = body[:4]
    first, second, along = _frame(body[7:10])
    heights = np.linspace(low, high, slices + 1)[:, None, None]
    wide = alpha * np.sqrt(1 + (heights / gamma) ** 2)
    circle = np.cos(_TURNS)[:, None] * first + np.sin(_TURNS)[:, None] * second
    return np.asarray(body[4:7] + wide * circle + heights * along)


def _spheroid(mover: Mover, axis: Numbers) -> Numbers:
    """Points (n, 3) of a spheroid about its centre."""
    first, second, along = _frame(axis)
    polar = np.linspace(0, np.pi, 25)[:, None, None]
    circle = np.cos(_TURNS)[:, None] * first + np.sin(_TURNS)[:, None] * second
    return np.asarray(mover.b * np.sin(polar) * circle + mover.d * np.cos(polar) * along).reshape(-1, 3)


def _hulls(rings: Numbers) -> list[Numbers]:
    return [_hull(np.concatenate(both)) for both in pairwise(rings)]


def _hull(points: Numbers) -> Numbers:
    """The convex hull of points (n, 2), by Andrew's monotone chain."""
    order = points[np.lexsort((points[:, 1], points[:, 0]))].tolist()
    halves = []
    for side in (order, order[::-1]):
        chain: list[list[float]] = []
        for x, y in side:
            while len(chain) > 1 and (chain[-1][0] - chain[-2][0]) * (y - chain[-2][1]) <= (
                chain[-1][1] - chain[-2][1]
            ) * (x - chain[-2][0]):
                chain.pop()
            chain.append([x, y])
        halves += chain[:-1]
    return np.array(halves)
