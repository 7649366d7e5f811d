"""Make hyperboloids and movers of numbers and arrays, checked as those of a file are; model.py has their meaning."""

from __future__ import annotations

import math
import reprlib
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.errors import InputError
from hypcheck.geometry.forms import named_points
from hypcheck.geometry.pair import AXIS, CENTER, HEIGHTS, SIZES, trouble_with, trouble_with_axis, trouble_with_heights
from hypcheck.geometry.rows import as_columns, as_numbers
from hypcheck.messages import counted, escaped
from hypcheck.scene.model import FREE, QUESTIONS, Hyperboloid, Mover, MoverPart, Point, Region, SceneModel, Span
from hypcheck.scene.reading import within

NO_HYPERBOLOID = "the scene has no hyperboloid; it must have one at least"


def hyperboloids_of(
    alpha: ArrayLike,
    gamma: ArrayLike,
    center: ArrayLike,
    axis: ArrayLike | None,
    heights: Sequence[ArrayLike],
    names: Sequence[str] | None,
) -> tuple[Hyperboloid, ...]:
    """Make a hyperboloid for each center, (n, 3); other values are numbers or columns (n,). Raises InputError."""
    points, axes = named_points("center", center), named_points("axis", (0, 0, 1) if axis is None else axis, AXIS)
    values = (alpha, gamma, *points.values(), *axes.values(), *heights)
    columns = [column.tolist() for column in as_columns((*SIZES[:2], *CENTER, *AXIS, *HEIGHTS), values)]
    count = len(columns[0])
    called = [f"hyperboloid {number + 1}" for number in range(count)] if names is None else list(map(str, names))
    if len(called) != count:
        raise InputError(f"there are {counted(len(called), 'name')} for {counted(count, 'hyperboloid')}")
    if len(set(called)) != count:
        twice = next(name for place, name in enumerate(called) if name in called[:place])
        raise InputError(f"there are two hyperboloids {twice!r}; each must have another name")
    bodies = []
    for name, (a, c, x, y, z, u, v, w, low, high, solid) in zip(called, zip(*columns, strict=True), strict=True):
        trouble = trouble_with_heights((low, high, solid)) or _trouble_with((a, c), (x, y, z), (u, v, w))
        if trouble is not None:
            raise InputError(f"the hyperboloid {name!r}: {trouble}")
        height = None if low == -math.inf and high == math.inf else Span(low, high)
        bodies.append(Hyperboloid(name, a, c, (x, y, z), height, (u, v, w), bool(solid)))
    return tuple(bodies)


def checked_hyperboloid(body: Hyperboloid) -> Hyperboloid:
    """Return the hyperboloid with float64 for its numbers. Raises InputError if one is not valid."""
    if not isinstance(body, Hyperboloid):
        raise InputError(
            f"a hyperboloid is of type {type(body).__name__}; it must be a Hyperboloid(name, alpha, gamma, center)"
        )
    if not isinstance(body.name, str):
        raise InputError(
            f"a hyperboloid's name is {escaped(reprlib.repr(body.name), 60)}; it must be a text: "
            "Hyperboloid(name, alpha, gamma, center)"
        )
    for name in SIZES[:2]:
        _require_number(f"the hyperboloid {body.name!r}: {name} is", getattr(body, name))
    if body.height is not None:
        _require_type(
            f"the hyperboloid {body.name!r}: height is", body.height, Span, "it must be a Span(low, high), or None"
        )
    if trouble := trouble_with("solid", float(body.solid) if isinstance(body.solid, bool) else body.solid):
        raise InputError(f"the hyperboloid {body.name!r}: {trouble}")
    low, high = (-math.inf, math.inf) if body.height is None else body.height.ends
    (checked,) = hyperboloids_of(
        body.alpha, body.gamma, [body.center], [body.axis], (low, high, float(body.solid)), [body.name]
    )
    return replace(checked, height=body.height)


def point_of(subject: str, point: ArrayLike) -> Point:
    """Read a point as three numbers; a message begins with `subject`. Raises InputError."""
    values = list(named_points(subject, point).values())
    if any(np.ndim(value) for value in values):
        raise InputError(f"{subject} is of shape {np.shape(point)}; it must be three numbers")
    x, y, z = values
    return x, y, z


def _require_number(subject: str, value: object) -> None:
    """Raise InputError unless the value is one real number."""
    if as_numbers(subject, value, "it must be a number").ndim:
        raise InputError(f"{subject} {escaped(reprlib.repr(value), 60)}; it must be a number")


def mover_of(mover: Mover | Sequence[float]) -> Mover:
    """Return a mover as it is, or make one of two semi-axes b and d. Raises InputError for anything else."""
    if isinstance(mover, Mover):
        return mover
    wanted = "it must be a hypcheck.Mover, or its two semi-axes b, d"
    b, *others = as_numbers("the mover is", mover, wanted).ravel().tolist() or [math.nan]
    if len(others) != 1:
        raise InputError(f"the mover is {escaped(reprlib.repr(mover), 60)}; {wanted}")
    return Mover(b, others[0])


def require_valid_model(model: SceneModel) -> None:
    """Raise InputError if a value of a scene is of another type than its field, or a number is not valid.

    The hyperboloids themselves are checked as columns, which a thousand of them need (PreparedScene).
    """
    _require_type(
        "the model's hyperboloids are", model.hyperboloids, (tuple, list), "they must be a tuple of Hyperboloid"
    )
    if not model.hyperboloids:
        raise InputError(NO_HYPERBOLOID)
    if model.question not in QUESTIONS:
        question = escaped(reprlib.repr(model.question), 60)
        raise InputError(f"the question is {question}; it must be {', '.join(QUESTIONS[:-1])} or {QUESTIONS[-1]}")
    _require_valid_mover(model.mover)
    _require_type("the region is", model.region, Region, "it must be a Region(x, y, z)")
    for name in CENTER:
        span = getattr(model.region, name)
        if span is not None:
            subject = f"the region: {name} is"
            _require_type(subject, span, Span, "it must be a Span(low, high), or None")
            numbers = [isinstance(end, (int, float)) and not math.isnan(end) for end in span.ends]
            if not all(numbers) or span.low > span.high:
                raise InputError(f"{subject} {span!r}; low and high must be numbers, low not greater than high")


def _require_type(subject: str, value: object, wanted: type | tuple[type, ...], right: str) -> None:
    """Raise InputError unless the value is of a type."""
    if not isinstance(value, wanted):
        raise InputError(f"{subject} {escaped(reprlib.repr(value), 60)}; {right}")


def _require_valid_mover(mover: Mover) -> None:
    """Raise InputError where a number of a mover or of its parts is not valid, or a part reaches beyond the mover."""
    _require_type("the mover is", mover, Mover, "it must be a Mover(b, d)")
    _require_type("the mover's parts are", mover.parts, (tuple, list), "they must be a tuple of MoverPart")
    for number, part in enumerate(mover.parts, start=1):
        _require_type(f"part {number} is", part, MoverPart, "it must be a MoverPart(b, d, arm, angle)")
    for subject, body in [("the mover", mover), *((f"part {k + 1}", part) for k, part in enumerate(mover.parts))]:
        troubles = (trouble_with(name, getattr(body, name)) for name in SIZES[2:])
        trouble = next((trouble for trouble in troubles if trouble), None)
        if trouble is not None:
            raise InputError(f"{subject}: {trouble}")
    for number, part in enumerate(mover.parts, start=1):
        trouble = trouble_with("arm", part.arm) or trouble_with("angle", part.angle)
        if trouble is None and part.arm < 0:
            trouble = f"arm is {part.arm!r}; it must be 0 or more"
        if trouble is None and not within(part, mover.b, mover.d):
            trouble = (
                "it reaches beyond the mover; it must lie within it, "
                "because it is tested only if the mover is not clear"
            )
        if trouble is not None:
            raise InputError(f"part {number}: {trouble}")
    trouble = None if mover.axis == FREE else trouble_with_axis(mover.axis)
    if trouble is not None:
        raise InputError(f"the mover: {trouble}")


def _trouble_with(sizes: Sequence[float], center: Sequence[float], axis: Sequence[float]) -> str | None:
    """Return the first trouble with these numbers of a hyperboloid; None if they are valid."""
    named = zip((*SIZES[:2], *CENTER), (*sizes, *center), strict=True)
    troubles = (trouble_with(name, value) for name, value in named)
    return next((trouble for trouble in troubles if trouble), None) or trouble_with_axis(axis)
