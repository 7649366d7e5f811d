"""The roots' way as programs, to be counted beside the formulas of formulas.py, which need no root."""

from __future__ import annotations

from hypcheck.derivation.coefficient_listings import TABLE_2
from hypcheck.derivation.formulas import Formula
from hypcheck.derivation.listing import program_of
from hypcheck.derivation.root_listings import TRIGONOMETRIC, WEIERSTRASS_SWEEP
from hypcheck.pairs import COLUMNS

ROOTS_TRIGONOMETRIC = Formula(
    name="roots-trigonometric",
    title="Δ, and where it is positive the signs of the three roots, by cosines",
    question="exterior",
    program=program_of("roots-trigonometric", COLUMNS, TABLE_2, TRIGONOMETRIC),
    answer="valid",
    source="section 3.1, after its words on [13]",
    regimes=("c2>=a",),
)

APPROXIMATIONS = ("x1", "y1", "x2", "y2", "x3", "y3")

SWEEP = program_of("roots-sweep", ("c2", "c1", "c0", *APPROXIMATIONS), WEIERSTRASS_SWEEP)
"""From approximations x + yi of the three roots to better ones, new_x1 … new_y3; a root finder does several."""
