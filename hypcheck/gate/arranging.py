"""Which cases are asked together when they are asked again: alone, in questions of every size, and in every place.

Whoever answers many rows at once can be wrong about a place of a question alone: the rest that no vector holds, the
first row of a thread, a block that is never begun. Such an answer is right by luck where it is the same as the truth,
so that each place of a large question is asked with each position in turn.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from hypcheck.pairs import Position

Indices = NDArray[np.intp]
Question = tuple[Indices, int | None]
"""Cases, and in questions of how many they are asked; None: of as many as can be."""

ALONE, MANY = 32, 1100
"""Cases that are asked one by one, and questions in turn to who takes no longer than QUICK over each: more than fit
into a counter of 8 or of 10 bits."""

QUICK = 2e-3
"""Seconds."""

SOON = 0.05
"""Seconds in which full questions are answered by whoever is asked the longest as well: these take a second then."""

LENGTHS = (7, 3, 11, 2, 5, 13, 9, 6, 15, 10, 4, 14, 12, 8, 17, 16, 31, 33, 63, 65, 129, 127)
"""Rows of small questions: each remainder by 2, 4, 8 and 16, and what is beside a power of two."""

IN_LENGTHS = 1536
"""Cases asked in questions of LENGTHS at most, unless they are asked more than once."""

ROUNDS = 3
"""Questions of each of LENGTHS to who stands so many rows that these cost nothing."""

TWINS = 64
"""Cases asked four times in one question, beside themselves and apart, for whoever keeps answers by their rows."""

LARGE = 4096
FULL = LARGE + 128 + 1
"""Rows of a full question at least, of who can be asked so many: cases are repeated, so that every thread, block and
page of whoever divides a question has some."""

PARTS = 3
"""Parts of a round at most, each with an order of its own."""

SHORTER = (0, 0, 2)
"""By how many rows full questions fall short, so that a vector's rest is not always the same; two are whole, so that
an answer that is always the same in the last place is wrong in one of them."""


def questions(
    truth: NDArray[np.int8],
    moments: NDArray[np.int64],
    stands: Callable[[], int],
    seed: int,
    number: int,
    part: int = 0,
) -> Iterator[Question]:
    """The questions about n cases with these positions, each case in one at least.

    `moments` (n,) are those of movements, −1 of cases that follow no object: who carries answers over from one question
    to the next is found where the same objects are asked moment by moment. `stands` is how many rows of one question
    it has shown to answer well within its time so far; who stands LARGE ones is asked each case many times in the first
    part of the first round of a run, of which `number` and `part` are 0. Parts 1 and 2 share the small questions.
    """
    random = np.random.Generator(np.random.Philox((seed, PARTS * number + part)))
    order = random.permutation(np.flatnonzero(moments < 0))
    share = 2 if part else 1
    alone = ALONE // share
    yield order[:alone], 1
    yield np.tile(np.repeat(order[: TWINS // share], 2), 2), None
    rest = order[alone:]
    some = min(IN_LENGTHS // share, (len(rest) + 1) // 2)
    began = time.monotonic()
    small = list(_of_every_length(rest[:some]))
    yield from small
    quick = time.monotonic() - began < QUICK * len(small)
    yield _filled(rest[some:], order, FULL if stands() >= FULL else 0), None
    if number == part == 0 and stands() >= LARGE and len(order):
        yield from _of_every_length(np.resize(order, ROUNDS * sum(LENGTHS)))
        began = time.monotonic()
        yield from _in_every_place(order, truth, random, min(FULL, stands()))
        if time.monotonic() - began < SOON:
            yield from _in_every_place(order, truth, random, stands())
        if quick:
            yield np.resize(order, MANY), 1
    yield from _moment_by_moment(moments)


def _of_every_length(cases: Indices) -> Iterator[Question]:
    start = 0
    while start < len(cases):
        for length in LENGTHS:
            part = cases[start : start + length]
            if len(part):
                yield part, length
            start += length


def _filled(cases: Indices, order: Indices, least: int) -> Indices:
    """The cases, repeated to make `least`."""
    if len(order) and len(cases) < least:
        return np.resize(cases if len(cases) else order, least)
    return cases


def _in_every_place(
    order: Indices, truth: NDArray[np.int8], random: np.random.Generator, size: int
) -> Iterator[Question]:
    """Questions of about `size` rows, as many as there are positions among the cases: others in each at each place."""
    parts = [part for position in Position if len(part := order[truth[order] == position])]
    which = random.integers(len(parts), size=size)
    for turn in range(len(parts)):
        chosen = (which[: size - SHORTER[turn]] + turn) % len(parts)
        cases = np.empty(len(chosen), dtype=np.intp)
        for number, part in enumerate(parts):
            here = np.flatnonzero(chosen == number)
            cases[here] = np.resize(part, len(here))
        yield cases, None


def _moment_by_moment(moments: NDArray[np.int64]) -> Iterator[Question]:
    moving = np.flatnonzero(moments >= 0)
    if len(moving):
        yield moving[: int(moments.max()) + 1], 1
        for moment in range(int(moments.max()) + 1):
            yield moving[moments[moving] == moment], None
