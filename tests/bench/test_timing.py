"""Rounds of timing: every entry once in each, in rotated order, with calibrated loops; wrong answers are refused.

Bootstrap intervals contain the median as often as they promise, and are the same for the same samples.
"""

from __future__ import annotations

import gc

import numpy as np
import pytest

from hypcheck.runs.timing import (
    MOST_LOOPS,
    Estimate,
    TimingEntry,
    TimingRefusedError,
    clocked,
    estimate,
    measure,
    measured_samples,
    ratios,
)


class Clock:
    """Work that takes as long as it is told, and remembers when it was asked."""

    def __init__(self, name, order, ns=1000, checksums=(7,)):
        self.name, self.order, self.ns, self.checksums = name, order, ns, list(checksums)
        self.repeats = []

    def __call__(self, repeat):  # noqa: D102 - the class says it
        self.order.append(self.name)
        self.repeats.append(repeat)
        return repeat * self.ns, self.checksums.pop(0) if len(self.checksums) > 1 else self.checksums[0]


def measured(entries, rounds=3, **options):
    done = []
    samples = measure(entries, rounds, advance=done.append, **options)
    assert sum(done) == rounds
    return {each.name: each for each in samples}


def test_each_timing_round_begins_with_another_method_and_times_all_methods():
    order = []
    names = ["a", "b", "c"]
    entries = [TimingEntry(name, 10, Clock(name, order), loops=1) for name in names]
    measured(entries, rounds=4, first=1)
    assert "".join(order[3:]) == "bca" + "cab" + "abc" + "bca"


def test_the_number_of_loops_makes_a_sample_as_long_as_requested():
    found = measured([TimingEntry("a", 4, Clock("a", [], ns=1000))], shortest_s=1e-3)["a"]
    assert found.loops * found.takes == 1000
    assert found.samples_ns == [250.0] * 3
    assert found.median_ns == 250.0


def test_a_sample_of_slow_work_has_one_loop():
    clock = Clock("a", [], ns=10**8)
    found = measured([TimingEntry("a", 1, clock)], shortest_s=1e-3)["a"]
    assert (found.loops, found.takes) == (1, 1)
    assert clock.repeats[2:] == [1, 1, 1]


def test_a_sample_is_the_fastest_of_several_takes_so_that_an_interruption_does_not_count():
    times = iter([9000, 1000, 1100, 8000, 7000] * 3)
    entry = TimingEntry("a", 1, lambda repeat: (0 if repeat == 1 else repeat * next(times), 3), 3, loops=7, takes=5)
    assert measured([entry])["a"].samples_ns == [1000.0] * 3


def test_timing_work_of_no_measurable_time_ends_at_the_largest_number_of_loops():
    assert measured([TimingEntry("a", 1, Clock("a", [], ns=0))])["a"].loops == MOST_LOOPS


def test_a_measurement_with_a_given_number_of_loops_keeps_that_number():
    assert measured([TimingEntry("a", 1, Clock("a", []), loops=17)])["a"].loops == 17


def test_a_method_whose_answers_change_during_timing_is_refused_and_not_timed_again():
    order = []
    changing = Clock("b", order, checksums=[7, 7, 8])
    found = measured([TimingEntry("a", 1, Clock("a", order), 7, 1), TimingEntry("b", 1, changing, 7, 1)], rounds=5)
    assert found["a"].refused is None
    assert len(found["a"].samples_ns) == 5
    assert found["b"].refused == "its answers summed to 8 while it was timed; they must sum to 7"
    assert len(found["b"].samples_ns) == 1
    assert order.count("b") == 3


def test_a_method_whose_first_answers_are_not_the_expected_ones_is_refused():
    found = measured([TimingEntry("a", 1, Clock("a", [], checksums=[6]), 7, 1)])["a"]
    assert found.refused is not None
    assert found.samples_ns == []


def test_clocked_repeats_the_work_and_sums_its_answers_once():
    done = []

    def work():
        done.append(1)
        return np.array([1, 1, -1, 1], dtype=np.int8)

    took, checksum = clocked(work)(5)
    assert took >= 0
    assert (len(done), checksum) == (5, 2)


def test_clocked_sums_int8_answers_beyond_the_range_of_int8():
    assert clocked(lambda: np.ones(1000, dtype=np.int8))(1)[1] == 1000


@pytest.mark.parametrize("enabled", [True, False])
def test_a_round_of_timing_switches_garbage_collection_off_and_restores_it(enabled):
    seen = []

    def work(repeat):
        seen.append(gc.isenabled())
        return 1, 0

    before = gc.isenabled()
    (gc.enable if enabled else gc.disable)()
    try:
        measured([TimingEntry("a", 1, work, loops=1)])
        assert gc.isenabled() is enabled
        assert seen[1:] == [False] * 3
    finally:
        (gc.enable if before else gc.disable)()


def test_a_method_that_cannot_be_timed_in_a_round_keeps_its_reason_and_is_not_timed_again():
    asked = []

    def refusing(repeat):
        asked.append(repeat)
        if len(asked) > 1:
            raise TimingRefusedError("it is gone")
        return 1000, 7

    entry = TimingEntry("a", 1, refusing, 7, 1)
    found = measured([entry], rounds=3)["a"]
    assert (found.refused, found.samples_ns) == ("it is gone", [])
    assert len(asked) == 2
    asked.clear()
    with pytest.raises(AssertionError, match="a: it is gone"):
        measured_samples([entry], 3)


DRAWN = 300


def coverage(processes, rounds, between, within):
    """How often the interval holds the true median of log-normal samples."""
    generator = np.random.default_rng(7)
    held = 0
    for _ in range(DRAWN):
        level = generator.normal(0, between, (processes, 1))
        found = estimate(np.exp(level + generator.normal(0, within, (processes, rounds))).tolist())
        held += found.low <= 1.0 <= found.high
    return held / DRAWN


@pytest.mark.slow
def test_interval_contains_the_median_in_94_of_100_runs_if_only_rounds_differ():
    assert coverage(5, 5, 0.0, 0.02) >= 0.94


@pytest.mark.parametrize("unit", [1e-3, 250.0])
def test_interval_in_another_unit_of_time_is_the_same_interval(unit):
    samples = np.exp(np.random.default_rng(7).normal(0, 0.02, (5, 5)))
    found, other = estimate(samples.tolist()), estimate((unit * samples).tolist())
    assert found.low < found.median < found.high
    assert (other.median, other.low, other.high) == pytest.approx(
        [unit * each for each in (found.median, found.low, found.high)]
    )


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
