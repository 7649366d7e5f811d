"""Crossed coincidences: each coincidence of a row occurs with each two others, on each side and in contact.

A program that treats special cases separately can be wrong if two occur together, such as x = y = 0 and a horizontal
axis. crossed.toml has designs, made by `python -m tests.tools.covering`: combinations of one value of each factor, such
that any three compatible values occur together in a row. The generators take the combinations in turn.

Rows are small whole numbers times a power of two, so that coincidences are exact. Of several candidates for a
combination the first one on the combination's side is taken.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck import toml
from hypcheck.geometry.rows import Floats, Mask, Rows
from hypcheck.kernel.classify import classify
from hypcheck.vectors.draw import Draw, Integers, Maker, ldexp

SIZES = ("any", "b = d", "α = γ", "α = b", "γ = d")
PLACES = ("any", "x = 0", "y = 0", "x = y", "x = −y", "on the hyperboloid's axis")
HEIGHTS = ("any", "z = 0", "z = x", "z = γ", "on the asymptotic cone")
AXES = (
    "any",
    "vertical",
    "horizontal",
    "along x",
    "along y",
    "to the hyperboloid's centre",
    "to the hyperboloid's axis, level",
    "in the meridian plane",
    "at right angles to the centre, level",
    "at right angles to the centre, in the meridian plane",
    "at right angles to the centre",
)
SWEEP_AXES = (*AXES, "along the way", "at right angles to the way")
MOTIONS = (
    "any",
    "still",
    "vertical",
    "along x",
    "along y",
    "radial",
    "tangent",
    "through the hyperboloid's centre",
    "on a line through the hyperboloid's centre",
    "through the hyperboloid's axis",
)
SIDES = ("exterior", "contact", "interior")
ENDS = ("clear at the end", "contact at the end")

FACTORS: Mapping[str, tuple[tuple[str, ...], ...]] = {
    "coincidences": (SIZES, PLACES, HEIGHTS, SIDES),
    "tilted-coincidences": (SIZES, PLACES, HEIGHTS, SIDES, AXES),
    "way-coincidences": (SIZES, PLACES, HEIGHTS, SIDES, MOTIONS, ENDS),
    "tilted-way-coincidences": (SIZES, PLACES, HEIGHTS, SIDES, MOTIONS, ENDS, SWEEP_AXES),
}
"""The factors of each family, and the values of each factor."""

CANDIDATES = 64
"""Candidates that are drawn for each row; for about one row in a hundred none is on the side that it must have."""


NEVER = (
    {SIDES: "exterior", PLACES: "on the hyperboloid's axis"},
    {SIDES: "exterior", HEIGHTS: "on the asymptotic cone"},
    {SIDES: "exterior", SIZES: "α = γ", PLACES: "y = 0", HEIGHTS: "z = x"},
    {SIDES: "interior", SIZES: "α = b", HEIGHTS: "z = 0"},
    {SIDES: "interior", SIZES: "α = b", HEIGHTS: "on the asymptotic cone"},
    {SIDES: "interior", SIZES: "α = b", HEIGHTS: "z = x", PLACES: "x = 0"},
    {SIDES: "interior", SIZES: "α = b", HEIGHTS: "z = x", PLACES: "on the hyperboloid's axis"},
    {MOTIONS: "still", SIDES: "contact", ENDS: "clear at the end"},
    {MOTIONS: "still", SIDES: "exterior", ENDS: "contact at the end"},
    {MOTIONS: "still", SIDES: "interior", ENDS: "contact at the end"},
)
"""Values that no row has together.

A centre on the axis or on the cone is inside the hyperboloid. A spheroid as wide as the waist has no room there, nor
farther up between the cone and the surface. A spheroid that does not move ends as it begins.
"""


def goes_together(values: Mapping[tuple[str, ...], str]) -> bool:
    """Decide whether a row can have all these values; `values` has a value for each factor."""
    return not any(all(values.get(factor) == value for factor, value in never.items()) for never in NEVER)


@cache
def design(name: str) -> NDArray[np.int64]:
    """Read the combinations of a family: the index of each factor's value, (combinations, factors)."""
    lines = toml.shipped("hypcheck.vectors", "crossed.toml")[name]["combinations"].split()
    return np.asarray([[int(letter, 16) for letter in line] for line in lines], dtype=np.int64)


def asked(name: str, count: int, strength: int) -> tuple[int, int]:
    """Count the combinations of `strength` values in the first `count` rows, and all compatible combinations."""
    factors, rows = FACTORS[name], design(name)[:count].tolist()
    met = {
        tuple((place, row[place]) for place in places)
        for row in rows
        for places in combinations(range(len(factors)), strength)
    }
    return len(met), len(possible(name, strength))


@cache
def possible(name: str, strength: int) -> frozenset[tuple[tuple[int, int], ...]]:
    """Return all compatible combinations of `strength` values of a family's factors, as (factor, value) indices."""
    factors = FACTORS[name]
    chosen: list[tuple[tuple[int, int], ...]] = [()]
    for number, factor in enumerate(factors):
        chosen += [(*some, (number, value)) for some in chosen if len(some) < strength for value in range(len(factor))]
    return frozenset(
        some
        for some in chosen
        if len(some) == strength and goes_together({factors[number]: factors[number][value] for number, value in some})
    )


def crossed(name: str) -> Maker:
    """Return the generator of the family of that name."""
    factors = FACTORS[name]

    def make(draw: Draw, n: int) -> Rows:
        combination = design(name)[np.arange(n) % len(design(name))].repeat(CANDIDATES, axis=0)
        values = {factor: np.asarray(factor)[combination[:, place]] for place, factor in enumerate(factors)}
        rows, fits = _candidates(draw, n * CANDIDATES, values)
        first = fits.reshape(n, CANDIDATES).argmax(axis=1)
        return np.ascontiguousarray(rows.reshape(n, CANDIDATES, -1)[np.arange(n), first])

    return make


def _candidates(draw: Draw, n: int, values: Mapping[tuple[str, ...], NDArray[Any]]) -> tuple[Rows, Mask]:
    """Draw a row for each combination of values; return the rows and a mask of those on the combination's side."""
    size = _sizes(draw, n, values)
    centre = _centre(draw, size, values)
    free = [draw.integers(n, 1, 5) * draw.signs(n) for _ in range(3)]
    motion = _motion(values[MOTIONS], centre, free) if MOTIONS in values else None
    axes = next((factor for factor in (AXES, SWEEP_AXES) if factor in values), None)
    axis = None if axes is None else _axis(values[axes], centre, free, motion)
    unit = draw.integers(n, -3, 3)
    lengths = [*size, *centre, *([] if motion is None else [p + w for p, w in zip(centre, motion, strict=True)])]
    rows = ldexp(np.stack(lengths, axis=1), unit[:, None])
    tail = [] if axis is None else [ldexp(np.stack(axis, axis=1), draw.integers(n, -9, 3)[:, None])]
    fits = _side(np.concatenate([rows[:, :7], *tail], axis=1)) == _code(values[SIDES])
    if motion is not None:
        at_the_end = _side(np.concatenate([rows[:, :4], rows[:, 7:], *tail], axis=1))
        fits &= (at_the_end == 0) == (values[ENDS] == ENDS[1])
    return np.concatenate([rows, *tail], axis=1) + 0.0, fits


def _side(rows: Rows) -> NDArray[np.int8]:
    """Return the position of each row, int8 (n,)."""
    return np.asarray(classify(rows))


def _code(sides: NDArray[Any]) -> Integers:
    """Turn the values of SIDES into the numbers of positions."""
    return np.select([sides == "exterior", sides == "interior"], [1, -1], 0)


def _sizes(draw: Draw, n: int, values: Mapping[tuple[str, ...], NDArray[Any]]) -> list[Floats]:
    """Draw α, γ, b, d that have the wanted coincidences: whole numbers, or quarters of them."""
    kind = values[SIZES]
    alpha, gamma = (draw.integers(n, 1, 12).astype(np.float64) for _ in range(2))
    b, d = (ldexp(draw.integers(n, 1, 12), -2 * draw.integers(n, 0, 1)) for _ in range(2))
    alpha = np.where(values[HEIGHTS] == HEIGHTS[-1], 5.0 * draw.integers(n, 1, 3), alpha)
    gamma = np.where(kind == "α = γ", alpha, gamma)
    b = np.where(kind == "α = b", alpha, b)
    d = np.select([kind == "b = d", kind == "γ = d"], [b, gamma], d)
    return [alpha, gamma, b, d]


def _centre(draw: Draw, size: list[Floats], values: Mapping[tuple[str, ...], NDArray[Any]]) -> list[Floats]:
    """Draw x, y, z that have the wanted coincidences."""
    n, (alpha, gamma, _, _) = len(size[0]), size
    place, height = values[PLACES], values[HEIGHTS]
    x, y, z = (draw.integers(n, 1, high) * draw.signs(n) for high in (14, 14, 30))
    level, up, swap = ldexp(draw.signs(n), draw.integers(n, -1, 1)), draw.signs(n), draw.signs(n) < 0
    cone = height == "on the asymptotic cone"
    # On the cone, x and y are legs whose hypotenuse is α times the level, so that z is exact too; except for x = ±y.
    legs = np.where(swap, 3, 4) * alpha * level / 5, np.where(swap, 4, 3) * alpha * level / 5
    x, y = np.where(cone, legs[0], x), np.where(cone, legs[1], y)
    alone, centred = np.where(cone, alpha * level, 0.0), place == "on the hyperboloid's axis"
    level_x = (place == "x = y") | (place == "x = −y")
    rise = np.select([centred, level_x], [0.0, gamma * np.sqrt(2 * x * x) / alpha], gamma * np.abs(level))
    x, y = (
        np.select([(place == "x = 0") | centred, (place == "y = 0") & cone], [0.0, alone], x),
        np.select(
            [(place == "x = 0") & cone, (place == "y = 0") | centred, place == "x = y", place == "x = −y"],
            [alone, 0.0, x, -x],
            y,
        ),
    )
    z = np.select([height == "z = 0", height == "z = x", height == "z = γ", cone], [0.0, x, gamma * up, rise * up], z)
    return [x, y, z]


def _motion(motion: NDArray[Any], centre: list[Floats], free: list[Floats]) -> list[Floats]:
    """Make the vectors from the start to the end, out of the centre and three random whole numbers."""
    x, y, z = centre
    i, j, k = free
    zero = np.zeros(len(x))
    motions: dict[str, tuple[Floats, Floats, Floats]] = {
        "still": (zero, zero, zero),
        "vertical": (zero, zero, 2 * i),
        "along x": (2 * i, zero, zero),
        "along y": (zero, 2 * i, zero),
        "radial": (i * x / 2, i * y / 2, zero),
        "tangent": (-i * y, i * x, zero),
        MOTIONS[7]: (-2 * x, -2 * y, -2 * z),
        MOTIONS[8]: (i * x / 4, i * y / 4, i * z / 4),
        MOTIONS[9]: (-2 * x, -2 * y, 2 * i),
    }
    return _selected(motion, motions, (3 * i, 3 * j, 3 * k))


def _axis(kind: NDArray[Any], centre: list[Floats], free: list[Floats], motion: list[Floats] | None) -> list[Floats]:
    """Make a vector along the spheroid's axis; it is along x if the vector to which it should be parallel is 0."""
    x, y, z = centre
    i, j, k = free
    zero, one = np.zeros(len(x)), np.ones(len(x))
    across = (-y * j, x * j, zero)
    slanting = (y * z * i, x * z * j, -x * y * (i + j))
    flat = (slanting[0] == 0) & (slanting[1] == 0) & (slanting[2] == 0)
    axes: dict[str, tuple[Floats, Floats, Floats]] = {
        "vertical": (zero, zero, i),
        "horizontal": (i, j, zero),
        "along x": (i, zero, zero),
        "along y": (zero, i, zero),
        AXES[5]: (x * i, y * i, z * i),
        AXES[6]: (x * i, y * i, zero),
        AXES[7]: (x * i, y * i, j),
        AXES[8]: across,
        AXES[9]: (x * z * i, y * z * i, -(x * x + y * y) * i),
        AXES[10]: (
            np.where(flat, across[0], slanting[0]),
            np.where(flat, across[1], slanting[1]),
            np.where(flat, across[2], slanting[2]),
        ),
    }
    if motion is not None:
        u, v, w = motion
        axes["along the way"] = (u, v, w)
        axes["at right angles to the way"] = (v - w, w - u, u - v)
    vector = _selected(kind, axes, (i, j, k))
    nowhere = (vector[0] == 0) & (vector[1] == 0) & (vector[2] == 0)
    return [np.where(nowhere, one, vector[0]), *vector[1:]]


def _selected(kind: NDArray[Any], known: Mapping[str, Any], otherwise: tuple[Floats, Floats, Floats]) -> list[Floats]:
    """Select for each row the vector that `known` has for its kind, or `otherwise`."""
    which = [kind == name for name in known]
    return [np.select(which, [vector[part] for vector in known.values()], otherwise[part]) for part in range(3)]
