"""One mover beside one hyperboloid, both in the scene's coordinates: exact positions, also where the hyperboloid ends.

A centre seen from another is x − x₀, which is usually not a float64. Its rounding error is one, and is known (TwoSum):
where it is 0 the difference is exact and the fast path answers.

**The hyperboloid is upright.** With the error e of the difference a spheroid whose semi-axes are ε = |e|/min(b, d)
longer contains the true one, and one with semi-axes that much shorter lies in it. The larger clear is clear, the
smaller in contact is contact; what is left is decided in integers from the exact difference. `positions_beside` does so
for arrays, `position_beside` for one step of a walk.

**The hyperboloid is tilted**, along w, and nothing is rotated: squares and products of its axis, the spheroid's and the
centre's difference are rational, and the position is decided from them (integers.squares_between_axes). Most movers are
nowhere near: with h and ϱ, the centre's height along w and its distance from the axis, the spheroid lies in the ball of
radius r = max(b, d) and is exterior where ϱ − r > ρ(|h| + r), interior where ϱ + r < ρ(|h| − r), with ρ the surface's
radius. In floats h and ϱ are formed from w/|w| and the centres with six roundings to a term, all on sums of at most six
terms: 64 u Σ|C| bounds what they are wrong by; ρ takes five roundings on positive terms.

**The hyperboloid ends.** The mover reaches no farther along the hyperboloid's axis than r, or its own d where both are
upright. Where it lies between the ends its position is that beside the whole hyperboloid, and beyond an end it is
exterior. `limits_of` has the heights of a centre, in the scene, at which that is so. Of a mover that reaches over an
end, in the hyperboloid's frame:

- exterior beside the whole hyperboloid is exterior;
- interior is interior, or exterior beyond the end, if the hyperboloid is open;
- contact is contact if the mover reaches to both sides of the wall at its own height, or at the end if it is beyond: at
  its own height it reaches b across the axis, or its shorter semi-axis at least, and e above or below, where both are
  upright, b √(1 − e²/d²).

If these do not decide and the hyperboloid is vertical, the kernel answers about a slightly larger and a slightly
smaller spheroid; truth/exact.py decides the rest. h and ϱ have a bound of their error; ρ is wrong by α/γ of the error
of the height and MARGIN of itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import inf, nan, sqrt
from typing import Any, TypeAlias

import numpy as np

from hypcheck.derivation.float_arithmetic import two_sum
from hypcheck.geometry.pair import UPRIGHT, WITHOUT_ENDS, Lengths, Position
from hypcheck.geometry.rows import CANNOT_SAY, Floats, Indices, Mask, Positions, Rows
from hypcheck.kernel.classify import classify
from hypcheck.kernel.in_use import kernel
from hypcheck.kernel.integers import position_of_squares, squares_between_axes
from hypcheck.kernel.scalar import position
from hypcheck.kernel.scene_index import Bodies, BodyNumbers
from hypcheck.scene.model import Mover, is_tilted
from hypcheck.truth import exact

ERROR = 64 * 2.0**-53
"""The error of h and ϱ, in units of the sum of all coordinates."""

MARGIN = 2.0**-40
"""The relative error of ρ and of |e|/min(b, d); far more than they can have."""

ROUNDED = 2.0**-50
"""More than the roundings of a semi-axis made longer or shorter, relative."""

LEAST, GREATEST = 2.0**-200, 2.0**200
"""Squares and quotients of lengths between these neither overflow nor underflow."""


def positions_beside(sizes: Rows, centres: Rows, origins: Rows, movers: Rows | None = None) -> Positions:
    """Return the exact position of each mover beside an upright hyperboloid, int8 (n,).

    `sizes` are (n, 4), both centres (n, 3) in the scene's coordinates, the movers' axes (n, 3); None: all are upright.
    """
    with np.errstate(all="ignore"):
        offset, error = two_sum(centres, -origins)
    beyond = np.asarray(~np.isfinite(offset).all(axis=1))
    offset[beyond] = 0.0
    place = offset if movers is None else np.concatenate([offset, movers], axis=1)
    result: Positions = classify(np.concatenate([sizes, place], axis=1))
    some = np.flatnonzero(beyond | ~(error == 0).all(axis=1))
    if len(some):
        result[some], unsettled = _between(sizes[some], place[some], np.abs(error[some]).sum(axis=1))
        upright = np.broadcast_to(UPRIGHT, (len(sizes), 3))
        movers = upright if movers is None else movers
        _exactly(some[unsettled], result, sizes, centres, origins, movers, upright)
    return result


def _between(sizes: Rows, place: Rows, lost: Floats) -> tuple[Positions, Mask]:
    """Return the positions about rounded differences that lost so much, and a mask of those that it leaves open."""
    larger, smaller, fits = larger_and_smaller(sizes[:, 2:], lost)
    outer, inner = (
        classify(np.concatenate([sizes[fits, :2], semi_axes[fits], place[fits]], axis=1))
        for semi_axes in (larger, smaller)
    )
    positions, unsettled = np.zeros(len(sizes), np.int8), ~fits
    positions[fits], unsettled[fits] = outer, (outer == Position.CONTACT) & (inner != Position.CONTACT)
    return positions, unsettled


def larger_and_smaller(semi_axes: Rows, lost: Floats) -> tuple[Floats, Floats, Mask]:
    """Return the semi-axes (n, 2), longer and shorter by what differences of centres lost, and a mask of usable ones.

    Where a difference has overflowed, what it lost is NaN, and the mask is false.
    """
    with np.errstate(all="ignore"):
        stretch = np.where(lost == 0, 0.0, lost / semi_axes.min(axis=1) * (1 + MARGIN) + ROUNDED)
        larger, smaller = semi_axes * (1 + stretch)[:, None], semi_axes * (1 - stretch)[:, None]
    return larger, smaller, np.asarray((smaller > LEAST).all(axis=1) & (larger < GREATEST).all(axis=1))


def position_beside(
    shape: tuple[float, float],
    origin: Sequence[float],
    b: float,
    d: float,
    x: float,
    y: float,
    z: float,
    axis: Sequence[float] | None = None,
) -> int:
    """Return the exact position of a spheroid at (x, y, z): as positions_beside has it, of one pair."""
    (alpha, gamma), (there_x, there_y, there_z) = shape, origin
    across, along, up = x - there_x, y - there_y, z - there_z
    # TwoSum: what the differences have lost together; 0 where they are exact, NaN where that is not known.
    back_x, back_y, back_z = across + there_x, along + there_y, up + there_z
    lost = (
        abs((x - back_x) - (there_x - (back_x - across)))
        + abs((y - back_y) - (there_y - (back_y - along)))
        + abs((z - back_z) - (there_z - (back_z - up)))
    )
    if lost == 0:
        return position(alpha, gamma, b, d, across, along, up, axis=axis)
    least = min(b, d)
    if LEAST < least and max(b, d) < GREATEST and lost < GREATEST:
        stretch = lost / least * (1 + MARGIN) + ROUNDED
        outer = position(alpha, gamma, b * (1 + stretch), d * (1 + stretch), across, along, up, axis=axis)
        if outer != Position.CONTACT:
            return outer
        if stretch < 1:
            inner = position(alpha, gamma, b * (1 - stretch), d * (1 - stretch), across, along, up, axis=axis)
            if inner == outer:
                return outer
    return _from_exact_difference((alpha, gamma, b, d), (x, y, z), origin, axis or UPRIGHT, UPRIGHT)


Parts: TypeAlias = Any
"""The numbers of sizes, of a point or of an axis: of one pair, or columns (n,) of many, as an array (3, n) has them."""


def _where(condition: Any, value: Any, otherwise: Any) -> Any:  # noqa: ANN401 - a number, or a column
    """Return one value where the condition holds, else the other one."""
    if isinstance(condition, np.ndarray):
        return np.where(condition, value, otherwise)
    return value if condition else otherwise


def _root(square: Any) -> Any:  # noqa: ANN401 - a number, or a column
    """Return the square root, rounded correctly, which a power with the exponent 0.5 need not be."""
    return np.sqrt(square) if isinstance(square, np.ndarray) else sqrt(square)


def along_and_across(centre: Parts, origin: Parts, axis: Parts) -> tuple[Any, Any, Any]:
    """Return a centre's height along an axis, its distance from it, and a bound of both errors, nan if not known."""
    (u, v, w), (x, y, z), (here_x, here_y, here_z) = axis, centre, origin
    size = abs(x) + abs(y) + abs(z) + abs(here_x) + abs(here_y) + abs(here_z)
    largest = _where(abs(u) > abs(v), abs(u), abs(v))
    largest = _where(largest > abs(w), largest, abs(w))
    u, v, w = u / largest, v / largest, w / largest
    length = _root(u * u + v * v + w * w)
    u, v, w = u / length, v / length, w / length
    x, y, z = x - here_x, y - here_y, z - here_z
    p, q, r = v * z - w * y, w * x - u * z, u * y - v * x
    ordinary = (largest > LEAST) & (largest < GREATEST) & (size < GREATEST)
    return u * x + v * y + w * z, _root(p * p + q * q + r * r), _where(ordinary, ERROR * size + LEAST, nan)


def _by_ball(sizes: Parts, centre: Parts, origin: Parts, axis: Parts) -> tuple[Any, Any]:
    """Whether the spheroid's ball is surely exterior, and interior, if the sizes are ordinary."""
    alpha, gamma, b, d = sizes
    height, distance, error = along_and_across(centre, origin, axis)
    longest = _where(b > d, b, d) * (1 + MARGIN) + error
    above, below = (abs(height) + longest) / gamma, (abs(height) - longest) / gamma
    below = _where(below > 0, below, 0.0)
    outside = distance - longest > alpha * _root(1 + above * above) * (1 + MARGIN)
    inside = distance + longest < alpha * _root(1 + below * below) * (1 - MARGIN)
    return outside, inside


def tilted_positions(sizes: Rows, centres: Rows, origins: Rows, movers: Rows, axes: Rows) -> Positions:
    """Return the exact position of each mover, int8 (n,): sizes (n, 4), both centres and both axes (n, 3)."""
    tilted = (axes[:, :2] != 0).any(axis=1)
    result = np.empty(len(sizes), np.int8)
    result[~tilted] = positions_beside(*(column[~tilted] for column in (sizes, centres, origins, movers)))
    with np.errstate(all="ignore"):
        outside, inside = _by_ball(*(column[tilted].T for column in (sizes, centres, origins, axes)))
        ordinary = np.asarray(((sizes > LEAST) & (sizes < GREATEST)).all(axis=1))[tilted]
    result[tilted] = np.where(outside, Position.EXTERIOR, Position.INTERIOR)
    _exactly(np.flatnonzero(tilted)[~((outside | inside) & ordinary)], result, sizes, centres, origins, movers, axes)
    return result


def tilted_position(
    sizes: Sequence[float],
    centre: Sequence[float],
    origin: Sequence[float],
    mover: Sequence[float],
    axis: Sequence[float],
) -> int:
    """As tilted_positions, for one pair."""
    if axis[0] == axis[1] == 0:
        alpha, gamma, b, d = sizes
        x, y, z = centre
        return position_beside((alpha, gamma), origin, b, d, x, y, z, mover)
    if LEAST < min(sizes) and max(sizes) < GREATEST:
        outside, inside = _by_ball(sizes, centre, origin, axis)
        if outside or inside:
            return int(Position.EXTERIOR if outside else Position.INTERIOR)
    return _from_exact_difference(sizes, centre, origin, mover, axis)


def _from_exact_difference(
    sizes: Sequence[float],
    centre: Sequence[float],
    origin: Sequence[float],
    mover: Sequence[float],
    axis: Sequence[float],
) -> int:
    """As tilted_position, in integers."""
    difference = [Fraction(there) - Fraction(here) for there, here in zip(centre, origin, strict=True)]
    return int(position_of_squares(squares_between_axes(sizes, difference, mover, axis)))


def _exactly(those: Indices, result: Positions, *columns: Rows) -> None:
    """Decide some rows in integers."""
    for index in those.tolist():
        result[index] = _from_exact_difference(*(column[index].tolist() for column in columns))


def positions(
    bodies: Bodies,
    body: Indices,
    semi_axes: tuple[float, float],
    centres: Rows,
    movers: Rows | None,
    limits: Floats | None = None,
) -> Positions:
    """Return the exact positions of a mover at centres (n, 3) beside hyperboloids, `body` (n,) of these; int8 (n,).

    `movers` (n, 3) are its axes there; None: it and all of these hyperboloids are upright. `limits` are those of
    limits_of for the mover: they spare pairs.
    """
    sizes = np.concatenate([bodies.shapes[body], np.broadcast_to(semi_axes, (len(body), 2))], axis=1)
    spans, origins = bodies.spans[body], bodies.origins[body]
    if movers is None:
        result = positions_beside(sizes, centres, origins)
    else:
        result = tilted_positions(sizes, centres, origins, movers, bodies.axes[body])
    between = np.asarray(np.isinf(spans).all(axis=1))
    if limits is not None:
        level, (low, high, inner_low, inner_high) = centres[:, 2], limits[body].T
        result[(level < low) | (level > high)] = Position.EXTERIOR
        between |= (level >= inner_low) & (level <= inner_high)
    some = np.flatnonzero(~between & (result != Position.EXTERIOR))
    if len(some):
        axes = np.broadcast_to(UPRIGHT, (len(some), 3)) if movers is None else movers[some]
        result[some] = _with_ends(result[some], (sizes[some], centres[some], origins[some], axes), bodies, body[some])
    return result


def position_of(
    body: BodyNumbers, semi_axes: tuple[float, float], centre: Sequence[float], mover: Sequence[float]
) -> int:
    """As positions, of one pair; `mover` is the axis of the mover."""
    whole = tilted_position((*body.shape, *semi_axes), centre, body.origin, mover, body.axis)
    if whole == Position.EXTERIOR or body.span == WITHOUT_ENDS[:2]:
        return whole
    return position_with_ends(whole, body, semi_axes, centre, mover)


def position_with_ends(
    whole: int, body: BodyNumbers, semi_axes: tuple[float, float], centre: Sequence[float], mover: Sequence[float]
) -> int:
    """Return the position of a mover beside a hyperboloid with ends; `whole` is that beside the hyperboloid without."""
    pair = (*body.shape, *semi_axes), centre, body.origin, mover, body.axis
    place, exterior, known, _, _ = _by_bounds(whole, pair, body.span, body.solid)
    if exterior:
        return int(Position.EXTERIOR)
    if known or (whole == Position.CONTACT and place.crosses()):
        return whole
    return _ended_exactly(whole, pair, body.span, body.solid)


Pair = tuple[Parts, Parts, Parts, Parts, Parts]
"""Sizes, both centres and both axes, those of the hyperboloid behind the mover's."""


def _by_bounds(whole: Any, pair: Pair, span: Parts, solid: Any) -> tuple[_Place, Any, Any, Any, Any]:  # noqa: ANN401
    """Return the mover's place and four truth values, or masks (n,), each true only if it is sure.

    The mover is exterior; its position is `whole`, that beside the hyperboloid without ends (contact at a wall is not
    included: crosses() of the place may prove it); its centre lies between the ends; its centre lies beyond an end.
    """
    (alpha, gamma, b, d), centre, origin, mover, axis = pair
    low, high = span
    upright = (mover[0] == 0) & (mover[1] == 0) & (axis[0] == 0) & (axis[1] == 0)
    along, across, error = along_and_across(centre, origin, axis)
    longer, shorter = _where(b > d, b, d), _where(b > d, d, b)
    place = _Place(
        alpha, gamma, along, across, error, low, high,
        level=_where(along < low, low, _where(along > high, high, along)),
        reach=_where(upright, d, longer),
        least=_where(upright, b, shorter),
        half=_where(upright, d, inf),
    )  # fmt: skip
    between, beyond = place.between_and_beyond()
    inner, outer = place.centre_between_and_beyond()
    open_inside = (whole == Position.INTERIOR) & (solid == 0)
    exterior = beyond | (whole == Position.EXTERIOR) | (open_inside & outer)
    return place, exterior, between | (open_inside & inner), inner, outer


def _with_ends(whole: Positions, places: tuple[Rows, Rows, Rows, Rows], bodies: Bodies, body: Indices) -> Positions:
    """As position_with_ends, of many: `places` are sizes (n, 4), both centres and the movers' axes (n, 3)."""
    spans, solid, pairs = bodies.spans[body], bodies.solid[body], (*places, bodies.axes[body])
    sizes, centres, origins, movers, axes = (column.T for column in pairs)
    with np.errstate(all="ignore"):
        pair = sizes, centres, origins, movers, axes
        place, exterior, known, inner, outer = _by_bounds(whole, pair, spans.T, solid)
        known |= place.crosses() & (whole == Position.CONTACT)
    result = np.where(exterior, Position.EXTERIOR, whole).astype(np.int8)
    rest = np.flatnonzero(~(exterior | known))
    stands = rest[~bodies.tilted[body[rest]]]
    if len(stands):
        rows = np.concatenate([places[0], places[3], spans, solid[:, None]], axis=1)[stands]
        result[stands] = _by_kernel(rows, places[1][stands], places[2][stands], inner[stands], outer[stands])
        rest = np.setdiff1d(rest, stands[result[stands] != CANNOT_SAY])
    for index in rest.tolist():
        size, centre, origin, mover, axis = (column[index].tolist() for column in pairs)
        numbers = size, centre, origin, mover, axis
        result[index] = _ended_exactly(int(whole[index]), numbers, spans[index].tolist(), bool(solid[index]))
    return result


def _ended_exactly(whole: int, pair: Pair, span: Sequence[float], solid: float) -> int:
    """As position_with_ends, in integers."""
    sizes, centre, origin, mover, axis = pair
    offset = [Fraction(there) - Fraction(here) for there, here in zip(centre, origin, strict=True)]
    return int(exact.ended_position(Lengths.of((*sizes, *offset, *mover, *span, solid), axis), Position(whole)))


def _by_kernel(rows: Rows, centres: Rows, origins: Rows, inner: Mask, outer: Mask) -> Positions:
    """Return positions beside vertical hyperboloids by the kernel, 2 if undecided; rows lack the centres' columns.

    It is asked about a spheroid that contains the exact one, and about one within it. What is clear of the wall lies on
    the side of its centre, which counts where it is surely between the ends (`inner`), or beyond one (`outer`).
    """
    place, error = two_sum(centres, -origins)
    lost = np.abs(error).sum(axis=1)
    larger, smaller, fits = larger_and_smaller(rows[:, 2:4], lost)
    around, within = (
        kernel().answer_ended(np.concatenate([rows[:, :2], size, place, rows[:, 4:]], axis=1))
        for size in (larger, smaller)
    )
    solid = rows[:, -1] != 0
    sure = (around == Position.EXTERIOR) | (around == Position.INTERIOR)
    positions = np.where(sure & (solid | inner), around, CANNOT_SAY)
    positions[sure & ~solid & outer] = Position.EXTERIOR
    positions[(within == Position.CONTACT) & fits] = Position.CONTACT
    return np.where(fits, positions, CANNOT_SAY).astype(np.int8)


Numbers = tuple[BodyNumbers, tuple[float, float, float, float]]
"""One hyperboloid, and the four heights of limits_of beside it for a scene's mover."""


def limits_of(bodies: Bodies, mover: Mover) -> Floats:
    """Return four heights of a mover's centre in the scene for each hyperboloid, (m, 4).

    Below the first and above the second the mover lies beyond an end; from the third to the fourth it lies between the
    ends. Of a tilted hyperboloid with ends nothing is known so.
    """
    reach = max(mover.b, mover.d) if is_tilted(mover.axis) else mover.d
    low, high = bodies.heights.T
    with np.errstate(all="ignore"):
        ends = np.where(np.isinf(bodies.heights), 0, np.abs(bodies.heights)).max(axis=1)
        far = reach * (1 + MARGIN) + 2.0**-45 * (np.abs(bodies.origins[:, 2]) + reach + ends)
        limits = np.stack([low - far, high + far, low + far, high - far], axis=1)
    tilted = bodies.tilted & np.isfinite(bodies.spans).any(axis=1)
    limits[tilted] = -inf, inf, inf, -inf
    return limits


@dataclass(frozen=True, slots=True)
class _Place:
    """Numbers, or arrays (n,), of movers in the frames of hyperboloids; `error` is that of `along` and `across`."""

    alpha: Any
    gamma: Any
    along: Any
    across: Any
    error: Any
    low: Any
    high: Any
    level: Any
    """The height next to `along` between the ends."""

    reach: Any
    least: Any
    half: Any
    """How far the mover reaches along the axis at most, and across it, at its own height, at least; and d, inf where
    one of the axes is tilted.
    """

    def between_and_beyond(self) -> tuple[Any, Any]:
        """Whether the mover surely lies between the ends, and beyond an end."""
        below, above, far = self.along - self.low, self.high - self.along, self.reach * (1 + MARGIN) + self.error
        return (below > far) & (above > far), (below < -far) | (above < -far)

    def centre_between_and_beyond(self) -> tuple[Any, Any]:
        """Whether the mover's centre surely lies between the ends, and beyond an end."""
        below, above = self.along - self.low, self.high - self.along
        return (below > self.error) & (above > self.error), (below < -self.error) | (above < -self.error)

    def crosses(self) -> Any:  # noqa: ANN401 - as the numbers are
        """Whether the mover surely reaches to both sides of the wall, at its own height or, upright, at an end."""
        share, away = self.level / self.gamma, abs(self.level - self.along)
        fall = (away + self.error) / self.half
        room = 1 - fall * fall
        radius, least = self.alpha * _root(1 + share * share), self.least * _root((room + abs(room)) / 2)
        loose = self.error * (2 + self.alpha / self.gamma) + MARGIN * (radius + self.across + self.least)
        crosses = (self.across + least > radius + loose) & (self.across - least < radius - loose)
        return crosses & (self.centre_between_and_beyond()[0] | (self.half < inf))


def meets_for_sure(least: Floats, shapes: Rows, spans: Rows, places: Rows, lost: Floats) -> Mask:
    """Whether bounds prove that movers touch walls at their own heights, (n,): `places` (n, 3) in the walls' frames.

    `least` (n,) are their shorter semi-axes. Each coordinate of a place is `lost` (n,) off at most, besides a few
    roundings.
    """
    with np.errstate(all="ignore"):
        size = np.abs(places).sum(axis=1)
        across = np.hypot(places[:, 0], places[:, 1])
        error = 2 * lost + MARGIN * size + LEAST
        alpha, gamma, low, high = shapes[:, 0], shapes[:, 1], spans[:, 0], spans[:, 1]
        level = np.clip(places[:, 2], low, high)
        place = _Place(alpha, gamma, places[:, 2], across, error, low, high, level, least, least, inf)
        return np.asarray(place.crosses() & (size < GREATEST))
