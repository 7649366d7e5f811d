"""The retest puts cases into batches of every length, and each position at every place."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from hypcheck.runs import retest
from hypcheck.runs.cases import PACE, Pace
from hypcheck.runs.retest import ALONE, FULL_QUESTION, LARGE_QUESTION, LENGTHS, retest_questions

N = 1100
TRUTH = np.resize(np.array([1, 0, -1, 1], dtype=np.int8), N)
STILL = np.full(N, -1)
LONGEST = 20_000


def asked(stands, truth=TRUTH, moments=STILL, number=0, part=0, pace=PACE):
    return list(retest_questions(truth, moments, lambda: stands, 1, number, part, pace))


@pytest.mark.parametrize("stands", [1, 64, LARGE_QUESTION, FULL_QUESTION, LONGEST])
def test_retest_repeats_every_pending_case(stands):
    for n, part in product((0, 1, 15, 31, 33, 40, 700), (0, 1)):
        again = asked(stands, TRUTH[:n], STILL[:n], part=part)
        assert set(np.concatenate([places for places, _ in again])) == set(range(n)), (n, part)


def test_small_batches_of_a_retest_round_are_shared_between_parts_1_and_2():
    shares = [asked(LONGEST, np.resize(TRUTH, 3 * N), np.full(3 * N, -1), part=part) for part in (1, 2)]
    for share in shares:
        assert [len(places) for places, batch in share if batch == 1] == [ALONE // 2]
        assert {len(places) for places, batch in share if batch and batch > 1} >= set(LENGTHS)
    assert shares[0][0][0].tolist() != shares[1][0][0].tolist()


def test_slow_implementation_is_retested_with_few_rows():
    once = N + 4 * retest.TWINS
    assert sum(len(places) for places, _ in asked(LARGE_QUESTION - 1)) == once


def test_retest_rounds_after_the_first_ask_few_rows():
    once = N + 4 * retest.TWINS
    assert sum(len(places) for places, _ in asked(LONGEST, number=1)) < once + FULL_QUESTION


def test_each_index_of_the_largest_retest_batches_has_every_position_in_turn():
    for size, fewest in ((FULL_QUESTION, FULL_QUESTION - 2), (LONGEST, LONGEST - 2)):
        large = [places for places, _ in asked(LONGEST) if fewest <= len(places) <= size][-3:]
        assert [len(places) for places in large] == [size, size, size - 2]
        positions = np.stack([TRUTH[places[: size - 2]] for places in large])
        assert (np.sort(positions, axis=0) == [[-1], [0], [1]]).all()
        assert TRUTH[large[0][-1]] != TRUTH[large[1][-1]]


def test_implementation_that_is_slow_with_full_batches_gets_no_longest_batches():
    assert max(len(places) for places, _ in asked(LONGEST, pace=Pace(soon_s=0.0))) == FULL_QUESTION


def test_small_retest_batches_have_every_remainder_of_a_vector_length():
    lengths = {len(places) for places, batch in asked(LONGEST) if batch and batch > 1}
    assert lengths >= set(LENGTHS)
    for lanes in (2, 4, 8, 16):
        assert {length % lanes for length in LENGTHS} == set(range(lanes))


@pytest.mark.parametrize(("seconds", "count"), [(60.0, ALONE + PACE.single_rows), (0.0, ALONE)])
def test_retest_sends_many_single_rows_until_their_time_is_over(seconds, count):
    assert sum(len(places) for places, batch in asked(LONGEST, pace=Pace(single_s=seconds)) if batch == 1) == count


def test_moving_objects_are_retested_moment_by_moment():
    moments = np.tile(np.arange(8), 4)
    assert [(len(places), batch) for places, batch in asked(64, TRUTH[:32], moments)][-9:] == [(8, 1), *[(4, None)] * 8]
