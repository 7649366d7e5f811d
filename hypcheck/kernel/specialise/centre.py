"""On which side of the hyperboloid the centre lies: all that a clear spheroid, or a one-sided "no", asks for.

The centre is outside where R > α² + (α²/γ²) Z. Each side carries at most 5 factors (1+δ), |δ| ≤ u, so the answer is
that of inputs changed by 5u at most; a clear spheroid's centre is a whole radius from the surface.
"""

from __future__ import annotations

from fractions import Fraction

from hypcheck.derivation.listing import program_of
from hypcheck.kernel.specialise.formats import Format
from hypcheck.kernel.specialise.scale import Scaled

CENTRE = program_of(
    "centre",
    ("R", "zz", "waist", "opening"),
    """
    spread = opening * zz
    surface = waist + spread
    outside = R > surface
    """,
)


def centre_constants(scaled: Scaled, form: Format) -> dict[str, float]:
    """α² and α²/γ² in the kernel's units. Raises OverflowError where one leaves the format."""
    exact: dict[str, Fraction] = {
        "waist": scaled.A * scaled.bb,
        "opening": scaled.A * scaled.bb / (scaled.B * scaled.dd),
    }
    return {name: form.rounded(value) for name, value in exact.items()}
