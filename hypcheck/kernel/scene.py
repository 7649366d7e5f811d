"""A prepared scene: exact answers about the mover, with centres in the scene's coordinates.

A whole scene asked at once: which hyperboloids are near, what each says exactly, and what that comes to.

Exact positions from a hyperboloid's centre, though the difference of two floats is rounded.

A centre seen from another is x − x₀, and that is no float64 as a rule. Its rounding error, though, is one, and is known
(TwoSum): where it is 0 the difference is exact and the fast path answers. Elsewhere the difference lies between two
neighbouring floats. The exterior positions are an up-set when |x| and |y| grow and |z| falls, the interior ones when
|x| and |y| fall and |z| grows: when the two extreme corners of that box have one position, it is the answer; else the
exact difference is taken in integers.

One mover beside one hyperboloid, both in the scene's coordinates, without arrays: what a step of a walk costs.

A scene that is asked again and again: prepared once, then exact answers about the mover wherever it stands.

The answer about a whole scene: contact with any hyperboloid is contact; else inside any is interior; else exterior. A
hyperboloid beyond whose modelled height the centre lies says nothing, and where all say nothing, so does the scene.
Parts of the mover are asked where the mover itself is in contact: what all parts say alike is then the answer.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import chain
from math import cos, inf, isfinite, nextafter, radians, sin
from sys import float_info

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.derivation.float_arithmetic import two_sum
from hypcheck.errors import InputError
from hypcheck.geometry.pair import CENTER, Lengths, to_integers, trouble_with
from hypcheck.geometry.rows import CANNOT_SAY, Floats, Indices, Positions, Rows, as_columns, as_numbers
from hypcheck.kernel import integers
from hypcheck.kernel.classify import classify
from hypcheck.kernel.scalar import position
from hypcheck.kernel.scene_index import (
    Bodies,
    Levels,
    PlaneGrid,
    bodies_of,
    grid_of,
    in_reach,
    levels_of,
    reaches,
)
from hypcheck.scene.model import SceneModel
from hypcheck.scene.reading import parse_scene, read_scene


def positions_beside(sizes: Rows, centres: Rows, origins: Rows) -> Positions:
    """The exact position of each mover, int8 (n,): sizes (n, 4), and both centres (n, 3) in the scene's coordinates."""
    with np.errstate(all="ignore"):
        offset, error = two_sum(centres, -origins)
    beyond = np.logical_not((np.abs(offset) < np.finfo(np.float64).max).all(axis=1))  # no float64, or none above it
    result = classify(np.concatenate([sizes, np.where(beyond[:, None], 0.0, offset)], axis=1))
    rounded = np.flatnonzero((error != 0).any(axis=1) & ~beyond)
    if len(rounded):
        result[rounded] = _between(sizes[rounded], offset[rounded], centres[rounded], origins[rounded])
    for index in np.flatnonzero(beyond).tolist():
        result[index] = position_of_exact_difference(
            sizes[index].tolist(), centres[index].tolist(), origins[index].tolist()
        )
    return result


def _between(sizes: Rows, offset: Floats, centres: Rows, origins: Rows) -> Positions:
    size = np.abs(offset)
    less, more = np.nextafter(size, 0.0), np.nextafter(size, np.inf)
    outermost = classify(np.concatenate([sizes, more[:, :2], less[:, 2:]], axis=1))
    innermost = classify(np.concatenate([sizes, less[:, :2], more[:, 2:]], axis=1))
    result = outermost.copy()
    for index in np.flatnonzero(outermost != innermost).tolist():
        result[index] = position_of_exact_difference(
            sizes[index].tolist(), centres[index].tolist(), origins[index].tolist()
        )
    return result


def position_of_exact_difference(sizes: list[float], centre: list[float], origin: list[float]) -> int:
    """The position about the exact difference of two centres, in integers."""
    alpha, gamma, b, d = sizes
    x, y, z = (Fraction(there) - Fraction(here) for there, here in zip(centre, origin, strict=True))
    radial = to_integers((Fraction(alpha), Fraction(b), x, y))
    axial = to_integers((Fraction(gamma), Fraction(d), z))
    return int(integers.position(Lengths(radial[0], radial[1], radial[2], radial[3], *axial)))


GREATEST = float_info.max
"""A difference of centres from here on has no float64 above it."""

Body = tuple[float, float, float, float, float, float, float]
"""α, γ, the centre x, y, z, and the lowest and highest modelled z, of a hyperboloid."""


def position_beside(body: Body, b: float, d: float, x: float, y: float, z: float) -> int:
    """The exact position of a spheroid at (x, y, z): as offsets.positions has it, of one pair."""
    alpha, gamma, there_x, there_y, there_z, _, _ = body
    across, along, up = x - there_x, y - there_y, z - there_z
    # TwoSum: what each difference has lost; 0 where it is exact.
    back_x, back_y, back_z = across + there_x, along + there_y, up + there_z
    if (
        (x - back_x) == (there_x - (back_x - across))
        and (y - back_y) == (there_y - (back_y - along))
        and (z - back_z) == (there_z - (back_z - up))
    ):
        return position(alpha, gamma, b, d, across, along, up)
    across, along, up = abs(across), abs(along), abs(up)
    if not (across < GREATEST and along < GREATEST and up < GREATEST):
        return position_of_exact_difference([alpha, gamma, b, d], [x, y, z], [there_x, there_y, there_z])
    outermost = position(alpha, gamma, b, d, nextafter(across, inf), nextafter(along, inf), nextafter(up, 0.0))
    innermost = position(alpha, gamma, b, d, nextafter(across, 0.0), nextafter(along, 0.0), nextafter(up, inf))
    if outermost == innermost:
        return outermost
    return position_of_exact_difference([alpha, gamma, b, d], [x, y, z], [there_x, there_y, there_z])


NOTHING_SAID = 2
CONTACT, EXTERIOR, INTERIOR = 0, 1, -1

YES = {"exterior": EXTERIOR, "interior": INTERIOR, "contact": CONTACT}
"""The position that is answered 1, by the question."""

_ASKED = (*CENTER, "heading")

_RANK = {CONTACT: 3, INTERIOR: 2, EXTERIOR: 1}
_OF_RANK = (NOTHING_SAID, EXTERIOR, INTERIOR, CONTACT)
"""What counts more when hyperboloids say different things; 0 is nothing said by those that are near."""


@dataclass(frozen=True)
class Scene:
    """A scene (docs/scenes.md), ready to be asked: `Scene.from_toml(path).classify(x, y, z)`."""

    model: SceneModel

    def __post_init__(self) -> None:
        if not self.model.hyperboloids:
            raise InputError("the scene has no hyperboloid; it must have one at least")

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Scene:
        """The scene in a file, or a shipped scene by its name. Raises InputError naming key and line."""
        return cls(read_scene(os.fspath(path)))

    @classmethod
    def from_text(cls, text: str) -> Scene:
        """The scene that a TOML text describes. Raises InputError naming key and line."""
        return cls(parse_scene(text))

    def classify(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, heading: ArrayLike = 0.0) -> Positions:
        """The exact answer to the scene's question for centres in the scene's coordinates; int8 (n,).

        `x`, `y`, `z` are (n,) each or single numbers, `heading` the mover's direction in degrees, which places its
        parts. Positions are +1, 0, −1, and other questions are answered 1 yes, 0 no; 2 is said beyond every modelled
        height. Offsets between centres are taken exactly, not rounded; a part stands where its rounded centre is.
        Raises InputError for numbers that are not finite.
        """
        columns = as_columns(_ASKED, (x, y, z, heading))
        centres = np.stack(columns[:3], axis=1)
        for name, values in zip(_ASKED, columns, strict=True):
            if not np.isfinite(values).all():
                index = int(np.argmin(np.isfinite(values)))
                raise InputError(f"row {index}: {name} is {float(values[index])!r}; it must be finite")
        query, body = self._pairs(centres)
        said = self._said(query, body, centres, columns[3])
        found = _combined(said, query, len(centres))
        silent = found == NOTHING_SAID
        found[silent] = np.where(self._levels.hold_each(centres[silent, 2]), EXTERIOR, NOTHING_SAID)
        return self._answers(found)

    def position(self, x: float, y: float, z: float, heading: float = 0.0) -> int:
        """The exact answer to the scene's question for one centre: as classify, at the price of a step.

        Raises InputError for numbers that are not finite.
        """
        if not (
            type(x) is type(y) is type(z) is type(heading) is float
            and (isfinite(x) and isfinite(y) and isfinite(z) and isfinite(heading))
        ):
            x, y, z, heading = map(_number, _ASKED, (x, y, z, heading))
        mover, found = self.model.mover, 0
        for index in self._near(x, y, z):
            body = self._body(index)
            if body[5] <= z <= body[6]:
                said = position_beside(body, mover.b, mover.d, x, y, z)
                if said == CONTACT and mover.parts:
                    said = self._of_parts(index, (x, y, z), heading)
                if said == CONTACT:
                    found = _RANK[CONTACT]
                    break
                found = max(found, _RANK[said])
        answer = _OF_RANK[found] if found or not self._levels.hold(z) else EXTERIOR
        question = self.model.question
        if question == "position":
            return answer
        return CANNOT_SAY if answer == NOTHING_SAID else int(answer == YES[question])

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

    def _said(self, query: Indices, body: Indices, centres: Floats, heading: Floats) -> Positions:
        """What each hyperboloid says about its centre."""
        shapes, origins, heights = self._bodies.shapes, self._bodies.origins, self._bodies.heights
        mover = self.model.mover
        result = _positions(shapes[body], (mover.b, mover.d), centres[query], origins[body])
        for pair in np.flatnonzero(result == CONTACT).tolist() if mover.parts else ():
            x, y, z = centres[query[pair]].tolist()
            result[pair] = self._of_parts(int(body[pair]), (x, y, z), float(heading[query[pair]]))
        level = centres[query, 2]
        result[(level < heights[body, 0]) | (level > heights[body, 1])] = NOTHING_SAID
        return result

    def _of_parts(self, index: int, centre: tuple[float, float, float], heading: float) -> int:
        """The position that all parts have in common beside a hyperboloid, else contact."""
        found = CONTACT
        for number, part in enumerate(self.model.mover.parts):
            turn = radians(heading + part.angle)
            x, y = centre[0] + part.arm * cos(turn), centre[1] + part.arm * sin(turn)
            said = position_beside(self._body(index), part.b, part.d, x, y, centre[2])
            if said == CONTACT or (number and said != found):
                return CONTACT
            found = said
        return found

    def _answers(self, positions: Positions) -> Positions:
        question = self.model.question
        if question == "position":
            return positions
        return np.where(positions == NOTHING_SAID, CANNOT_SAY, positions == YES[question]).astype(np.int8)

    def _body(self, index: int) -> Body:
        """A hyperboloid's numbers without arrays; each is kept once it was asked."""
        found = self._asked.get(index)
        if found is None:
            of = self._bodies
            columns = (of.shapes[index], of.origins[index], of.heights[index])
            alpha, gamma, x, y, z, low, high = (number for column in columns for number in column.tolist())
            found = self._asked[index] = (alpha, gamma, x, y, z, low, high)
        return found

    @cached_property
    def _asked(self) -> dict[int, Body]:
        return {}

    @cached_property
    def _grid(self) -> PlaneGrid:
        origins = self._bodies.origins
        far = reaches(self._bodies, self.model.mover, self.model.region.z)
        return grid_of(origins[:, 0], origins[:, 1], far)

    @cached_property
    def _levels(self) -> Levels:
        return levels_of(self._bodies.heights)

    @cached_property
    def _bodies(self) -> Bodies:
        return bodies_of(self.model.hyperboloids)


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


def _positions(shapes: Floats, spheroid: tuple[float, float], centres: Floats, origins: Floats) -> Positions:
    sizes = np.concatenate([shapes, np.broadcast_to(spheroid, (len(shapes), 2))], axis=1)
    return positions_beside(sizes, centres, origins)


def _combined(said: Positions, query: Indices, count: int) -> Positions:
    """What those that are near come to at each centre: contact before interior before exterior, else nothing said."""
    rank = np.select([said == position for position in _RANK], list(_RANK.values()), 0).astype(np.int8)
    highest = np.zeros(count, np.int8)
    np.maximum.at(highest, query, rank)
    return np.array(_OF_RANK, np.int8)[highest]
