"""Causes of wrong answers about ways: positions tested in place of the way, columns and times mistaken."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hypcheck.geometry.pair import TILTED_COLUMNS
from hypcheck.geometry.rows import Floats, Rows
from hypcheck.implementations import ways
from hypcheck.kernel.classify import classify
from hypcheck.runs.causes import SILENT, Answers, Asked, Rule, Standing
from hypcheck.runs.judge import Criterion
from hypcheck.runs.judges import passage_of, time_is_right
from hypcheck.runs.slips import always, causes_told


def _touches(asked: Asked, place: int) -> Answers:
    """Whether the spheroid is in contact at the start (place 4) or the end (7) of each way, with its axis if any."""
    rows = asked.rows
    ends = np.hstack([rows[:, :4], rows[:, place : place + 3], rows[:, 10:]])
    return np.asarray(classify(np.ascontiguousarray(ends)) == 0, dtype=np.int8)


def _at_the_start(asked: Asked) -> Answers:
    return _timed(asked, _touches(asked, 4), np.zeros(len(asked.rows)))


def _at_the_end(asked: Asked) -> Answers:
    return _timed(asked, _touches(asked, 7), np.ones(len(asked.rows)))


def _at_both_ends(asked: Asked) -> Answers:
    first = _touches(asked, 4)
    return _timed(asked, np.maximum(first, _touches(asked, 7)), np.where(first == 1, 0.0, 1.0))


def _between(asked: Asked) -> Answers:
    """Clear where both ends are clear and the way between them is not."""
    first, last = _touches(asked, 4), _touches(asked, 7)
    missed = (asked.truth == 1) & (asked.given == 0) & (first == 0) & (last == 0)
    return np.where(missed, 0, SILENT).astype(np.int8)


def _timed(asked: Asked, hits: Answers, times: Floats) -> Answers:
    """The hits; nothing where a hit is given at another time than these, which explains no time that is wrong."""
    if asked.times is None:
        return hits
    both = (hits == 1) & (asked.given == 1)
    with np.errstate(invalid="ignore"):
        other = both & ~(np.abs(asked.times - times) <= SAME_TIME)
    return np.where(other, SILENT, hits).astype(np.int8)


SAME_TIME = 1e-9
"""Two times of a way, from 0 to 1, that a rule and an implementation may compute differently."""


@dataclass(frozen=True, slots=True)
class ChangedWay:
    """The exact hits on other ways than those asked, upright spheroids alone."""

    change: Callable[[Rows], Rows]

    def __call__(self, asked: Asked) -> Answers:
        """The hits; SILENT of tilted spheroids."""
        if asked.rows.shape[1] != len(TILTED_COLUMNS):
            return np.full(len(asked.rows), SILENT, dtype=np.int8)
        changed = self.change(asked.rows.copy())
        answers, times = np.full(len(asked.rows), SILENT, dtype=np.int8), np.zeros(len(asked.rows))
        answers[:_MOST_WAYS], times[:_MOST_WAYS] = ways.exact(changed[:_MOST_WAYS])
        return _timed(asked, answers, times)


_MOST_WAYS = 512
"""Deciding a way exactly costs a millisecond, so only so many ways of a chunk are asked again."""


def _times_from_the_end(asked: Asked) -> Answers:
    """The answer given where its time, counted from the end, is right."""
    answers = np.full(len(asked.rows), SILENT, dtype=np.int8)
    if asked.times is None:
        return answers
    for place in np.flatnonzero((asked.given == 1) & (asked.truth == 1)).tolist():
        row = tuple(asked.rows[place].tolist())
        if _time_right(row, 1 - float(asked.times[place]), asked.criterion):
            answers[place] = 1
    return answers


def _times_off(late: bool) -> Rule:
    """The answer given where only its time is wrong, in this direction, by less than a thousandth of the way."""

    def rule(asked: Asked) -> Answers:
        answers = np.full(len(asked.rows), SILENT, dtype=np.int8)
        if asked.times is None:
            return answers
        for place in np.flatnonzero((asked.given == 1) & (asked.truth == 1)).tolist():
            row, time = tuple(asked.rows[place].tolist()), float(asked.times[place])
            off = time - passage_of(row).first_lower
            if 0 < abs(off) < 1e-3 and (off > 0) is late and not _time_right(row, time, asked.criterion):
                answers[place] = 1
        return answers

    return rule


def _time_right(row: tuple[float, ...], time: float, criterion: Criterion) -> bool:
    return time_is_right(row, time, criterion)


def _moved(*order: int) -> ChangedWay:
    return ChangedWay(lambda rows: np.ascontiguousarray(rows[:, order]))


def _level(rows: Rows) -> Rows:
    rows[:, 9] = rows[:, 6]
    return rows


_WHOLE_WAY = "decide the way, not positions on it (hypcheck.passage, docs/motion.md)"

_WAYS: tuple[tuple[str, str, str, Rule], ...] = (
    ("only-the-start", "it tests the start of the way alone", _WHOLE_WAY, _at_the_start),
    ("only-the-end", "it tests the end of the way alone", _WHOLE_WAY, _at_the_end),
    ("only-the-ends", "it tests both ends of the way and nothing between", _WHOLE_WAY, _at_both_ends),
    (
        "way-x-z",
        "it answers as if x and z changed places",
        "columns are alpha, gamma, b, d, x0, y0, z0, x1, y1, z1",
        _moved(0, 1, 2, 3, 6, 5, 4, 9, 8, 7),
    ),
    (
        "way-b-d",
        "it answers as if b and d changed places",
        "columns are alpha, gamma, b, d, x0, y0, z0, x1, y1, z1",
        _moved(0, 1, 3, 2, 4, 5, 6, 7, 8, 9),
    ),
    ("way-level", "it answers as if the way were horizontal", "the way ends at x1, y1, z1", ChangedWay(_level)),
    (
        "way-always-0",
        "it answers 0 whatever the way",
        "let the answer depend on the way",
        always(0),
    ),
    (
        "way-always-1",
        "it answers 1 whatever the way",
        "let the answer depend on the way",
        lambda asked: _timed(asked, always(1)(asked), np.zeros(len(asked.rows))),
    ),
    (
        "times-from-the-end",
        "its times count from the end",
        "time 0 is the start of the way, 1 its end",
        _times_from_the_end,
    ),
)

_WAY_PLACES: tuple[tuple[str, str, str, Rule], ...] = (
    (
        "between-positions",
        "both ends of the way are clear and it says clear, but there is contact between them: it tests positions",
        _WHOLE_WAY,
        _between,
    ),
    (
        "late-times",
        "its times of first contact are late by less than 1/1000 of the way",
        "round times down",
        _times_off(late=True),
    ),
    (
        "early-times",
        "its times of first contact are early by less than 1/1000 of the way",
        "compute the time to the tolerance",
        _times_off(late=False),
    ),
)


WAY_SLIPS = (
    *causes_told(_WAY_PLACES[:1], "way", Standing.PLACE),
    *causes_told(_WAY_PLACES[1:], "way", Standing.ROUNDING),
    *causes_told(_WAYS, "way", Standing.EVERYWHERE),
)
"""The simplest first."""
