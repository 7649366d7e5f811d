"""Lengths scaled by powers of two where their squares could leave the format, and the exact constants of a setting."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from hypcheck.kernel.specialise.formats import Format, power_of_two_near
from hypcheck.kernel.specialise.settings import Sizes

ORDINARY = {"float32": Fraction(2) ** 16, "float64": Fraction(2) ** 100}
"""Semi-axes between this and its reciprocal have squares, and products of squares, well inside the format."""


@dataclass(frozen=True, slots=True)
class Scaled:
    """A setting's squares, exactly, in the units of the kernel: radial lengths times `radial`, axial times `axial`.

    A = (α/b)² and B = (γ/d)² have no unit. `bb` and `dd` are b² and d². The factors are powers of two, so that a
    kernel's products by them round nothing; they are 1 where nothing has to be scaled.
    """

    A: Fraction
    B: Fraction
    bb: Fraction
    dd: Fraction
    radial: Fraction
    axial: Fraction


def scaled(sizes: Sizes, form: Format) -> Scaled:
    """The squares of the sizes, scaled where the format asks for it (Theorem 1 allows any two factors).

    Raises OverflowError where a factor is no number of the format.
    """
    alpha, gamma, b, d = map(Fraction, sizes)
    limit = ORDINARY[form.name]
    radial = Fraction(1) if all(1 / limit < each < limit for each in (alpha, b)) else 1 / power_of_two_near(b)
    axial = Fraction(1) if all(1 / limit < each < limit for each in (gamma, d)) else 1 / power_of_two_near(d)
    for unit in (radial, axial):
        form.rounded(unit)
    return Scaled((alpha / b) ** 2, (gamma / d) ** 2, (b * radial) ** 2, (d * axial) ** 2, radial, axial)
