"""A scene prepared once, then asked again and again: exact answers about the mover, wherever it stands in the scene.

The answer about a whole scene: contact with any hyperboloid is contact; else inside any is interior; else exterior.
Parts of the mover are asked where the mover itself is in contact: an answer that all parts share is then the answer.
scene_pairs.py, scene_ends.py and scene_sweeps.py give the answer of each hyperboloid.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from math import isfinite

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.errors import InputError
from hypcheck.float_environment import in_default_environment
from hypcheck.geometry.pair import AXIS, CENTER, NO_DIRECTION, trouble_with, trouble_with_axis
from hypcheck.geometry.rows import Floats, Indices, Positions, as_columns, as_numbers
from hypcheck.kernel import scene_nearest
from hypcheck.kernel.choice import POSITION_OF
from hypcheck.kernel.passages import First, Passages
from hypcheck.kernel.scene_ends import limits_of, position_with_ends, positions_with_ends
from hypcheck.kernel.scene_frames import places_of_parts
from hypcheck.kernel.scene_index import (
    Bodies,
    PlaneGrid,
    bodies_of,
    grid_of,
    in_reach,
    near_ways,
    reaches,
)
from hypcheck.kernel.scene_nearest import Nearest
from hypcheck.kernel.scene_pairs import (
    Body,
    position_beside,
    position_leaning,
    positions_beside,
    positions_leaning,
)
from hypcheck.kernel.scene_sweeps import Spheroid, Sweep, first_contact, hits_beside, is_clear
from hypcheck.scene.model import FREE, UPRIGHT, Point, SceneModel, leans
from hypcheck.scene.reading import parse_scene, read_scene

CONTACT, EXTERIOR, INTERIOR = 0, 1, -1

_ASKED = (*CENTER, "heading")
_POINTS = f"it must be three numbers, {', '.join(CENTER)}, or an array (n, 3) of them"

_RANK = {CONTACT: 3, INTERIOR: 2, EXTERIOR: 1}
_OF_RANK = (EXTERIOR, EXTERIOR, INTERIOR, CONTACT)
"""The greater rank prevails where hyperboloids give different answers; 0 means that none is near."""


@dataclass(frozen=True)
class Scene:
    """A scene (docs/scenes.md), ready to be asked: `Scene.from_toml(path).classify(x, y, z)`."""

    model: SceneModel

    @in_default_environment
    def __post_init__(self) -> None:
        if not self.model.hyperboloids:
            raise InputError("the scene has no hyperboloid; it must have one at least")
        mover = self.model.mover
        trouble = None if mover.axis == FREE else trouble_with_axis(mover.axis)
        if trouble is not None:
            raise InputError(f"the mover: {trouble}")

    @classmethod
    @in_default_environment
    def from_toml(cls, path: str | os.PathLike[str]) -> Scene:
        """The scene in a file, or a shipped scene by its name. Raises InputError naming key and line."""
        return cls(read_scene(os.fspath(path)))

    @classmethod
    @in_default_environment
    def from_text(cls, text: str) -> Scene:
        """The scene that a TOML text describes. Raises InputError naming key and line."""
        return cls(parse_scene(text))

    @in_default_environment
    def classify(
        self,
        x: ArrayLike,
        y: ArrayLike,
        z: ArrayLike,
        heading: ArrayLike = 0.0,
        *,
        axis: ArrayLike | None = None,
    ) -> Positions:
        """The exact answer to the scene's question for centres in the scene's coordinates; int8 (n,).

        `x`, `y`, `z` are (n,) each or single numbers, `heading` the mover's direction in degrees, which places its
        parts. `axis`, (3,) or (n, 3), is the mover's where the scene says that it is free, any vector ≠ 0 along its
        axis of revolution. Positions are +1, 0, −1, and other questions are answered 1 yes, 0 no. Offsets between
        centres are taken exactly, not rounded; a part stands where its rounded centre is. Raises InputError for numbers
        that are not finite, and for an axis where the scene fixes it.
        """
        axes = self._axes(axis) if axis is not None or self._leaning else ()
        asked = (*_ASKED, *AXIS[: len(axes)])
        columns = _finite_columns(asked, (x, y, z, heading, *axes))
        centres = np.stack(columns[:3], axis=1)
        query, body = self._pairs(centres)
        movers = _directions(columns[4:]) if axes else None
        said = self._said(query, body, centres, columns[3], movers)
        return self._answers(_combined(said, query, len(centres)))

    @in_default_environment
    def position(
        self, x: float, y: float, z: float, heading: float = 0.0, *, axis: Sequence[float] | None = None
    ) -> int:
        """The exact answer to the scene's question for one centre: as classify, at the price of a step.

        Raises InputError for numbers that are not finite, and for an axis where the scene fixes it.
        """
        if not (
            type(x) is type(y) is type(z) is type(heading) is float
            and (isfinite(x) and isfinite(y) and isfinite(z) and isfinite(heading))
        ):
            x, y, z, heading = map(_number, _ASKED, (x, y, z, heading))
        if axis is not None or self._leaning:
            return self._position_leaning((x, y, z), heading, axis)
        mover, found = self.model.mover, EXTERIOR
        for index in self._near(x, y, z):
            body, low, high, inner_low, inner_high = self._body(index)
            if z < low or z > high:  # beyond an end
                continue
            said = position_beside(body, mover.b, mover.d, x, y, z)
            if said != EXTERIOR and not inner_low <= z <= inner_high:
                said = self._with_ends(said, index, (mover.b, mover.d), (x, y, z), UPRIGHT)
            if said == CONTACT and mover.parts:
                said = self._of_parts(index, (x, y, z), heading, UPRIGHT)
            if said == CONTACT:
                return self._answer(CONTACT)
            if said == INTERIOR:
                found = INTERIOR
        return self._answer(found)

    @in_default_environment
    def passage(
        self, start: ArrayLike, end: ArrayLike, heading: ArrayLike = 0.0, *, axis: ArrayLike | None = None
    ) -> Passages:
        """Whether the mover meets contact on each straight way, its ends included, when first, and with what.

        `start` and `end` are (n, 3) or (3,), in the scene's coordinates; `heading`, (n,) or a number, and `axis`, as in
        classify, are the same all along. `.hit` says exactly whether there is contact on the way, whatever the
        scene's question is; `.first_lower` ≤ first time ≤ `.first_upper`, 0 at the start and 1 at the end, `.index` is
        the hyperboloid, and `.first` has the times as fractions; they are found when they are asked for, a millisecond
        a hit. A part goes straight from where it stands at the start to where it stands at the end; it is asked where
        the mover has contact. Beside an end of a hyperboloid, a miss by less than 2^−240 of the way or the sizes counts
        as contact. Raises InputError for numbers that are not finite, and for an axis where the scene fixes it.
        """
        bodies, mover = self._bodies, self.model.mover
        axes = self._axes(axis) if axis is not None or leans(mover.axis) else ()
        starts, ends, headings, *columns = _ways(start, end, heading, axes)
        movers = _directions(columns) if columns else None
        query, body = near_ways(bodies, mover, self.model.region.z, self._grid, self._reaches, starts, ends)
        hits = hits_beside(bodies, body, mover, starts[query], ends[query], None if movers is None else movers[query])

        def sweeps(way: int) -> tuple[Spheroid, list[Spheroid]]:
            own_axis = UPRIGHT if movers is None else movers[way].tolist()
            return self._sweeps(starts[way].tolist(), ends[way].tolist(), float(headings[way]), own_axis)

        for pair in np.flatnonzero(hits).tolist() if mover.parts else ():
            hits[pair] = not is_clear(bodies, int(body[pair]), *sweeps(query[pair]))
        result = np.zeros(len(starts), np.bool_)
        result[query[hits]] = True

        def measure(way: int) -> First:
            touched = body[hits & (query == way)].tolist()
            return min((first_contact(bodies, index, *sweeps(way)), index) for index in touched)

        single = np.ndim(start) == 1 and np.ndim(end) == 1 and len(starts) == 1 and np.ndim(heading) == 0
        return Passages(bool(result[0]) if single else result, measure)

    def _sweeps(
        self, start: list[float], end: list[float], heading: float, axis: Sequence[float]
    ) -> tuple[Spheroid, list[Spheroid]]:
        """The sweep of the mover, and those of its parts."""
        mover = self.model.mover
        places = (places_of_parts(mover.parts, at, heading, axis) for at in (start, end))
        parts = [
            (part.b, part.d, Sweep(here, there, axis)) for part, here, there in zip(mover.parts, *places, strict=True)
        ]
        return (mover.b, mover.d, Sweep(start, end, axis)), parts

    @in_default_environment
    def nearest(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, *, axis: ArrayLike | None = None) -> Nearest:
        """Which hyperboloid is nearest to the mover, its distance between proved numbers, and the nearest point.

        `x`, `y`, `z` are (n,) each or single numbers. The distance is Euclidean, from the mover itself, not its parts,
        to what stands of the surface, and to flat ends where they belong to it, wherever the mover is, whatever the
        scene's question is; it is 0 in contact, and only there. `axis` is as in classify. Raises InputError for numbers
        that are not finite, and for an axis where the scene fixes it.
        """
        mover = self.model.mover
        axes = self._axes(axis) if axis is not None or leans(mover.axis) else ()
        columns = _finite_columns((*CENTER, *AXIS[: len(axes)]), (x, y, z, *axes))
        movers = _directions(columns[3:]) if axes else None
        return scene_nearest.nearest(self._bodies, mover, np.stack(columns[:3], axis=1), movers)

    def _position_leaning(self, centre: Point, heading: float, axis: Sequence[float] | None) -> int:
        """The same where something leans."""
        given = self._axes(axis)
        if np.ndim(given[0]):
            raise InputError(
                f"axis is of shape {(*np.shape(given[0]), 3)}; it must be three numbers (classify takes arrays)"
            )
        mover_axis = [float(each) for each in given]
        trouble = trouble_with_axis(mover_axis)
        if trouble is not None:
            raise InputError(trouble)
        said = [self._said_leaning(index, centre, heading, mover_axis) for index in self._near(*centre)]
        return self._answer(_OF_RANK[max((_RANK[position] for position in said), default=0)])

    def _said_leaning(self, index: int, centre: Point, heading: float, axis: list[float]) -> int:
        """What a hyperboloid says about one centre."""
        mover = self.model.mover
        said = self._of_one(index, (mover.b, mover.d), centre, axis)
        return self._of_parts(index, centre, heading, axis) if said == CONTACT and mover.parts else said

    def _of_one(
        self, index: int, semi_axes: tuple[float, float], centre: Sequence[float], axis: Sequence[float]
    ) -> int:
        """The position of one spheroid with these semi-axes beside a hyperboloid."""
        body = self.model.hyperboloids[index]
        whole = position_leaning((body.alpha, body.gamma, *semi_axes), centre, body.center, axis, body.axis)
        return whole if body.height is None else self._with_ends(whole, index, semi_axes, centre, axis)

    def _with_ends(
        self,
        whole: int,
        index: int,
        semi_axes: tuple[float, float],
        centre: Sequence[float],
        axis: Sequence[float],
    ) -> int:
        """The same from the position beside the whole hyperboloid."""
        bodies, body = self._bodies, self.model.hyperboloids[index]
        upward, span = bodies.axes[index].tolist(), bodies.spans[index].tolist()
        sizes = (body.alpha, body.gamma, *semi_axes)
        return position_with_ends(whole, sizes, centre, body.center, axis, upward, span, solid=body.solid)

    def _answer(self, position: int) -> int:
        question = self.model.question
        if question == "position":
            return position
        return int(position == POSITION_OF[question])

    def _axes(self, axis: ArrayLike | None) -> tuple[float, float, float] | tuple[Floats, Floats, Floats]:
        """The three numbers of the mover's axis: the scene's, or the query's where the scene leaves it free."""
        fixed = self.model.mover.axis
        if fixed != FREE:
            if axis is not None:
                raise InputError(
                    f"axis is given, and the scene fixes the mover's: {list(fixed)}; only where [mover] has "
                    'axis = "free" does a query name it'
                )
            return fixed
        wanted = "it must be three numbers, or an array (n, 3) of them"
        if axis is None:
            raise InputError(f"no axis is given, and the scene leaves the mover's free; {wanted}")
        given = as_numbers("axis is", axis, wanted)
        if given.ndim not in (1, 2) or given.shape[-1] != 3:
            raise InputError(f"axis is of shape {given.shape}; {wanted}")
        return given[..., 0], given[..., 1], given[..., 2]

    def _near(self, x: float, y: float, z: float) -> Sequence[int]:
        height = self.model.region.z
        if height is not None and not height.low <= z <= height.high:  # of which the grid promises nothing
            near: list[int] = in_reach(self._bodies, self.model.mover, (x, y, z)).tolist()
            return near
        return self._grid.near(x, y)

    def _pairs(self, centres: Floats) -> tuple[Indices, Indices]:
        """Which hyperboloids have to be asked about which centres."""
        height = self.model.region.z
        if height is None or ((centres[:, 2] >= height.low) & (centres[:, 2] <= height.high)).all():
            return self._grid.near_each(centres[:, 0], centres[:, 1])
        near = [self._near(x, y, z) for x, y, z in centres.tolist()]
        counts = [len(each) for each in near]
        return np.repeat(np.arange(len(centres)), counts), np.array(list(chain.from_iterable(near)), np.int64)

    def _said(
        self, query: Indices, body: Indices, centres: Floats, heading: Floats, movers: Floats | None
    ) -> Positions:
        """What each hyperboloid says about its centre; `movers` are the mover's axes where something leans."""
        bodies, mover = self._bodies, self.model.mover
        level, (low, high, inner_low, inner_high) = centres[query, 2], self._limits[body].T
        beyond, between = (level < low) | (level > high), (level >= inner_low) & (level <= inner_high)
        sizes = np.concatenate([bodies.shapes[body], np.broadcast_to((mover.b, mover.d), (len(body), 2))], axis=1)
        pairs = centres[query], bodies.origins[body]
        if movers is None:
            result = positions_beside(sizes, *pairs)
        else:
            result = positions_leaning(sizes, *pairs, movers[query], bodies.axes[body])
        result[beyond] = EXTERIOR
        some = np.flatnonzero(~between & (result != EXTERIOR))
        if len(some):
            axes = np.broadcast_to(UPRIGHT, (len(some), 3)) if movers is None else movers[query[some]]
            places = pairs[0][some], pairs[1][some], axes
            result[some] = positions_with_ends(result[some], sizes[some], *places, bodies, body[some])
        for pair in np.flatnonzero(result == CONTACT).tolist() if mover.parts else ():
            asked = query[pair]
            axis = UPRIGHT if movers is None else movers[asked].tolist()
            result[pair] = self._of_parts(int(body[pair]), centres[asked].tolist(), float(heading[asked]), axis)
        return result

    def _of_parts(self, index: int, centre: Sequence[float], heading: float, mover: Sequence[float]) -> int:
        """The position that all parts of a mover with this axis have in common beside a hyperboloid, else contact."""
        found = CONTACT
        for number, place in enumerate(places_of_parts(self.model.mover.parts, centre, heading, mover)):
            part = self.model.mover.parts[number]
            said = self._of_one(index, (part.b, part.d), place, mover)
            if said == CONTACT or (number and said != found):
                return CONTACT
            found = said
        return found

    def _answers(self, positions: Positions) -> Positions:
        question = self.model.question
        if question == "position":
            return positions
        return np.asarray(positions == POSITION_OF[question], np.int8)

    def _body(self, index: int) -> tuple[Body, float, float, float, float]:
        """A hyperboloid's numbers, and its limits, without arrays; each is kept once it was asked."""
        found = self._asked.get(index)
        if found is None:
            of = self._bodies
            columns = (of.shapes[index], of.origins[index], self._limits[index])
            alpha, gamma, x, y, z, *limits = (number for column in columns for number in column.tolist())
            low, high, inner_low, inner_high = limits
            found = self._asked[index] = ((alpha, gamma, x, y, z), low, high, inner_low, inner_high)
        return found

    @cached_property
    def _leaning(self) -> bool:
        return self.model.leaning

    @cached_property
    def _asked(self) -> dict[int, tuple[Body, float, float, float, float]]:
        return {}

    @cached_property
    def _grid(self) -> PlaneGrid:
        origins = self._bodies.origins
        return grid_of(origins[:, 0], origins[:, 1], self._reaches)

    @cached_property
    def _reaches(self) -> Floats:
        return reaches(self._bodies, self.model.mover, self.model.region.z)

    @cached_property
    def _limits(self) -> Floats:
        return limits_of(self._bodies, self.model.mover)

    @cached_property
    def _bodies(self) -> Bodies:
        bodies = bodies_of(self.model.hyperboloids)
        invalid = ~(np.isfinite(bodies.axes).all(axis=1) & (bodies.axes != 0).any(axis=1))
        for index in np.flatnonzero(invalid)[:1].tolist():
            body = self.model.hyperboloids[index]
            raise InputError(f"the hyperboloid {body.name!r}: {trouble_with_axis(body.axis)}")
        for index in np.flatnonzero(~(bodies.spans[:, 0] < bodies.spans[:, 1]))[:1].tolist():
            body = self.model.hyperboloids[index]
            raise InputError(f"the hyperboloid {body.name!r}: height is {body.height}; its low must be less than high")
        return bodies


def _ways(start: ArrayLike, end: ArrayLike, heading: ArrayLike, axes: Sequence[ArrayLike]) -> tuple[Floats, ...]:
    """The ends of ways, (n, 3) each, headings (n,), and the numbers of axes. Raises InputError where they are none."""
    points = []
    for name, given in (("start", start), ("end", end)):
        point = as_numbers(f"{name} is", given, _POINTS)
        if point.ndim not in (1, 2) or point.shape[-1] != len(CENTER):
            raise InputError(f"{name} is of shape {point.shape}; {_POINTS}")
        points.append(point.reshape(-1, len(CENTER)).T)
    names = (*(f"{each} of the start" for each in CENTER), *(f"{each} of the end" for each in CENTER), "heading")
    columns = _finite_columns((*names, *AXIS[: len(axes)]), (*points[0], *points[1], heading, *axes))
    return np.stack(columns[:3], axis=1), np.stack(columns[3:6], axis=1), *columns[6:]


def _finite_columns(names: Sequence[str], given: Sequence[ArrayLike]) -> tuple[Floats, ...]:
    """The columns as as_columns makes them. Raises InputError about the first number that is not finite."""
    columns = as_columns(names, given)
    for name, values in zip(names, columns, strict=True):
        finite = np.isfinite(values)
        if not finite.all():
            index = int(np.argmin(finite))
            raise InputError(f"row {index}: {name} is {float(values[index])!r}; it must be finite")
    return columns


def _directions(columns: Sequence[Floats]) -> Floats:
    """The axes as (n, 3). Raises InputError about the first that is 0, 0, 0."""
    axes = np.stack(columns, axis=1)
    nowhere = np.flatnonzero(~(axes != 0).any(axis=1))
    if len(nowhere):
        raise InputError(f"row {int(nowhere[0])}: {NO_DIRECTION}")
    return axes


def _number(name: str, value: object) -> float:
    """The value as a finite float64; raises InputError about anything else."""
    if not isinstance(value, (int, float)):
        array = as_numbers(f"{name} is", value, "it must be a number")
        if array.size != 1:
            raise InputError(f"{name} is of shape {array.shape}; it must be a number (classify takes arrays)")
        value = float(array.item())
    trouble = trouble_with(name, value)
    if trouble is not None:
        raise InputError(trouble)
    return float(value)


def _combined(said: Positions, query: Indices, count: int) -> Positions:
    """The answer at each centre by the near hyperboloids: contact, else interior, else exterior."""
    rank = np.select([said == position for position in _RANK], list(_RANK.values()), 0).astype(np.int8)
    highest = np.zeros(count, np.int8)
    np.maximum.at(highest, query, rank)
    return np.array(_OF_RANK, np.int8)[highest]
