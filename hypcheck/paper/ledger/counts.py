"""The counts of the ledger: operations of programs, the printed figures of Table 5, the numbers in its sentences.

Costs that can be counted are counted from the programs. The ledger does not judge other costs.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np

from hypcheck.derivation import formulas
from hypcheck.paper.ledger.entry import Evidence
from hypcheck.paper.ledger.points import SquaredRatios, discriminant
from hypcheck.paper.tower import PRINTED, SPEEDS, TIMES

Floats = np.ndarray[Any, np.dtype[np.float64]]

_TABLE_2, _COSINES = formulas.cost_of(formulas.FORMULAS["table-2"]), formulas.cost_of(formulas.ROOTS_TRIGONOMETRIC)


def divisions_of_table_2() -> Evidence:
    """Return evidence that the loop of Table 2 has divisions."""
    count = _TABLE_2.query.divisions
    text = f"{count} divisions a query, {_TABLE_2.by_fixed} of them by a number that the sizes fix"
    return Evidence("count", text, count > 0 and _TABLE_2.by_fixed == count)


def operations_of_the_sizes() -> Evidence:
    """Return evidence that more operations could be moved out of Table 2's loop than the paper moves."""
    scene, left = _TABLE_2.scene.rounded, formulas.loop_as_printed().rounded - _TABLE_2.query.rounded
    return Evidence("count", f"{scene} operations depend on the sizes alone", 0 < left < scene)


def operations_of_roots() -> Evidence:
    """Return evidence that Table 2 takes fewer operations than the roots by cosines, and no cosine."""
    coefficients, roots = _TABLE_2.query, _COSINES.query
    fewer = coefficients.rounded < roots.rounded and coefficients.functions == 0
    return Evidence("count", f"{coefficients.rounded} < {roots.rounded}", fewer)


def directions_of_rotors() -> Evidence:
    """Return evidence that one cosine and one sine serve all rotors."""
    formula = formulas.FORMULAS["procedure-2a"]
    angles, cost = [name for name in formula.program.inputs if name in {"cosine", "sine"}], formulas.cost_of(formula)
    text = f"{len(angles)} inputs tell the direction of four rotors, and no step takes a cosine"
    return Evidence("count", text, len(angles) == 2 and cost.scene.functions + cost.query.functions == 0)


def share_of_discriminants() -> Evidence:
    """Return evidence that discriminants take over half of Procedure 2.a's operations; the ledger chose "half"."""
    share, whole = formulas.discriminant_share()
    return Evidence("count", f"{share} of {whole} is more than half", 2 * share > whole)


TOWER = ("64", "126736/9")
"""A = (2/0.25)² and B = (17.8/0.15)² of the paper's body in its tower."""

ON_THE_AXIS = SquaredRatios(*TOWER, "0", "0")
NEAR_THE_WALL = SquaredRatios(*TOWER, "33884041/390625", "126736/9")
"""z = 17.8 m, where the wall is 2.8284 m from the axis, and 2.3284 m from it: P = (2.3284/0.25)²."""


NEAREST = (0.28, 0.46)
"""For the 1 % and the 10 % of interior positions with the least Δ: an upper bound of the distance of the centre from
the wall in metres."""


def discriminants_closest_to_zero() -> Evidence:
    """Return evidence that the least values of Δ > 0 in the paper's tower are those near its wall."""
    # Uniform in the cylinder around the tower, so that the points inside are uniform in the tower's volume.
    heights, areas = (np.arange(400) + 0.5) / 400 * 17.8, (np.arange(1000) + 0.5) / 1000
    walls, radii = 2 * np.hypot(1, heights / 17.8)[:, None], 2 * np.sqrt(2 * areas)
    A, B, P, Q = 64.0, (17.8 / 0.15) ** 2, (radii / 0.25) ** 2, (heights[:, None] / 0.15) ** 2
    values = _discriminants(A, B, P, Q)
    inside = (radii < walls) & (values > 0)
    distances = (walls - radii)[inside][np.argsort(values[inside])]
    least = [float(distances[: len(distances) // part].max()) for part in (100, 10)]
    near = all(far <= bound for far, bound in zip(least, NEAREST, strict=True))
    text = (
        f"of {len(distances):,} clear positions spread evenly over the paper's tower, those with the lowest 1 % of Δ "
        f"have the centre within {least[0]:.2f} m of the wall, the lowest 10 % within {least[1]:.2f} m; the median "
        f"is {np.median(distances):.2f} m"
    )
    return Evidence("count", text, near)


def _discriminants(A: float, B: float, P: Floats, Q: Floats) -> Floats:
    """Compute Δ by (14) and (13) in float64, which is enough because no verdict depends on the sign of one value."""
    c0, c1, c2 = -A * B, -A * B + A - B + B * P - A * Q, A - B + 1 - P - Q
    return -4 * c2**3 * c0 + c2**2 * c1**2 + 18 * c2 * c1 * c0 - 4 * c1**3 - 27 * c0**2


def discriminant_is_no_distance() -> Evidence:
    """Return evidence that Δ near the wall at one height exceeds Δ on the axis at another."""
    greater = 0 < discriminant(ON_THE_AXIS) < discriminant(NEAR_THE_WALL)
    return Evidence("count", "across heights the greater Δ can be the one nearer to the wall", greater)


def discriminant_falls_at_each_height() -> Evidence:
    """Return evidence that at one height Δ falls towards the wall."""
    text = "at each of 7 heights from 0 to 17.8 m Δ falls at each of the steps of 6 cm from the axis to Δ ≤ 0"
    return Evidence("count", text, all(_falls(height) for height in range(7)))


def _falls(height: int) -> bool:
    """Decide whether Δ falls along a radius at height/6 of γ until it is not above 0, in steps of b/4."""
    Q = str(Fraction(126736 * height**2, 9 * 36))
    values = [discriminant(SquaredRatios(*TOWER, str(Fraction(step**2, 16)), Q)) for step in range(48)]
    end = next(place for place, value in enumerate(values) if value <= 0)
    return end > 20 and _falling(values[: end + 1])


def _falling(values: Iterable[Fraction | float]) -> bool:
    """Decide whether each value is less than the one before."""
    return all(one > two for one, two in pairwise(values))


def greatest_share() -> Evidence:
    """Return evidence that all printed figures of Table 5 are below 14 %."""
    most = max(map(max, PRINTED))
    return Evidence("count", f"{most} < 14", most < 14)


_FALL = 100 * (1 - PRINTED[0][-1] / PRINTED[0][0])
"""The fall of the printed figures from the first to the last speed for t = 0.1, in percent."""


def rows_fall() -> Evidence:
    """Return evidence that all rows of Table 5 fall as the speed rises."""
    return Evidence("count", "15 falls of 15", all(map(_falling, PRINTED)))


def columns_fall() -> Evidence:
    """Return evidence that all columns of Table 5 fall as the response time rises."""
    return Evidence("count", "12 falls of 12", all(map(_falling, zip(*PRINTED, strict=True))))


def _figure(time: float, speed: int) -> float:
    """Return the printed figure of Table 5 for a response time and a speed."""
    return PRINTED[TIMES.index(time)][SPEEDS.index(speed)]


_EQUAL_STEPS = tuple(
    (_figure(*one), _figure(*other), one[0] * one[1], other[0] * other[1])
    for one, other in (((0.1, 10), (0.2, 5)), ((0.3, 6), (0.2, 9)))
)
"""Pairs of printed figures whose flights have steps of equal length, and the two lengths."""

_SAID_OF_STEPS = ", ".join(f"{one:.2f} against {other:.2f} at v·t = {step:g}" for one, other, step, _ in _EQUAL_STEPS)


def equal_steps() -> Evidence:
    """Return evidence that equal steps have unequal figures."""
    apart = all(abs(one - other) > 0.6 and abs(here - there) < 1e-9 for one, other, here, there in _EQUAL_STEPS)
    return Evidence("count", f"{_SAID_OF_STEPS}: more than 7 standard errors of a difference", apart)


def second_row_read_as_a_quarter() -> Evidence:
    """Return evidence that figures depend only on the step, and fall as it grows, if t = 0.2 is a misprint for 0.25."""
    near = abs(_figure(0.3, 5) - _figure(0.2, 6)) < 0.02
    text = "t = 0.25 brings the two figures of v·t = 1.5 to within 0.02, and all figures fall as v·t grows"
    return Evidence("count", text, near and _fall_with_steps((0.1, 0.25, 0.3)) and not _fall_with_steps(TIMES))


def _fall_with_steps(times: Sequence[float]) -> bool:
    """Decide whether the figures fall as v·t grows, if the rows are those of these times."""
    steps: dict[float, list[float]] = defaultdict(list)
    for time, figures_of_row in zip(times, PRINTED, strict=True):
        for speed, figure in zip(SPEEDS, figures_of_row, strict=True):
            steps[round(time * speed, 9)].append(figure)
    return all(min(steps[one]) > max(steps[two]) for one, two in pairwise(sorted(steps)))


def _volumes(share: float) -> float:
    """Return the mean number of spheroids that Procedure 2.b tests, if `share` % have Δ ≤ 0: the body, or all five."""
    return 1 + 4 * share / 100


BENCH = {
    "operations": "does not hold in numpy, and does not hold in C",
    "roots": "holds in numpy, and holds in C",
    "hull_first": "holds in numpy, 8,192 positions at a time, and holds in C, one position a call",
    "spheres": "22 % of a sphere's answers are false contacts uniformly around the tower, 26 % along flights",
    "cylinders": "1 % of a cylinder's are, and 2 % along flights",
}
"""Figures of the reference run of `hypcheck bench` (reports/reference/bench); a test compares them with that report."""


@cache
def figures() -> dict[str, str]:
    """Return the numbers for the names in braces in sentences of claims.toml."""
    share, whole = formulas.discriminant_share()
    numbers = {
        "query": _TABLE_2.query.rounded,
        "divisions": _TABLE_2.query.divisions,
        "scene_divisions": _TABLE_2.scene.divisions,
        "loop": formulas.loop_as_printed().rounded,
        "could_leave": formulas.loop_as_printed().rounded - _TABLE_2.query.rounded,
        "cosines": _COSINES.query.functions,
        "by_cosines": _COSINES.query.rounded,
        "of_discriminants": share,
        "of_procedure_2a": whole,
        "delta_on_the_axis": round(discriminant(ON_THE_AXIS) / 10**18),
        "delta_near_the_wall": round(discriminant(NEAR_THE_WALL) / 10**18),
        "least_share": min(map(min, PRINTED)),
        "greatest_share": max(map(max, PRINTED)),
        "least_volumes": f"{_volumes(min(map(min, PRINTED))):.2f}",
        "most_volumes": f"{_volumes(max(map(max, PRINTED))):.2f}",
        "closest_to_zero": discriminants_closest_to_zero().text,
        "first_share": PRINTED[0][0],
        "last_share": PRINTED[0][-1],
        "fall": f"{_FALL:.1f}",
        "equal_steps": _SAID_OF_STEPS,
        "second_row_anew": f"{_figure(0.2, 6):.4f}",
        "third_row": f"{_figure(0.3, 5):.4f}",
    }
    return {name: str(number) for name, number in numbers.items()} | {
        f"bench_{name}": value for name, value in BENCH.items()
    }
