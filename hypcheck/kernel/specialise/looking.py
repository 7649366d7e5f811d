"""Routines that look at a spheroid at a time of its sweep: a multiplier by halving, and what SWEEP proves by it.

The multiplier need not be right. At the best one numbers may cancel, where it lies next to a pole; so where nothing is
proved, others are tried that keep away from the poles (programs/sweeps.py). Printed clearances bound the maximum of the
dual function by several multipliers in the same manner.
"""

from __future__ import annotations

from sys import float_info

from hypcheck.derivation.program import needed, steps_of
from hypcheck.derivation.routines import Call, Loop, Part, Routine
from hypcheck.geometry.pair import AXIS, CENTER, SIZES, TILTED_COLUMNS
from hypcheck.kernel.programs import sweeps, tilted

HALVINGS = 52
"""Of the exponents between 2⁻⁶⁰ and 2⁶⁰: the multiplier's distance from its pole is found within 2⁻⁴⁵ of itself."""

WIDEST = 2.0**-60
TRIES = 3

CONTACT = 8
"""What stands for contact among reaches."""

_POLES = """
    k1_squared = k1 * k1
    k0_t = k0 * t
    fourfold = 4 * k0_t
    under_root = k1_squared + fourfold
    root = sqrt under_root
    size_k1 = abs k1
    sum = root + size_k1
    twice_t = 2 * t
    twice_k0 = 2 * k0
    larger = sum / twice_t
    smaller = twice_k0 / sum
    k1_positive = k1 > 0
    B = k1_positive ? larger : smaller
    A2 = k1_positive ? smaller : larger
    A2_nearer = A2 < p
    A = A2_nearer ? A2 : p
    outside = G > k0
    minus_A = - A
    pole = outside ? B : minus_A
"""

_OF_SHARE = """
    one_v = 1 + v
    pole_v = pole * v
    l = pole_v / one_v
"""

_HALVE = f"""
    product = low * high
    v = sqrt product
    {_OF_SHARE}
"""

_MOVE = """
    rises = psi > 0
    farther = rises == outside
    new_low = farther ? v : low
    new_high = farther ? high : v
"""

_AT_MULTIPLIER = steps_of(tilted.AT_MULTIPLIER)
_PLACE_STEPS = needed(sweeps.PLACE, ("E", "G", "m", "k0", "k1", "p", "t"))

MULTIPLIER = Routine(
    "multiplier",
    "About the multiplier at which the dual function is greatest at a time, or one nearer to 0; it need not be right.",
    (*sweeps.ROW, *sweeps.LENGTHS, "at", "most_share"),
    (
        *_PLACE_STEPS,
        *steps_of(_POLES),
        Loop(
            HALVINGS,
            (("low", "least_share", "new_low"), ("high", "greatest_share", "new_high")),
            (*steps_of(_HALVE), *_AT_MULTIPLIER, *steps_of(_MOVE)),
        ),
        *steps_of(
            """
            last_product = low * high
            last_v = sqrt last_product
            too_near = last_v > most_share
            share = too_near ? most_share : last_v
            one_share = 1 + share
            pole_share = pole * share
            found = pole_share / one_share
            """
        ),
    ),
    "found",
    constants={"least_share": WIDEST, "greatest_share": 1 / WIDEST},
)

REACH = Routine(
    "reach_of",
    "How far a parabola is proved to stay above 0, 2 at most.",
    ("here", "slope", "bend"),
    sweeps.ROOT.steps,
    "reach",
    constants=sweeps.ROOT_CONSTANTS,
)


def _length(of: str) -> str:
    return f"""
    size_{of}_x = abs {of}_x
    size_{of}_y = abs {of}_y
    size_{of}_z = abs {of}_z
    {of}_y_more = size_{of}_y > size_{of}_x
    size_{of}_xy = {of}_y_more ? size_{of}_y : size_{of}_x
    {of}_z_more = size_{of}_z > size_{of}_xy
    {of}_size = {of}_z_more ? size_{of}_z : size_{of}_xy
"""


def tried(
    kept: tuple[tuple[str, str, str], ...], parts: tuple[Part, ...], until: str | None = None
) -> tuple[Part, ...]:
    """SWEEP at the best multiplier, and at ones that keep away from the poles, where numbers cancel."""
    body: tuple[Part, ...] = (
        Call("l", MULTIPLIER, (*sweeps.ROW, *sweeps.LENGTHS, "at", "most_share")),
        *sweeps.SWEEP.steps,
        *parts,
        *steps_of("share_next = most_share * shrink"),
    )
    loop = Loop(TRIES, (("most_share", "widest_share", "share_next"), *kept), body, until)
    return (*steps_of(_length("axis")), *steps_of(_length("wall_axis")), loop)


TRY_CONSTANTS = {**sweeps.CONSTANTS, "zero": 0.0, "widest_share": 1 / WIDEST, "shrink": 2.0**-24}

LOOK = Routine(
    "look",
    f"How far from a time on the sweep is proved to be clear, negative inside; {CONTACT} contact, 0 nothing is proved.",
    (*sweeps.ROW, "at"),
    tried(
        (("found", "zero", "looked"),),
        (
            Call("reach", REACH, ("here", "slope", "bend")),
            *steps_of(
                f"""
                minus_reach = - reach
                sided = on_side_of_B ? reach : minus_reach
                sided_clear = clear ? sided : 0
                looked = contact ? {CONTACT} : sided_clear
                proved = looked != 0
                """
            ),
        ),
        "proved",
    ),
    "found",
    constants=TRY_CONSTANTS,
)

STANDING = (*SIZES, *CENTER, *CENTER, *AXIS, 0, 0, 0, 0, 0, 1)
"""A spheroid that stays where it is, beside the hyperboloid about the origin: the arguments of a sweep."""


POSITION = Routine(
    "position_of",
    "+1 exterior, 0 contact, -1 interior, each proved; 2 cannot say.",
    TILTED_COLUMNS,
    (
        Call("found", LOOK, (*STANDING, 0)),
        *steps_of(
            f"""
            is_contact = found == {CONTACT}
            is_exterior = found > 0
            is_interior = found < 0
            inside_or_not = is_interior ? -1 : 2
            clear_or_not = is_exterior ? 1 : inside_or_not
            told = is_contact ? 0 : clear_or_not
            """
        ),
    ),
    "told",
)


def _bound(name: str, meaning: str, bound: str, at_first: str) -> Routine:
    """A bound of the clearance: the best of those at several multipliers."""
    more = "bound > best" if at_first == "nothing_least" else "bound < best"
    of_way = Routine(
        f"{name}_at",
        meaning,
        (*sweeps.ROW, "at"),
        tried(
            (("best", at_first, "best_now"),),
            (
                *steps_of(bound),
                *steps_of(
                    f"better = {more}\nbest_better = better ? bound : best\nbest_now = valid ? best_better : best"
                ),
            ),
        ),
        "best",
        constants={
            **TRY_CONSTANTS,
            "unsure_u": sweeps.CONSTANTS["u_k"],
            "nothing_least": -1.0,
            "nothing_most": float_info.max,
        },
    )
    return Routine(name, meaning, TILTED_COLUMNS, (Call("told", of_way, (*STANDING, 0)),), "told")


_QUOTIENT = """
    valid = inside and d_known
    d_most = d_l + e_d
    is_positive = {value} > 0
    under = is_positive ? {positive} : {negative}
    divisor = valid ? under : 1
    quotient = {value} / divisor
    size_quotient = abs quotient
"""

_FACTOR = """
    usable_square = square_bound > 0
    square_or_0 = usable_square ? square_bound : 0
    factor = sqrt square_or_0
    rough = factor - 1
    factor_sizes = 1 + factor
    last_unsure = unsure_u * factor_sizes
"""

LOWER = _bound(
    "lower_of",
    "A proved lower bound of the clearance, in radii: grown by less, the spheroid stays clear; -1 says nothing.",
    _QUOTIENT.format(value="here", positive="d_most", negative="d_least")
    + """
    sizes_sum = 1 + size_quotient
    unsure = unsure_u * sizes_sum
    square = 1 + quotient
    square_bound = square - unsure
    """
    + _FACTOR
    + "bound = rough - last_unsure",
    "nothing_least",
)

UPPER = _bound(
    "upper_of",
    "A proved upper bound of the clearance, in radii: grown by more, the spheroid has contact.",
    "over = F + e_F\n"
    + _QUOTIENT.format(value="over", positive="d_least", negative="d_most")
    + """
    divisor_least = valid ? d_least : 1
    rise = slope_most / divisor_least
    rise_over = rise / divisor_least
    rise_most = rise_over / less_sure
    sizes_before = 1 + size_quotient
    sizes_sum = sizes_before + rise_most
    unsure = unsure_u * sizes_sum
    square_before = 1 + quotient
    square = square_before + rise_most
    square_bound = square + unsure
    """
    + _FACTOR
    + "bound = rough + last_unsure",
    "nothing_most",
)
