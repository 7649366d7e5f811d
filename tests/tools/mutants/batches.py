"""Right answers to the wrong row, or to some rows of a question and not to others."""

from __future__ import annotations

import numpy as np

from tests.tools.mutants.exactly import moved, position
from tests.tools.mutants.expectation import wrong

_random = np.random.Generator(np.random.Philox(5))


def _flipped(rows, part):
    """Right answers, but for this part of them on average."""
    answers = position(rows)
    return np.where(_random.random(len(rows)) < part, moved(answers), answers).astype(np.int8)


@wrong()
def last_row(rows):
    """The last row of a question is not computed."""
    answers = position(rows)
    answers[-1] = 0
    return answers


@wrong()
def first_row(rows):
    """The first row of a question is not computed."""
    answers = position(rows)
    answers[0] = 0
    return answers


@wrong()
def lanes_of_4(rows):
    """The rows that are left over when vectors of 4 are full are not computed."""
    answers = position(rows)
    answers[len(rows) - len(rows) % 4 :] = 0
    return answers


@wrong()
def lanes_of_8_read_beyond(rows):
    """The rows left over when vectors of 8 are full get the answer of the last full vector."""
    answers = position(rows)
    full = len(rows) - len(rows) % 8
    answers[full:] = answers[full - 1] if full else 0
    return answers


@wrong()
def blocks_of_256(rows):
    """Every 256th row is not computed: a loop over blocks begins with 1."""
    answers = position(rows)
    answers[::256] = moved(answers[::256])
    return answers


@wrong()
def one_row_behind(rows):
    """Each answer belongs to the row before."""
    return np.roll(position(rows), 1)


@wrong()
def backwards(rows):
    """The answers come in the opposite order."""
    return position(rows)[::-1].copy()


@wrong()
def sorted_by_position(rows):
    """The answers are sorted."""
    return np.sort(position(rows))


@wrong()
def sizes_of_the_first_row(rows):
    """The sizes of a question's first row are used for all its rows."""
    changed = np.array(rows)
    changed[:, :4] = rows[0, :4]
    return position(changed)


def _carried(rows, reach):
    """Right answers, but for those that are kept from the row before, of the same sizes and within reach."""
    answers = position(rows)
    step = np.abs(np.diff(rows[:, 4:], axis=0)).max(axis=1, initial=0)
    same = (step < reach) & (rows[1:, :4] == rows[:-1, :4]).all(axis=1)
    for index in np.flatnonzero(same):
        answers[index + 1] = answers[index]
    return answers


@wrong()
def carried_over(rows):
    """A row whose centre moved by less than a radius since the row before gets the answer of that row."""
    return _carried(rows, rows[1:, 2])


@wrong()
def carried_over_on_a_flight(rows):
    """A row whose centre moved by less than the waist since the row before gets the answer of that row."""
    return _carried(rows, rows[1:, 0])


@wrong()
def small_questions(rows):
    """Questions of fewer than 16 rows take another path, which is wrong."""
    return position(rows) if len(rows) >= 16 else np.zeros(len(rows), dtype=np.int8)


@wrong()
def lone_questions(rows):
    """A question of one row is not computed."""
    return position(rows) if len(rows) > 1 else np.zeros(len(rows), dtype=np.int8)


@wrong()
def large_questions(rows):
    """Of a question of more than 256 rows only the first 256 are computed."""
    answers = position(rows)
    answers[256:] = 0
    return answers


@wrong()
def minds_alignment(rows):
    """Rows that do not begin at a multiple of 16 bytes are read wrongly."""
    return position(rows) if rows.ctypes.data % 16 == 0 else np.zeros(len(rows), dtype=np.int8)


@wrong()
def threads_of_4096(rows):
    """Questions of more than 4096 rows are shared by threads, and the second thread's share is lost."""
    answers = position(rows)
    answers[4096:] = 0
    return answers


@wrong()
def one_flip_in_a_thousand(rows):
    """One answer in a thousand, at random, is another one."""
    return _flipped(rows, 1e-3)


@wrong(asked=("--count", "4000"), luck=True)
def one_flip_in_ten_thousand(rows):
    """One answer in ten thousand, at random, is another one; the default count misses it once in seven times."""
    return _flipped(rows, 1e-4)


@wrong(asked=("--deterministic",))
def rounds_at_random(rows):
    """The spheroid is grown or shrunk by 2 units of rounding, at random."""
    changed = np.array(rows)
    changed[:, 2:4] *= 1 + _random.choice([-2, 2], (len(rows), 1)) * 2.0**-53
    return position(changed)


@wrong()
def lanes_of_64(rows):
    """The rows that are left over when vectors of 64 are full are not computed."""
    answers = position(rows)
    answers[len(rows) - len(rows) % 64 :] = 0
    return answers


@wrong()
def odd_questions(rows):
    """Questions of an odd number of rows are not computed."""
    return position(rows) if len(rows) % 2 == 0 else np.zeros(len(rows), dtype=np.int8)


@wrong()
def answer_kept_while_x_and_y_stay(rows):
    """A row of the same sizes, x and y as the row before gets its answer: z is forgotten."""
    answers = position(rows)
    for index in np.flatnonzero((rows[1:, :6] == rows[:-1, :6]).all(axis=1)):
        answers[index + 1] = answers[index]
    return answers


@wrong()
def twins_of_a_question(rows):
    """Equal rows of a question are computed once, and only the first of them is answered."""
    answers = position(rows)
    first = np.unique(rows, axis=0, return_index=True)[1]
    again = np.ones(len(rows), dtype=bool)
    again[first] = False
    answers[again] = moved(answers[again])
    return answers


@wrong()
def neighbours_alike(rows):
    """A row that is equal to the row before it is not computed."""
    answers = position(rows)
    alike = np.flatnonzero((rows[1:] == rows[:-1]).all(axis=1)) + 1
    answers[alike] = moved(answers[alike])
    return answers


@wrong()
def rest_of_three(rows):
    """Where three rows are left over when vectors of 8 are full, these are not computed."""
    answers = position(rows)
    if len(rows) % 8 == 3:
        answers[-3:] = 0
    return answers


@wrong()
def row_4096(rows):
    """The 4097th row of a question, with which its second page begins, is not computed."""
    answers = position(rows)
    answers[4096:4097] = 0
    return answers


@wrong()
def row_1000_is_interior(rows):
    """The 1001st row of a question is called interior, whatever it is."""
    answers = position(rows)
    answers[1000:1001] = -1
    return answers


@wrong()
def rows_from_4200(rows):
    """What is behind the 4200th row of a question is called exterior."""
    answers = position(rows)
    answers[4200:] = 1
    return answers


@wrong(asked=("--families", "tower-body", "--count", "20000"), luck=True)
def rows_from_8192(rows):
    """What is behind the 8192nd row of a question is not computed; who takes 4 µs a row is asked fewer by default."""
    answers = position(rows)
    answers[8192:] = 0
    return answers
