"""The built-in methods: all are reachable by name, the exact one is exact, the dual form is backward stable."""

from __future__ import annotations

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.implementations.builtin import builtin, methods
from hypcheck.implementations.description import QUESTIONS
from hypcheck.implementations.domain import UNIT_ROUNDOFF, representable
from hypcheck.runs import judge
from hypcheck.runs.judge import Criterion
from hypcheck.vectors.families import select
from tests.support import inside
from tests.support.judging import wrong_cases

POSITIONS = [
    name for name, each in methods().items() if not each.needs and not each.tilt and each.question != "passage"
]


@pytest.fixture(scope="module")
def rows():
    return np.concatenate([family.rows(11, 60) for family in select()])


@pytest.mark.slow
@pytest.mark.parametrize("name", POSITIONS)
def test_each_built_in_method_gives_answers_that_its_question_allows(name, rows):
    method = builtin(name)
    some = rows if method.max_rows is None else rows[:: 1 + 10 * len(rows) // (method.max_rows * 28)]
    answers = method.answer(some)
    assert answers.dtype == np.int8
    assert answers.shape == (len(some),)
    assert set(answers.tolist()) <= {*QUESTIONS[method.question].answers, CANNOT_SAY}


@pytest.mark.parametrize("name", ["fast", "fast-numpy"])
def test_the_built_in_methods_that_are_kernels_are_exact(name, rows):
    method = builtin(name)
    assert method.exact
    assert (method.answer(rows) == inside.positions(rows)).all()
    assert {each.name for each in methods().values() if each.exact and not each.measured} == {
        "fast",
        "fast-numpy",
    }


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_the_built_in_dual_form_has_a_backward_error_below_one_unit(precision, rows):
    method = builtin(f"dual-{precision}")
    asked = rows[method.domain.holds(rows) & representable(rows, precision)]
    cases = wrong_cases(asked, inside.positions(asked), method.answer(asked), Criterion(precision=precision))
    assert cases  # at a tangency one side or the other is bound to be missed
    unit = UNIT_ROUNDOFF[precision]
    assert max(judge.in_units(judge.measured(case, "position"), unit) for case in cases) < 1


def test_an_unknown_built_in_method_is_refused_with_the_known_names():
    with pytest.raises(InputError, match=r"no built-in method 'tabel-2-float32'; did you mean table-2-float32"):
        builtin("tabel-2-float32")
    with pytest.raises(InputError, match=r"no built-in method 'xyzzy'; there are .*table-2-float32"):
        builtin("xyzzy")
