"""The last stage of a kernel for a tilted spheroid: the dual function in double-double, and what it proves.

**The frame.** With v the spheroid's axis, lengths in units of b, and p, s, t the squares of α/b, γ/b, d/b, the matrices
of both bodies are diagonal in three directions, which are the frame: e′ across the plane of the two axes, and two
within it. The dual function φ has the poles −A1, −A2 and B. A1 = p, and A2 and B follow from l² − 2 q1 l − p s/t = 0:
with h and c the squares of the sine and cosine of the axis' angle from the vertical,
q1 = (s (t h + c) − p (t c + h))/(2t), root² = q1² + p s/t, B = q1 + root, A2 = root − q1. The components of the centre
C are linear: c1 = e′·C, c2 = r2·C, c3 = r3·C with

    r2 = f2 (m/p e + off/s e_z),   m = (t h + c)/t + A2/s,   f2² = A2 p s/(2 root m)
    r3 = f3 (off/p e + n/s e_z),   n = (t c + h)/t + B/p,    f3² = B p s/(2 root n)

where e is the horizontal direction of v, e_z the vertical one, and off = (1 − t)/t times the sine and cosine of the
angle. Each of r2 and r3 is the null vector of M + λD at a pole (M and D are the matrices of the spheroid and of the
hyperboloid), scaled to length 1 by its own eigenvalue equation, so that only q1 and 1 − t are differences. An upright
axis has no e; any horizontal direction will do. FRAME is that program. Then (../../../docs/mathematics.md, "General
position")

    φ(λ) = λ (c1²/(A1+λ) + c2²/(A2+λ) − c3²/(B−λ)) − 1 − λ,   concave between −min(A1, A2) and B,

and a spheroid with b and d times k is clear if and only if φ is above k² − 1 somewhere: at λ > 0 it is then exterior,
at λ < 0 interior.

**Double-double.** A number is the sum of two doubles; sums, products, quotients and roots of these are within 16 u² of
the exact ones, u = 2⁻⁵³ (Joldes, Muller and Popescu, ACM TOMS 44, 2017: 3 u² for sums, 8 u² for products, 15 u² for
quotients; the root is one step of Newton's method, whose own error is the square of half a unit, after a product).

OMEGA bounds the relative error of each number of a frame, and of all operations of COMPONENTS and PHI together. A value
passes at most 12 of these operations: 2⁻⁹⁸. The frame of a fixed axis is computed in rational numbers, and only
rounded: 2⁻⁹⁶. The frame of a free axis passes 40 operations, 40·2⁻¹⁰² < 2⁻⁹⁶, and only its q1 may cancel. Where it
does, s (t h + c) and p (t c + h) are within a factor of 2 of each other, and so their sum is at most 2.2 root times
(d/b + b/d)/2 times t: the error of root, A2 and B is 2.2·2¹² times that of the terms at most, as d/b lies in 2^±12. So
2⁻⁸².

**What proves.** A search finds λ; no proof rests on λ being the best. E = 4 OMEGA (|x|+|y|+|z|) most is above the error
of each component, `most` being above every number of the three rows. At λ, as computed and exact by definition, each
distance to a pole is known within 2 OMEGA (A + |λ|), hence φ within `error` (DECISION; its leading 2 covers the
rounding of the error itself, E² and second order). Then

    φ > error        is exterior where λ > 0 and interior where λ < 0: this answer is never wrong;
    φ + error + (slope at λ)·(distance to the maximum) < 2u   is contact for b and d changed by u at most, since a
                     concave function lies below its tangents. The maximum is nearer than a step where the slope has
                     changed its sign there, and else nearer than the pole.

The slope φ′ = A1 c1²/(A1+λ)² + A2 c2²/(A2+λ)² − B c3²/(B−λ)² − 1 is taken in doubles between bounds: components E
larger or smaller, and each side moved by 2⁻⁴⁸, where it rounds 12 times at most. The step is one at which it changes by
more than its bounds are apart, and so small that the tangent gains nothing by it. Where neither holds, the answer is
"cannot say"; so it is where a number left the format, as no comparison holds for NaN.

**Range.** p and s in 2^±40, t in 2^±24, b in 2^±60 and the centre within 2⁴⁰ b: no product leaves float64. What
underflows, in the axis or in the centre, changes a component by less than LOST.
"""

from __future__ import annotations

from fractions import Fraction

from hypcheck.derivation.program import program_of

SIZE_NAMES = ("A1", "s", "t", "b")
"""The numbers from which the frame of a free axis is computed, beside the axis: p, s, t and b."""

ROWS = ("r1x", "r1y", "r2x", "r2y", "r2z", "r3x", "r3y", "r3z")
POLES = ("A1", "A2", "B", "least", "gap1", "gap2")
FRAME_NAMES = (*ROWS, *POLES)
"""The numbers of a frame: the rows r1, r2, r3 divided by b, the poles A1, A2, B, the lesser of A1 and A2 (`least`), and
how far A1 and A2 are above it (gap1, gap2)."""

FRAME = program_of(
    "frame",
    ("hx", "hy", "vx", "vy", "vz", *SIZE_NAMES),
    """
    hh = hx * hx
    kk = hy * hy
    level = hh + kk
    length = sqrt level
    ex = hx / length
    ey = hy / length
    xx = vx * vx
    yy = vy * vy
    flat = xx + yy
    zz = vz * vz
    w = flat + zz
    sine_squared = flat / w
    cosine_squared = zz / w
    tilt_x = vx * ex
    tilt_y = vy * ey
    tilt = tilt_x + tilt_y
    tilt_z = tilt * vz
    both = tilt_z / w
    t_sine = t * sine_squared
    along = t_sine + cosine_squared
    t_cosine = t * cosine_squared
    across = t_cosine + sine_squared
    one_t = 1 - t
    stretch = one_t / t
    off = stretch * both
    s_along = s * along
    p_across = A1 * across
    twice_t = 2 * t
    difference = s_along - p_across
    q1 = difference / twice_t
    ps = A1 * s
    q0 = ps / t
    q1q1 = q1 * q1
    root_squared = q1q1 + q0
    root = sqrt root_squared
    size_q1 = abs q1
    larger = size_q1 + root
    smaller = q0 / larger
    rises = q1 > 0
    B = rises ? larger : smaller
    A2 = rises ? smaller : larger
    second = A2 < A1
    least = second ? A2 : A1
    gap1 = A1 - least
    gap2 = A2 - least
    twice_root = 2 * root
    along_t = along / t
    A2_s = A2 / s
    m = along_t + A2_s
    across_t = across / t
    B_p = B / A1
    n = across_t + B_p
    A2_ps = A2 * ps
    root_m = twice_root * m
    f2_squared = A2_ps / root_m
    f2 = sqrt f2_squared
    B_ps = B * ps
    root_n = twice_root * n
    f3_squared = B_ps / root_n
    f3 = sqrt f3_squared
    r1y = ex / b
    ey_b = ey / b
    m_p = m / A1
    r2e = f2 * m_p
    off_s = off / s
    r2u = f2 * off_s
    off_p = off / A1
    r3e = f3 * off_p
    n_s = n / s
    r3u = f3 * n_s
    r1x = - ey_b
    r2x = r2e * r1y
    r2y = r2e * ey_b
    r2z = r2u / b
    r3x = r3e * r1y
    r3y = r3e * ey_b
    r3z = r3u / b
    """,
)
"""The program from an axis (vx, vy, vz), its horizontal direction (hx, hy), A1 = p, s, t and b to the frame."""

COMPONENTS = program_of(
    "components",
    ("x", "y", "z", *ROWS),
    """
    x1 = r1x * x
    y1 = r1y * y
    c1 = x1 + y1
    x2 = r2x * x
    y2 = r2y * y
    xy2 = x2 + y2
    z2 = r2z * z
    c2 = xy2 + z2
    x3 = r3x * x
    y3 = r3y * y
    xy3 = x3 + y3
    z3 = r3z * z
    c3 = xy3 + z3
    """,
)
"""The program from the centre and the rows of a frame to the components c1, c2, c3 of the centre."""

PHI = program_of(
    "phi",
    ("c1", "c2", "c3", "A1", "A2", "B", "lambda_"),
    """
    to_a1 = A1 + lambda_
    to_a2 = A2 + lambda_
    to_b = B - lambda_
    P1 = c1 * c1
    P2 = c2 * c2
    Q = c3 * c3
    part_1 = P1 / to_a1
    part_2 = P2 / to_a2
    part_3 = Q / to_b
    gains = part_1 + part_2
    parts = gains - part_3
    terms = lambda_ * parts
    one_lambda = 1 + lambda_
    phi = terms - one_lambda
    """,
)
"""The program from the components, the poles and λ to φ and to the distances from the poles."""


_SIDES = ((1, "a1", "A1"), (2, "a2", "A2"), (3, "b", "B"))
"""Of each term of φ: its number, the end of the name of the distance to its pole, and the name of the pole."""

FALLS = program_of(
    "falls",
    ("c1", "c2", "c3", "A1", "A2", "B", "to_a1", "to_a2", "to_b"),
    *(
        f"share_{i} = c{i} / to_{to}\n square_{i} = share_{i} * share_{i}\n slope_{i} = {pole} * square_{i}"
        for i, to, pole in _SIDES
    ),
    "gain = slope_1 + slope_2\n loss = slope_3 + 1\n past = gain <= loss",
)
"""The program that computes in doubles whether φ′ ≤ 0 at these distances to the poles."""

FROM_POLE = """
    is_near_zero = near_zero > 0
    is_inside = inside > 0
    complement = pole - distance
    to_pole = is_near_zero ? complement : distance
    from_zero = is_near_zero ? distance : complement
"""
"""The steps from `distance`, to 0 (near_zero = 1) or to the pole (near_zero = 0), to both distances."""

PLACE = program_of(
    "place",
    ("A1", "A2", "B", "gap1", "gap2", "pole", "distance", "near_zero", "inside"),
    FROM_POLE,
    """
    outside_a1 = A1 + from_zero
    inside_a1 = gap1 + to_pole
    to_a1 = is_inside ? inside_a1 : outside_a1
    outside_a2 = A2 + from_zero
    inside_a2 = gap2 + to_pole
    to_a2 = is_inside ? inside_a2 : outside_a2
    inside_b = B + from_zero
    to_b = is_inside ? inside_b : to_pole
    """,
)
"""The program from `distance`, to 0 (near_zero = 1) or to the pole (0), to the distances to all poles, in doubles.

λ itself is a step of last_stages.PLACE, in double-double."""

OMEGA = {"fixed": 2.0**-96, "free": 2.0**-82}
"""The bound of the relative errors, for a fixed axis and for a free one (above)."""

LOST = 2.0**-400
"""More than a component of the centre can change by underflow (Range, above)."""

DECISION_CONSTANTS = {
    "lost": LOST,
    "more": 1 + 2.0**-48,
    "less": 1 - 2.0**-48,
    "granted": 1.5 * 2.0**-53,
}
"""`granted` is below 2u."""


def _slopes(end: str, shift: str) -> str:
    """Return the steps to bounds of both sides of φ′, gain and loss, at λ moved by a step.

    `shift` is "+" for a step up, "-" for a step down, and "" for no step. `end` ends the names of the steps.
    """
    text = ""
    for i, to, pole in _SIDES:
        moved = f"to_{to}"
        if shift:
            sign = shift if i < 3 else {"+": "-", "-": "+"}[shift]
            moved = f"moved_{to}{end}"
            text += f"{moved} = to_{to} {sign} step{end}\n"
        for bound in ("low", "high"):
            text += (
                f"{bound}_share_{i}{end} = {bound}_{i} / {moved}\n"
                f"{bound}_square_{i}{end} = {bound}_share_{i}{end} * {bound}_share_{i}{end}\n"
                f"{bound}_slope_{i}{end} = {pole} * {bound}_square_{i}{end}\n"
            )
    for bound, moved in (("low", "less"), ("high", "more")):
        text += (
            f"{bound}_sum{end} = {bound}_slope_1{end} + {bound}_slope_2{end}\n"
            f"{bound}_gain{end} = {moved} * {bound}_sum{end}\n"
            f"{bound}_side{end} = {bound}_slope_3{end} + 1\n"
            f"{bound}_loss{end} = {moved} * {bound}_side{end}\n"
        )
    return text


def _errors() -> str:
    """Return the steps to bounds of each component's size, and to the error of its term of φ."""
    return "".join(
        f"""
        size_{i} = abs c{i}
        high_{i} = size_{i} + E
        under_{i} = size_{i} - E
        is_sure_{i} = under_{i} > 0
        low_{i} = is_sure_{i} ? under_{i} : 0
        twice_{i} = size_{i} + high_{i}
        of_component_{i} = twice_{i} * E
        reach_{i} = {pole} + size_l
        times_{i} = reach_{i} / to_{to}
        part_{i} = size_{i} * size_{i}
        times_part_{i} = times_{i} * part_{i}
        of_pole_{i} = four_omega * times_part_{i}
        of_both_{i} = of_component_{i} + of_pole_{i}
        weight_{i} = size_l / to_{to}
        error_{i} = weight_{i} * of_both_{i}
        """
        for i, to, pole in _SIDES
    )


DECISION = program_of(
    "decision",
    (
        *("x", "y", "z", "most", "omega", "c1", "c2", "c3", "A1", "A2", "B", "lambda_", "to_a1", "to_a2", "to_b"),
        *("phi", *DECISION_CONSTANTS),
    ),
    """
    size_x = abs x
    size_y = abs y
    size_z = abs z
    size_xy = size_x + size_y
    far = size_xy + size_z
    four_omega = 4 * omega
    most_omega = most * four_omega
    E_seen = far * most_omega
    E = E_seen + lost
    size_l = abs lambda_
    """,
    _errors(),
    """
    one_l = 1 + size_l
    error_l = four_omega * one_l
    errors_12 = error_1 + error_2
    errors_123 = errors_12 + error_3
    errors = errors_123 + error_l
    error = 2 * errors
    clear = phi > error
    """,
    _slopes("", ""),
    """
    a1_is_nearer = to_a1 < to_a2
    to_a = a1_is_nearer ? to_a1 : to_a2
    bend_1 = low_slope_1 / to_a1
    bend_2 = low_slope_2 / to_a2
    bend_3 = low_slope_3 / to_b
    bend_12 = bend_1 + bend_2
    bend_123 = bend_12 + bend_3
    bend = bend_123 + lost
    gain_spread = high_gain - low_gain
    loss_spread = high_loss - low_loss
    spread = gain_spread + loss_spread
    much_spread = 16 * spread
    step = much_spread / bend
    half_a = to_a / 2
    half_b = to_b / 2
    is_before_a = step < half_a
    is_before_b = step < half_b
    step_left = is_before_a ? step : half_a
    step_right = is_before_b ? step : half_b
    """,
    _slopes("_right", "+"),
    _slopes("_left", "-"),
    """
    turns_right = high_gain_right < low_loss_right
    turns_left = high_loss_left < low_gain_left
    right = turns_right ? step_right : to_b
    left = turns_left ? step_left : to_a
    rise = high_gain - low_loss
    fall = high_loss - low_gain
    more_right = rise * right
    more_left = fall * left
    room_seen = granted - phi
    room = room_seen - error
    half_room = room / 2
    has_room = room > 0
    right_fits = more_right < half_room
    left_fits = more_left < half_room
    both_fit = right_fits and left_fits
    contact = both_fit and has_room
    """,
)
"""The program, in doubles, from the numbers computed at λ to `clear` and `contact`; if neither holds: "cannot say"."""

BOUND_U = Fraction(1)
"""By so many units u b and d may have to change for an answer "contact" to be right."""

GEOMETRIC_STEPS, ARITHMETIC_STEPS = 8, 46
"""First the exponent of the distance is halved, until 62 octaves are a quarter of an octave; then the distance."""

START = 2.0**-62
"""The least distance to 0 or to a pole at which the search looks, as a share of the pole."""
