"""The routines of printed clearances: bounds of the maximum of the dual function, at several multipliers."""

from __future__ import annotations

from sys import float_info

from hypcheck.derivation.program import steps_of
from hypcheck.derivation.routines import Call, Routine
from hypcheck.geometry.pair import TILTED_COLUMNS
from hypcheck.kernel.programs import sweeps
from hypcheck.kernel.specialise.looking import STANDING, TRY_CONSTANTS, tried


def _bound(name: str, meaning: str, bound: str, at_first: str) -> Routine:
    """A bound of the clearance: the best of those at several multipliers."""
    more = "bound > best" if at_first == "nothing_least" else "bound < best"
    of_way = Routine(
        f"{name}_at",
        meaning,
        (*sweeps.ROW, "at"),
        tried(
            (("best", at_first, "best_now"),),
            (
                *steps_of(bound),
                *steps_of(
                    f"better = {more}\nbest_better = better ? bound : best\nbest_now = valid ? best_better : best"
                ),
            ),
        ),
        "best",
        constants={
            **TRY_CONSTANTS,
            "unsure_u": sweeps.CONSTANTS["u_k"],
            "nothing_least": -1.0,
            "nothing_most": float_info.max,
        },
    )
    return Routine(name, meaning, TILTED_COLUMNS, (Call("told", of_way, (*STANDING, 0)),), "told")


_QUOTIENT = """
    valid = inside and d_known
    d_most = d_l + e_d
    is_positive = {value} > 0
    under = is_positive ? {positive} : {negative}
    divisor = valid ? under : 1
    quotient = {value} / divisor
    size_quotient = abs quotient
"""

_FACTOR = """
    usable_square = square_bound > 0
    square_or_0 = usable_square ? square_bound : 0
    factor = sqrt square_or_0
    rough = factor - 1
    factor_sizes = 1 + factor
    last_unsure = unsure_u * factor_sizes
"""

LOWER = _bound(
    "lower_of",
    "A proved lower bound of the clearance, in radii: grown by less, the spheroid stays clear; -1 says nothing.",
    _QUOTIENT.format(value="here", positive="d_most", negative="d_least")
    + """
    sizes_sum = 1 + size_quotient
    unsure = unsure_u * sizes_sum
    square = 1 + quotient
    square_bound = square - unsure
    """
    + _FACTOR
    + "bound = rough - last_unsure",
    "nothing_least",
)

UPPER = _bound(
    "upper_of",
    "A proved upper bound of the clearance, in radii: grown by more, the spheroid has contact.",
    "over = F + e_F\n"
    + _QUOTIENT.format(value="over", positive="d_least", negative="d_most")
    + """
    divisor_least = valid ? d_least : 1
    rise = slope_most / divisor_least
    rise_over = rise / divisor_least
    rise_most = rise_over / less_sure
    sizes_before = 1 + size_quotient
    sizes_sum = sizes_before + rise_most
    unsure = unsure_u * sizes_sum
    square_before = 1 + quotient
    square = square_before + rise_most
    square_bound = square + unsure
    """
    + _FACTOR
    + "bound = rough + last_unsure",
    "nothing_most",
)
