"""The first steps of a specialised kernel: from the centre to R = x² + y² and zz = z², in the kernel's units."""

from __future__ import annotations

from fractions import Fraction

from hypcheck.derivation.listing import program_of
from hypcheck.derivation.program import Program
from hypcheck.kernel.specialise.scale import Scaled

RADIAL, AXIAL = "radial_unit", "axial_unit"
"""Names of the two powers of two, where a kernel has them."""

_ONE = Fraction(1)
UNSCALED = Scaled(_ONE, _ONE, _ONE, _ONE, _ONE, _ONE)
"""Some sizes that need no scaling: what is counted of their entry holds for all."""


def entry(scaled: Scaled) -> tuple[Program, dict[str, float]]:
    """The program from x, y, z to R, zz and height = |z|, with the constants it takes besides them."""
    constants = {
        name: float(value) for name, value in ((RADIAL, scaled.radial), (AXIAL, scaled.axial)) if value != _ONE
    }
    lines = []
    across, up = ("x", "y"), "z"
    if RADIAL in constants:
        lines += [f"x_scaled = x * {RADIAL}", f"y_scaled = y * {RADIAL}"]
        across = ("x_scaled", "y_scaled")
    if AXIAL in constants:
        lines.append(f"z_scaled = z * {AXIAL}")
        up = "z_scaled"
    lines += [f"xx = {across[0]} * {across[0]}", f"yy = {across[1]} * {across[1]}", "R = xx + yy"]
    lines += [f"zz = {up} * {up}", f"height = abs {up}"]
    return program_of("entry", ("x", "y", "z", *constants), "\n".join(lines)), constants
