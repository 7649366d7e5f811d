"""Right answers to the wrong row, or to some rows of a question and not to others; state that outlives a question."""

from __future__ import annotations

import numpy as np

from tests.mutants.exactly import position
from tests.mutants.expectation import wrong

_calls = [0]
_rows = [0]
_kept = np.zeros(1 << 17, dtype=np.int8)
_kept_sizes = np.ones(4)
_seen: set[bytes] = set()
_last = [np.zeros(1, dtype=np.int8)]
_random = np.random.Generator(np.random.Philox(5))


def _moved(answers):
    """Other answers than these."""
    return np.where(answers == 0, 1, 0).astype(np.int8)


def _flipped(rows, part):
    """Right answers, but for this part of them on average."""
    answers = position(rows)
    return np.where(_random.random(len(rows)) < part, _moved(answers), answers).astype(np.int8)


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
    answers[::256] = _moved(answers[::256])
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
def question_before(rows):
    """Each question gets the answers of the one before it."""
    answers, _last[0] = np.resize(_last[0], len(rows)), position(rows)
    return answers


@wrong()
def after_ten_questions(rows):
    """Everything is contact from the eleventh question on."""
    _calls[0] += 1
    return position(rows) if _calls[0] <= 10 else np.zeros(len(rows), dtype=np.int8)


@wrong()
def after_ten_thousand_rows(rows):
    """Everything is contact from the ten-thousandth row on."""
    _rows[0] += len(rows)
    return position(rows) if _rows[0] <= 10_000 else np.zeros(len(rows), dtype=np.int8)


@wrong()
def first_question_only(rows):
    """The sizes of the first row that a process ever saw are used for all."""
    if not _calls[0]:
        _kept_sizes[:] = rows[0, :4]
    _calls[0] += 1
    changed = np.array(rows)
    changed[:, :4] = _kept_sizes
    return position(changed)


@wrong()
def sizes_of_the_first_row(rows):
    """The sizes of a question's first row are used for all its rows."""
    changed = np.array(rows)
    changed[:, :4] = rows[0, :4]
    return position(changed)


@wrong()
def contact_is_not_written(rows):
    """Clear rows are written into a buffer that is kept, contact is what was there before."""
    answers = position(rows)
    kept = _kept[: len(rows)]
    kept[answers != 0] = answers[answers != 0]
    return kept.copy()


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


@wrong(asked=("--count", "4000"))
def after_a_hundred_thousand_rows(rows):
    """Everything is contact from the hundred-thousandth row on."""
    _rows[0] += len(rows)
    return position(rows) if _rows[0] <= 100_000 else np.zeros(len(rows), dtype=np.int8)


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
def after_the_first_question(rows):
    """Everything is contact from the second question on."""
    _calls[0] += 1
    return position(rows) if _calls[0] == 1 else np.zeros(len(rows), dtype=np.int8)


@wrong()
def begins_with_a_lone_row(rows):
    """A process that was asked about a lone row first takes another path ever after, which is wrong."""
    if not _calls[0]:
        _last[0] = np.full(1, len(rows), dtype=np.int64)
    _calls[0] += 1
    return position(rows) if _last[0][0] > 1 else np.zeros(len(rows), dtype=np.int8)


def _kept_while_alike(rows, alike):
    """The sizes of a row are those of the row before where these columns are alike, from question to question."""
    changed = np.array(rows)
    for row in changed:
        if (row[alike] == _kept_sizes[alike]).all():
            row[:4] = _kept_sizes
        _kept_sizes[:] = row[:4]
    return position(changed)


@wrong()
def sizes_kept_while_alpha_stays(rows):
    """What depends on the sizes is computed anew when α changes."""
    return _kept_while_alike(rows, [0])


@wrong()
def sizes_kept_while_the_hyperboloid_stays(rows):
    """What depends on the sizes is computed anew when α or γ changes."""
    return _kept_while_alike(rows, [0, 1])


@wrong()
def sizes_kept_while_the_spheroid_stays(rows):
    """What depends on the sizes is computed anew when b or d changes."""
    return _kept_while_alike(rows, [2, 3])


@wrong()
def answer_kept_while_x_and_y_stay(rows):
    """A row of the same sizes, x and y as the row before gets its answer: z is forgotten."""
    answers = position(rows)
    for index in np.flatnonzero((rows[1:, :6] == rows[:-1, :6]).all(axis=1)):
        answers[index + 1] = answers[index]
    return answers


@wrong()
def sizes_kept_while_three_stay(rows):
    """What depends on the sizes is computed anew when α, γ or b changes; d is forgotten."""
    return _kept_while_alike(rows, [0, 1, 2])


@wrong()
def twins_of_a_question(rows):
    """Equal rows of a question are computed once, and only the first of them is answered."""
    answers = position(rows)
    first = np.unique(rows, axis=0, return_index=True)[1]
    again = np.ones(len(rows), dtype=bool)
    again[first] = False
    answers[again] = _moved(answers[again])
    return answers


@wrong()
def neighbours_alike(rows):
    """A row that is equal to the row before it is not computed."""
    answers = position(rows)
    alike = np.flatnonzero((rows[1:] == rows[:-1]).all(axis=1)) + 1
    answers[alike] = _moved(answers[alike])
    return answers


@wrong()
def rows_that_come_again(rows):
    """What was answered once is looked up from then on, in a table that holds something else."""
    answers = position(rows)
    for place, row in enumerate(rows):
        if row.tobytes() in _seen:
            answers[place] = _moved(answers[place : place + 1])[0]
        _seen.add(row.tobytes())
    return answers
