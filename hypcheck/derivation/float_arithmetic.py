"""Float arithmetic for programs: each operation rounded once to one numpy format, over scalars or arrays; TwoSum.

All operands have the one format, constants included, so that no promotion rule of any numpy version matters. numpy
computes binary16 in binary32 and rounds again, which is the correctly rounded result for + − × ÷ √, since
24 ≥ 2·11 + 2; cosines are as good as numpy's. Infinities and NaN raise nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from typing import Any

import numpy as np

from hypcheck.derivation.evaluation import OPERATORS, Arithmetic
from hypcheck.geometry.rows import Floats

_OPERATIONS: dict[str, Callable[..., Any]] = {
    **OPERATORS,
    "sqrt": np.sqrt,
    "cos": np.cos,
    "arccos": np.arccos,
    "not": np.logical_not,
    "select": np.where,
}

FORMATS = ("float16", "float32", "float64", "longdouble")


@cache
def float_arithmetic(format_name: str) -> Arithmetic:
    """The arithmetic of one of FORMATS; longdouble is whatever numpy has by that name here (x87 on x86-64).

    Inputs are floats, integers or arrays of them, rounded to the format on entry; arrays of that format are taken as
    they are, without a copy. Shapes broadcast, so sizes can be scalars beside arrays of centres.
    Raises ValueError where there is no such format.
    """
    if format_name not in FORMATS:
        raise ValueError(f"{format_name!r} is none of the formats {', '.join(FORMATS)}")
    return Arithmetic(
        name=format_name,
        convert=partial(np.asarray, dtype=np.dtype(format_name)),
        operations=_OPERATIONS,
        integers=lambda values: np.asarray(values).astype(np.int8),
        guard=partial(np.errstate, all="ignore"),
    )


def unit_roundoff(format_name: str) -> float:
    """The largest relative error u of one rounding to nearest in the format: half the gap after 1."""
    return float(np.finfo(np.dtype(format_name)).eps) / 2


def two_sum(first: Floats, second: Floats | float) -> tuple[Floats, Floats]:
    """The rounded sum of float64 numbers and its rounding error, which is a float64 too (Knuth's TwoSum): exact.

    The error is NaN where the sum leaves the range of float64.
    """
    total = first + second
    shadow = total - first
    return total, (first - (total - shadow)) + (second - shadow)
