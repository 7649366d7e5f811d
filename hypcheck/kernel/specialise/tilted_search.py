"""The routines that search by halving for the maximum of the dual function, and say what its value there proves.

**An upright spheroid**: the answer is the sign of the maximum. The steps are the programs of last_stages.py. The
unknown is the distance to 0 or to the pole, whichever is nearer. First its exponent is halved, then the distance.

**A tilted spheroid**: the steps are the programs of tilted.py; the value at the maximum is computed in double-double.
If each query names an axis, so is the frame: the directions in which both matrices are diagonal.
"""

from __future__ import annotations

from dataclasses import replace

from hypcheck.derivation.program import Program, steps_of
from hypcheck.derivation.routines import Call, Half, Loop, Part, Return, Routine, Stored, renamed
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.kernel.specialise import last_stages, tilted
from hypcheck.kernel.specialise.double_double import WHOLE, in_double_double

SETTING = ("A", "B", "PR", "QZ", "AR", "CZ", "low_a", "low_b")
"""The constants of a search, in the order in which a kernel holds them."""

FALLS = Routine(
    "falling",
    "Whether the dual function does not rise at the multiplier with these distances to its poles.",
    ("ar", "cz", "to_a", "to_b"),
    last_stages.FALLS.steps,
    "past",
)

PAST_MAXIMUM = Routine(
    "past_maximum",
    "Whether the maximum of the dual function lies beyond the multiplier at this distance from 0, or from the pole.",
    ("ar", "cz", "pole", "other", "distance", "near_zero", "inside"),
    (
        *last_stages.PLACE.steps,
        *last_stages.FALLS.steps,
        *steps_of("beyond = past != is_inside"),
    ),
    "beyond",
)

ABOVE_ZERO = Routine(
    "above_zero",
    "Whether the dual function is above zero there: the spheroid is clear.",
    last_stages.PHI.inputs,
    last_stages.PHI.steps,
    "above_zero",
)


_IS_PAST = Call("beyond", PAST_MAXIMUM, ("ar", "cz", "pole", "other", "middle", "near_zero", "inside"))


def halving(times: int, mean: Program, low: tuple[str, str], high: tuple[str, str], is_past: Call = _IS_PAST) -> Loop:
    """Return a loop of `times` halvings between `low` and `high`, each the name of an end and its initial value.

    `mean` computes `middle` from the ends. `is_past` computes from that the truth value `beyond`; where it differs from
    `beyond_half`, the low end becomes the middle, else the high end.
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
    """Return the search for an upright spheroid, with this total number of halvings."""
    parts: tuple[Part, ...] = (
        *(step for step in last_stages.START.steps),
        Call("is_interior", FALLS, ("ar", "cz", "A", "B")),
        *steps_of(
            """
            inside = is_interior ? 1 : 0
            pole = is_interior ? A : B
            other = is_interior ? B : A
            first = is_interior ? low_a : low_b
            """
        ),
        *last_stages.HALF.steps,
        Call("beyond_half", PAST_MAXIMUM, ("ar", "cz", "pole", "other", "half", 1, "inside")),
        *steps_of("near_zero = beyond_half ? 1 : 0"),
        halving(last_stages.GEOMETRIC_STEPS, last_stages.GEOMETRIC, ("low", "first"), ("high", "half")),
        halving(steps - last_stages.GEOMETRIC_STEPS, last_stages.ARITHMETIC, ("near", "low"), ("distance", "high")),
        *last_stages.PLACE.steps,
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


CENTRE = ("centre_x", "centre_y", "centre_z")
AXIS = ("axis_x", "axis_y", "axis_z")
BOUNDS = ("most", "omega")
_COMPONENTS, _POLES, _GAPS = ("c1", "c2", "c3"), ("A1", "A2", "B"), ("gap1", "gap2")
_PLACES = ("to_a1", "to_a2", "to_b")

FALLING = Routine(
    "falling",
    "Whether the slope of the dual function is not positive at these distances to its poles.",
    (*_COMPONENTS, *_POLES, *_PLACES),
    tilted.FALLS.steps,
    "past",
)

PAST_PEAK = Routine(
    "past_peak",
    "Whether the maximum of the dual function lies beyond the multiplier at this distance from 0, or from the pole.",
    (*_COMPONENTS, *_POLES, *_GAPS, "pole", "distance", "near_zero", "inside"),
    (*tilted.PLACE.steps, *tilted.FALLS.steps, *steps_of("beyond = past != is_inside")),
    "beyond",
)

PROVED = Routine(
    "proved",
    "+1 exterior, 0 contact, -1 interior, or CANNOT_SAY: what the dual function at lambda_ proves.",
    ("x", "y", "z", *BOUNDS, *_COMPONENTS, *_POLES, "lambda_", *_PLACES, "phi", "inside"),
    (*tilted.DECISION.steps, *steps_of("is_inside = inside > 0\n clear_inside = clear and is_inside")),
    Return((("clear_inside", -1), ("clear", 1), ("contact", 0)), CANNOT_SAY),
    constants=tilted.DECISION_CONSTANTS,
)


def _highs(*pairs: str) -> tuple[str, ...]:
    """Return the names that `_nearly` gives to the first numbers of these pairs."""
    return tuple(f"nearly_{pair}" for pair in pairs)


def _nearly(*pairs: str) -> tuple[Half, ...]:
    """Return the parts that take the first numbers of pairs: their values rounded to doubles."""
    return tuple(Half(high, pair) for high, pair in zip(_highs(*pairs), pairs, strict=True))


def _halving(times: int, mean: Program, low: tuple[str, str], high: tuple[str, str]) -> Loop:
    """Return the loop of halvings for a tilted spheroid, with the arguments that PAST_PEAK needs."""
    known = (*_highs(*_COMPONENTS, *_POLES, *_GAPS), "nearly_pole")
    return halving(times, mean, low, high, Call("beyond", PAST_PEAK, (*known, "middle", "near_zero", "inside")))


def _search() -> tuple[Part, ...]:
    """Return the parts of the search for a tilted spheroid, from the centre and the frame to what is proved."""
    nearly = _highs(*_COMPONENTS, *_POLES)
    return (
        *(Call(name, WHOLE, (argument,)) for name, argument in zip("xyz", CENTRE, strict=True)),
        *in_double_double(tilted.COMPONENTS, _COMPONENTS),
        *_nearly(*_COMPONENTS, *_POLES, *_GAPS),
        Call("is_interior", FALLING, (*nearly, *_highs(*_POLES))),
        *steps_of("inside = is_interior ? 1 : 0\n pole = is_interior ? least : B"),
        *_nearly("pole"),
        *steps_of("half = nearly_pole / 2\n first = start * nearly_pole"),
        Call("beyond_half", PAST_PEAK, (*nearly, *_highs(*_GAPS), "nearly_pole", "half", 1, "inside")),
        *steps_of("near_zero = beyond_half ? 1 : 0"),
        _halving(tilted.GEOMETRIC_STEPS, last_stages.GEOMETRIC, ("low", "first"), ("high", "half")),
        _halving(tilted.ARITHMETIC_STEPS, last_stages.ARITHMETIC, ("near", "low"), ("far", "high")),
        *_parts_at_the_maximum(),
    )


def _parts_at_the_maximum() -> tuple[Part, ...]:
    """Return the parts that compute the dual function where the search ends, in double-double, and what it proves."""
    at = {"distance": "far", "near_zero": "near_zero", "inside": "inside"}
    values = ("lambda_", *_PLACES, "phi")
    return (
        *(Call(f"{name}_there", WHOLE, (argument,)) for name, argument in at.items()),
        *renamed(in_double_double(last_stages.PLACE, ("lambda_",)), {name: f"{name}_there" for name in at}),
        *in_double_double(tilted.PHI, ("phi", *_PLACES)),
        *_nearly(*values),
        Call("found", PROVED, (*CENTRE, *BOUNDS, *_highs(*_COMPONENTS, *_POLES, *values), "inside")),
    )


SEARCH = Routine(
    "tilted_search",
    "+1 exterior, 0 contact, -1 interior, or CANNOT_SAY: by the dual function where a search finds it largest.",
    CENTRE,
    _search(),
    "found",
    (*tilted.FRAME_NAMES, *BOUNDS),
    frozenset(tilted.FRAME_NAMES),
    {"start": tilted.START},
    "frame",
)
"""The search for one fixed axis, whose frame is a record of constants."""

_ANY = replace(SEARCH, inputs=(*CENTRE, *SEARCH.record), record=())
"""The search for any axis, whose frame is given as inputs."""

POWER_FOR = Routine(
    "power_for",
    "A power of two that brings a number > 0 between 2^-100 and 2^100.",
    ("number",),
    (
        Loop(
            5,
            (("power", "first", "changed"),),
            steps_of(
                """
                product = number * power
                is_small = product < small
                is_large = product > large
                raised = power * up
                lowered = power * down
                unless_small = is_large ? lowered : power
                changed = is_small ? raised : unless_small
                """
            ),
        ),
    ),
    "power",
    constants={"first": 1.0, "small": 2.0**-100, "large": 2.0**100, "up": 2.0**200, "down": 2.0**-200},
)
"""Five factors of 2^±200 are enough for every float64."""

_LARGEST = steps_of(
    """
    size_x = abs axis_x
    size_y = abs axis_y
    size_z = abs axis_z
    y_is_longer = size_y > size_x
    flat_size = y_is_longer ? size_y : size_x
    z_is_longer = size_z > flat_size
    largest = z_is_longer ? size_z : flat_size
    """
)
"""The steps to the largest component of an axis, and to the larger one of x and y, without their signs."""

FREE_SEARCH = Routine(
    "tilted_search_free",
    "The same of any axis, whose frame is made of it.",
    (*CENTRE, *AXIS),
    (
        *_LARGEST,
        *steps_of(
            """
            is_flat = flat_size > 0
            some_size = is_flat ? flat_size : 1
            """
        ),
        Call("flat_power", POWER_FOR, ("some_size",)),
        Call("power", POWER_FOR, ("largest",)),
        *steps_of(
            """
            flat_x = flat_power * axis_x
            across_x = is_flat ? flat_x : 1
            across_y = flat_power * axis_y
            along_x = power * axis_x
            along_y = power * axis_y
            along_z = power * axis_z
            """
        ),
        *(
            Call(name, WHOLE, (argument,))
            for name, argument in zip(
                ("hx", "hy", "vx", "vy", "vz"),
                ("across_x", "across_y", "along_x", "along_y", "along_z"),
                strict=True,
            )
        ),
        *in_double_double(tilted.FRAME, tilted.FRAME_NAMES),
        Call("found", _ANY, (*CENTRE, *tilted.FRAME_NAMES, *BOUNDS)),
    ),
    "found",
    (*tilted.SIZE_NAMES, *BOUNDS),
    frozenset(tilted.SIZE_NAMES),
    record_name="sizes_of_frame",
)

HAS_DIRECTION = Routine(
    "has_direction",
    "Whether an axis is one: finite, not 0, 0, 0, and longer than 2^-500 where subnormal numbers are flushed to 0.",
    AXIS,
    (
        Stored("normal", "least", opaque=True),
        *steps_of("halved = normal / 2"),
        Stored("half", "halved", opaque=True),  # 0 where subnormal numbers are flushed to zero
        *steps_of(
            """
            both = half + half
            lost = normal - both
            shortest = lost * scale
            """
        ),
        *_LARGEST,
        *steps_of(
            """
            is_long = largest > shortest
            nothing_x = axis_x - axis_x
            nothing_y = axis_y - axis_y
            nothing_z = axis_z - axis_z
            nothing_xy = nothing_x + nothing_y
            nothing = nothing_xy + nothing_z
            is_finite = nothing == 0
            has_direction = is_long and is_finite
            """
        ),
    ),
    "has_direction",
    constants={"least": 2.0**-1022, "scale": 2.0**522},
)
"""Flushing subnormal components to 0 does not matter for an axis longer than 2^-500."""
