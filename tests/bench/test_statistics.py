"""Bootstrap intervals contain the median as often as they promise, and are the same for the same samples."""

from __future__ import annotations

import numpy as np
import pytest

from hypcheck.bench.timing import Estimate, estimate, ratios

DRAWN = 300


def coverage(processes, rounds, between, within, median=1.0):
    """How often the interval holds the true median of log-normal samples."""
    generator = np.random.default_rng(7)
    held = 0
    for _ in range(DRAWN):
        level = generator.normal(0, between, (processes, 1))
        found = estimate((median * np.exp(level + generator.normal(0, within, (processes, rounds)))).tolist())
        held += found.low <= median <= found.high
    return held / DRAWN


@pytest.mark.slow
@pytest.mark.parametrize("median", [1e-3, 1.0, 250.0])
def test_interval_contains_the_median_in_94_of_100_runs_if_only_rounds_differ(median):
    assert coverage(5, 5, 0.0, 0.02, median) >= 0.94


@pytest.mark.slow
def test_interval_contains_the_median_in_90_of_100_runs_if_processes_differ_too():
    assert coverage(5, 5, 0.02, 0.02) >= 0.90


def test_interval_of_five_processes_is_too_short_if_only_processes_differ():
    assert 0.75 <= coverage(5, 5, 0.05, 0.001) <= 0.96


def test_interval_does_not_count_the_rounds_of_one_process_as_separate_processes():
    """Levels differ by 5 %, rounds by nothing: an interval from the 25 numbers as such would be far too narrow."""
    levels = [1.0, 1.05, 0.95, 1.02, 0.97]
    found = estimate([[level] * 5 for level in levels])
    assert found.median == 1.0
    assert found.low <= 0.97
    assert found.high >= 1.02


@pytest.mark.slow
def test_the_confidence_interval_shrinks_with_more_rounds():
    generator = np.random.default_rng(3)

    def width(rounds):
        found = estimate(np.exp(generator.normal(0, 0.05, (7, rounds))).tolist())
        return found.high - found.low

    assert width(3) > 3 * width(300)


def test_interval_contains_the_median_of_its_samples_and_is_reproducible():
    samples = [[3.0, 1.0, 2.0], [5.0, 4.0]]
    assert estimate(samples) == estimate(samples)
    found = estimate(samples)
    assert found.median == 3.0
    assert 1.0 <= found.low <= found.median <= found.high <= 5.0


def test_the_interval_of_a_single_sample_is_that_sample():
    assert estimate([[4.0]]) == Estimate(4.0, 4.0, 4.0)
    with pytest.raises(ValueError, match="no sample"):
        estimate([[], []])


def test_ratios_divide_the_samples_of_the_same_round():
    assert ratios([[2.0, 6.0], [8.0]], [[1.0, 2.0], [4.0]]) == [[2.0, 3.0], [2.0]]


def test_a_round_in_which_the_whole_machine_is_slow_does_not_change_ratios():
    """The whole machine is three times slower in one round: both are, so their ratio is not."""
    slow = np.array([[1.0, 3.0, 1.0], [1.0, 1.0, 3.0]])
    found = estimate(ratios((2 * slow).tolist(), slow.tolist()))
    assert found == Estimate(2.0, 2.0, 2.0)


@pytest.mark.parametrize(
    ("low", "high", "width"), [(0.98, 1.01, 1 / 0.98 - 1), (0.99, 1.05, 0.05), (1, 1, 0), (0, 1, np.inf)]
)
def test_half_width_is_the_distance_to_the_farther_end_of_the_interval(low, high, width):
    assert Estimate(1.0, low, high).half_width == pytest.approx(width)
