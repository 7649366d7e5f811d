"""The public functions: validated input, exact positions, and no output unless all of it is right.

C answers ordinary calls without these functions: calls with numbers, lists and numpy's arrays of any strides and most
types of numbers, all rows valid, no heights and no margin, and no more rows than one thread answers. C passes any other
call to them. They convert other types, or raise an error that says what is wrong. Without the compiled kernel they take
all calls.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import InitVar, dataclass, field
from typing import Any, Literal, overload

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.errors import InputError
from hypcheck.float_environment import in_default_environment
from hypcheck.geometry import pair
from hypcheck.geometry.forms import Answers, Argument, mean_no_ends, points_or_columns, questions_of
from hypcheck.geometry.rows import (
    PAIRS,
    Columns,
    Floats,
    Positions,
    as_columns,
    as_numbers,
    as_rows,
    require_valid,
    tilted_rows,
)
from hypcheck.kernel.choice import Question, choice, required
from hypcheck.kernel.compiled_kernel import extension
from hypcheck.kernel.in_use import kernel, positions_of_rows
from hypcheck.messages import escaped

ROWS_AT_A_TIME = 1 << 22
"""How many rows are made at a time from centres with an axis each: some 300 MB, and work for four threads."""


@dataclass(frozen=True)
class Prepared:
    """One spheroid beside one hyperboloid, prepared once; it replaces the sizes in any number of calls.

    `classify_scene(Prepared(sizes), x, y, z)` answers as `classify_scene(sizes, x, y, z)`; it keeps everything that
    does not depend on the centres, which saves most in batches of 64 to some thousand centres. `axis` (3,) is the
    spheroid's as in classify_scene. `like`, three columns x, y, z, are centres similar to those you will ask: they
    change no answer, only how many centres the first stage decides. Without them, heights near the waist are assumed.
    Raises InputError for sizes or an axis that are not valid.
    """

    sizes: pair.Sizes
    axis: pair.Axis | None = None
    like: InitVar[tuple[ArrayLike, ArrayLike, ArrayLike]] = ((), (), ())
    kept: bytes = field(init=False, repr=False, compare=False)

    @in_default_environment
    def __post_init__(self, like: tuple[ArrayLike, ArrayLike, ArrayLike]) -> None:
        sizes, axis = _sizes(self.sizes), self.axis
        if axis is not None:
            axes = _axes(axis)
            if axes.ndim == 2:
                raise InputError(f"axis is of shape {axes.shape}; it must be three numbers, {', '.join(pair.AXIS)}")
            axis = _one_axis(axes, "raise")
        columns = as_columns(pair.CENTER, like)
        kept = kernel().prepared(sizes, (columns[0], columns[1], columns[2]), axis)
        for name, value in (("sizes", sizes), ("axis", axis), ("kept", kept)):
            object.__setattr__(self, name, value)

    def __reduce__(self) -> tuple[type[Prepared], tuple[pair.Sizes, pair.Axis | None]]:
        """Return sizes and axis only: prepared data are valid for the build that made them; a copy prepares again."""
        return Prepared, (self.sizes, self.axis)


@overload
def classify(
    *pairs: Argument,
    axis: ArrayLike | None = None,
    z_min: ArrayLike = -math.inf,
    z_max: ArrayLike = math.inf,
    solid: ArrayLike = False,
    margin: float = 0.0,
    out: Positions,
    on_invalid: Literal["raise", "flag"] = "raise",
    question: Question = "position",
    threads: int | None = None,
    **columns: ArrayLike,
) -> Positions: ...


@overload
def classify(
    alpha: float,
    gamma: float,
    b: float,
    d: float,
    x: float,
    y: float,
    z: float,
    /,
    *,
    axis: Sequence[float] | None = None,
    z_min: float = -math.inf,
    z_max: float = math.inf,
    solid: bool = False,
    margin: float = 0.0,
    on_invalid: Literal["raise", "flag"] = "raise",
    question: Question = "position",
    threads: int | None = None,
) -> int: ...


@overload
def classify(
    *pairs: Argument,
    axis: ArrayLike | None = None,
    z_min: ArrayLike = -math.inf,
    z_max: ArrayLike = math.inf,
    solid: ArrayLike = False,
    margin: float = 0.0,
    out: None = None,
    on_invalid: Literal["raise", "flag"] = "raise",
    question: Question = "position",
    threads: int | None = None,
    **columns: ArrayLike,
) -> Answers: ...


@in_default_environment
def classify(
    *pairs: Argument,
    axis: ArrayLike | None = None,
    z_min: ArrayLike = -math.inf,
    z_max: ArrayLike = math.inf,
    solid: ArrayLike = False,
    margin: float = 0.0,
    out: Positions | None = None,
    on_invalid: Literal["raise", "flag"] = "raise",
    question: Question = "position",
    threads: int | None = None,
    **columns: ArrayLike,
) -> Answers:
    """Return the exact position of every pair: +1 exterior, 0 contact (tangency included), −1 interior; int8 (n,).

    For one pair the answer is an int, for arrays an array. Pairs are written in any of these forms, with
    lengths in one unit; numbers and columns (n,) are broadcast, `points` are one point (3,) or many (n, 3):

        classify(rows)                             (n, 7): alpha, gamma, b, d, x, y, z; (n, 10), (n, 13) with more
        classify({"alpha": 2, …, "z": zs})         columns by name: a dict, a data frame, a structured array
        classify((alpha, gamma, b, d), points)     or (…), x, y, z
        classify(alpha, gamma, b, d, points)       or …, x, y, z, or alpha=2, …, center=points

    `axis`, axis_x, axis_y, axis_z, is any finite vector ≠ 0 along the spheroid's axis of revolution; its length and
    sign have no effect: (3,) for all, or (n, 3); without it the spheroid is upright, as with 0, 0, 1. The hyperboloid
    ends at the heights `z_min` and `z_max`; with `solid`, flat ends belong to it. `margin`, a length: a spheroid that
    is not proved to be at least so far away counts as contact. float64 is not copied, and no number is rounded.

    `out`, int8 (n,), is filled and returned in place of a new array; it may overlap the input. `question` "exterior",
    "interior" or "contact" asks for 1 (yes) or 0 (no) instead. `threads` is how many threads share the work; by default
    one, and more for millions of rows (HYPCHECK_THREADS limits them).

    A row is valid when its sizes are finite and > 0, its centre finite, its axis finite and not 0, z_min < z_max (they
    may be infinite) and solid 0 or 1. The first invalid row raises InputError (its index counted from 0) and `out` is
    not changed; with on_invalid="flag" such rows are marked 127.

    >>> classify((2, 17.8, 0.25, 0.15), [[0, 0, 5], [3, 0, 5]])
    array([-1,  1], dtype=int8)
    """
    number = required(question, threads, on_invalid)
    if pairs and isinstance(pairs[0], Prepared):
        pairs, axis = (pairs[0].sizes, *pairs[1:]), _axis_of(pairs[0], axis, columns)
    call = questions_of(pairs, columns, axis, (z_min, z_max, solid))
    if call.single and out is not None:
        raise InputError("out is given, but the answer to one pair is a number; give out only with rows")
    if call.scene and not margin:
        result = _of_scene(*_parts_of_scene(call.columns), out, (on_invalid, question, number))
        return int(result[0]) if call.single else result
    queries = call.rows()
    _require_fitting(out, len(queries))
    result, refused = positions_of_rows(queries, question if not margin else "position", number)
    if refused and on_invalid == "raise":
        call.require_valid(queries)
    if margin:
        from hypcheck.kernel.clearance import with_margin  # noqa: PLC0415 - a margin alone needs it

        result = with_margin(queries, result, margin, question, number)
    return int(result[0]) if call.single else _into(out, result)


def _parts_of_scene(
    columns: Mapping[str, Any],
) -> tuple[pair.Sizes, Sequence[ArrayLike], Sequence[Argument] | None]:
    """Return sizes, centre and axis of pairs of one spheroid's sizes.

    Raises InputError for another or a missing column.
    """
    known = (*pair.SIZES, *pair.CENTER, *pair.AXIS)
    for name in columns:
        if name not in known:
            raise InputError(f"there is no column {escaped(repr(name), 60)}; the columns are {', '.join(PAIRS.ended)}")
    sizes, center = (tuple(columns[name] for name in names) for names in (pair.SIZES, pair.CENTER))
    axis = [columns[name] for name in pair.AXIS if name in columns]
    if len(axis) not in (0, len(pair.AXIS)):
        as_rows(columns, pair.ALL_GROUPS)  # which says what is missing
    return _sizes(sizes), center, axis or None


@in_default_environment
def classify_scene(
    sizes: pair.Sizes | Prepared,
    x: ArrayLike,
    y: ArrayLike | None = None,
    z: ArrayLike | None = None,
    out: Positions | None = None,
    *,
    axis: ArrayLike | None = None,
    z_min: ArrayLike = -math.inf,
    z_max: ArrayLike = math.inf,
    solid: ArrayLike = False,
    margin: float = 0.0,
    on_invalid: Literal["raise", "flag"] = "raise",
    question: Question = "position",
    threads: int | None = None,
) -> Positions:
    """Return the exact position of one spheroid at many centres; int8 (n,) always, numbers and options as in classify.

    `sizes` are alpha, gamma, b, d; `x`, `y`, `z` are float64 (n,) each, or single numbers for all centres; or `x` alone
    are points, (n, 3) or (3,). `axis` is the spheroid's axis as in classify: (3,) for all centres, or (n, 3); without
    it the spheroid is upright. `z_min`, `z_max`, `solid` are the hyperboloid's ends, as in classify. The first centre,
    axis or end that is not valid raises InputError (its index counted from 0) and `out` is not changed; with
    on_invalid="flag" such centres are marked 127, all of them if the one axis is not valid. Sizes that are not valid
    are always refused. `sizes` may also be Prepared(sizes, axis), with no other axis.
    """
    number = required(question, threads, on_invalid)
    if isinstance(sizes, Prepared):
        axis, sizes = _axis_of(sizes, axis), sizes.sizes
    four = _sizes(sizes)
    center = points_or_columns(x, y, z)
    if margin or not mean_no_ends((z_min, z_max, solid)):
        ends: Any = {"z_min": z_min, "z_max": z_max, "solid": solid, "margin": margin}
        options: Any = {"on_invalid": on_invalid, "question": question, "threads": threads}
        answers = np.atleast_1d(np.asarray(classify(four, *center, axis=axis, **ends, **options), np.int8))
        _require_fitting(out, len(answers))
        return _into(out, answers)
    axes = None if axis is None else _axes(axis)
    return _of_scene(four, center, None if axes is None else (*axes.T,), out, (on_invalid, question, number))


def _axis_of(
    prepared: Prepared, axis: ArrayLike | None, columns: Mapping[str, ArrayLike] | None = None
) -> pair.Axis | None:
    """Return the axis of a prepared scene. Raises InputError if the call gives one too, whole or by its columns."""
    if axis is not None or not {"axis", *pair.AXIS}.isdisjoint(columns or ()):
        raise InputError("axis is given, and the scene was prepared with its own; it must be given once")
    return prepared.axis


_Options = tuple[str, Question, "int | None"]
"""`on_invalid`, `question`, and the number of threads."""


def _of_scene(
    sizes: pair.Sizes,
    center: Sequence[ArrayLike],
    axis: Sequence[Argument] | None,
    out: Positions | None,
    options: _Options,
) -> Positions:
    """Return the answers about one spheroid of valid sizes; its axis is three numbers, or a column of each."""
    on_invalid, question, threads = options
    if axis is not None and any(map(np.ndim, axis)):
        columns = as_columns((*pair.CENTER, *pair.AXIS), (*center, *axis))
        _require_fitting(out, len(columns[0]))
        return _into(out, _with_axes(sizes, columns, question, threads, on_invalid))
    x, y, z = as_columns(pair.CENTER, center)
    _require_fitting(out, len(x))
    one = None if axis is None else _one_axis(_axes([*axis]), on_invalid)
    in_place = out is not None and question == "position" and _lie_apart(out, (x, y, z))
    if out is not None and in_place and kernel().fill_valid_scene(sizes, (x, y, z), out, threads, one):
        return out
    result, refused = kernel().answer_scene(sizes, (x, y, z), question, threads, one)
    if refused and on_invalid == "raise":
        raise _not_finite((x, y, z))
    return _into(out, result)


def _with_axes(
    sizes: pair.Sizes, columns: Sequence[Floats], question: Question, threads: int | None, on_invalid: str
) -> Positions:
    """Return the answers for centres with an axis each: six columns, which become rows some at a time."""
    result = np.empty(len(columns[0]), dtype=np.int8)
    for start in range(0, len(result), ROWS_AT_A_TIME):
        x, y, z, *axis = (column[start : start + ROWS_AT_A_TIME] for column in columns)
        rows = tilted_rows(sizes, (x, y, z), axis)
        result[start : start + len(rows)], refused = kernel().answer_rows(rows, question, threads)
        if refused and on_invalid == "raise":
            require_valid(rows, start)
    return result


def _axes(axis: ArrayLike) -> Floats:
    """Return the axis or axes, (3,) or (n, 3); a single row is one axis."""
    wanted = f"it must be three numbers, {', '.join(pair.AXIS)}, or an array (n, 3) of them"
    numbers = as_numbers("axis is", axis, wanted)
    if numbers.ndim not in (1, 2) or numbers.shape[-1] != len(pair.AXIS):
        raise InputError(f"axis is of shape {numbers.shape}; {wanted}")
    return numbers[0] if len(numbers) == 1 and numbers.ndim == 2 else numbers


def _one_axis(numbers: Floats, on_invalid: str) -> pair.Axis:
    """Return the numbers of an axis. Raises InputError if it is not valid, unless invalid rows are flagged."""
    vx, vy, vz = numbers.tolist()
    trouble = pair.trouble_with_axis((vx, vy, vz))
    if trouble is not None and on_invalid == "raise":
        raise InputError(trouble)
    return vx, vy, vz


def _sizes(sizes: pair.Sizes) -> pair.Sizes:
    """Return four valid sizes. Raises InputError."""
    wanted = f"they must be four numbers: {', '.join(pair.SIZES)}"
    numbers = as_numbers("the sizes are", sizes, wanted)
    if numbers.shape != (len(pair.SIZES),):
        raise InputError(f"the sizes are of shape {numbers.shape}; {wanted}")
    alpha, gamma, b, d = numbers.tolist()
    for name, value in zip(pair.SIZES, (alpha, gamma, b, d), strict=True):
        trouble = pair.trouble_with(name, value)
        if trouble is not None:
            raise InputError(trouble)
    return alpha, gamma, b, d


def _not_finite(columns: Columns) -> InputError:
    """Return a sentence about the first centre that is not finite; there must be one."""
    index = int(np.argmin(np.isfinite(columns).all(axis=0)))
    trouble = pair.trouble_with_row([float(column[index]) for column in columns], pair.CENTER)
    return InputError(f"row {index}: {trouble}")


def _require_fitting(out: object, count: int) -> None:
    """Raise InputError unless `out` is None, or an array for the answers to so many rows."""
    if out is None:
        return
    if not isinstance(out, np.ndarray):
        actual = f"of type {type(out).__name__}"
    elif out.dtype != np.int8 or out.shape != (count,):
        actual = f"an array of {out.dtype} and of shape {out.shape}"
    elif not out.flags.writeable:
        actual = "read-only"
    elif count > 1 and out.strides == (0,):
        actual = "an array whose elements share one byte"
    else:
        return
    raise InputError(f"out is {actual}; it must be a writable int8 array of shape ({count},), a byte for each position")


def _lie_apart(out: Positions, columns: Columns) -> bool:
    """Whether all are contiguous, and `out` shares no memory with a column."""
    every = (out, *columns)
    return all(array.flags.c_contiguous and array.flags.aligned for array in every) and not any(
        np.may_share_memory(out, column) for column in columns
    )


def _into(out: Positions | None, result: Positions) -> Positions:
    """Return the result, written into `out` if there is one."""
    if out is None:
        return result
    out[:] = result
    return out


def _at_once() -> tuple[Callable[..., Answers], Callable[..., Answers]]:
    """Return classify and classify_scene of the kernel in use: those in C, which call these for the rest, or these."""
    if choice().kernel == "numpy":
        return classify, classify_scene
    module = extension()
    module.set_slow_calls(classify, classify_scene, Prepared)
    return module.classify, module.classify_scene


classify_at_once, classify_scene_at_once = _at_once()
"""The public functions, hypcheck.classify and hypcheck.classify_scene."""
