"""What stands beside the paper's methods when `bench` compares: other precisions, roots, exact ones, other shapes."""

from __future__ import annotations

from functools import partial

import numpy as np

from hypcheck.derivation.formulas import FORMULAS
from hypcheck.kernel import integers
from hypcheck.methods import bounding, roots
from hypcheck.methods.domain import EVERYWHERE, Domain
from hypcheck.methods.formula import by_rows
from hypcheck.methods.method import Answers, Method
from hypcheck.pairs import Pair
from hypcheck.rows import Rows
from hypcheck.truth import exact

DIGITS = (15, 30, 50, 100)
"""Decimal digits at which mpmath is asked for roots."""

SLOW_ROWS = 24
"""Rows of a family that are asked of a method that takes milliseconds for one."""

LONG_DOUBLE = {2.0**-63: "x87", 2.0**-112: "binary128"}.get(float(np.finfo(np.longdouble).eps))
"""What numpy's long double is on this machine; None where it is no more than float64, or two of them."""


def measured_methods() -> list[Method]:
    """All of them; none loads mpmath or FCL before it is asked."""
    return [*_other_precisions(), *_roots(), *_exact(), *_shapes()]


def _other_precisions() -> list[Method]:
    formats = {"float16": "float16", **({"longdouble": LONG_DOUBLE} if LONG_DOUBLE else {})}
    listed = FORMULAS["table-2"]
    return [
        Method(
            f"{listed.name}-{format_name}",
            f"{listed.title}, {format_name}",
            listed.question,
            precision,
            by_rows(listed, format_name),
            Domain(regimes=listed.regimes),
            measured=True,
        )
        for format_name, precision in formats.items()
    ]


def _roots() -> list[Method]:
    trigonometric = [
        Method(
            f"trigonometric-{precision}",
            f"the roots of g by the trigonometric form, {precision}",
            "position",
            precision,
            roots.trigonometric(precision),
            Domain(),
            measured=True,
        )
        for precision in ("float32", "float64")
    ]
    general = Method(
        "numpy-roots",
        "the roots of g by numpy.roots, float64",
        "position",
        "float64",
        roots.by_numpy,
        Domain(),
        most=400,
        measured=True,
    )
    many_digits = [
        Method(
            f"mpmath-roots-{digits}",
            f"the roots of g by mpmath.polyroots at {digits} digits",
            "position",
            "float64",
            partial(roots.by_mpmath, digits=digits),
            Domain(),
            most=SLOW_ROWS,
            measured=True,
        )
        for digits in DIGITS
    ]
    return [*trigonometric, general, *many_digits]


def _exact() -> list[Method]:
    named = (
        ("exact-integers", "the coefficient rule in integers, the fast path's last stage", _integers),
        ("exact-oracle", "the exact oracle: the sign of g at its local maximum, in integers", _oracle),
        ("nearest-point", "the nearest point, in double-double and then in exact enclosures", _nearest),
    )
    return [
        Method(name, title, "position", "float64", answer, EVERYWHERE, exact=True, most=400, measured=True)
        for name, title, answer in named
    ]


def _shapes() -> list[Method]:
    named = (
        ("bounding-sphere", "the circumscribed sphere in the spheroid's place, exact", bounding.sphere),
        ("bounding-cylinder", "the circumscribed cylinder in the spheroid's place, float64", bounding.cylinder),
    )
    return [
        Method(name, title, "position", "float64", answer, Domain(), measured=True) for name, title, answer in named
    ]


def _integers(rows: Rows) -> Answers:
    return np.array([integers.position(Pair.from_row(row).lengths) for row in rows.tolist()], dtype=np.int8)


def _oracle(rows: Rows) -> Answers:
    return np.array([exact.position(Pair.from_row(row).lengths) for row in rows.tolist()], dtype=np.int8)


def _nearest(rows: Rows) -> Answers:
    from hypcheck.truth.nearest import positions  # noqa: PLC0415 - loads mpmath

    return positions(np.ascontiguousarray(rows)).position
