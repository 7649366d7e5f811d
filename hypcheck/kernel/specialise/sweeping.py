"""The routine of printed sweeps: up to when a sweep is proved clear, and whether it has contact.

From the start on, each round proves that the sweep is clear up to a time: that of the first root of a parabola below F.
There, and half as far ahead, it looks for a proof of contact, or that the spheroid is on the other side of the
hyperboloid: between unlike sides is contact. Rounds end where the end of the sweep is reached (no contact), or where a
step comes to nothing; then it looks ahead in steps that grow. Without a proof of either it cannot say.

Times are numbers of the format, exactly: SWEEP is asked about that very time. A step is shortened by 2⁻⁴⁹, as the sum
with the time is rounded, by 2⁻⁵² at most. So `now`, up to which the sweep is proved clear, bounds the first contact.
"""

from __future__ import annotations

from hypcheck.derivation.program import steps_of
from hypcheck.derivation.routines import Call, Loop, Part, Routine
from hypcheck.geometry.pair import AXIS, SIZES
from hypcheck.kernel.programs import sweeps
from hypcheck.kernel.specialise.looking import CONTACT, LOOK

ROUNDS = 96
LOOKS = 14

NEVER, UNKNOWN = 2, 3
"""What stands among times for a sweep without contact, and for "cannot say"."""

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
    at_end = goes_on and arrived
    moves = goes_on and next_unbounded_below
    next = moves ? next_unbounded : now
    half = step / 2
    ahead_unbounded = next + half
    beyond_end = ahead_unbounded > to_time
    ahead_before = beyond_end ? to_time : ahead_unbounded
    ahead = moves ? ahead_before : next
""".replace("next_unbounded_below\n", "before_end\n").replace(
    "    at_end =", "    before_end = not arrived\n    at_end ="
)

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
    open_after = moves and not_touching_next
    state_new = open_after ? 0 : done_clear
    stops = state_new > 0
""".replace("    open_after =", "    not_touching_next = not touches_next\n    open_after =")

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
"""Between two times of the sweep. A contact is proved before anything is said to be one; `first` is NEVER only where
every piece is proved clear."""

SWEEP_COLUMNS = (*SIZES, *sweeps.START, *sweeps.END, *AXIS)
"""The columns of a sweep: those of geometry/pair.py, by names that no language has taken."""

FIRST = Routine(
    "first_of",
    FIRST_OF_SWEEP.meaning,
    SWEEP_COLUMNS,
    (Call("first", FIRST_OF_SWEEP, (*SWEEP_COLUMNS, 0, 0, 0, 0, 0, 1, 0, 1)),),
    "first",
)
