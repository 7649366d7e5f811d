"""Every decider answers every frozen case of `cases/` as it is labelled: one loop over hard cases."""

from __future__ import annotations

import numpy as np
import pytest

from hypcheck.errors import InputError
from tests.support.corpus import expected, files, questions
from tests.support.deciders import ALL, CANNOT_SAY, DECIDERS, REFUSED, Times, answers_of

ASKED = [
    pytest.param(decider, groups, id=f"{decider}: {groups or 'upright'}")
    for decider in DECIDERS
    for groups in decider.takes
]


def asked(decider, groups, every):
    """The frozen cases that a decider is asked."""
    lacks = decider.lacks()
    if lacks:
        pytest.skip(lacks)
    return questions(groups)[::every]


def require_right(decider, given):
    """Ask the decider, and fail with the first cases that it answers wrongly."""
    result = decider.answer(given)
    answers = result.answers if isinstance(result, Times) else result
    wrong = [
        f"{case['id']} is {expected(case)}; answered: {answer}"
        for case, answer in zip(given.cases, answers, strict=True)
        if answer not in (expected(case), CANNOT_SAY)
    ]
    assert not wrong, f"{len(wrong)} wrong, {wrong[:3]}"
    assert list(answers).count(CANNOT_SAY) <= decider.abstains * len(given)
    if isinstance(result, Times):
        hits = [bool(case["hit"]) for case in given.cases]
        true = np.array([case["first"] for case in given.cases if case["hit"]])
        assert np.isnan(result.first[np.logical_not(hits)]).all()
        assert not (result.first[hits, 0] > true[:, 1]).any(), "a time after the first contact"
        assert not (result.first[hits, 1] < true[:, 0]).any(), "a bound before the first contact"


@pytest.mark.parametrize(("decider", "groups"), ASKED)
def test_every_decider_answers_the_frozen_cases_as_they_are_labelled(decider, groups):
    require_right(decider, asked(decider, groups, decider.every))


@pytest.mark.thorough
@pytest.mark.parametrize(("decider", "groups"), [each for each in ASKED if each.values[0].every > 1])
def test_slow_deciders_answer_all_frozen_cases_as_they_are_labelled(decider, groups):
    require_right(decider, asked(decider, groups, 1))


@pytest.mark.parametrize(("decider", "groups"), [each for each in ASKED if each.values[0].refuses])
def test_deciders_that_users_call_refuse_every_frozen_invalid_row(decider, groups):
    if decider.lacks():
        pytest.skip(decider.lacks())
    invalid = questions(groups, refused=True)
    try:
        answers = answers_of(decider, invalid)
    except InputError:
        for index in range(len(invalid)):
            with pytest.raises(InputError):
                decider.answer(invalid[index : index + 1])
    else:
        assert answers == [REFUSED] * len(invalid)


def test_the_corpus_has_every_case_of_every_file():
    counts = [len(questions(groups, refused=refused)) for groups in ALL for refused in (False, True)]
    assert sum(counts) == sum(file["count"] for file in files().values()) > 12_000
