"""The families for fixed sizes: the traps of one spheroid beside one hyperboloid, at every scale of distance.

A kernel that was made for a scene supports only the scene's sizes, so other families have almost no row for it. The
names of these families contain the sizes and the spans of the centre, as in `razor@2.0,17.8,0.25,0.15,z=-17.8:17.8`.
"""

from __future__ import annotations

import math
import re
import struct
import sys
from collections.abc import Callable, Iterable
from functools import partial
from typing import Literal

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.pair import CENTER, SIZES, Pair, Position, trouble_with
from hypcheck.geometry.rows import FixedSizes, Floats, Range, Rows, with_axis
from hypcheck.truth import exact
from hypcheck.vectors import tilted
from hypcheck.vectors.draw import MARK, Draw, Family, ldexp, stepped, turns
from hypcheck.vectors.random_pairs import Sizes, beside_surface, nearly_touching, stack

OPEN = 2.0
"""Where the centre may be anywhere, rows lie within so many waist radii of the axis and heights γ of the waist."""

FARTHEST = 2.0**1000
"""The largest coordinate of a row, in metres; ratios near 10¹⁰⁰ could lead to larger ones."""

_SPAN = re.compile(r"([xyz])=([^:]+):([^:]+)")


Trap = Callable[[FixedSizes, Draw, int], Rows]
"""A generator of rows for fixed sizes."""


def families_for(settings: tuple[FixedSizes, ...]) -> tuple[Family, ...]:
    """Return the families of all traps of every setting."""
    return tuple(_family(trap, setting) for setting in settings for trap in _traps(setting))


def _traps(setting: FixedSizes) -> dict[str, Trap]:
    """Return the traps for a setting: of upright or of tilted spheroids."""
    return TRAPS if setting.axis is None else TILTED_TRAPS


def family_at(name: str) -> Family:
    """Return the family with this name. Raises InputError, which says what is wrong in the name."""
    trap, _, text = name.partition(MARK)
    known = (*TRAPS, *TILTED_TRAPS)
    if trap not in known:
        raise InputError(f"there is no family {trap!r} for fixed sizes; there are {', '.join(known)}")
    setting = _parsed_sizes(text, name)
    if trap not in _traps(setting):
        with_axis = "an axis" if trap in TILTED_TRAPS else "no axis"
        raise InputError(f"{name!r} is not a family of fixed sizes: {trap} takes {with_axis}")
    return _family(trap, setting)


def _family(trap: str, setting: FixedSizes) -> Family:
    """Return the family of a trap at fixed sizes. Raises InputError if its centres do not fit in float64."""
    _require_room(setting)
    make = partial(_made, _traps(setting)[trap], setting)
    groups = frozenset(() if setting.axis is None else {"axis"})
    return Family(f"{trap}{MARK}{_sizes_text(setting)}", make, groups=groups)


def _made(trap: Trap, setting: FixedSizes, draw: Draw, n: int) -> Rows:
    """Make the trap's rows. Formulas may overflow because sizes differ too much; `_rows` makes the centres finite."""
    with np.errstate(all="ignore"):
        return trap(setting, draw, n)


def _require_room(setting: FixedSizes) -> None:
    """Raise InputError if centres around the hyperboloid, or in the spans, are beyond float64."""
    alpha, gamma, b, d = setting.sizes
    widths = [2 * OPEN * (alpha + b), 2 * OPEN * (gamma + d), *(span[1] - span[0] for span in setting.spans if span)]
    if not all(map(math.isfinite, widths)):
        raise InputError(f"the sizes {_sizes_text(setting)} leave no room in float64 for the centres about them")


def _sizes_text(setting: FixedSizes) -> str:
    """Write the sizes, spans and axis of a setting as a family's name has them."""
    spans = [f"{name}={span[0]!r}:{span[1]!r}" for name, span in zip(CENTER, setting.spans, strict=True) if span]
    axis = () if setting.axis is None else (f"axis={':'.join(_words(setting.axis))}",)
    return ",".join([*map(repr, setting.sizes), *spans, *axis])


def _words(axis: tuple[float, float, float] | Literal["free"]) -> Iterable[str]:
    """Return the words of an axis in a family's name."""
    return (axis,) if isinstance(axis, str) else map(repr, axis)


def _parsed_sizes(text: str, name: str) -> FixedSizes:
    """Read the sizes, spans and axis in a family's name. Raises InputError."""
    words = text.split(",")
    try:
        alpha, gamma, b, d = (float(word) for word in words[: len(SIZES)])
        axis = _axis(words[-1]) if words[-1].startswith("axis=") else None
        spans = dict(_span(word) for word in words[len(SIZES) : len(words) - (axis is not None)])
    except ValueError:
        raise InputError(
            f"{name!r} is not a family of fixed sizes; after {MARK} come alpha,gamma,b,d and, optionally, x=low:high, "
            "y=…, z=…, axis=x:y:z or axis=free"
        ) from None
    for column, value in zip(SIZES, (alpha, gamma, b, d), strict=True):
        trouble = trouble_with(column, value)
        if trouble is not None:
            raise InputError(f"{name!r} is not a family of fixed sizes: {trouble}")
    return FixedSizes((alpha, gamma, b, d), **spans, axis=axis)


def _axis(word: str) -> tuple[float, float, float] | Literal["free"]:
    """Read the axis of a word such as axis=0:0:1 or axis=free. Raises ValueError."""
    value = word.removeprefix("axis=")
    if value == "free":
        return "free"
    x, y, z = map(float, value.split(":"))
    if not (math.isfinite(x) and math.isfinite(y) and math.isfinite(z) and (x or y or z)):
        raise ValueError(word)
    return x, y, z


def _span(word: str) -> tuple[str, Range]:
    """Read the column and the span of a word such as z=-1.0:1.0. Raises ValueError."""
    match = _SPAN.fullmatch(word)
    if match is None:
        raise ValueError(word)
    low, high = float(match.group(2)), float(match.group(3))
    if not low <= high:
        raise ValueError(word)
    return match.group(1), (low, high)


def _span_or(span: Range | None, reach: float) -> Range:
    """Return the span, or −reach to reach if there is none."""
    return span if span is not None else (-reach, reach)


def _rows(setting: FixedSizes, x: Floats, y: Floats, z: Floats) -> Rows:
    """Make upright rows of these centres; heights are moved into the span of z, and NaN becomes 0."""
    n = len(x)
    alpha, gamma, b, d = (np.full(n, size) for size in setting.sizes)
    low, high = _span_or(setting.z, FARTHEST)
    z = np.where(np.isnan(z), 0.0, z)
    return stack(Sizes(alpha, gamma, b, d), x, y, np.clip(z, low, high))


def _turned(setting: FixedSizes, draw: Draw, radius: Floats, z: Floats) -> Rows:
    """Make rows with centres `radius` from the axis, at most FARTHEST, and at height z, at any azimuth."""
    cosine, sine = draw.circle(len(radius))
    radius = np.where(radius <= FARTHEST, radius, FARTHEST)
    return _rows(setting, radius * cosine, radius * sine, z)


def _heights(setting: FixedSizes, draw: Draw, n: int) -> Floats:
    """Draw heights in the span of z: half of them uniform, half near the waist."""
    low, high = _span_or(setting.z, OPEN * (setting.sizes[1] + setting.sizes[3]))
    near = np.clip(draw.signs(n) * setting.sizes[3] * draw.log_uniform(n, -40, 3), low, high)
    return np.where(turns(n, True, False), draw.between(n, low, high), near)


def _box(setting: FixedSizes, draw: Draw, n: int) -> Rows:
    """Make centres uniform in the spans, or in a box about the hyperboloid."""
    alpha, gamma, b, d = setting.sizes
    reaches = (OPEN * (alpha + b), OPEN * (alpha + b), OPEN * (gamma + d))
    spans = [_span_or(span, reach) for span, reach in zip(setting.spans, reaches, strict=True)]
    x, y, z = (draw.between(n, low, high) for low, high in spans)
    return _rows(setting, x, y, z)


def _beside(setting: FixedSizes, draw: Draw, n: int) -> Rows:
    """Make centres one radius, more or less by 2⁻⁵³ … 1 of it, off the surface, on either side, along the normal."""
    alpha, gamma, b, d = (np.full(n, size) for size in setting.sizes)
    offset = nearly_touching(draw, n, -53, 0)
    height = np.abs(_heights(setting, draw, n)) / d
    radius, level = beside_surface(alpha / b, gamma / d, height, offset)
    return _turned(setting, draw, radius * b, level * d * draw.signs(n))


def _ring(setting: FixedSizes, draw: Draw, n: int) -> Rows:
    """Make centres on and near the ring, r² = (c² + 1)(a² + c²)/c² with a = α/b, c = γ/d, r = √(x² + y²)/b.

    There the discriminant vanishes, far from the surface if c² > a.
    """
    alpha, gamma, b, d = setting.sizes
    a, c = np.float64(alpha) / b, np.float64(gamma) / d  # numpy floats, which can be divided by c = 0
    radius: Floats = np.full(n, b * np.sqrt((c * c + 1) * (a * a / (c * c) + 1)))
    radius = radius * (1 + turns(n, 0.0, 1.0) * draw.signed(n, -53, -2))
    height = turns(n, 0.0, 0.0, 1.0) * draw.signs(n) * d * draw.log_uniform(n, -50, 0)
    return _turned(setting, draw, radius, height)


def _zeros(setting: FixedSizes, draw: Draw, n: int) -> Rows:
    """Make centres where a coefficient of the cubic, c1 or c2, is 0 or nearly: a strict inequality of the paper fails.

    A, B, P, Q are α²/b², γ²/d², (x² + y²)/b² and z²/d².
    """
    alpha, gamma, b, d = setting.sizes
    a, c = np.float64(alpha) / b, np.float64(gamma) / d
    A, B = a * a, c * c
    z = _heights(setting, draw, n)
    Q = (z / d) * (z / d)
    P = np.where(turns(n, True, False), A - B + 1 - Q, (A * B - A + B + A * Q) / B)
    steps = draw.signed(n, -53, -3) * turns(n, 0.0, 1.0, 1.0)
    return _turned(setting, draw, b * np.sqrt(np.maximum(P * (1 + steps), 0.0)), z)


def _axes(setting: FixedSizes, draw: Draw, n: int) -> Rows:
    """Make centres on the axis or very near to it, at any height, and centres far out, at any azimuth."""
    alpha, gamma = setting.sizes[:2]
    hair = alpha * draw.log_uniform(n, -60, 1) * turns(n, 0.0, 1.0)
    far = alpha * draw.log_uniform(n, 0, 12)
    z = np.where(turns(n, True, False, False), 0.0, _heights(setting, draw, n))
    away = turns(n, False, False, True)
    up = draw.signs(n) * gamma * draw.log_uniform(n, 0, 12)
    return _turned(setting, draw, np.where(away, far, hair), np.where(away & turns(n, True, False), up, z))


def _razor(setting: FixedSizes, draw: Draw, n: int) -> Rows:
    """Make centres at the last floats before contact and the first in it, on both sides, y = 0, 16 heights a block."""
    heights = np.clip(_heights(setting, draw, 16), *_span_or(setting.z, np.inf))
    sides = (Position.EXTERIOR, Position.INTERIOR)
    edges = [(_edge(setting.sizes, z, side), z) for z in heights.tolist() for side in sides]
    table = np.resize(np.array(edges), (n, 2))
    edge, steps = np.ascontiguousarray(table[:, 0]), draw.integers(n, -6, 6)
    x = stepped(edge, np.maximum(steps, -edge.view(np.int64)))  # not past 0, among the least of subnormals
    return _rows(setting, draw.signs(n) * x, np.zeros(n), table[:, 1])


def _edge(sizes: tuple[float, float, float, float], z: float, side: Position) -> float:
    """Find the end of contact towards that side: of the centres (x, 0, z), x ≥ 0, return the first x that is outward.

    For EXTERIOR outward means exterior; for INTERIOR it means exterior or in contact. The result is 0 if every x is
    outward, FARTHEST if none is.
    """

    def outward(x: float) -> bool:
        position = exact.position(Pair(*sizes, x, 0.0, z).lengths)
        return position is Position.EXTERIOR if side is Position.EXTERIOR else position is not Position.INTERIOR

    if outward(0.0):
        return 0.0
    if not outward(sys.float_info.max):
        return FARTHEST
    # Bisection by the number of floats between takes 63 steps at any scale; by distance up to two thousand.
    first, last = 0, _ordinal(sys.float_info.max)
    while last - first > 1:
        middle = (first + last) // 2
        first, last = (first, middle) if outward(_float_at(middle)) else (middle, last)
    return _float_at(last)


def _ordinal(x: float) -> int:
    """Return the number of floats from 0 to x ≥ 0, without 0."""
    return int.from_bytes(struct.pack(">d", x), "big")


def _float_at(ordinal: int) -> float:
    """Return the float ≥ 0 of which `_ordinal` is the number."""
    return float(struct.unpack(">d", ordinal.to_bytes(8, "big"))[0])


TRAPS: dict[str, Trap] = {
    "box": _box,
    "beside": _beside,
    "razor": _razor,
    "ring-about": _ring,
    "zeros": _zeros,
    "axes": _axes,
}
"""The constructions of rows of upright spheroids, by name; descriptions.toml has their purposes."""


def _axes_of(setting: FixedSizes, draw: Draw, n: int) -> tilted.Vectors:
    """Return the axis of the setting; if it is free, draw axes in all directions, a third in a coordinate plane."""
    if setting.axis is None or setting.axis == "free":
        x, y, z = tilted.anywhere(draw, n)
        return x * turns(n, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0), y, z * turns(n, 1.0, 1.0, 1.0, 0.0, 1.0, 1.0)
    x, y, z = (np.full(n, part) for part in setting.axis)
    return x, y, z


def _tilted_rows(setting: FixedSizes, draw: Draw, n: int, offset: Floats) -> Rows:
    """Make tilted rows with centres `offset` radii off the surface."""
    size = Sizes(*(np.full(n, value) for value in setting.sizes))
    heights = _heights(setting, draw, n) / setting.sizes[1]
    return tilted.beside(draw, size, heights, _axes_of(setting, draw, n), offset)


def _held(setting: FixedSizes, rows: Rows) -> Rows:
    """Make each centre finite, and move its height into the setting's span."""
    centre = np.where(np.abs(rows[:, 4:7]) <= FARTHEST, rows[:, 4:7], 0.0)
    rows[:, 4:7] = centre
    rows[:, 6] = np.clip(centre[:, 2], *_span_or(setting.z, FARTHEST))
    return rows + 0.0


def _tilted_box(setting: FixedSizes, draw: Draw, n: int) -> Rows:
    """Make rows as _box does, with an axis."""
    rows = with_axis(_box(setting, draw, n))
    rows[:, 7:] = np.stack(_axes_of(setting, draw, n), axis=1)
    return rows + 0.0


def _tilted_beside(setting: FixedSizes, draw: Draw, n: int) -> Rows:
    """Make tilted rows one radius, more or less by 2⁻⁵³ … 1 of it, off the surface."""
    offset = nearly_touching(draw, n, -53, 0)
    return _held(setting, _tilted_rows(setting, draw, n, offset))


def _tilted_razor(setting: FixedSizes, draw: Draw, n: int) -> Rows:
    """Make centres at the last floats before contact and the first in it, 16 places a block, x a few ulps apart."""
    touching = _held(setting, _tilted_rows(setting, draw, 16, np.zeros(16)))
    spread = draw.signs(16) * max(setting.sizes[2:]) * 4.0
    edges = np.array([_tilted_edge(row, offset) for row, offset in zip(touching, spread.tolist(), strict=True)])
    rows = np.resize(edges, (n, 10))
    x, steps = np.ascontiguousarray(rows[:, 4]), draw.integers(n, -6, 6)
    rows[:, 4] = stepped(x, np.maximum(steps, -np.abs(x).view(np.int64)))  # not past 0
    return rows + 0.0


def _tilted_edge(row: Rows, offset: float) -> Rows:
    """Move a centre on the surface along x until the row is clear, or by `offset` if it never is; return the row."""
    start, far = float(row[4]), float(row[4]) + offset
    result = row.copy()

    def is_contact(x: float) -> bool:
        lengths = Pair.from_row((*row[:4].tolist(), x, *row[5:].tolist())).lengths
        return exact.position(lengths) is Position.CONTACT

    while math.nextafter(start, far) != far:
        middle = start + (far - start) / 2
        if middle in (start, far):
            break
        start, far = (middle, far) if is_contact(middle) else (start, middle)
    result[4] = far
    return result


def _tilted_zeros(setting: FixedSizes, draw: Draw, n: int) -> Rows:
    """Make centres on the axis, in the plane of the waist and in a plane of symmetry, and centres far out."""
    rows = _tilted_box(setting, draw, n)
    far = ldexp(1, draw.integers(n, 0, 12))
    rows[:, 4] *= turns(n, 1.0, 0.0, 0.0, 1.0, 1.0)
    rows[:, 5] *= turns(n, 0.0, 1.0, 0.0, 1.0, 1.0)
    rows[:, 6] *= turns(n, 1.0, 1.0, 1.0, 0.0, 1.0)
    rows[:, 4:6] *= np.where(turns(n, False, False, False, False, True), far, 1.0)[:, None]
    return _held(setting, rows)


TILTED_TRAPS: dict[str, Trap] = {
    "leaning-box": _tilted_box,
    "leaning-beside": _tilted_beside,
    "leaning-razor": _tilted_razor,
    "leaning-zeros": _tilted_zeros,
}
"""The traps of a tilted spheroid."""
