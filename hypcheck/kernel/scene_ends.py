"""The effect of a hyperboloid's ends on a mover's position: first by bounds, then exactly in integers.

The mover reaches no farther along the hyperboloid's axis than r, its longer semi-axis, or its own d where both are
upright. Where it lies between the ends its position is that beside the whole hyperboloid, and beyond an end it is
exterior. `limits_of` has the heights of a centre, in the scene, at which that is so.

Of a mover that reaches over an end, in the hyperboloid's frame:

- exterior beside the whole hyperboloid is exterior;
- interior is interior, or exterior beyond the end, if the hyperboloid is open;
- contact is contact if the mover reaches to both sides of the wall at its own height, or at the end if it is beyond: at
  its own height it reaches b across the axis, or its shorter semi-axis at least, and e above or below, where both are
  upright, b √(1 − e²/d²).

If these do not decide and the hyperboloid is vertical, the kernel answers about a slightly larger and a slightly
smaller spheroid; truth/exact.py decides the rest. Heights and distances from an axis are those of along_and_across,
with a bound of their error; ρ is wrong by α/γ of the error of the height and MARGIN of itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import inf
from typing import Any

import numpy as np

from hypcheck.derivation.float_arithmetic import two_sum
from hypcheck.geometry.pair import WITHOUT_ENDS, Lengths, Position
from hypcheck.geometry.rows import CANNOT_SAY, Floats, Indices, Mask, Positions, Rows
from hypcheck.kernel import scene_pairs
from hypcheck.kernel.in_use import kernel
from hypcheck.kernel.scene_index import Bodies
from hypcheck.scene.model import Mover, is_tilted
from hypcheck.truth import exact


def limits_of(bodies: Bodies, mover: Mover) -> Floats:
    """Four heights of a mover's centre in the scene for each hyperboloid, (m, 4).

    Below the first and above the second the mover lies beyond an end; from the third to the fourth it lies between the
    ends. Of a tilted hyperboloid with ends nothing is known so.
    """
    reach = max(mover.b, mover.d) if is_tilted(mover.axis) else mover.d
    low, high = bodies.heights.T
    with np.errstate(all="ignore"):
        ends = np.where(np.isinf(bodies.heights), 0, np.abs(bodies.heights)).max(axis=1)
        far = reach * (1 + scene_pairs.MARGIN) + 2.0**-45 * (np.abs(bodies.origins[:, 2]) + reach + ends)
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
        below, above, far = (
            self.along - self.low,
            self.high - self.along,
            self.reach * (1 + scene_pairs.MARGIN) + self.error,
        )
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
        radius, least = self.alpha * (1 + share * share) ** 0.5, self.least * ((room + abs(room)) / 2) ** 0.5
        loose = self.error * (2 + self.alpha / self.gamma) + scene_pairs.MARGIN * (radius + self.across + self.least)
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
        error = 2 * lost + scene_pairs.MARGIN * size + scene_pairs.LEAST
        alpha, gamma, low, high = shapes[:, 0], shapes[:, 1], spans[:, 0], spans[:, 1]
        level = np.clip(places[:, 2], low, high)
        place = _Place(alpha, gamma, places[:, 2], across, error, low, high, level, least, least, inf)
        return np.asarray(place.crosses() & (size < scene_pairs.GREATEST))


def positions_with_ends(
    whole: Positions, sizes: Rows, centres: Rows, origins: Rows, movers: Rows, bodies: Bodies, body: Indices
) -> Positions:
    """The exact positions of movers, int8 (n,), from those beside whole hyperboloids, `body` (n,) of these bodies.

    `sizes` are (n, 4), centres and the movers' axes (n, 3).
    """
    axes, spans, solid = bodies.axes[body], bodies.spans[body], bodies.solid[body]
    with np.errstate(all="ignore"):
        upright = (movers[:, :2] == 0).all(axis=1) & ~bodies.tilted[body]
        (alpha, gamma, b, d), (low, high) = sizes.T, spans.T
        along, across, error = scene_pairs.along_and_across(centres, origins, axes)
        reach, least = np.where(upright, d, np.maximum(b, d)), np.where(upright, b, np.minimum(b, d))
        level, half = np.clip(along, low, high), np.where(upright, d, inf)
        place = _Place(alpha, gamma, along, across, error, low, high, level, reach, least, half)
        between, beyond = place.between_and_beyond()
        inner, outer = place.centre_between_and_beyond()
        open_inside = (whole == Position.INTERIOR) & ~solid
        crosses = place.crosses() & (whole == Position.CONTACT)
    exterior = beyond | (whole == Position.EXTERIOR) | (open_inside & outer)
    known = between | (open_inside & inner) | crosses
    result = np.where(exterior, Position.EXTERIOR, whole).astype(np.int8)
    rest = np.flatnonzero(~(exterior | known))
    stands = rest[~bodies.tilted[body[rest]]]
    if len(stands):
        rows = np.concatenate([sizes, movers, spans, solid[:, None]], axis=1)[stands]
        result[stands] = _by_kernel(rows, centres[stands], origins[stands], inner[stands], outer[stands])
        rest = np.setdiff1d(rest, stands[result[stands] != CANNOT_SAY])
    for index in rest.tolist():
        row, centre, origin, mover, axis, span = (
            column[index].tolist() for column in (sizes, centres, origins, movers, axes, spans)
        )
        result[index] = _exactly(int(whole[index]), row, centre, origin, mover, axis, span, solid=bool(solid[index]))
    return result


def _by_kernel(rows: Rows, centres: Rows, origins: Rows, inner: Mask, outer: Mask) -> Positions:
    """Positions beside vertical hyperboloids by the kernel, 2 if it does not decide; rows lack the centres' columns.

    It is asked about a spheroid that contains the exact one, and about one within it. What is clear of the wall lies on
    the side of its centre, which counts where it is surely between the ends (`inner`), or beyond one (`outer`).
    """
    place, error = two_sum(centres, -origins)
    lost = np.abs(error).sum(axis=1)
    larger, smaller, fits = scene_pairs.larger_and_smaller(rows[:, 2:4], lost)
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


def position_with_ends(
    whole: int,
    sizes: Sequence[float],
    centre: Sequence[float],
    origin: Sequence[float],
    mover: Sequence[float],
    axis: Sequence[float],
    span: Sequence[float],
    *,
    solid: bool,
) -> int:
    """As positions_with_ends, for one pair."""
    (alpha, gamma, b, d), (low, high) = sizes, span
    upright = mover[0] == mover[1] == axis[0] == axis[1] == 0
    along, across, error = scene_pairs.height_and_distance(centre, origin, axis)
    reach, least, half = (d, b, d) if upright else (max(b, d), min(b, d), inf)
    level = min(max(along, low), high)
    place = _Place(alpha, gamma, along, across, error, low, high, level, reach, least, half)
    between, beyond = place.between_and_beyond()
    if between:
        return whole
    if beyond or whole == Position.EXTERIOR:
        return int(Position.EXTERIOR)
    inner, outer = place.centre_between_and_beyond()
    if whole == Position.INTERIOR and not solid and (inner or outer):
        return int(Position.INTERIOR if inner else Position.EXTERIOR)
    if whole == Position.CONTACT and place.crosses():
        return whole
    return _exactly(whole, sizes, centre, origin, mover, axis, span, solid=solid)


def _exactly(
    whole: int,
    sizes: Sequence[float],
    centre: Sequence[float],
    origin: Sequence[float],
    mover: Sequence[float],
    axis: Sequence[float],
    span: Sequence[float],
    *,
    solid: bool,
) -> int:
    """As position_with_ends, in integers."""
    if tuple(span) == WITHOUT_ENDS[:2]:
        return whole
    offset = [Fraction(there) - Fraction(here) for there, here in zip(centre, origin, strict=True)]
    return int(exact.ended_position(Lengths.of((*sizes, *offset, *mover, *span, solid), axis), Position(whole)))
