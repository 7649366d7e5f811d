"""What the programs of the float stages must answer for all signs and at their limits, asked of any program.

Each function returns the questions that the program answers otherwise: none for ours, some for one with a step changed.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from hypcheck.derivation.evaluation import EXACT, outputs
from hypcheck.derivation.program import Program, cut
from hypcheck.geometry.pair import Position
from tests.support.inside import CERTIFIED_CONSTANTS, tilted

BOUNDS = {
    "delta_3": "E",
    "c1": "e1",
    "c2": "e2",
    "slope_B": "bound_B",
    "offset_B": "offset_bound_B",
    "slope_A": "bound_A",
    "offset_A": "offset_bound_A",
}
"""What the second stage compares, and the bound that each is compared with."""

LIMITS = {
    "certified": {
        "alpha": (None, None),
        "gamma": (None, None),
        "b": ("least", "greatest"),
        "d": ("least", "greatest"),
        "A": ("least", "greatest"),
        "B": ("least", "greatest"),
        "P_plus_Q": (None, "farthest"),
    },
    "tilted": {
        "alpha": (None, None),
        "gamma": (None, None),
        "d": (None, None),
        "b": ("least_b", "greatest_b"),
        "p": ("least_square", "greatest_square"),
        "s": ("least_square", "greatest_square"),
        "t": ("least_square", "greatest_square"),
        "w": ("least_axis", "greatest_axis"),
        "distance": (None, "farthest_square"),
        "l": (None, "greatest_l"),
    },
}
"""By program and by value: the constants between which it has to lie; a size without one has to be above 0."""

CONSTANTS = {"certified": CERTIFIED_CONSTANTS, "tilted": tilted.CONSTANTS}

Wrong = list[dict[str, Any]]


def rule(delta: int, c1: int, c2: int, slope_B: int, offset_B: int, slope_A: int, offset_A: int) -> Position | None:
    """The rule for all regimes (docs/mathematics.md), each sign +1, −1, or 0 where it is not certain."""
    if delta <= 0:
        return Position.CONTACT if delta else None
    if c2 < 0 < c1:  # three positive roots: B lies before all of them, or two lie before B
        if offset_B > 0 or slope_B < 0:
            return Position.EXTERIOR
        return Position.CONTACT if offset_B < 0 and slope_B > 0 else None
    if c2 > 0 or c1 < 0:  # two negative ones: both lie above −A, or −A above one of them
        if offset_A > 0 and slope_A > 0:
            return Position.INTERIOR
        return Position.CONTACT if offset_A < 0 or slope_A < 0 else None
    return None


def wrong_signs(program: Program) -> Wrong:
    """Signs for which the second stage answers otherwise than the rule; a value equal to its bound has none."""
    sizes = dict.fromkeys(("alpha", "gamma", "b", "d", "A", "B"), 1)
    inputs = {**CERTIFIED_CONSTANTS, **sizes, **dict.fromkeys(BOUNDS.values(), 2), "P_plus_Q": 1}
    asked = []
    for signs in itertools.product((-1, 0, 1), repeat=len(BOUNDS)):
        for at_bound in (2, -2) if 0 in signs else (2,):
            told = {name: 3 * sign or at_bound for name, sign in zip(BOUNDS, signs, strict=True)}
            asked.append((told, rule(*signs)))
    return _wrong(program, (*sizes, "P_plus_Q", *BOUNDS, *BOUNDS.values()), inputs, asked)


def wrong_signs_of_tilted_rows(program: Program) -> Wrong:
    """The same for tilted rows: φ > 0 between the poles proves its side, φ < 0 contact where a tangent allows.

    Of a centre that is too far, nothing is decided.
    """
    bounds = {"k": "e_k", "p_l": "e_pl", "F": "e_F"}
    inputs = {**tilted.CONSTANTS, **dict.fromkeys(("alpha", "gamma", "b", "d", "p", "s", "t", "w", "distance"), 1)}
    inputs |= {"s_along": 1, "e_psi": 0, "d_l": 3, "e_d": 2, **dict.fromkeys(bounds.values(), 2)}
    limit = Fraction(tilted.CONSTANTS["less_sure"]) / 2  # of psi, where −F is 3, d least 1 and the width 2
    asked = []
    for k, p_l, F, l_, steep in itertools.product((3, 2, -3), (3, 2, -3), (3, 2, -2, -3), (-1, 0, 1), (-1, 0, 1)):
        if F > 0 and not l_:
            continue  # at l = 0 F is -d, which is below 0 between the poles
        found = None
        if k == p_l == 3:
            found = Position(l_) if F == 3 and l_ else Position.CONTACT if F == -3 and steep < 0 else None
        told = {"k": k, "p_l": p_l, "F": F, "l": l_, "psi": limit * (1 + Fraction(steep, 2))}
        asked += [(told, found), (told | {"distance": Fraction(tilted.CONSTANTS["farthest_square"])}, None)]
    known = (*inputs, "k", "p_l", "F", "l", "psi")
    return _wrong(program, tuple(name for name in known if name not in tilted.CONSTANTS), inputs, asked)


def _wrong(
    program: Program,
    known: tuple[str, ...],
    inputs: dict[str, Any],
    asked: Iterable[tuple[dict[str, Any], Position | None]],
) -> Wrong:
    wanted = ("exterior", "interior", "decided")
    decision = cut(program, known, wanted)
    wrong = []
    for told, right in asked:
        exterior, interior, decided = outputs(decision, EXACT, {**inputs, **told}, wanted)
        if (decided, exterior - interior) != (right is not None, right or 0):
            wrong.append(told)
    return wrong


def wrong_limits(program: Program) -> Wrong:
    """Values at which, or beyond which, the program must not answer, and does; or that it must answer, and does not."""
    limits, constants = LIMITS[program.name], {name: Fraction(each) for name, each in CONSTANTS[program.name].items()}
    part = cut(program, tuple(limits), ("usable",))
    inputs = {**constants, **dict.fromkeys(limits, Fraction(1))}
    wrong = []
    for name, (least, greatest) in limits.items():
        inside = [Fraction(1), *(2 * constants[each] for each in (least,) if each)]
        inside += [constants[each] / 2 for each in (greatest,) if each]
        beyond = [constants[each] for each in (least, greatest) if each]
        beyond += [] if greatest and not least else [Fraction(0), Fraction(-1)]
        beyond += [-constants[each] for each in (greatest,) if name == "l" and each]
        for value, right in [(each, True) for each in inside] + [(each, False) for each in beyond]:
            if outputs(part, EXACT, {**inputs, name: value}, ("usable",)) != (right,):
                wrong.append({name: value})
    return wrong


SIGNS = {"certified": wrong_signs, "tilted": wrong_signs_of_tilted_rows}
"""By the name of a program: what it says for all signs."""
