"""The routines of printed sweeps: up to when a sweep is proved clear, and whether it has contact.

From the start on, each round proves that the sweep is clear up to a time: that of the first root of a parabola below F.
There, and half a step farther, it looks for a proof of contact, or of a position on the other side of the hyperboloid:
between positions on different sides there is contact. Rounds end at the end of the sweep (no contact), or when a step
becomes too short; then it looks ahead in steps that grow. Without a proof of either it cannot say.

To look at the spheroid at a time means to find a multiplier by halving, and to compute what SWEEP proves with it. A
multiplier is an argument l of the dual function; every one proves something, so it need not be the best. Numbers may
cancel at the best one if it lies next to a pole. If nothing is proved there, other multipliers are tried that keep away
from the poles (programs/sweeps.py). Printed clearances bound the maximum of the dual function by several multipliers in
the same way.

Times are numbers of the format, exactly: SWEEP gets exactly that time. A step is shortened by 2⁻⁴⁹, as the sum
with the time is rounded, by 2⁻⁵² at most. So `now`, up to which the sweep is proved clear, bounds the first contact.
"""

from __future__ import annotations

from sys import float_info

from hypcheck.derivation.program import needed, steps_of
from hypcheck.derivation.routines import Call, Loop, Part, Routine
from hypcheck.geometry.pair import AXIS, CENTER, SIZES, TILTED_COLUMNS
from hypcheck.kernel.programs import sweeps, tilted

HALVINGS = 52
"""How often the exponents from −60 to 60 are halved: the multiplier's distance from its pole is then found within a
relative 2⁻⁴⁵."""

WIDEST = 2.0**-60
"""The least share v from which a multiplier is made (_OF_SHARE); the greatest is its reciprocal."""

TRIES = 3
"""How many multipliers are tried at a time."""

CONTACT = 8
"""The result of LOOK that means contact. All other results are reaches, at most 2 in size."""

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
"""The steps to the poles B and −A2 of the dual function, and to the pole on the centre's side; A is min(A2, p)."""

_OF_SHARE = """
    one_v = 1 + v
    pole_v = pole * v
    l = pole_v / one_v
"""
"""The steps from a share v > 0 to the multiplier l = pole · v/(1 + v), between 0 and the pole."""

_HALVE = f"""
    product = low * high
    v = sqrt product
    {_OF_SHARE}
"""
"""The steps to the middle share, the geometric mean of `low` and `high`, and to its multiplier."""

_MOVE = """
    rises = psi > 0
    farther = rises == outside
    new_low = farther ? v : low
    new_high = farther ? high : v
"""
"""The steps that move one end to v: `low` if the maximum of the dual function lies farther from 0, else `high`."""

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


def _largest_component(of: str) -> str:
    """Return the steps to {of}_size, the largest component of a vector without its sign; vectors are divided by it."""
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
    """Return parts that run SWEEP at the best multiplier, then at others that keep away from the poles.

    Next to a pole numbers cancel. `parts` follow SWEEP in each round; `kept` and `until` are those of the Loop.
    """
    body: tuple[Part, ...] = (
        Call("l", MULTIPLIER, (*sweeps.ROW, *sweeps.LENGTHS, "at", "most_share")),
        *sweeps.SWEEP.steps,
        *parts,
        *steps_of("share_next = most_share * shrink"),
    )
    loop = Loop(TRIES, (("most_share", "widest_share", "share_next"), *kept), body, until)
    return (*steps_of(_largest_component("axis")), *steps_of(_largest_component("wall_axis")), loop)


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
"""The arguments of a sweep on which the spheroid stays where it is, beside the hyperboloid about the origin."""


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
    """Return a routine for a bound of the clearance: the best of the bounds at several multipliers.

    `bound` has the steps to the bound at one multiplier, with `valid` where it holds. `at_first` names the constant
    that is the result if no bound holds.
    """
    more = "bound > best" if at_first == "nothing_least" else "bound < best"
    routine = Routine(
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
    return Routine(name, meaning, TILTED_COLUMNS, (Call("told", routine, (*STANDING, 0)),), "told")


_QUOTIENT = """
    valid = inside and d_known
    d_most = d_l + e_d
    is_positive = {value} > 0
    under = is_positive ? {positive} : {negative}
    divisor = valid ? under : 1
    quotient = {value} / divisor
    size_quotient = abs quotient
"""
"""The steps to `quotient`, a bound of φ = F/d: `value` bounds F; `positive` or `negative`, by its sign, bounds d."""

_FACTOR = """
    usable_square = square_bound > 0
    square_or_0 = usable_square ? square_bound : 0
    factor = sqrt square_or_0
    rough = factor - 1
    factor_sizes = 1 + factor
    last_unsure = unsure_u * factor_sizes
"""
"""The steps from a bound of the square of a factor of size to `rough`, the clearance, and to its rounding error."""

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


ROUNDS = 96
LOOKS = 14
"""How many rounds a sweep has at most, and at how many times it looks ahead after them."""

NEVER, UNKNOWN = 2, 3
"""The results in place of a time that mean a sweep without contact, and "cannot say"."""

_LOOK_AT = sweeps.ROW

_STEP = """
    size = abs found
    same = found * start_found
    same_side = same > 0
    long_enough = size > shortest
    short_of_contact = size < contact_code
    known = same_side and long_enough
    goes_on = known and short_of_contact
    step = size - margin
    next_unbounded = now + step
    arrived = next_unbounded >= to_time
    before_end = not arrived
    at_end = goes_on and arrived
    moves = goes_on and before_end
    next = moves ? next_unbounded : now
    half = step / 2
    ahead_unbounded = next + half
    beyond_end = ahead_unbounded > to_time
    ahead_before = beyond_end ? to_time : ahead_unbounded
    ahead = moves ? ahead_before : next
"""
"""The steps of a round from `found`, LOOK's result at `now`, to `next`, up to which the sweep is proved clear, and to
`ahead`, half a step farther."""

_SEEN = """
    next_contact = next_found == contact_code
    next_product = next_found * start_found
    next_other = next_product < 0
    ahead_contact = ahead_found == contact_code
    ahead_product = ahead_found * start_found
    ahead_other = ahead_product < 0
    touches_next = next_contact or next_other
    touches_ahead = ahead_contact or ahead_other
    touches = touches_next or touches_ahead
    hit_seen = touches ? 1 : hit
    done_clear = at_end ? 2 : 1
    not_touching_next = not touches_next
    open_after = moves and not_touching_next
    state_new = open_after ? 0 : done_clear
    stops = state_new > 0
"""
"""The steps of a round from LOOK's results at `next` and `ahead` to `hit_seen`, 1 if contact is proved, and to
`state_new`: 0 goes on, 1 stops undecided, 2 has reached the end of the sweep."""

_SWEPT: tuple[Part, ...] = (
    Call("start_found", LOOK, (*_LOOK_AT, "from_time")),
    Call("end_found", LOOK, (*_LOOK_AT, "to_time")),
    *steps_of(
        """
        ends_product = start_found * end_found
        ends_differ = ends_product < 0
        start_contact = start_found == contact_code
        end_contact = end_found == contact_code
        one_contact = start_contact or end_contact
        hit_known = ends_differ or one_contact
        hit_0 = hit_known ? 1 : 0
        """
    ),
    Loop(
        ROUNDS,
        (
            ("now", "from_time", "next"),
            ("found", "start_found", "next_found"),
            ("hit", "hit_0", "hit_seen"),
            ("state", "zero", "state_new"),
        ),
        (
            *steps_of(_STEP),
            Call("next_found", LOOK, (*_LOOK_AT, "next")),
            Call("ahead_found", LOOK, (*_LOOK_AT, "ahead")),
            *steps_of(_SEEN),
        ),
        until="stops",
    ),
    *steps_of(
        """
        is_clear = state == 2
        is_hit = hit == 1
        settled = is_clear or is_hit
        stuck_hit = settled ? 1 : 0
        """
    ),
    Loop(
        LOOKS,
        (("hit_late", "stuck_hit", "hit_later"), ("distance", "shortest", "farther_on")),
        (
            *steps_of(
                """
                look_unbounded = now + distance
                look_beyond = look_unbounded > to_time
                look_time = look_beyond ? to_time : look_unbounded
                """
            ),
            Call("late_found", LOOK, (*_LOOK_AT, "look_time")),
            *steps_of(
                """
                late_contact = late_found == contact_code
                late_product = late_found * start_found
                late_other = late_product < 0
                late_touches = late_contact or late_other
                hit_later = late_touches ? 1 : hit_late
                farther_on = distance * 8
                late_hit = hit_later == 1
                late_stops = late_hit or look_beyond
                """
            ),
        ),
        until="late_stops",
    ),
    *steps_of(
        f"""
        any_hit = hit_late == 1
        told = any_hit ? now : {UNKNOWN}
        first = is_clear ? {NEVER} : told
        """
    ),
)

FIRST_OF_SWEEP = Routine(
    "first_of_sweep",
    f"A time up to which a sweep with contact is proved clear; {NEVER} without contact, {UNKNOWN} cannot say.",
    (*sweeps.ROW, "from_time", "to_time"),
    _SWEPT,
    "first",
    constants={"zero": 0.0, "contact_code": float(CONTACT), "shortest": 2.0**-46, "margin": 2.0**-49},
)
"""Asked between two times of the sweep. The result is a time only if a contact is proved, and NEVER only if every piece
is proved clear."""

SWEEP_COLUMNS = (*SIZES, *sweeps.START, *sweeps.END, *AXIS)
"""The columns of a sweep: those of geometry/pair.py, by names that no language has taken."""

FIRST = Routine(
    "first_of",
    FIRST_OF_SWEEP.meaning,
    SWEEP_COLUMNS,
    (Call("first", FIRST_OF_SWEEP, (*SWEEP_COLUMNS, 0, 0, 0, 0, 0, 1, 0, 1)),),
    "first",
)
