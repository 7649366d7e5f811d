"""The search for an upright spheroid as a routine: the maximum of the dual function by halving, and its sign there.

Its steps are the programs of last_stages.py. The distance to 0, or to the pole, is halved in its exponent first, then
in itself.
"""

from __future__ import annotations

from hypcheck.derivation.program import Program, steps_of
from hypcheck.derivation.routines import Call, Loop, Part, Return, Routine, renamed
from hypcheck.kernel.specialise.last_stages import (
    ARITHMETIC,
    GEOMETRIC,
    GEOMETRIC_STEPS,
    HALF,
    PHI,
    PLACE,
    START,
    falls,
)

SETTING = ("A", "B", "PR", "QZ", "AR", "CZ", "low_a", "low_b")
"""The constants of a search, in the order in which a kernel holds them."""

FALLS = Routine(
    "falling",
    "Whether the dual function does not rise at the multiplier with these distances to its poles.",
    ("ar", "cz", "to_a", "to_b"),
    falls().steps,
    "past",
)

PAST_MAXIMUM = Routine(
    "past_maximum",
    "Whether the maximum of the dual function lies beyond the multiplier at this distance from 0, or from the pole.",
    ("ar", "cz", "pole", "other", "distance", "near_zero", "inside"),
    (
        *PLACE.steps,
        *falls().steps,
        *steps_of("beyond = past != is_inside"),
    ),
    "beyond",
)

ABOVE_ZERO = Routine(
    "above_zero", "Whether the dual function is above zero there: the spheroid is clear.", PHI.inputs, PHI.steps,
    "above_zero",
)  # fmt: skip


_IS_PAST = Call("beyond", PAST_MAXIMUM, ("ar", "cz", "pole", "other", "middle", "near_zero", "inside"))


def halving(times: int, mean: Program, low: tuple[str, str], high: tuple[str, str], is_past: Call = _IS_PAST) -> Loop:
    """So many halvings between `low` and `high`, each the name of an end and of what it is at first.

    `mean` makes `middle` of them, `is_past` makes `beyond` of that, which is compared with `beyond_half`.
    """
    body: tuple[Part, ...] = (
        *renamed(mean.steps, {"low": low[0], "high": high[0]}),
        is_past,
        *steps_of(
            f"""
            rises = beyond != beyond_half
            new_low = rises ? middle : {low[0]}
            new_high = rises ? {high[0]} : middle
            """
        ),
    )
    return Loop(times, ((*low, "new_low"), (*high, "new_high")), body)


def search_of(steps: int) -> Routine:
    """The search of so many halvings in all."""
    parts: tuple[Part, ...] = (
        *(step for step in START.steps),
        Call("is_interior", FALLS, ("ar", "cz", "A", "B")),
        *steps_of(
            """
            inside = is_interior ? 1 : 0
            pole = is_interior ? A : B
            other = is_interior ? B : A
            first = is_interior ? low_a : low_b
            """
        ),
        *HALF.steps,
        Call("beyond_half", PAST_MAXIMUM, ("ar", "cz", "pole", "other", "half", 1, "inside")),
        *steps_of("near_zero = beyond_half ? 1 : 0"),
        halving(GEOMETRIC_STEPS, GEOMETRIC, ("low", "first"), ("high", "half")),
        halving(steps - GEOMETRIC_STEPS, ARITHMETIC, ("near", "low"), ("distance", "high")),
        *PLACE.steps,
        Call("clear", ABOVE_ZERO, ("P", "Q", "lambda_", "to_a", "to_b")),
        *steps_of("clear_inside = clear and is_interior"),
    )
    return Routine(
        "search",
        "+1 exterior, 0 contact, -1 interior: the sign of the dual function at its maximum, found by halving.",
        ("R", "zz", "height"),
        parts,
        Return((("clear_inside", -1), ("clear", 1)), 0),
        SETTING,
    )
