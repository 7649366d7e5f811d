"""The programs of printed sweeps: what any multiplier proves at a time of a sweep, however both bodies are tilted.

The centre of the spheroid is C(s) = start + s V − c at the time s, V = end − start, c the centre of the hyperboloid.
n and v are vectors along the axes of the hyperboloid and of the spheroid; lengths are in units of b. A multiplier is an
argument l of the dual function φ. As in tilted.py, F = φ d with

    F = l N − (1 + l) d,   N = l E + (p + l)(G − l m),   d = (p + l) k,   k = k0 + l k1 − t l²,

Here no frame is turned, since F depends on the directions only by

    E = (t − 1)(s + p) ((n × v)·C)²/(n² v²),   G = s |n × C|²/n² − p (n·C)²/n²,   m = t C² − (t − 1)(v·C)²/v²,
    h = |n × v|²/(n² v²),   c = (n·v)²/(n² v²)        (the squares of sine and cosine between the axes).

So N is a quadratic form of the centre, and d does not depend on the centre. **A piece of a sweep.** For one l, and
exactly,

    F(s + r) = F + 2 r l N(C, V) + r² l N(V, V),

N(·, ·) being the form's symmetric bilinear one. Where l lies between the poles, F > 0 proves the side of l: take a
parabola that is nowhere above this one; the piece of the sweep up to its first root is proved to be clear. **A time of
contact** is proved by the tangent of φ, as in tilted.py: φ < 0, and the tangent stays below 0 both up to B and down to
−min(A1, A2). These poles are at most k/(t l) away, for l > 0, as k = t (B − l)(A2 + l), and p + l. Else B ≤ s (t h +
c)/t, and the magnitude of s (t h + c), a sum without cancellation, is not below that.

**Clearance.** The spheroid made f times as large is clear if and only if φ > f² − 1 somewhere (docs/mathematics.md).
So if f is the factor at which it touches, f² − 1 is the maximum of φ: not below any φ(l), and not above a tangent.

Bounds (u = 2⁻⁵², which covers every rounding mode). derivation/rounding.py counts the rounding factors of what is
bounded and makes the magnitudes M, from the numbers of the row on: the differences of centres and the product with the
time are steps like all others. Each value is within (count + 3) u·SLACK of M, F within (count + 4): one unit for the
second order, two for underflow; F has another for what slope and bend lose to F(s + r) by underflow, r being ≤ 1.

Range. The program tests that b is in 2^±300, p, s, t in 2^±54, the magnitudes of C²/b² and V²/b² below 2¹⁰⁸, n² and v²
in 2^±50 after the division by LENGTHS, so that n² v² is in 2^±100 as v² alone is in tilted.py, and |l| < 2⁶⁰. What a
component of an axis loses that underflows there is 2⁻¹⁰²¹ beside 2⁻²⁵. Then all that tilted.py says of overflow and
underflow holds. Magnitudes are sums of positive numbers: where a coordinate overflows they are not below their limit in
any rounding mode.

ROOT computes a number below the first root of here + 2 slope r + bend r², here > 0: here/(√D − slope), D = slope² −
here·bend. D is off by 3u of its terms' sizes, hence 4u; what underflows in D is below 2⁻¹⁰²⁰, so 2⁻⁵⁰⁰ covers its root,
and `here` is asked to be above 2⁻⁴⁰². Where D < 0, or √D ≤ slope, there is no root after 0.
"""

from __future__ import annotations

from functools import cache

from hypcheck.derivation.program import program_of
from hypcheck.derivation.rounding import ErrorCounts, relative_error_counts
from hypcheck.geometry.pair import AXIS, SIZES
from hypcheck.kernel.programs import tilted
from hypcheck.kernel.programs.certified import SLACK, U

START, END = ("start_x", "start_y", "start_z"), ("end_x", "end_y", "end_z")
WALL = ("wall_x", "wall_y", "wall_z")
WALL_AXIS = ("wall_axis_x", "wall_axis_y", "wall_axis_z")
ROW = (*SIZES, *START, *END, *AXIS, *WALL, *WALL_AXIS)
LENGTHS = ("axis_size", "wall_axis_size")
"""ROW has the columns of a spheroid's sweep beside a hyperboloid anywhere: sizes, both ends of the sweep, the
spheroid's axis, the hyperboloid's centre and axis. LENGTHS are numbers by which the axes are divided, so that neither
is too long or too short; any numbers > 0 are right."""

_SIZES = f"""
    {tilted.SQUARES}
    t_1 = t - 1
    s_p = s + p
    t_1_s_p = t_1 * s_p
    k0 = p * s
"""

_PLACES = "".join(
    f"""
    change_{k} = end_{k} - start_{k}
    moved_{k} = at * change_{k}
    place_{k} = start_{k} + moved_{k}
    off_{k} = place_{k} - wall_{k}
    here_{k} = off_{k} * r
    along_{k} = change_{k} * r
"""
    for k in "xyz"
)


def dot(name: str, left: str, right: str) -> str:
    """Return the steps to the scalar product of two vectors, the names of whose components end with _x, _y and _z."""
    return f"""
    {name}_x = {left}_x * {right}_x
    {name}_y = {left}_y * {right}_y
    {name}_z = {left}_z * {right}_z
    {name}_xy = {name}_x + {name}_y
    {name} = {name}_xy + {name}_z
"""


def _cross(name: str, left: str, right: str) -> str:
    """Return the steps to the vector product of two vectors."""
    steps = ""
    for k, i, j in (("x", "y", "z"), ("y", "z", "x"), ("z", "x", "y")):
        steps += f"""
    {name}_{i}{j} = {left}_{i} * {right}_{j}
    {name}_{j}{i} = {left}_{j} * {right}_{i}
    {name}_{k} = {name}_{i}{j} - {name}_{j}{i}
"""
    return steps


def _linear(of: str) -> str:
    """Return the steps to the linear functions of a vector: across and along n, along v, and along n × v."""
    return (
        _cross(f"across_{of}", "n", of)
        + dot(f"level_{of}", "n", of)
        + dot(f"axial_{of}", "v", of)
        + dot(f"mixed_{of}", "both", of)
    )


def _form(tag: str, left: str, right: str) -> str:
    """Return the steps to E, G and m of two vectors; their names end with the tag."""
    return f"""
    {dot(f"circle{tag}", f"across_{left}", f"across_{right}")}
    radius{tag} = circle{tag} / nn
    levels{tag} = level_{left} * level_{right}
    height{tag} = levels{tag} / nn
    s_radius{tag} = s * radius{tag}
    p_height{tag} = p * height{tag}
    G{tag} = s_radius{tag} - p_height{tag}
    mixed{tag} = mixed_{left} * mixed_{right}
    cross_part{tag} = mixed{tag} / nnvv
    E{tag} = t_1_s_p * cross_part{tag}
    {dot(f"distance{tag}", left, right)}
    axials{tag} = axial_{left} * axial_{right}
    axis_part{tag} = axials{tag} / vv
    t_distance{tag} = t * distance{tag}
    t_1_axis{tag} = t_1 * axis_part{tag}
    m{tag} = t_distance{tag} - t_1_axis{tag}
"""


_DIRECTIONS = f"""
    n_x = wall_axis_x / wall_axis_size
    n_y = wall_axis_y / wall_axis_size
    n_z = wall_axis_z / wall_axis_size
    v_x = axis_x / axis_size
    v_y = axis_y / axis_size
    v_z = axis_z / axis_size
    {dot("nn", "n", "n")}
    {dot("vv", "v", "v")}
    nnvv = nn * vv
    {_cross("both", "n", "v")}
    {dot("sines", "both", "both")}
    h = sines / nnvv
    {dot("cosine", "n", "v")}
    cosines = cosine * cosine
    c = cosines / nnvv
    {tilted.K1}
"""


def _at_slope(tag: str, name: str) -> str:
    """Return the steps to l N, called `name`, from the E, G and m with this tag."""
    return f"""
    m_l{tag} = m{tag} * l
    g{tag} = G{tag} - m_l{tag}
    E_l{tag} = E{tag} * l
    p_l_g{tag} = p_l * g{tag}
    N{tag} = E_l{tag} + p_l_g{tag}
    {name} = l * N{tag}
"""


_PLACE = (_SIZES, _PLACES, _DIRECTIONS, _linear("here"), _form("", "here", "here"))

PLACE = program_of("place", (*ROW, *LENGTHS, "at"), *_PLACE)
"""The program from a sweep and a time `at` to the terms of F there."""

VALUES = program_of(
    "sweep-values",
    (*ROW, *LENGTHS, "at", "l"),
    *_PLACE,
    tilted.AT_MULTIPLIER,
    _linear("along"),
    _form("_1", "here", "along"),
    _form("_2", "along", "along"),
    _at_slope("_1", "F_slope"),
    _at_slope("_2", "F_bend"),
)
"""The program from a sweep, a time and l to F, d, k, p + l, psi, and to the slope and bend of F along the sweep."""

BOUNDED = {**tilted.BOUNDED, "F_slope": "e_slope", "F_bend": "e_bend"}
"""The names whose errors are bounded, each with the name of its bound."""


@cache
def counted() -> ErrorCounts:
    """Count the rounding factors of the bounded values, and make their magnitudes."""
    return relative_error_counts(VALUES, (*BOUNDED, "distance", "distance_2", "s_along"), positive=(*SIZES, *LENGTHS))


COUNTS = {name: counted().counts[name] for name in BOUNDED}
SPARE = dict.fromkeys(BOUNDED, 3) | {"F": 4}
"""Of each bounded value, the count of its rounding factors, and the units that its bound has beyond that."""

CONSTANTS = {
    **{f"u_{name}": (COUNTS[name] + SPARE[name]) * U * SLACK for name in BOUNDED},
    "less_sure": 1 - 2.0**-20,
    "least_b": 2.0**-300,
    "greatest_b": 2.0**300,
    "least_square": 2.0**-54,
    "greatest_square": 2.0**54,
    "farthest_square": 2.0**108,
    "least_axis": 2.0**-50,
    "greatest_axis": 2.0**50,
    "greatest_l": 2.0**60,
}
"""The inputs of SWEEP beside the sweep, the time and l, by name."""

_NEAR = """
    place_near = magnitude_distance < farthest_square
    change_near = magnitude_distance_2 < farthest_square
"""

_JOINED = """
    axes_usable = vv_usable and nn_usable
    sweep_usable = place_near and change_near
"""

_DECISION = f"""
    {tilted.in_range(("vv", "nn"), _NEAR, _JOINED, "axes_usable", "sweep_usable")}
    here = F - e_F
    phi_positive = here > 0
    {tilted.SIDES}
    d_known = d_least > 0
    room = minus_F_least * d_least
    room_least = less_sure * room
    B_most = magnitude_s_along / t
    k_most = k + e_k
    t_l_or_t = on_side_of_B ? t_l : t
    to_B_by_k = k_most / t_l_or_t
    nearer_by_k = to_B_by_k < B_most
    to_B_near = nearer_by_k ? to_B_by_k : B_most
    size_l_B = size_l + B_most
    to_B = on_side_of_B ? to_B_near : size_l_B
    to_A = p_l + e_pl
    rising = psi + e_psi
    falling = e_psi - psi
    rise_to_B = rising * to_B
    rise_to_A = falling * to_A
    A_more = rise_to_A > rise_to_B
    slope_most = A_more ? rise_to_A : rise_to_B
    below_tangent = slope_most < room_least
    below = below_tangent and phi_negative
    inside_below = below and inside
    contact = inside_below and d_known
    slope = F_slope - e_slope
    bend = F_bend - e_bend
"""


SWEEP = tilted.certificate("sweep", VALUES, (*ROW, *LENGTHS, "at", "l", *CONSTANTS), counted(), BOUNDED, _DECISION)
"""The program from a sweep, a time, any l and CONSTANTS to `exterior`, `interior` and `contact` there, each proved
where it holds, and to here, slope, bend: the parabola here + 2 slope r + bend r², which is below F from that time
on."""

ROOT_CONSTANTS = {
    "u_4": 4 * U * SLACK,
    "more": 1 + 8 * U * SLACK,
    "less": 1 - 8 * U * SLACK,
    "least_root": 2.0**-500,
    "least_here": 2.0**-402,
}

ROOT = program_of(
    "root",
    ("here", "slope", "bend", *ROOT_CONSTANTS),
    """
    slope_squared = slope * slope
    product = here * bend
    size_product = abs product
    difference = slope_squared - product
    terms = slope_squared + size_product
    unsure = u_4 * terms
    most = difference + unsure
    no_root = most < 0
    most_or_0 = no_root ? 0 : most
    rough = sqrt most_or_0
    rough_more = more * rough
    root_most = rough_more + least_root
    bottom = root_most - slope
    twice_bottom = 2 * bottom
    rises = bottom <= 0
    far = here >= twice_bottom
    never = no_root or rises
    beyond = never or far
    divisor = rises ? 1 : bottom
    ratio = here / divisor
    ratio_less = less * ratio
    large_enough = here > least_here
    reach_before = beyond ? 2 : ratio_less
    reach = large_enough ? reach_before : 0
""",
)
"""The program from a parabola to `reach`, how far it is proved to stay above 0: 2 if it has no root before 2, 0 if
nothing is proved."""
