"""Routines of a whole scene, for movers and hyperboloids of any axis: positions and sweeps, by a loop over a table.

A row of the table is a hyperboloid: sizes, centre, axis, the ends of its height and whether it is solid. Each one is
tested by LOOK or by the routine of sweeps, whose error bounds include the difference of the centres. Bounds decide what
the ends change:

- if the mover is beyond an end by more than its longer semi-axis, it is exterior;
- if it is between the ends by more than that, the ends do not matter;
- else what is exterior to the hyperboloid without ends is exterior; what is inside an open one is clear of it, interior
  or exterior by the height of its centre; and all else is left undecided.

A sweep is tested twice: once from the time when it comes near the heights to the time when it leaves them, where it may
be clear of the hyperboloid without ends, and once while it is between the ends, where contact is contact with the wall.

The level is how far a place C lies along the axis n of a hyperboloid with the centre c: n·(C − c)/|n|. Its error is at
most about 20u of the sizes of its terms. `loose` is 2⁻⁴⁵ = 128u of the sum of the sizes of all its terms, ends and
semi-axes too. It covers that error, the sums of ends and reach, and what the rounding of a time makes of a level: the
times of a window are quotients by a change of the level that is larger than `loose`.

The answers are combined as in kernel/scene.py: contact with any is contact, else inside any is interior, else exterior;
"cannot say" about one is "cannot say" unless another is in contact. Of a mover with parts only the mover itself is
tested: where it has contact, the caller must test its parts, and the answer is "cannot say".
"""

from __future__ import annotations

from collections.abc import Iterable
from sys import float_info

from hypcheck.derivation.program import steps_of
from hypcheck.derivation.routines import Call, Loop, Part, Routine, Table
from hypcheck.errors import InputError
from hypcheck.geometry.pair import AXIS, CENTER
from hypcheck.kernel.programs import sweeps
from hypcheck.kernel.specialise.sweeping import CONTACT, FIRST_OF_SWEEP, LOOK, NEVER, UNKNOWN
from hypcheck.scene.model import FREE, Hyperboloid, SceneModel

LOOSE = 2.0**-45
"""The share of the sizes of its terms by which a level may be off (above)."""

_COLUMNS = ("alpha", "gamma", *sweeps.WALL, *sweeps.WALL_AXIS, "z_min", "z_max", "solid")
"""The columns of the table of hyperboloids."""

_POSITION_OF = {"exterior": 1, "interior": -1, "contact": 0}
"""By question: the position that answers it with yes."""


def scene_columns(scene: SceneModel, *, sweep: bool) -> tuple[str, ...]:
    """Return the columns of a row: the mover's centre, or both ends of its sweep, and its axis if that is free."""
    places = (*sweeps.START, *sweeps.END) if sweep else CENTER
    return (*places, *(AXIS if scene.mover.axis == FREE else ()))


def _row(body: Hyperboloid) -> tuple[float, ...]:
    """Return a hyperboloid's row of the table. Without ends, they are the largest floats, and it counts as open."""
    span = (-float_info.max, float_info.max) if body.height is None else body.height.ends
    ends = (min(max(end, -float_info.max), float_info.max) for end in span)
    return (body.alpha, body.gamma, *body.center, *body.axis, *ends, 1.0 if body.solid and body.height else 0.0)


def _level(at: str) -> str:
    """Return the steps to the level of a place, and to the sum of the sizes of the place's coordinates."""
    sizes = "".join(f"\nsize_{at}_{k} = abs {at}_{k}" for k in "xyz")
    return (
        "".join(f"\nfrom_wall_{at}_{k} = {at}_{k} - wall_{k}" for k in "xyz")
        + sweeps.dot(f"raised_{at}", f"from_wall_{at}", "upward")
        + f"\nlevel_{at} = raised_{at} / upward_length"
        + sizes
        + f"\nsum_{at}_xy = size_{at}_x + size_{at}_y\nsum_{at} = sum_{at}_xy + size_{at}_z"
    )


_AXIS_SIZES = (
    "".join(f"\nsize_wall_axis_{k} = abs wall_axis_{k}\nsize_wall_{k} = abs wall_{k}" for k in "xyz")
    + """
length_xy = size_wall_axis_x + size_wall_axis_y
length = length_xy + size_wall_axis_z
sum_wall_xy = size_wall_x + size_wall_y
sum_wall = sum_wall_xy + size_wall_z
"""
    + "".join(f"\nupward_{k} = wall_axis_{k} / length" for k in "xyz")
    + sweeps.dot("upward_squares", "upward", "upward")
    + "\nupward_length = sqrt upward_squares"
)
"""The steps to the axis of a hyperboloid, about 1 long, and to the sum of the sizes of its centre's coordinates."""

_ENDS = """
no_lower = z_min < least_end
no_upper = z_max > greatest_end
lower_size = abs z_min
upper_size = abs z_max
lower_counts = no_lower ? 0 : lower_size
upper_counts = no_upper ? 0 : upper_size
ends_sum = lower_counts + upper_counts
outer_sum = places_sum + sum_wall
inner_sum = ends_sum + longest
whole_sum = outer_sum + inner_sum
loose = whole_sum * loose_share
reach = longest + loose
lowest_reach = lowest - reach
highest_reach = highest + reach
beyond_upper = lowest_reach > z_max
beyond_lower = highest_reach < z_min
beyond = beyond_upper or beyond_lower
above_lower = lowest_reach > z_min
below_upper = highest_reach < z_max
above_or_none = above_lower or no_lower
below_or_none = below_upper or no_upper
between = above_or_none and below_or_none
is_solid = solid > 0
is_open = not is_solid
"""
"""The steps from the lowest and highest level to whether the mover is, by its reach, beyond the ends or between."""

_OF_PLACE = """
places_sum = sum_place + sum_place
lowest = level_place + 0
highest = level_place + 0
"""
"""The steps to the least and greatest level of a mover at one place."""

_OF_SWEEP = """
places_sum = sum_start + sum_end
rises = level_start < level_end
lowest = rises ? level_start : level_end
highest = rises ? level_end : level_start
"""
"""The steps to the least and greatest level of the centre on a sweep."""


def _window(name: str, lower: str, upper: str, sign: tuple[str, str]) -> str:
    """Return the steps to the times `name`_from and `name`_to, between which the level lies within a window.

    The window is from `lower` to `upper`, each moved by the reach: outwards with the signs ("-", "+"), inwards with
    ("+", "-"). `name`_open says whether there is such a time.
    """
    return f"""
{name}_low = {lower} {sign[0]} reach
{name}_high = {upper} {sign[1]} reach
{name}_level_first = rises ? {name}_low : {name}_high
{name}_level_last = rises ? {name}_high : {name}_low
{name}_to_first = {name}_level_first - level_start
{name}_to_last = {name}_level_last - level_start
{name}_enters = {name}_to_first / divisor
{name}_leaves = {name}_to_last / divisor
{name}_enters_late = {name}_enters > 0
{name}_enters_0 = {name}_enters_late ? {name}_enters : 0
{name}_leaves_early = {name}_leaves < 1
{name}_leaves_1 = {name}_leaves_early ? {name}_leaves : 1
{name}_from = whole_time ? 0 : {name}_enters_0
{name}_to = whole_time ? 1 : {name}_leaves_1
{name}_open = {name}_from <= {name}_to
"""


_WINDOWS = (
    """
change = level_end - level_start
size_change = abs change
flat = size_change <= loose
whole_time = flat or between
divisor = whole_time ? 1 : change
"""
    + _window("outer", "z_min", "z_max", ("-", "+"))
    + _window("inner", "z_min", "z_max", ("+", "-"))
    + """
not_flat = not flat
inner_known = between or not_flat
inner_counts = inner_known and inner_open
never_there = not outer_open
"""
)
"""The steps to the times of a sweep between which it is near the heights, and between which it is between the ends."""

_ONE_POSITION = f"""
is_exterior_raw = found > 0
is_contact_raw = found == {CONTACT}
is_interior = found < 0
not_contact = not is_contact_raw
is_exterior_whole = is_exterior_raw and not_contact
is_exterior = beyond or is_exterior_whole
not_beyond = not beyond
stands = between and not_beyond
contact_here = is_contact_raw and stands
centre_low = lowest - loose
centre_high = lowest + loose
centre_above = centre_low > z_min
centre_below = centre_high < z_max
centre_above_or_none = centre_above or no_lower
centre_below_or_none = centre_below or no_upper
centre_between = centre_above_or_none and centre_below_or_none
centre_under = centre_high < z_min
centre_over = centre_low > z_max
centre_beyond = centre_under or centre_over
inside_open = is_interior and is_open
inside_between = inside_open and centre_between
inside_stands = is_interior and stands
inside_any = inside_between or inside_stands
inside_here = inside_any and not_beyond
inside_beyond = inside_open and centre_beyond
exterior_here = is_exterior or inside_beyond
known_clear = exterior_here or inside_here
known = known_clear or contact_here
touching_now = contact_here ? 1 : touching
inside_now = inside_here ? 1 : inside
unknown_now = known ? unknown : 1
"""
"""The steps from LOOK's result about one hyperboloid to what is kept: touching, inside, unknown."""

_ONE_SWEEP = f"""
whole_never = first == {NEVER}
whole_hit = first <= 1
inner_hit = inner_first <= 1
start_outside = side > 0
clear_beside = start_outside or is_open
clear_where_stands = between or clear_beside
never_here = whole_never and clear_where_stands
absent = beyond or never_there
clear_here = absent or never_here
hit_within = inner_hit and inner_counts
present = not absent
hit_here = hit_within and present
clear_until = whole_hit and clear_where_stands
time_here = clear_until ? first : outer_from
earlier = time_here < earliest
hit_earlier = hit_here and earlier
earliest_now = hit_earlier ? time_here : earliest
known = clear_here or hit_here
unknown_now = known ? unknown : 1
"""
"""The steps from the times of first contact with one hyperboloid to what is kept: the earliest time, unknown."""


def _arguments(*, sweep: bool) -> tuple[str | int, ...]:
    """Return the arguments of LOOK or FIRST_OF_SWEEP, without the times."""
    places = (*sweeps.START, *sweeps.END) if sweep else (*CENTER, *CENTER)
    return ("alpha", "gamma", "b", "d", *places, *AXIS, *sweeps.WALL, *sweeps.WALL_AXIS)


def _constants(scene: SceneModel) -> dict[str, float]:
    """Return the numbers that all rounds of the loop read: the mover's sizes, its axis unless free, and limits."""
    mover = scene.mover
    axis = {} if mover.axis == FREE else dict(zip(AXIS, mover.axis, strict=True))
    ends = {"least_end": -float_info.max / 2, "greatest_end": float_info.max / 2}
    sizes = {"b": mover.b, "d": mover.d, "longest": max(mover.b, mover.d) * (1 + 2.0**-40)}
    return {**sizes, **axis, **ends, "zero": 0.0, "never": float(NEVER), "loose_share": LOOSE}


def _over(bodies: Iterable[Hyperboloid], kept: tuple[tuple[str, str, str], ...], body: tuple[Part, ...]) -> Loop:
    """Return the loop over the hyperboloids. Raises InputError if there is none."""
    rows = tuple(map(_row, bodies))
    if not rows:
        raise InputError("no kernel is made: the scene has no hyperboloid")
    return Loop(len(rows), kept, body, table=Table("hyperboloids", _COLUMNS, rows))


def position_routine(scene: SceneModel) -> Routine:
    """Return the routine that computes the mover's position in the scene, or the answer to the scene's question.

    2 means "cannot say". Raises InputError if the scene has no hyperboloid.
    """
    body: tuple[Part, ...] = (
        *steps_of(_AXIS_SIZES + _level("place") + _OF_PLACE + _ENDS),
        Call("found", LOOK, (*_arguments(sweep=False), 0)),
        *steps_of(_ONE_POSITION),
    )
    kept = (("touching", "zero", "touching_now"), ("inside", "zero", "inside_now"), ("unknown", "zero", "unknown_now"))
    contact = 2 if scene.mover.parts else 0
    yes = _POSITION_OF.get(scene.question)
    end = f"""
    is_touching = touching > 0
    is_unknown = unknown > 0
    is_inside = inside > 0
    clear = is_inside ? -1 : 1
    clear_or_2 = is_unknown ? 2 : clear
    position = is_touching ? {contact} : clear_or_2
    """
    if yes is not None:
        end += f"""
    is_2 = position == 2
    is_yes = position == {yes}
    truth = is_yes ? 1 : 0
    answer = is_2 ? 2 : truth
    """
    return Routine(
        "position_in_scene",
        "The answer about the mover in the scene, each proved; 2 cannot say.",
        scene_columns(scene, sweep=False),
        (
            *steps_of("".join(f"place_{k} = {k} + 0\n" for k in "xyz")),
            _over(scene.hyperboloids, kept, body),
            *steps_of(end),
        ),
        "position" if yes is None else "answer",
        constants=_constants(scene),
    )


def sweep_routine(scene: SceneModel) -> Routine:
    """Return the routine that finds the first contact of a sweep in the scene, as FIRST_OF_SWEEP does for one body.

    Raises InputError if the scene has no hyperboloid.
    """
    arguments = _arguments(sweep=True)
    body: tuple[Part, ...] = (
        *steps_of(_AXIS_SIZES + _level("start") + _level("end") + _OF_SWEEP + _ENDS + _WINDOWS),
        Call("first", FIRST_OF_SWEEP, (*arguments, "outer_from", "outer_to")),
        Call("inner_first", FIRST_OF_SWEEP, (*arguments, "inner_from", "inner_to")),
        Call("side", LOOK, (*arguments, "outer_from")),
        *steps_of(_ONE_SWEEP),
    )
    kept = (("earliest", "never", "earliest_now"), ("unknown", "zero", "unknown_now"))
    contact = f"{UNKNOWN}" if scene.mover.parts else "time"
    end = f"""
    is_unknown = unknown > 0
    is_hit = earliest <= 1
    time = is_unknown ? 0 : earliest
    clear = is_unknown ? {UNKNOWN} : {NEVER}
    told = is_hit ? {contact} : clear
    """
    return Routine(
        "first_in_scene",
        FIRST_OF_SWEEP.meaning,
        scene_columns(scene, sweep=True),
        (_over(scene.hyperboloids, kept, body), *steps_of(end)),
        "told",
        constants=_constants(scene),
    )
