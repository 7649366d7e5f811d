"""Contact on straight sweeps by the kernel: against frozen sweeps, exact decisions and every rounding mode."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.geometry.pair import REFUSED
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.implementations import sweeps
from hypcheck.vectors.frozen import SWEEP_NAMES, load
from tests.support.inside import answer_sweeps as compiled_answer_sweeps
from tests.support.inside import hits_at_size, numpy_kernel_answer_sweeps, passage_of_row
from tests.tools.attack.rounding import DIRECTED, rounded

compiled = pytest.importorskip("hypcheck.kernel._compiled")

UPRIGHT = [name for name in SWEEP_NAMES if not name.startswith("tilted")]
TOUCHING = {"way-grazing", "way-near-graze", "way-short"}
"""Families in which clearance, or overlap, falls below what rounding may amount to."""

DOWN = (2.0, 17.8, 0.25, 0.15, 1.8, 0.0, 9.0, 1.8, 0.0, -9.0)


def some_sweeps(seed, count, *, tilted=False):
    """Sweeps of sizes from 1/16 to 16, half of them about as short as the spheroid, with an axis if `tilted`."""
    random = np.random.default_rng(seed)
    sizes = np.exp2(random.uniform(-4, 4, (count, 4)))
    spread = 2 * sizes[:, [0, 0, 1]] * np.exp2(random.uniform(-2, 2, (count, 1)))
    start, end = random.normal(size=(2, count, 3)) * spread
    end[::2] = (start + 0.3 * random.normal(size=(count, 3)) * sizes[:, [2, 2, 3]])[::2]
    axis = random.normal(size=(count, 3 if tilted else 0))
    return np.concatenate([sizes, start, end, axis], axis=1)


def test_the_compiled_kernel_decides_every_frozen_sweep_but_those_that_touch():
    """That it decides none wrongly is tested in tests/test_corpus.py, as of all that decide."""
    for name in SWEEP_NAMES:
        hits, times = compiled_answer_sweeps(load(name).rows)
        assert (hits != CANNOT_SAY).all() or name in TOUCHING, name
        assert np.isnan(times[hits != 1]).all(), name


@pytest.mark.parametrize(("count", "tilted"), [(300, False), (80, True)])
def test_the_compiled_kernel_gives_exact_hits_and_times_not_after_the_first_contact(count, tilted):
    rows = some_sweeps(1, count, tilted=tilted)
    hits, times = compiled_answer_sweeps(rows)
    truth = [passage_of_row(row) for row in rows.tolist()]
    assert hits.tolist() == [each.hit for each in truth]
    assert 0.1 * count < hits.sum() < 0.9 * count
    for time, each in zip(times.tolist(), truth, strict=True):
        assert math.isnan(time) or 0 <= time <= each.first_upper
    assert np.isnan(times[hits == 1]).sum() < 3


@pytest.mark.parametrize(("count", "tilted"), [(120, False), (40, True)])
def test_a_slightly_larger_spheroid_has_contact_at_the_time_of_a_hit(count, tilted):
    rows = some_sweeps(2, count, tilted=tilted)
    hits, times = compiled_answer_sweeps(rows)
    timed = np.isfinite(times)
    assert timed.sum() > 0.9 * (hits == 1).sum()
    for row, time in zip(rows[timed].tolist(), times[timed].tolist(), strict=True):
        alpha, gamma, b, d, *ends = (Fraction(each) for each in row[:10])
        across, along = sum(map(abs, (ends[0], ends[1], ends[3], ends[4]))), abs(ends[2]) + abs(ends[5])
        there = [start + Fraction(time) * (end - start) for start, end in zip(ends[:3], ends[3:], strict=True)]
        radii = (min(b, d),) * 2 if tilted else (b, d)
        grown = 1 + Fraction(1, 2**43) * (1 + across / radii[0] + along / radii[1])
        assert hits_at_size((alpha, gamma, b, d, *there, *there, *row[10:]), grown)


@pytest.mark.parametrize("mode", DIRECTED)
def test_the_compiled_kernel_answers_no_sweep_wrongly_in_any_rounding_mode(mode):
    for name in ("way-near-graze", "way-short", "way-stiff", "way-vertical", "tilted-way-end", "tilted-way-uniform"):
        cases = load(name)
        hits, times = np.empty(len(cases.rows), np.int8), np.empty(len(cases.rows))
        with rounded(mode):
            compiled.passage(cases.rows, hits, times)
        assert ((hits == CANNOT_SAY) | (hits == cases.positions)).all()


@pytest.mark.parametrize("answer_sweeps", [compiled_answer_sweeps, numpy_kernel_answer_sweeps], ids=["c", "numpy"])
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 0.0, -1.0])
def test_an_invalid_sweep_is_refused_and_changes_no_other_answer(answer_sweeps, value):
    for column in range(10):
        rows = np.array([DOWN, DOWN, DOWN])
        rows[1, column] = value
        hits, times = answer_sweeps(rows)
        valid = math.isfinite(value) and (column >= 4 or value > 0)
        assert (hits[1] != REFUSED) == valid, column
        assert hits[[0, 2]].tolist() == answer_sweeps(rows[:1])[0].tolist() * 2
        assert valid or math.isnan(times[1])


@pytest.mark.parametrize("axis", [(0.0, -0.0, 0.0), (math.nan, 0.0, 1.0), (0.0, 1.0, -math.inf)])
@pytest.mark.parametrize("answer_sweeps", [compiled_answer_sweeps, numpy_kernel_answer_sweeps], ids=["c", "numpy"])
def test_a_sweep_whose_axis_has_no_direction_is_refused(answer_sweeps, axis):
    rows = np.array([(*DOWN, 1.0, 0.0, 1.0), (*DOWN, *axis)])
    hits, times = answer_sweeps(rows)
    assert (hits == REFUSED).tolist() == [False, True]
    assert math.isnan(times[1])


TINY, HUGE = 5e-324, 1.7e308


@pytest.mark.parametrize(
    ("row", "hit"),
    [
        ((2, 17.8, TINY, TINY, 2.2, 0, 9, 2.2, 0, 0), 1),  # to shrink the least subnormal radius is no change
        ((2, 17.8, 2.0**-950, 2.0**-950, 2.2, 0, 9, 2.2, 0, 0), 1),
        ((2, 17.8, 2.0**-150, 2.0**-150, 2.2, 0, 9, 2.2, 0, -9), 1),  # out and in again
        ((2, 17.8, TINY, TINY, 1.8, 0, 1, 1.8, 0, -1), 0),
        ((TINY, TINY, TINY, TINY, 0, 0, 0, TINY, 0, 0), 1),
        ((HUGE, HUGE, 1, 1, 0, 0, 0, 1, 0, 0), 0),
        ((1, 1, HUGE, HUGE, 0, 0, 0, 1, 0, 0), 1),
        ((2, 17.8, 0.25, 0.15, 2.0**160, 0, 0, -(2.0**160), 0, 0), 1),
        ((2, 17.8, 0.25, 0.15, HUGE, 0, 0, HUGE, HUGE, 0), 0),
        ((2, 17.8, 0.25, 0.15, TINY, -TINY, TINY, -TINY, TINY, -TINY), 0),
        ((2.0**90, 2.0**90, 2.0**80, 2.0**80, 2.0**95, 0, 0, 0, 0, 0), 1),
    ],
)
def test_sweeps_with_subnormal_and_huge_numbers_are_decided_exactly(row, hit):
    rows = np.array([row], dtype=float)
    assert compiled_answer_sweeps(rows)[0][0] in (hit, CANNOT_SAY)
    assert sweeps.certified(rows).tolist() == [hit]


def test_hits_of_sweeps_do_not_depend_on_whether_times_are_requested():
    rows = np.concatenate([load(name).rows for name in UPRIGHT])
    without = np.empty(len(rows), np.int8)
    compiled.passage(rows, without)
    assert (without == compiled_answer_sweeps(rows)[0]).all()


def test_compiled_passage_refuses_buffers_that_do_not_fit():
    rows, hits = np.array([DOWN, DOWN]), np.empty(2, np.int8)
    for given in ((rows, hits[:1]), (rows, hits, np.empty(1)), (rows, hits, hits), (hits, hits)):
        with pytest.raises(ValueError, match=r"ten, thirteen or sixteen numbers|a buffer of format d"):
            compiled.passage(*given)
