"""One pair again and again, with one of its seven numbers changed in between: what is kept from the row before."""

from __future__ import annotations

import numpy as np

from hypcheck.casebook.draw import Draw, stepped
from hypcheck.casebook.everyday import all_regimes
from hypcheck.casebook.family import Family
from hypcheck.casebook.placing import beside, heights, sizes
from hypcheck.pairs import COLUMNS
from hypcheck.rows import Rows

TURN = 2 * len(COLUMNS)
"""Consecutive rows of one pair: as it is, α changed, α as it was but for an ulp, γ changed, and so on."""


def one_number_changed(draw: Draw, n: int) -> Rows:
    """Pairs 2⁻¹⁴ to 2⁻⁶ radii from contact, and changes by 1/16 of the number to all of it, so that many cross it."""
    pairs = -(-n // TURN)
    size = sizes(draw, *all_regimes(draw, pairs))
    offset = draw.signs(pairs) * (1 + draw.signs(pairs) * draw.log_uniform(pairs, -14, -6))
    row = np.repeat(beside(draw, size, heights(draw, size.c), offset), TURN, axis=0)[:n]
    factor = 1 + draw.signs(n) * draw.log_uniform(n, -4, 0)
    turn, column = (np.arange(n) % TURN)[:, None], np.arange(len(COLUMNS))
    changed_now = (turn % 2 == 1) & (column == turn // 2)
    changed_before = column < turn // 2
    ulp_up = stepped(row, np.ones(row.shape, dtype=np.int64))
    return np.where(changed_now, row * factor[:, None], np.where(changed_before, ulp_up, row))


FAMILIES = (
    Family(
        name="one-number-changed",
        version=1,
        title="one number changed from row to row",
        source=f"{TURN} consecutive rows are one pair near contact, each unlike the one before in one number",
        purpose="what is kept from the row before, sizes or an answer, must be dropped whichever of the seven changes",
        game="a creature that grows is still tested at the size it was born with",
        drone="a payload is attached, and the test goes on with the drone's old height",
        regimes="all four",
        make=one_number_changed,
    ),
)
