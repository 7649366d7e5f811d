"""Wrong answers of a batch, judged, and both ends of the backward error of an answer about a tilted spheroid."""

from __future__ import annotations

import numpy as np

from hypcheck.geometry.pair import Pair, Position
from hypcheck.runs import judge
from tests.support import inside
from tests.support.inside import quick_bracket


def wrong_cases(rows, truth, answers, criterion) -> list[judge.WrongCase]:
    """Every wrong answer of a batch, judged."""
    wrong = np.flatnonzero(judge.is_wrong(truth, answers, criterion.question))
    return list(judge.judged(rows, answers, wrong, criterion))


def ends_of(row, answer) -> tuple[float, float]:
    """Two ends between which the backward error of a position is proved to lie."""
    pair = Pair.from_row(row)
    ends = quick_bracket(pair, inside.decide(pair.lengths), Position(answer))
    return ends.lower, ends.upper
