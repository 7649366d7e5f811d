"""Causes about sweeps: positions tested in place of the sweep, columns mistaken, times of first contact wrong.

A rule about the input answers the sweep that its sentence in causes.toml says. A rule about times gives the given
answer where only the time is wrong, in its way. Places at times between the ends are rounded: they name a cause, and
judge nothing.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hypcheck.geometry.rows import SWEEPS, Floats, Row
from hypcheck.implementations import sweeps
from hypcheck.kernel.classify import classify
from hypcheck.runs.causes import SILENT, AnsweredRows, Answers, Rule, Scope, always, causes_about, silent
from hypcheck.runs.judge import time_is_right
from hypcheck.truth.passage_error import passage_of

SAME_TIME = 1e-9
"""The most by which two times of a sweep (0 to 1) may differ if a rule and an implementation compute the same one."""


_SLIGHTLY = 1e-3
"""A time that is wrong by less was computed inexactly; a time that is later by more belongs to another position."""


_MOST_SWEEPS = 512
"""A sweep that bounds do not decide costs milliseconds, so at most this many sweeps of a chunk are tested again."""


def _touches(answered: AnsweredRows, times: Floats | float) -> Answers:
    """Return 1 for each sweep with contact at its time, else 0. Time 0 is the start of the sweep, 1 its end."""
    rows, times = answered.rows, np.full((1, len(answered.rows)), times).T
    start, end = rows[:, 4:7], rows[:, 7:10]
    with np.errstate(over="ignore"):  # rounded beyond the largest float64, a centre would be no valid row
        centres = np.clip((1 - times) * start + times * end, np.minimum(start, end), np.maximum(start, end))
    return np.asarray(classify(np.hstack([rows[:, :4], centres, rows[:, 10:]])) == 0, dtype=np.int8)


def _timed(answered: AnsweredRows, hits: Answers, times: Floats | float) -> Answers:
    """Return the hits, but SILENT where the given answer is a hit at a time other than this rule's."""
    if answered.times is None:
        return hits
    with np.errstate(invalid="ignore"):
        other = (hits == 1) & (answered.given == 1) & ~(np.abs(answered.times - times) <= SAME_TIME)
    return np.where(other, SILENT, hits).astype(np.int8)


def _at_both_ends(answered: AnsweredRows) -> Answers:
    """Answer by the positions at both ends of the sweep alone."""
    first = _touches(answered, 0.0)
    return _timed(answered, np.maximum(first, _touches(answered, 1.0)), np.where(first == 1, 0.0, 1.0))


def _between(answered: AnsweredRows) -> Answers:
    """Answer 0 (clear) where 0 is given, both ends are clear, and the sweep between them is not; SILENT elsewhere."""
    first, last = _touches(answered, 0.0), _touches(answered, 1.0)
    missed = (answered.truth == 1) & (answered.given == 0) & (first == 0) & (last == 0)
    return np.where(missed, 0, SILENT).astype(np.int8)


def _other_sweeps(*order: int) -> Rule:
    """Return the rule that answers sweeps with their columns in another order; SILENT about tilted spheroids."""

    def rule(answered: AnsweredRows) -> Answers:
        answers, times = silent(answered), np.zeros(len(answered.rows))
        if SWEEPS.has_axis(answered.rows):
            return answers
        answers[:_MOST_SWEEPS], times[:_MOST_SWEEPS] = sweeps.certified_times(
            np.ascontiguousarray(answered.rows[:_MOST_SWEEPS, order])
        )
        return _timed(answered, answers, times)

    return rule


def _where_time(answered: AnsweredRows, holds: Callable[[Row, float], bool]) -> Answers:
    """Return the given answer where it is a right hit and `holds(sweep, time)` is true; SILENT elsewhere."""
    answers = silent(answered)
    if answered.times is not None:
        for place in np.flatnonzero((answered.given == 1) & (answered.truth == 1)).tolist():
            if holds(tuple(answered.rows[place].tolist()), float(answered.times[place])):
                answers[place] = 1
    return answers


def _times_from_the_end(answered: AnsweredRows) -> Answers:
    """Return the given answer where its time is right if it is counted from the sweep's end; SILENT elsewhere."""
    return _where_time(answered, lambda row, time: time_is_right(row, 1 - time, answered.criterion))


def _times_off(answered: AnsweredRows, holds: Callable[[float], bool]) -> Answers:
    """Return the given answer where only its time is wrong, by an amount for which `holds` is true; SILENT elsewhere.

    The amount is the time minus the first contact.
    """

    def is_off(row: Row, time: float) -> bool:
        return holds(time - passage_of(row).first_lower) and not time_is_right(row, time, answered.criterion)

    return _where_time(answered, is_off)


def _sampled(answered: AnsweredRows) -> Answers:
    """Return the given answer where its time is a thousandth of the sweep or more too late; SILENT elsewhere.

    There must be contact at that time, as there is if positions at sampled times are tested.
    """
    touches = _touches(answered, 0.0 if answered.times is None else np.nan_to_num(answered.times))
    late = _times_off(answered, lambda off: off >= _SLIGHTLY)
    return np.where(touches == 1, late, SILENT).astype(np.int8)


SWEEP_CAUSES = (
    *causes_about("way", {"between-positions": _between}, Scope.PLACE),
    *causes_about(
        "way",
        {
            "late-times": lambda answered: _times_off(answered, lambda off: 0 < off < _SLIGHTLY),
            "early-times": lambda answered: _times_off(answered, lambda off: -_SLIGHTLY < off < 0),
        },
        Scope.ROUNDING,
    ),
    *causes_about(
        "way",
        {
            "only-the-start": lambda answered: _timed(answered, _touches(answered, 0.0), 0.0),
            "only-the-end": lambda answered: _timed(answered, _touches(answered, 1.0), 1.0),
            "only-the-ends": _at_both_ends,
            "way-x-z": _other_sweeps(0, 1, 2, 3, 6, 5, 4, 9, 8, 7),
            "way-b-d": _other_sweeps(0, 1, 3, 2, 4, 5, 6, 7, 8, 9),
            "way-level": _other_sweeps(0, 1, 2, 3, 4, 5, 6, 7, 8, 6),
            "way-always-0": always(0),
            "way-always-1": lambda answered: _timed(answered, always(1)(answered), 0.0),
            "times-from-the-end": _times_from_the_end,
        },
    ),
    *causes_about("way", {"sampled-times": _sampled}, Scope.PLACE),
)
"""Positions tested in place of the sweep, columns and times mistaken. The simplest first."""
