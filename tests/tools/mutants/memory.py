"""State that outlives a question: what was asked or answered before decides what is answered now."""

from __future__ import annotations

import numpy as np

from tests.tools.mutants.exactly import moved, position
from tests.tools.mutants.expectation import wrong

_calls = [0]
_rows = [0]
_kept = np.zeros(1 << 17, dtype=np.int8)
_kept_sizes = np.ones(4)
_seen: set[bytes] = set()
_answers: dict[object, int] = {}
_last = [np.zeros(1, dtype=np.int8)]


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


@wrong(asked=("--count", "4000"))
def after_a_hundred_thousand_rows(rows):
    """Everything is contact from the hundred-thousandth row on."""
    _rows[0] += len(rows)
    return position(rows) if _rows[0] <= 100_000 else np.zeros(len(rows), dtype=np.int8)


@wrong()
def after_five_hundred_questions(rows):
    """Everything is contact from the 501st question on."""
    _calls[0] += 1
    return position(rows) if _calls[0] <= 500 else np.zeros(len(rows), dtype=np.int8)


@wrong()
def after_the_first_question(rows):
    """Everything is contact from the second question on."""
    _calls[0] += 1
    return position(rows) if _calls[0] == 1 else np.zeros(len(rows), dtype=np.int8)


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
def begins_with_a_lone_row(rows):
    """A process that was asked about a lone row first takes another path ever after, which is wrong."""
    if not _calls[0]:
        _last[0] = np.full(1, len(rows), dtype=np.int64)
    _calls[0] += 1
    return position(rows) if _last[0][0] > 1 else np.zeros(len(rows), dtype=np.int8)


@wrong()
def contact_is_not_written(rows):
    """Clear rows are written into a buffer that is kept, contact is what was there before."""
    answers = position(rows)
    kept = _kept[: len(rows)]
    kept[answers != 0] = answers[answers != 0]
    return kept.copy()


@wrong()
def rows_that_come_again(rows):
    """What was answered once is looked up from then on, in a table that holds something else."""
    answers = position(rows)
    for place, row in enumerate(rows):
        if row.tobytes() in _seen:
            answers[place] = moved(answers[place : place + 1])[0]
        _seen.add(row.tobytes())
    return answers


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
def sizes_kept_while_three_stay(rows):
    """What depends on the sizes is computed anew when α, γ or b changes; d is forgotten."""
    return _kept_while_alike(rows, [0, 1, 2])


def _remembered_by(rows, key):
    """Answers are kept for ever, by a key of the row that is not the whole row."""
    return np.array(
        [_answers.setdefault(key(row), answer) for row, answer in zip(rows, position(rows), strict=True)],
        dtype=np.int8,
    )


@wrong()
def key_without_order(rows):
    """Answers are kept by the sizes and the three coordinates, in whatever order these come."""
    return _remembered_by(rows, lambda row: (row[:4].tobytes(), *sorted(row[4:])))


@wrong()
def key_without_order_of_sizes(rows):
    """Answers are kept by the coordinates and the four sizes, in whatever order these come."""
    return _remembered_by(rows, lambda row: (row[4:].tobytes(), *sorted(row[:4])))


@wrong()
def key_of_ratios(rows):
    """Answers are kept by α/b, γ/d and the centre in metres, as if b and d were 1."""
    return _remembered_by(rows, lambda row: (row[0] / row[2], row[1] / row[3], *row[4:]))


@wrong()
def key_of_the_centre(rows):
    """Answers are kept by the centre alone, as in a program for one scene."""
    return _remembered_by(rows, lambda row: row[4:].tobytes())


@wrong()
def key_of_the_sum(rows):
    """Answers are kept by the sum of the seven numbers."""
    return _remembered_by(rows, lambda row: float(row.sum()))


@wrong()
def key_of_twelve_digits(rows):
    """Answers are kept by the row to twelve significant digits."""
    return _remembered_by(rows, lambda row: tuple(f"{value:.12g}" for value in row))
