"""The data of a picture of a flight, computed by the scene: contacts, and the least distance on each piece of it."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.errors import InputError
from hypcheck.geometry.rows import Floats, Indices, Mask
from hypcheck.kernel.passages import Passages
from hypcheck.kernel.scene_flights import FirstContact, paths_of
from hypcheck.kernel.scene_queries import places_of_parts
from hypcheck.messages import counted
from hypcheck.pictures.page import ShownContact, ShownFlight
from hypcheck.scene.model import FREE, SceneModel

PIECES = 240
"""Pieces of a flight, each with a least distance."""

_MOST_CONTACTS = 100
"""Segments whose first contact is found; each takes a millisecond."""


class Asked(Protocol):
    """The methods of a Scene that a picture needs."""

    @property
    def model(self) -> SceneModel:
        """The scene's file."""

    def passage(
        self, start: ArrayLike, end: ArrayLike, heading: ArrayLike = 0.0, *, axis: ArrayLike | None = None
    ) -> Passages:
        """As Scene.passage."""

    def first_contact(
        self, path: ArrayLike | Sequence[ArrayLike], heading: ArrayLike = 0.0, *, axis: ArrayLike | None = None
    ) -> FirstContact:
        """As Scene.first_contact."""


def shown_flight(
    scene: Asked,
    path: ArrayLike,
    heading: ArrayLike = 0.0,
    axis: ArrayLike | None = None,
    count_of_pieces: int = PIECES,
) -> ShownFlight:
    """The data of a picture of one flight, with the least distance on each of `pieces` pieces.

    Raises InputError as first_contact, and for more flights than one.
    """
    paths = paths_of(path)
    if not paths.single:
        raise InputError("a picture shows one flight, and many are given; give points (T, 3)")
    contact = scene.first_contact(path, heading, axis=axis)
    count = len(paths.starts)
    headings = np.broadcast_to(np.asarray(heading, np.float64), count)
    fixed = scene.model.mover.axis
    own = np.asarray(axis if fixed == FREE else fixed, np.float64)
    axes = np.ascontiguousarray(np.broadcast_to(own, (count, 3)))
    free = axes if fixed == FREE else None
    passages = scene.passage(paths.starts, paths.ends, headings, axis=free)
    hits = np.atleast_1d(passages.hit)
    contacts = []
    for segment in np.flatnonzero(hits)[:_MOST_CONTACTS].tolist():
        (low, high), index = passages.measure(segment)
        here, there = paths.starts[segment], paths.ends[segment]
        contacts.append(ShownContact(segment, (here + float((low + high) / 2) * (there - here)).tolist(), index))
    pieces, segments, flown = _pieces(np.vstack([paths.starts[:1], paths.ends]), count_of_pieces)
    near = _least_on(scene, pieces, segments, headings, free)
    whole = contact.least
    least_flown = float(flown[whole.segment] + whole.time * (flown[whole.segment + 1] - flown[whole.segment]))
    parts = scene.model.mover.parts
    places = [places_of_parts(parts, (0, 0, 0), *turn) for turn in zip(headings.tolist(), axes.tolist(), strict=True)]
    caption = f"{counted(count, 'segment')}, {float(flown[-1]):.6g} long; " + (
        f"{counted(int(hits.sum()), 'segment')} with contact, the first is segment {contact.segment}"
        if contact.hit
        else f"clear, its least distance is {float(whole.distance_lower):.6g}"
    )
    return ShownFlight(
        np.vstack([paths.starts[:1], paths.ends]), axes, hits, contacts,
        np.array(places, np.float64).reshape(count, len(parts), 3), *near,
        (least_flown, float(whole.distance_lower), float(whole.distance_upper)), caption,
    )  # fmt: skip


def _least_on(
    scene: Asked, pieces: Sequence[Floats], segments: Sequence[Indices], headings: Floats, axes: Floats | None
) -> tuple[Floats, Floats, Indices, Mask]:
    """Both bounds of the least distance on each piece, the hyperboloid that it is from, and whether there is contact.

    Where the mover meets contact, the distance is 0, and which hyperboloid it meets is not asked.
    """

    def first_contacts(chosen: list[int]) -> FirstContact:
        owner = np.concatenate([segments[piece] for piece in chosen])
        these = [pieces[piece] for piece in chosen]
        return scene.first_contact(these, headings[owner], axis=None if axes is None else axes[owner])

    lower, upper, index = np.zeros(len(pieces)), np.zeros(len(pieces)), np.zeros(len(pieces), np.intp)
    clear = np.flatnonzero(~np.asarray(first_contacts(list(range(len(pieces)))).hit))
    if len(clear):
        least = first_contacts(clear.tolist()).least
        lower[clear], index[clear] = least.distance_lower, np.maximum(least.index, 0)
        upper[clear] = np.where(np.isfinite(least.distance_upper), least.distance_upper, 0.0)
        clear = clear[least.distance_upper != 0]
    touched = np.ones(len(pieces), np.bool_)
    touched[clear] = False
    return lower, upper, index, touched


def _pieces(points: Floats, count: int) -> tuple[list[Floats], list[Indices], Floats]:
    """The flight cut into pieces of one length: their points, the segments that these lie on, and the length flown."""
    steps = np.sqrt((np.diff(points, axis=0) ** 2).sum(axis=1))
    flown = np.append(0.0, np.cumsum(steps))
    if flown[-1] == 0 or not np.isfinite(flown[-1]):
        return [points], [np.arange(len(steps))], np.where(np.isfinite(flown), flown, 0.0)
    cuts = np.linspace(0, flown[-1], count + 1)
    pieces: list[Floats] = []
    segments: list[Indices] = []
    for low, high in pairwise(cuts.tolist()):
        first = min(int(np.searchsorted(flown, low, "right")) - 1, len(steps) - 1)
        last = min(max(int(np.searchsorted(flown, high, "left")) - 1, first), len(steps) - 1)
        ends = [_at(points, flown, first, low), *points[first + 1 : last + 1], _at(points, flown, last, high)]
        pieces.append(np.array(ends))
        segments.append(np.arange(first, last + 1))
    return pieces, segments, flown


def _at(points: Floats, flown: Floats, segment: int, length: float) -> Floats:
    step = flown[segment + 1] - flown[segment]
    share = min(max((length - flown[segment]) / step, 0.0), 1.0) if step > 0 else 0.0
    return np.asarray(points[segment] + share * (points[segment + 1] - points[segment]))
