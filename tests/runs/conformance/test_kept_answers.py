"""`verify SPEC` rejects implementations that keep the answer of the row before, found by some of its columns alone."""

from __future__ import annotations

import numpy as np
import pytest

from hypcheck import classify, passage
from hypcheck.cli.main import main

pytestmark = [pytest.mark.usefixtures("text_reports"), pytest.mark.slow]


def positions(rows):
    return classify(np.ascontiguousarray(rows))


def hits(rows):
    end = rows.shape[1]
    heights = dict(zip(("z_min", "z_max", "solid"), rows[:, 13:].T, strict=False))
    axis = rows[:, 10:13] if end > 10 else None
    return passage(rows[:, :4], rows[:, 4:7], rows[:, 7:10], axis=axis, **heights).hit.astype(np.int8)


def keeping(answers_of, columns):
    """Right, but where the first columns are those of the row before: such a row gets that row's answer."""

    def answers(rows):
        given = answers_of(rows)
        for place in np.flatnonzero((rows[1:, :columns] == rows[:-1, :columns]).all(axis=1)) + 1:
            given[place] = given[place - 1]
        return given

    return answers


TILT, HEIGHTS = {"tilt": True}, {"tilt": True, "heights": True}
SWEEP = {"question": "passage"}


@pytest.mark.parametrize(
    ("answers_of", "declared", "columns", "family", "count"),
    [
        (positions, TILT, 7, "tilted-one-number-changed", "80"),
        (positions, HEIGHTS, 10, "ended-one-number-changed", "80"),
        (hits, SWEEP, 7, "way-one-number-changed", "80"),
        (hits, SWEEP | TILT, 10, "tilted-way-one-number-changed", "400"),
        (hits, SWEEP | HEIGHTS, 13, "ended-way-one-number-changed", "80"),
    ],
    ids=["axis", "heights", "end", "axis of a sweep", "heights of a sweep"],
)
def test_an_answer_kept_from_a_row_that_differs_in_the_last_columns_is_rejected(
    tmp_path, built_in, answers_of, declared, columns, family, count
):
    for function, code in ((answers_of, 0), (keeping(answers_of, columns), 1)):
        spec = built_in(function, **declared)
        options = ["--families", family, "--count", count, "--isolate", "off", "--out", str(tmp_path)]
        assert main(["verify", spec, *options]) == code
