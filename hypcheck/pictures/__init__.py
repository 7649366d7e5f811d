"""A scene, and a flight through it, as an HTML page in three dimensions, and as plan and elevation.

The page needs nothing but a browser. three.js draws it (three/README.md), packed into the page. Numbers are float32
from the middle of the picture: precise enough for the eye; numbers in text come from float64. The page shows decisions
and makes none.

Plan and elevation are drawn by matplotlib. A body is cut into slices between rings of points. The projection of a slice
is nearly the convex hull of its two rings', and the projection of what a spheroid sweeps on a segment is the hull of
those at both its ends.
"""

from __future__ import annotations

import base64
import gzip
import html
import io
import json
import os
import tarfile
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import InputError, UnavailableError
from hypcheck.messages import counted, escaped
from hypcheck.scene.model import Mover, SceneModel

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Numbers = NDArray[np.float64]


@dataclass(frozen=True)
class ShownContact:
    """The first contact of the mover on a segment: the mover's centre there, and the index of the hyperboloid."""

    segment: int
    center: Sequence[float]
    index: int


@dataclass(frozen=True)
class ShownFlight:
    """A flight in a scene.

    T is the number of corners. `points` (T, 3) are the corners, and `axes` (T - 1, 3) is the mover's axis on each
    segment. `hits` (T - 1,) says which segments have contact. `contacts` are the first contacts on some of these
    segments. `places` (T - 1, parts, 3) are the centres of the mover's parts on each segment, from the mover's centre.

    The flight is cut into k pieces of equal length. `lower` and `upper` (k,) are proved bounds of the least distance
    on each piece. `near` (k,) is the index of the hyperboloid at this distance, and `touched` (k,) says where the
    distance is 0. `least` is the length flown until the least distance of all, with its lower and its upper bound.
    """

    points: Numbers
    axes: Numbers
    hits: NDArray[np.bool_]
    contacts: Sequence[ShownContact]
    places: Numbers
    lower: Numbers
    upper: Numbers
    near: NDArray[np.intp]
    touched: NDArray[np.bool_]
    least: tuple[float, float, float]
    summary: str


_SEE_THROUGH = 12
"""A scene of at most so many hyperboloids is drawn transparent, so that the inside can be seen."""

_FILES = files("hypcheck.pictures")


@dataclass(frozen=True)
class ScenePage:
    """An HTML page; a notebook shows it if it is the last line of a cell."""

    html: str

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the page to a file."""
        Path(path).write_text(self.html, encoding="utf-8")

    def _repr_html_(self) -> str:
        """Return the HTML for a notebook: a frame with the page."""
        return f'<iframe srcdoc="{html.escape(self.html)}" width="100%" height="640" style="border:0"></iframe>'


_FARTHEST = 1e18
"""The largest length that can be drawn, since the browser squares lengths in float32."""


def page_of(model: SceneModel, flight: ShownFlight | None = None) -> str:
    """Make the page of a scene, and of a flight if there is one. Raises InputError for a scene that is too large."""
    with np.errstate(all="ignore"):
        bodies = drawn_bodies(model, flight)
        view, middle = _view(bodies, flight)
    if not np.max([view["extent"], bodies[:, :2].max(), model.mover.b, model.mover.d]) <= _FARTHEST:  # not if NaN
        raise InputError(
            f"the scene {escaped(repr(model.name))} is too large to draw: what is shown of its hyperboloids, its mover "
            f"and the flight must be within {_FARTHEST:g} units of length"
        )
    bodies[:, 4:7] -= middle
    mover = model.mover
    data: dict[str, Any] = {
        "bodies": _packed(bodies), "see_through": len(bodies) <= _SEE_THROUGH, "view": view, "path": None,
        "mover": {"b": mover.b, "d": mover.d, "parts": []},
    }  # fmt: skip
    if flight is not None:
        data |= _of_flight(model, flight, middle)
    counted_bodies = counted(len(bodies), "hyperboloid")
    summary = f"{counted_bodies}; no flight" if flight is None else f"{counted_bodies}; {flight.summary}"
    return _filled(escaped(model.name), escaped(summary), data, with_flight=flight is not None)


def drawn_bodies(model: SceneModel, flight: ShownFlight | None) -> Numbers:
    """Return α, γ, both heights, centre, axis, solid, touched of each body, (n, 12).

    A body without ends is drawn as high as the others, or as the flight. Axes are unit vectors; one straight down is
    turned up.
    """
    touched = set() if flight is None else {contact.index for contact in flight.contacts}
    rows = []
    for number, body in enumerate(model.hyperboloids):
        low, high = (-np.inf, np.inf) if body.height is None else body.height.ends
        axis = body.axis if body.axis[0] or body.axis[1] or body.axis[2] > 0 else tuple(-part for part in body.axis)
        if axis is not body.axis:
            low, high = -high, -low
        rows.append((body.alpha, body.gamma, low, high, *body.center, *axis, body.solid, number in touched))
    table = np.array(rows, np.float64)
    table[:, 7:10] /= np.sqrt((table[:, 7:10] ** 2).sum(axis=1, keepdims=True))
    tall = np.abs(table[:, 2:4][np.isfinite(table[:, 2:4])]).max(initial=0.0)
    reach = tall or 2 * float(table[:, :2].max())
    if flight is not None:
        rise = np.abs(flight.points[:, 2, None] - table[None, :64, 6]).max(initial=0.0)
        reach = max(tall, float(rise) + 2 * max(model.mover.b, model.mover.d))
    table[:, 2:4] = np.clip(np.nan_to_num(table[:, 2:4], posinf=reach, neginf=-reach), -1e6, 1e6)
    return table


def _view(bodies: Numbers, flight: ShownFlight | None) -> tuple[dict[str, Any], Numbers]:
    """Return the first view of the camera, relative to the middle of the picture, and that middle."""
    tall = np.abs(bodies[:, 2:4]).max(axis=1)
    wide = np.maximum(bodies[:, 0] * np.sqrt(1 + (tall / bodies[:, 1]) ** 2), tall)[:, None]
    low, high = (bodies[:, 4:7] - wide).min(axis=0), (bodies[:, 4:7] + wide).max(axis=0)
    extent = float(np.sqrt(((high - low) ** 2).sum())) + 1e-9
    shown = (low, high) if flight is None else (flight.points.min(axis=0), flight.points.max(axis=0))
    middle = (shown[0] + shown[1]) / 2
    radius = float(np.sqrt(((shown[1] - shown[0]) ** 2).sum())) / 2
    if flight is not None:
        radius = min(max(1.15 * radius, float(np.median(wide))), max(extent, radius))
    extent += radius + float(np.abs(middle - (low + high) / 2).max())
    return {"centre": [0, 0, 0], "radius": max(radius, 1e-6), "from": [0.45, -0.8, 0.5], "extent": extent}, middle


def _of_flight(model: SceneModel, flight: ShownFlight, middle: Numbers) -> dict[str, Any]:
    """Return the data of a flight that the page needs; coordinates are relative to `middle`."""
    names = [body.name for body in model.hyperboloids]
    flown, lower, upper = flight.least
    parts = [
        {"b": part.b, "d": part.d, "places": np.round(flight.places[:, number], 7).tolist()}
        for number, part in enumerate(model.mover.parts)
    ]
    return {
        "path": _packed(flight.points - middle), "axes": _packed(flight.axes),
        "hits": base64.b64encode(flight.hits.astype(np.uint8).tobytes()).decode(),
        "contacts": [
            {"at": (np.asarray(contact.center) - middle).tolist(), "segment": contact.segment}
            for contact in flight.contacts
        ],
        "distances": {"lower": flight.lower.tolist(), "upper": flight.upper.tolist()},
        "touched": flight.touched.astype(int).tolist(), "nearest": [names[index] for index in flight.near.tolist()],
        "least": {"flown": flown, "lower": lower, "upper": upper},
        "mover": {"b": model.mover.b, "d": model.mover.d, "parts": parts},
    }  # fmt: skip


def _packed(numbers: NDArray[Any]) -> str:
    """Write numbers as little-endian float32 in base64."""
    return base64.b64encode(np.ascontiguousarray(numbers, "<f4").tobytes()).decode()


def _filled(name: str, summary: str, data: dict[str, Any], *, with_flight: bool) -> str:
    """Fill the template of the page with the data, styles and scripts."""
    legend = [("body", "hyperboloids")]
    if with_flight:
        legend += [("mover", "mover"), ("swept", "what it sweeps"), ("contact", "contact"), ("least", "least distance")]
    items = "".join(f'<li><i style="background:var(--{colour})"></i>{text}</li>' for colour, text in legend)
    library = _library()
    values = {
        "title": html.escape(name), "summary": html.escape(summary), "legend": items,
        "panel": _text("panel.html") if with_flight else "", "style": _text("view.css"), "script": _text("view.js"),
        "data": json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c"),
        "core": library["three.core.js"], "module": library["three.module.js"],
        "controls": library["OrbitControls.js"],
    }  # fmt: skip
    before, *rest = _text("view.html").split("{{")
    filled = [before]
    for part in rest:
        key, _, after = part.partition("}}")
        filled += [values[key], after]
    return "".join(filled)


def _text(name: str) -> str:
    """Return the text of a template."""
    return _FILES.joinpath("templates", name).read_text(encoding="utf-8")


@cache
def _library() -> dict[str, str]:
    """Read the files of three.js by name, packed as a page holds them: a megabyte, which takes longer than all else."""
    packed = io.BytesIO(_FILES.joinpath("three", "three.tar.xz").read_bytes())
    with tarfile.open(fileobj=packed, mode="r:xz") as archive:
        contents = {member.name: archive.extractfile(member) for member in archive.getmembers()}
        return {
            name: base64.b64encode(gzip.compress(file.read(), mtime=0)).decode()
            for name, file in contents.items()
            if file
        }


_VIEWS = (("plan", 0, 1, "x", "y"), ("elevation", 0, 2, "x", "z"))
_MOST = 400
"""The largest number of bodies in a plot; the nearest to the middle of the flight are drawn."""

_TURNS = np.linspace(0, 2 * np.pi, 33)[:-1]


def plot_of(model: SceneModel, flight: ShownFlight | None) -> Figure:
    """Draw plan and elevation of a scene and a flight. Raises UnavailableError if matplotlib is missing."""
    try:
        from matplotlib import collections, figure  # noqa: PLC0415 - an extra, which takes half a second
    except ModuleNotFoundError:
        raise UnavailableError("a plot needs matplotlib; install it, or hypcheck with its extra [report]") from None
    bodies = drawn_bodies(model, flight)
    middle = bodies[:, 4:7].mean(axis=0) if flight is None else flight.points.mean(axis=0)
    near = np.argsort(((bodies[:, 4:6] - middle[:2]) ** 2).sum(axis=1), kind="stable")[:_MOST]
    rings = [_rings(body, 12 if len(near) <= 40 else 3) for body in bodies[near]]
    drawn = figure.Figure(figsize=(11, 5), layout="constrained")
    axes = drawn.subplots(1, 2)
    for panel, (title, across, up, x, y) in zip(axes, _VIEWS, strict=True):
        for touched, colour in ((0, "#8a9a7b"), (1, "#c2161d")):
            chosen = [ring for place, ring in zip(near, rings, strict=True) if bodies[place, 11] == touched]
            slices = [hull for ring in chosen for hull in _hulls(ring[:, :, [across, up]])]
            hulls = collections.PolyCollection(slices, facecolors=colour, edgecolors="none", alpha=0.55, zorder=1)
            panel.add_collection(hulls)
        if flight is not None:
            _draw_flight(panel, collections.PolyCollection, model.mover, flight, (across, up))
        panel.set(title=title, xlabel=x, ylabel=y, aspect="equal")
        panel.autoscale_view()
    return drawn


def _draw_flight(axes: Any, collection: Any, mover: Mover, flight: ShownFlight, columns: tuple[int, int]) -> None:  # noqa: ANN401 - matplotlib's
    """Draw what the spheroid sweeps, red on segments with contact, the line of the centre, and first contacts."""
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
    """Return three unit vectors at right angles to each other; the third is along the axis."""
    along = axis / np.linalg.norm(axis)
    across = np.cross(np.eye(3)[np.abs(along).argmin()], along)
    across /= np.linalg.norm(across)
    return across, np.cross(along, across), along


def _rings(body: Numbers, slices: int) -> Numbers:
    """Return rings of points on a body, a row of drawn_bodies: (slices + 1, 32, 3)."""
    alpha, gamma, low, high = body[:4]
    first, second, along = _frame(body[7:10])
    heights = np.linspace(low, high, slices + 1)[:, None, None]
    wide = alpha * np.sqrt(1 + (heights / gamma) ** 2)
    circle = np.cos(_TURNS)[:, None] * first + np.sin(_TURNS)[:, None] * second
    return np.asarray(body[4:7] + wide * circle + heights * along)


def _spheroid(mover: Mover, axis: Numbers) -> Numbers:
    """Return points (n, 3) of the mover's surface, relative to its centre."""
    first, second, along = _frame(axis)
    polar = np.linspace(0, np.pi, 25)[:, None, None]
    circle = np.cos(_TURNS)[:, None] * first + np.sin(_TURNS)[:, None] * second
    return np.asarray(mover.b * np.sin(polar) * circle + mover.d * np.cos(polar) * along).reshape(-1, 3)


def _hulls(rings: Numbers) -> list[Numbers]:
    """Return the convex hull of each two neighbouring rings."""
    return [_hull(np.concatenate(both)) for both in pairwise(rings)]


def _hull(points: Numbers) -> Numbers:
    """Return the convex hull of points (n, 2), by Andrew's monotone chain."""
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
