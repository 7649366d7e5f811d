"""Makes the plan from which kernels are emitted: the stages that a scene needs, and what it can omit."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fractions import Fraction
from sys import float_info
from typing import Literal

import numpy as np

from hypcheck.derivation.evaluation import evaluate, outputs
from hypcheck.derivation.float_arithmetic import FloatFormat, float_arithmetic
from hypcheck.derivation.program import Program
from hypcheck.errors import InputError
from hypcheck.geometry.pair import SIZES, Position
from hypcheck.geometry.rows import Floats, Mask
from hypcheck.kernel.specialise import first_stages, last_stages, tilted
from hypcheck.kernel.specialise.settings import (
    REACH,
    ScaledSetting,
    Setting,
    axis_of,
    centres,
    farthest,
    format_of,
    position_of_box,
    scaled,
    settings_of,
)
from hypcheck.scene.model import FREE, Point, SceneModel

MOST_SETTINGS = 64
"""The most settings in a plan, so that a kernel stays readable."""

USEFUL = 0.5
"""The least share of the centres left by the lines that the discriminant must decide; else it is omitted."""

USEFUL_TILTED = 0.2
"""The same for a tilted spheroid, where the stage after it costs more."""

TILTED_FORMAT = "float64"
"""The format of kernels for a tilted mover: a double-double is two numbers of it."""

AFAR = 2.0**13
"""Where the region is open, a kernel must answer up to so many times α + b across, and γ + d up."""

SHORT = 2.0**-500
"""If an axis is at least so long, the share of a subnormal component is less than tilted.LOST."""

ONE_SIDED = ("exterior", "interior")
"""The questions for one position without contact. The side of the centre can answer them with no."""

SIDES = {
    "position": (Position.EXTERIOR, Position.INTERIOR),
    "contact": (Position.EXTERIOR, Position.INTERIOR),
    "exterior": (Position.EXTERIOR,),
    "interior": (Position.INTERIOR,),
}
"""By question: the sides whose lines it can use."""


@dataclass(frozen=True, slots=True)
class Omission:
    """Something that a kernel leaves out, though the paper's Table 2 or the general kernel has it, and why it may."""

    what: str
    why: str


@dataclass(frozen=True)
class Stages:
    """The stages of a setting in order: `entry`, then lines, the centre's side and the discriminant, then `last`.

    `entry` is the program from x, y, z to R = x² + y², zz = z² and height = |z|, in the kernel's units, with the
    constants `entry_constants`. `centre` has the constants of the side, which a one-sided question tests after the
    lines. `last` is a search, which answers all that is left. If the height is fixed, `last` has its thresholds, and if
    the whole region has one position, `last` is that position; there are no stages between then. `shares` says what
    share of the sample centres each stage decided. `omitted` lists what is left out. `bound_u` is the greatest backward
    error of an answer, in units u.
    """

    setting: Setting
    entry: Program
    entry_constants: dict[str, float]
    last: Position | first_stages.Thresholds | last_stages.DualSearch | last_stages.TiltedSearch
    shares: dict[str, float]
    omitted: tuple[Omission, ...]
    bound_u: Fraction
    lines: tuple[first_stages.ProvedLine, ...] = ()
    centre: dict[str, float] = field(default_factory=dict)
    discriminant: last_stages.Discriminant | None = None

    @property
    def searches(self) -> bool:
        """Whether the last stage is a search."""
        return isinstance(self.last, last_stages.DualSearch | last_stages.TiltedSearch)


@dataclass(frozen=True)
class ScenePlan:
    """The stages of every setting of a scene, for one question in one format."""

    scene: SceneModel
    question: str
    format: FloatFormat
    settings: tuple[Stages, ...]

    @property
    def axis(self) -> Point | Literal["free"] | None:
        """The axis of a tilted mover, FREE if each query names one; None if the mover is upright."""
        return axis_of(self.scene.mover)

    @property
    def free(self) -> bool:
        """Whether each query names an axis."""
        return self.axis == FREE

    @property
    def bound_u(self) -> Fraction:
        """The largest backward error that an answer can have, in units u of the format."""
        return max(stages.bound_u for stages in self.settings)


def plan_of(scene: SceneModel, precision: str = "float64", most: int = MOST_SETTINGS) -> ScenePlan:
    """Make the plan for a scene's own question, with at most `most` settings.

    Raises InputError for an unknown format, for too many or too extreme sizes, and if no query of the region can reach
    a hyperboloid.
    """
    form = format_of(precision)
    settings = settings_of(scene)
    if axis_of(scene.mover) is not None and form.name != TILTED_FORMAT:
        raise InputError(
            f"no kernel is made in {form.name}: where the mover is tilted, kernels compute in {TILTED_FORMAT}"
        )
    if len(settings) > most:
        raise InputError(
            f"the scene has {len(settings)} different pairs of sizes; a plan holds at most {most} "
            "(hypcheck emit --whole keeps them in tables, and hypcheck.Scene has no such limit)"
        )
    if not settings:
        raise InputError("no kernel is made: the region contains no height of a hyperboloid, so no query can reach one")
    return ScenePlan(scene, scene.question, form, tuple(_within(setting, scene.question, form) for setting in settings))


def _within(setting: Setting, question: str, form: FloatFormat) -> Stages:
    """Return the stages of a setting. Raises InputError if a number leaves the format."""
    try:
        return _stages(setting, question, form)
    except OverflowError as error:
        sizes = ", ".join(f"{name} {size!r}" for name, size in zip(SIZES, setting.sizes, strict=True))
        raise InputError(f"no kernel is made for {sizes}: {error} (hypcheck.Scene asks any)") from None


def _stages(setting: Setting, question: str, form: FloatFormat) -> Stages:
    """Return the stages of a setting. Raises OverflowError if a number leaves the format."""
    scale = scaled(setting.sizes, form)
    position = position_of_box(setting)
    if position is not None:
        return _without_tests(setting, scale, position)
    height = setting.box.z
    if setting.axis is None and height is not None and height.fixed:
        return _at_one_height(setting, scale, first_stages.thresholds(setting.sizes, height.low, scale, form), question)
    return _in_turn(setting, question, form)


def _require_kept(axis: Point) -> None:
    """Raise OverflowError if flushing subnormal numbers to zero would change the direction of the axis."""
    parts = [abs(part) for part in axis]
    if max(parts) < SHORT and any(0 < part < float_info.min for part in parts):
        raise OverflowError(
            f"an axis shorter than {SHORT:.2g} must have no number below {float_info.min:.2g} but 0, as a program may "
            "flush it to zero: take a longer axis of the same direction"
        )


def _in_turn(setting: Setting, question: str, form: FloatFormat) -> Stages:
    """Return the stages of a setting that needs tests: lines, perhaps the discriminant, the search.

    For a tilted spheroid the lines are those of the smallest ball about it, and the discriminant is that of the largest
    ball in it.
    """
    axis = setting.axis
    fixed = None if axis == FREE else axis
    if fixed is not None:
        _require_kept(fixed)
    tilted_last = None if axis is None else last_stages.tilted_search(setting.sizes, fixed)
    inner, outer = (scaled(sizes, form) for sizes in setting.inner_and_outer)
    first, constants = first_stages.entry(outer)
    R, zz = _sample(setting, first, constants, form)
    lines, by_lines = _lines(question, outer, form, R, zz)
    sides = first_stages.centre_constants(outer, form)
    by_lines = by_lines | _by_centre(question, sides, form, R, zz)
    left = np.flatnonzero(~by_lines)
    delta = last_stages.discriminant(inner, form, first, constants, far_corner(setting))
    if delta is not None and tilted_last is not None:
        delta = replace(delta, clear_where_positive=False)
    by_delta = np.zeros(len(left), dtype=bool) if delta is None else decided_by(delta, form, R[left], zz[left])
    if by_delta.sum() < (USEFUL if tilted_last is None else USEFUL_TILTED) * len(left):
        delta, by_delta = None, np.zeros(len(left), dtype=bool)
    if tilted_last is None:
        bound = last_stages.backward_bound()
    else:
        bound = first_stages.CENTRE_BOUND if question in ONE_SIDED else tilted.BOUND_U
    last = last_stages.search(outer, form, far_corner(setting, AFAR)) if tilted_last is None else tilted_last
    omitted = _omissions(setting, question, delta, constants)
    shares = _shares(by_lines, by_delta)
    return Stages(setting, first, constants, last, shares, omitted, bound, lines, sides, delta)


def _sample(setting: Setting, first: Program, constants: dict[str, float], form: FloatFormat) -> tuple[Floats, Floats]:
    """Return R and zz of the sample centres, as the kernel computes them."""
    x, y, z = centres(setting)
    values = evaluate(first, float_arithmetic(form.name), {"x": x, "y": y, "z": z, **constants})
    return values["R"], values["zz"]


def _lines(
    question: str, scale: ScaledSetting, form: FloatFormat, R: Floats, zz: Floats
) -> tuple[tuple[first_stages.ProvedLine, ...], Mask]:
    """Return the lines that the question can use, and a mask of the centres that they decide."""
    lines: list[first_stages.ProvedLine] = []
    decided = np.zeros(len(R), dtype=bool)
    for side in SIDES[question]:
        own, by_own = first_stages.lines_for(side, scale, form, R, zz, len(lines) + 1)
        lines += own
        decided |= by_own
    return tuple(lines), decided


def _by_centre(question: str, sides: dict[str, float], form: FloatFormat, R: Floats, zz: Floats) -> Mask:
    """Return a mask of the centres whose side alone answers a one-sided question."""
    if question not in ONE_SIDED:
        return np.zeros(len(R), dtype=bool)
    (outside,) = outputs(first_stages.CENTRE, float_arithmetic(form.name), {"R": R, "zz": zz, **sides}, ("outside",))
    return np.asarray(outside == (question == "interior"))


def _shares(by_lines: Mask, by_delta: Mask) -> dict[str, float]:
    """Return the share of the sample that each stage decides.

    `by_lines` is a mask of all centres; `by_delta` has an entry only for those that the lines leave undecided.
    """
    return {
        "lines": float(by_lines.mean()),
        "discriminant": float(by_delta.sum() / len(by_lines)),
        "search": float((~by_delta).sum() / len(by_lines)),
    }


def decided_by(delta: last_stages.Discriminant, form: FloatFormat, R: Floats, zz: Floats) -> Mask:
    """Return a mask of the centres that the discriminant decides: in its region, and larger in size than its bound."""
    values = evaluate(delta.program, float_arithmetic(form.name), {"R": R, "zz": zz, **delta.constants})
    inside = (R <= delta.widest) & (zz <= delta.highest)
    beyond = values["delta_3"] < -delta.bound
    if delta.clear_where_positive:
        beyond = beyond | (values["delta_3"] > delta.bound)
    return np.asarray(inside & beyond)


def far_corner(setting: Setting, reach: float = REACH) -> tuple[Fraction, Fraction]:
    """Return the greatest |x| or |y|, and the greatest |z|, in the box.

    Where the box is open, they are `reach` times α + b, and γ + d.
    """
    alpha, gamma, b, d = map(Fraction, setting.sizes)
    x, y, z = setting.box.spans
    across = [Fraction(reach) * (alpha + b) if span is None else Fraction(farthest(span)) for span in (x, y)]
    return max(across), Fraction(reach) * (gamma + d) if z is None else Fraction(farthest(z))


def _without_tests(setting: Setting, scale: ScaledSetting, position: Position) -> Stages:
    """Return the stages of a setting whose whole region has this position."""
    name = position.name.lower()
    why = (
        f"the least favourable corner of the region is {name}, decided exactly, and {name} positions are monotone in "
        "each coordinate (docs/mathematics.md)"
    )
    return Stages(
        setting, *first_stages.entry(scale), position, {"always": 1.0}, (Omission("every test", why),), Fraction(0)
    )


def _at_one_height(setting: Setting, scale: ScaledSetting, limits: first_stages.Thresholds, question: str) -> Stages:
    """Return the stages of a setting with a fixed height: two thresholds."""
    omitted = [
        Omission(
            "the coefficients, the discriminant and every term in z",
            f"the height is {limits.height!r}: position depends on x² + y² alone and is monotone in it",
        )
    ]
    if limits.inner is None and question != "exterior":
        omitted.append(Omission("the interior threshold", "at this height not even a centre on the axis is interior"))
    omitted += _one_sided(question)
    bound = first_stages.BACKWARD_BOUND
    return Stages(setting, *first_stages.entry(scale), limits, {"thresholds": 1.0}, tuple(omitted), bound)


def _one_sided(question: str) -> list[Omission]:
    """Return what a one-sided question leaves out."""
    if question not in ONE_SIDED:
        return []
    other = "interior" if question == "exterior" else "exterior"
    return [
        Omission(
            f"whatever tells {other} from contact",
            f"the question is {question}: both are answered no",
        )
    ]


_SIZES_ALONE = Omission(
    "the divisions and the products of sizes alone",
    "the sizes are fixed: each is rounded once, from its exact value, when the kernel is made",
)
_AXIS = Omission(
    "the axis, in lines and discriminant",
    "what the smallest ball about the spheroid is clear of, so is the spheroid; what the largest ball in it "
    "touches, it touches too",
)
_DISCRIMINANT = Omission(
    "the discriminant",
    "of degree 12 in the lengths, it decides too little of this region in this format, "
    "or leaves it; the dual form, of degree 2, does not",
)
_DISCRIMINANT_OF_BALL = Omission("the discriminant of the largest ball", "it decides too little of this region")


def _omissions(
    setting: Setting, question: str, delta: last_stages.Discriminant | None, constants: dict[str, float]
) -> tuple[Omission, ...]:
    """Return what the stages of a setting leave out, and why."""
    upright = setting.axis is None
    omitted = [_SIZES_ALONE if upright else _AXIS, *_one_sided(question)]
    if delta is None:
        omitted.append(_DISCRIMINANT if upright else _DISCRIMINANT_OF_BALL)
    elif upright and not delta.clear_where_positive:
        omitted.append(Omission("clear where Δ > 0", "a < 1 or c² < a: Δ > 0 does not mean clear there"))
    if upright and not constants:
        omitted.append(Omission("scaling of lengths", "the semi-axes are ordinary: no square leaves the format"))
    if setting.cut is None and setting.box.z is not None:
        omitted.append(Omission("the test of height", "the region ends before the hyperboloids do"))
    return tuple(omitted)
