"""What an implementation can be asked, how it may answer, and the precisions in which it can compute that."""

from __future__ import annotations

from fractions import Fraction

QUESTIONS = ("position", "exterior", "interior", "contact")
"""The position itself, or whether it is one of the three."""

UNIT_ROUNDOFF = {
    "float16": Fraction(1, 2**11),
    "bfloat16": Fraction(1, 2**8),
    "float32": Fraction(1, 2**24),
    "float64": Fraction(1, 2**53),
    "x87": Fraction(1, 2**64),
    "binary128": Fraction(1, 2**113),
    "exact": Fraction(0),
}
"""The unit u of each precision an implementation can declare: half the distance from 1 to the next number."""

PRECISIONS = tuple(UNIT_ROUNDOFF)


def allowed(question: str) -> tuple[int, ...]:
    """The answers that a question has."""
    return (-1, 0, 1) if question == "position" else (0, 1)
