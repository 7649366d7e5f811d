"""A scene that is prepared once for many queries: exact answers about the mover at any place in the scene.

The answer about a whole scene: contact with any hyperboloid is contact; else inside any is interior; else exterior.
If the mover itself is in contact, its parts are tested: if all parts have the same position, that is the answer.
scene_pairs.py and scene_sweeps.py give the answer of each hyperboloid.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import isfinite
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.errors import InputError
from hypcheck.float_environment import in_default_environment
from hypcheck.geometry.forms import (
    Answers,
    are_one,
    directions,
    finite_columns,
    finite_numbers,
    points_or_columns,
    sweeps_of,
)
from hypcheck.geometry.pair import AXIS, CENTER, trouble_with_axis
from hypcheck.geometry.rows import Floats, Indices, Positions, as_numbers
from hypcheck.kernel import scene_nearest
from hypcheck.kernel.choice import POSITION_OF, answers_to
from hypcheck.kernel.clearance import checked_margin
from hypcheck.kernel.passages import First, Passages
from hypcheck.kernel.scene_flights import (
    FirstContact,
    Paths,
    Swept,
    first_segments,
    measured,
    paths_of,
    require_for_each,
    shown_flight,
)
from hypcheck.kernel.scene_index import near_sweeps
from hypcheck.kernel.scene_least import Flights, LeastDistance, least_distances
from hypcheck.kernel.scene_nearest import Nearest
from hypcheck.kernel.scene_pairs import position_beside, position_of, position_with_ends, positions
from hypcheck.kernel.scene_prepared import PreparedScene
from hypcheck.kernel.scene_sweeps import (
    Spheroid,
    Sweep,
    enters,
    first_contact,
    hit_at_once,
    hits_beside,
    is_clear,
    point_at_once,
)
from hypcheck.pictures import ScenePage, page_of, plot_of
from hypcheck.scene.model import FREE, UPRIGHT, Point, is_tilted, places_of_parts

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CONTACT, EXTERIOR, INTERIOR = 0, 1, -1

_ASKED = (*CENTER, "heading")

_RANK = {CONTACT: 3, INTERIOR: 2, EXTERIOR: 1}
_OF_RANK = (EXTERIOR, EXTERIOR, INTERIOR, CONTACT)
"""The positions by rank: the greatest rank prevails if hyperboloids give different answers. At rank 0 none is near."""


@dataclass(frozen=True)
class Scene(PreparedScene):
    """A scene (docs/scenes.md) that answers queries: `Scene.from_toml(path).classify(x, y, z)`.

    It is made from a file, a text, arrays (from_arrays), or a SceneModel. It never changes, and may be shared by any
    number of threads; `with_hyperboloid`, `moved` and `without` return another one.
    """

    @in_default_environment
    def classify(
        self,
        x: ArrayLike,
        y: ArrayLike | None = None,
        z: ArrayLike | None = None,
        heading: ArrayLike = 0.0,
        *,
        axis: ArrayLike | None = None,
        margin: float = 0.0,
    ) -> Answers:
        """Return the exact answer to the scene's question for centres in the scene's coordinates.

        They are int8 (n,), or an int for one centre.

        `x`, `y`, `z` are (n,) each or single numbers, or `x` alone are points, (n, 3) or (3,); `heading` is the mover's
        direction in degrees, which places its parts. `axis`, (3,) or (n, 3), is the mover's if the scene says that it
        is free, any vector ≠ 0 along its axis of revolution. Positions are +1, 0, −1, and other questions are answered
        1 yes, 0 no. Offsets between centres are exact; the place of a part is its rounded centre. `margin`, a length: a
        mover that is not proved to be at least so far from all hyperboloids counts as contact. Raises InputError for
        numbers that are not finite, and for an axis if the scene fixes it.
        """
        center = points_or_columns(x, y, z)
        found = self._positions(center, heading, axis)
        if margin:
            found = self._kept_apart(found, center, heading, axis, margin)
        answers = answers_to(self.model.question, found)
        return int(answers[0]) if are_one(center, heading, axis) else answers

    def _positions(self, center: Sequence[ArrayLike], heading: ArrayLike, axis: ArrayLike | None) -> Positions:
        """Return the positions of the mover at these centres. Raises InputError."""
        axes = self._axes(axis) if axis is not None or self._is_tilted else ()
        names = (*_ASKED, *AXIS[: len(axes)])
        columns = finite_columns(names, (*center, heading, *axes))
        centres = np.stack(columns[:3], axis=1)
        query, body = self._pairs(centres)
        movers = directions(columns[4:]) if axes else None
        replies = self._replies(query, body, centres, columns[3], movers)
        return _combined(replies, query, len(centres))

    def _kept_apart(
        self,
        positions: Positions,
        center: Sequence[ArrayLike],
        heading: ArrayLike,
        axis: ArrayLike | None,
        margin: float,
    ) -> Positions:
        """Return the positions, with contact unless a larger mover or its distance proves the margin (clearance.py)."""
        larger = self._enlarged(checked_margin(margin))
        sure = larger is not None and larger._positions(center, heading, axis) == positions
        sure = np.broadcast_to(sure, positions.shape) & (positions != CONTACT)
        if not self.model.mover.parts and not sure.all():
            sure = sure | (self.nearest(*center, axis=axis).distance_lower >= margin)
        return np.where(sure, positions, CONTACT).astype(np.int8)

    @in_default_environment
    def position(
        self,
        x: ArrayLike,
        y: ArrayLike | None = None,
        z: ArrayLike | None = None,
        heading: ArrayLike = 0.0,
        *,
        axis: ArrayLike | None = None,
        margin: float = 0.0,
    ) -> Answers:
        """Return the exact answer to the scene's question for one centre, as classify, at the price of a step.

        The centre is three numbers, or a point (3,); many are answered by classify. Raises InputError for numbers that
        are not finite, and for an axis where the scene fixes it.
        """
        if y is None or z is None or margin:
            x, y, z = points_or_columns(x, y, z)
        ordinary = axis is None and float is type(x) is type(y) is type(z)
        if margin or not (ordinary or are_one((x, y, z), heading, axis)):
            return self.classify(x, y, z, heading, axis=axis, margin=margin)
        x, y, z, heading = finite_numbers(x, y, z, heading)
        if axis is not None or self._is_tilted:
            return self._tilted_position((x, y, z), heading, axis)
        mover, answer = self.model.mover, EXTERIOR
        b, d = mover.b, mover.d
        for index in self._near(x, y, z):
            body, (low, high, inner_low, inner_high) = self._numbers(index)
            if z < low or z > high:  # beyond an end
                continue
            reply = position_beside(body.shape, body.origin, b, d, x, y, z)
            if reply != EXTERIOR and not inner_low <= z <= inner_high:
                reply = position_with_ends(reply, body, (b, d), (x, y, z), UPRIGHT)
            if reply == CONTACT and mover.parts:
                reply = self._of_parts(index, (x, y, z), heading, UPRIGHT)
            if reply == CONTACT:
                return self._answer(CONTACT)
            if reply == INTERIOR:
                answer = INTERIOR
        return self._answer(answer)

    @in_default_environment
    def passage(
        self, start: ArrayLike, end: ArrayLike, heading: ArrayLike = 0.0, *, axis: ArrayLike | None = None
    ) -> Passages:
        """Whether the mover has contact on each straight sweep, also at its ends, when first, and with what.

        `start` and `end` are (n, 3) or (3,), in the scene's coordinates; `heading`, (n,) or a number, and `axis`, as in
        classify, are the same all along. `.hit` says exactly whether there is contact on the sweep, whatever the
        scene's question is; `.first_lower` ≤ first time ≤ `.first_upper`, 0 at the start and 1 at the end, `.index` is
        the hyperboloid, and `.first` has the times as fractions; they are computed at their first use, a millisecond
        a hit. A part moves straight from its place at the start to its place at the end; it is tested if the mover has
        contact. Beside an end of a hyperboloid, a miss by less than 2^−240 of the mover's size counts as contact.
        Raises InputError for numbers that are not finite, and for an axis where the scene fixes it.
        """
        hit = self._hit_at_once(start, end, heading) if axis is None else None
        if hit is not None:
            return Passages(hit, partial(self._first_on, start, end, heading))
        swept = self._swept(start, end, heading, axis)
        result = np.zeros(len(swept.starts), np.bool_)
        result[swept.query[swept.hits]] = True
        single = np.ndim(start) == 1 and np.ndim(end) == 1 and len(result) == 1 and np.ndim(heading) == 0
        return Passages(bool(result[0]) if single else result, self._measure(swept))

    @in_default_environment
    def first_contact(
        self, path: ArrayLike | Sequence[ArrayLike], heading: ArrayLike = 0.0, *, axis: ArrayLike | None = None
    ) -> FirstContact:
        """Return the mover's first contact on a flight, a polyline of its centre, and its least distance all along.

        `path` is (T, 3), or many: (k, T, 3), or a list of points (T, 3), in the scene's coordinates. `heading` and
        `axis` are as in passage, one for all, or one for each segment, with the segments of all paths one after the
        other. `.hit`, `.segment` and the first contact's `.time_lower` ≤ time ≤ `.time_upper`, `.index`, the
        hyperboloid's, and `.center` are decided as by passage. `.least` has the least distance of the mover itself,
        without its parts: `.distance_lower`, `.distance_upper`, `.segment`, `.time`, `.index`, `.center`. Times and
        `.least` are computed at their first use. Raises InputError for numbers that are not finite and for a path
        without points.

        """
        paths = paths_of(path)
        require_for_each(paths, "heading", np.shape(heading))
        require_for_each(paths, "axis", () if axis is None else np.shape(axis)[:-1])
        swept = self._swept(paths.starts, paths.ends, heading, axis)
        hit, segments = first_segments(paths, np.unique(swept.query[swept.hits]))
        first = np.full(len(hit), -1)
        first[hit] = segments - paths.first[:-1][hit]
        passages = measured(self._measure(swept), segments)
        single = paths.single
        return FirstContact(
            bool(hit[0]) if single else hit, int(first[0]) if single else first, passages, paths,
            lambda: self._least(paths, swept),
        )  # fmt: skip

    @in_default_environment
    def show(
        self, path: ArrayLike | None = None, heading: ArrayLike = 0.0, *, axis: ArrayLike | None = None
    ) -> ScenePage:
        """Return a page in 3-D of the scene, and of a flight (T, 3): `.save("view.html")`, or a notebook's last line.

        It needs a browser and no network: three.js is in it. The flight is drawn with all that the mover sweeps, its
        contacts, and the least distance on each of 240 pieces. Arguments are as in first_contact.
        """
        flight = None if path is None else shown_flight(self, path, heading, axis)
        return ScenePage(page_of(self.model, flight))

    @in_default_environment
    def plot(self, path: ArrayLike | None = None, heading: ArrayLike = 0.0, *, axis: ArrayLike | None = None) -> Figure:
        """Return plan and elevation of the scene and a flight (T, 3), a figure of matplotlib: `.savefig("view.pdf")`.

        Arguments are as in first_contact. Raises UnavailableError where matplotlib is missing.
        """
        return plot_of(self.model, None if path is None else shown_flight(self, path, heading, axis, count_of_pieces=1))

    def _least(self, paths: Paths, swept: Swept) -> LeastDistance:
        """Return the least distance of each path; segments are counted over all paths."""
        hit, segments = first_segments(paths, np.unique(swept.query[swept.own]))
        own = measured(self._measure(swept, parts=False), segments)
        clear = np.flatnonzero(~hit[paths.path])
        axes = None if swept.movers is None else swept.movers[clear]
        flights = Flights(paths.starts[clear], paths.ends[clear], paths.path[clear], axes)
        least = least_distances(self._bodies, self.model.mover, self._grid, self._reaches, flights, len(hit))
        known = least.segment >= 0
        least.segment[known] = clear[least.segment[known]]
        least.distance_lower[hit], least.distance_upper[hit], least.segment[hit] = 0.0, 0.0, segments
        least.time[hit], least.index[hit] = own.first_upper, own.index
        return least

    def _swept(self, start: ArrayLike, end: ArrayLike, heading: ArrayLike, axis: ArrayLike | None) -> Swept:
        """Return straight sweeps, and which pairs of them and of hyperboloids have contact."""
        bodies, mover = self._bodies, self.model.mover
        axes = self._axes(axis) if axis is not None or is_tilted(mover.axis) else ()
        starts, ends, headings, *columns = sweeps_of(start, end, heading, axes)
        movers = directions(columns) if columns else None
        query, body = near_sweeps(bodies, mover, self.model.region.z, self._grid, self._reaches, starts, ends)
        sizes = np.broadcast_to((mover.b, mover.d), (len(body), 2))
        own = hits_beside(bodies, body, sizes, starts[query], ends[query], None if movers is None else movers[query])
        swept = Swept(starts, ends, headings, movers, query, body, own, own.copy())
        for pair in np.flatnonzero(own).tolist() if mover.parts else ():
            swept.hits[pair] = not is_clear(bodies.one(int(body[pair])), *self._sweeps(swept, int(query[pair])))
        return swept

    def _hit_at_once(self, start: object, end: object, heading: object) -> bool | None:
        """Whether the mover has contact on one sweep, if everything is upright and bounds decide; else None."""
        here, there = point_at_once(start), point_at_once(end)
        if here is None or there is None or self._is_tilted or not (isinstance(heading, float) and isfinite(heading)):
            return None
        if not self._grid_holds(here[2], there[2]):
            return None
        mover = self.model.mover
        hit = hit_at_once(self._grid, self._reaches, self._numbers, mover, here, there)
        return None if hit and mover.parts else hit

    def _first_on(self, start: ArrayLike, end: ArrayLike, heading: ArrayLike, sweep: int) -> First:
        """Return the first contact of one sweep that has one, which is prepared now."""
        return self._measure(self._swept(start, end, heading, None))(sweep)

    def _measure(self, swept: Swept, *, parts: bool = True) -> Callable[[int], First]:
        """Return the function that finds the first contact of a sweep that has one, of the parts or of the mover."""
        hits = swept.hits if parts else swept.own

        def measure(sweep: int) -> First:
            here = slice(*np.searchsorted(swept.query, (sweep, sweep + 1)).tolist())
            touched = swept.body[here][hits[here]].tolist()
            mover, others = self._sweeps(swept, sweep)
            sweeps = (mover, others if parts else [])
            start, end = swept.starts[sweep], swept.ends[sweep]
            far = self._reaches[touched] if self._grid_holds(start[2], end[2]) else np.full(len(touched), np.inf)
            earliest = enters(self._bodies.origins[touched], far, start, end)
            firsts: list[First] = []
            for time, index in sorted(zip(earliest, touched, strict=True)):
                if not firsts or time <= min(firsts)[0][1]:  # what comes later is not the first
                    firsts.append((first_contact(self._numbers(index)[0], *sweeps), index))
            return min(firsts)

        return measure

    def _sweeps(self, swept: Swept, sweep: int) -> tuple[Spheroid, list[Spheroid]]:
        """Return one sweep of the mover, and those of its parts."""
        mover, heading = self.model.mover, float(swept.headings[sweep])
        start, end = swept.starts[sweep].tolist(), swept.ends[sweep].tolist()
        axis = UPRIGHT if swept.movers is None else swept.movers[sweep].tolist()
        places = (places_of_parts(mover.parts, at, heading, axis) for at in (start, end))
        parts = [
            (part.b, part.d, Sweep(here, there, axis)) for part, here, there in zip(mover.parts, *places, strict=True)
        ]
        return (mover.b, mover.d, Sweep(start, end, axis)), parts

    @in_default_environment
    def nearest(
        self, x: ArrayLike, y: ArrayLike | None = None, z: ArrayLike | None = None, *, axis: ArrayLike | None = None
    ) -> Nearest:
        """Return the nearest hyperboloid to the mover, proved bounds of its distance, the nearest point and the normal.

        `x`, `y`, `z` are (n,) each or single numbers, or `x` alone are points, (n, 3) or (3,); one centre is answered
        by numbers. The distance is Euclidean, from the mover itself, not its parts, to the real surface between its
        ends, and to flat ends if they belong to it. It does not depend on the scene's question; it is 0 if and only if
        there is contact. `axis` is as in classify. Raises InputError for numbers that are not finite, and for an axis
        where the scene fixes it.

        >>> scene = Scene.from_arrays([2, 1], 17.8, [[0, 0, 0], [9, 0, 0]], mover=(0.25, 0.25))
        >>> near = scene.nearest((5, 0, 0))
        >>> near.index, near.distance_lower <= 2.75 <= near.distance_upper, near.normal.round(6).tolist()
        (0, True, [1.0, 0.0, 0.0])
        """
        mover = self.model.mover
        axes = self._axes(axis) if axis is not None or is_tilted(mover.axis) else ()
        center = points_or_columns(x, y, z)
        columns = finite_columns((*CENTER, *AXIS[: len(axes)]), (*center, *axes))
        movers = directions(columns[3:]) if axes else None
        result = scene_nearest.nearest(self._bodies, mover, np.stack(columns[:3], axis=1), movers)
        return scene_nearest.first_of(result) if are_one(center, 0, axis) else result

    def _tilted_position(self, centre: Point, heading: float, axis: ArrayLike | None) -> int:
        """Return the position where the mover or a hyperboloid is tilted."""
        mover_axis = [float(number) for number in self._axes(axis)]
        trouble = trouble_with_axis(mover_axis)
        if trouble is not None:
            raise InputError(trouble)
        replies = [self._tilted_reply(index, centre, heading, mover_axis) for index in self._near(*centre)]
        return self._answer(_OF_RANK[max((_RANK[position] for position in replies), default=0)])

    def _tilted_reply(self, index: int, centre: Point, heading: float, axis: list[float]) -> int:
        """Return the position of one centre beside one hyperboloid."""
        mover = self.model.mover
        reply = position_of(self._numbers(index)[0], (mover.b, mover.d), centre, axis)
        return self._of_parts(index, centre, heading, axis) if reply == CONTACT and mover.parts else reply

    def _answer(self, position: int) -> int:
        """Return the answer to the scene's question from a position."""
        question = self.model.question
        if question == "position":
            return position
        return int(position == POSITION_OF[question])

    def _axes(self, axis: ArrayLike | None) -> tuple[float, float, float] | tuple[Floats, Floats, Floats]:
        """Return the three numbers of the mover's axis: the scene's, or the query's where the scene leaves it free."""
        fixed = self.model.mover.axis
        if fixed != FREE:
            if axis is not None:
                raise InputError(
                    f'axis is given, but the scene fixes it: {list(fixed)}; give one only if [mover] has axis = "free"'
                )
            return fixed
        wanted = "it must be three numbers, or an array (n, 3) of them"
        if axis is None:
            raise InputError(f"no axis is given, and the scene leaves the mover's free; {wanted}")
        axes = as_numbers("axis is", axis, wanted)
        if axes.ndim not in (1, 2) or axes.shape[-1] != 3:
            raise InputError(f"axis is of shape {axes.shape}; {wanted}")
        return axes[..., 0], axes[..., 1], axes[..., 2]

    def _replies(
        self, query: Indices, body: Indices, centres: Floats, heading: Floats, movers: Floats | None
    ) -> Positions:
        """Return the position of each centre beside its hyperboloid.

        `movers` are the mover's axes if something is tilted.
        """
        bodies, mover = self._bodies, self.model.mover
        axes = None if movers is None else movers[query]
        result = positions(bodies, body, (mover.b, mover.d), centres[query], axes, self._limits)
        for pair in np.flatnonzero(result == CONTACT).tolist() if mover.parts else ():
            owner = query[pair]
            axis = UPRIGHT if movers is None else movers[owner].tolist()
            result[pair] = self._of_parts(int(body[pair]), centres[owner].tolist(), float(heading[owner]), axis)
        return result

    def _of_parts(self, index: int, centre: Sequence[float], heading: float, mover: Sequence[float]) -> int:
        """Return the position that all parts of a mover with this axis share beside a hyperboloid, else contact."""
        common = CONTACT
        for number, place in enumerate(places_of_parts(self.model.mover.parts, centre, heading, mover)):
            part = self.model.mover.parts[number]
            reply = position_of(self._numbers(index)[0], (part.b, part.d), place, mover)
            if reply == CONTACT or (number and reply != common):
                return CONTACT
            common = reply
        return common


def _combined(replies: Positions, query: Indices, count: int) -> Positions:
    """Return the answer at each centre by the near hyperboloids: contact, else interior, else exterior."""
    rank = np.select([replies == position for position in _RANK], list(_RANK.values()), 0).astype(np.int8)
    highest = np.zeros(count, np.int8)
    np.maximum.at(highest, query, rank)
    return np.array(_OF_RANK, np.int8)[highest]
