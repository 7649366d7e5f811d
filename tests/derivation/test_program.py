"""Straight-line programs: malformed ones raise errors; well-formed ones are written, run, cut and counted."""

from __future__ import annotations

import operator
import weakref
from fractions import Fraction

import pytest

from hypcheck.derivation.evaluation import EXACT, Arithmetic, evaluate, outputs
from hypcheck.derivation.formulas import FORMULAS, answers
from hypcheck.derivation.program import (
    Operations,
    Program,
    Step,
    count,
    cut,
    hoist,
    line_of,
    needed,
    program_of,
    steps_of,
)
from hypcheck.geometry.pair import COLUMNS, SIZES

SMALL = program_of("small", ("x", "y"), "s = x + y\nt = s * s\nunused = x - y\nlarge = t > 4\nanswer = large ? t : 0")
ROW = dict(zip(COLUMNS, (3, 5, 2, 1, 4, 1, 2), strict=True))


@pytest.mark.parametrize(
    ("inputs", "steps", "complaint"),
    [
        (("x",), (Step("x", "neg", ("x",)),), "x is defined twice"),
        (("x", "x"), (), "x is defined twice"),
        (("x",), (Step("y", "add", ("x", "z")),), "z is not defined before it is used"),
        (("x",), (Step("y", "neg", ("y",)),), "y is not defined before it is used"),
        (("x",), (Step("y", "fma", ("x", "x")),), "no operation 'fma'"),
        (("x",), (Step("y", "add", ("x",)),), "takes 2 arguments, not 1"),
        (("x",), (Step("y", "and", ("x", "x")),), r"takes \(boolean, boolean\), not \(number, number\)"),
        (("x",), (Step("p", "gt", ("x", 0)), Step("y", "add", ("p", "x"))), r"not \(boolean, number\)"),
        (
            ("x",),
            (Step("p", "gt", ("x", 0)), Step("y", "select", ("p", "p", "x"))),
            r"not \(boolean, boolean, number\)",
        ),
        (("x",), (Step("y", "add", ("x", 2049)),), "2049 is neither a name nor an integer up to 2048"),
        (("x",), (Step("y", "add", ("x", True)),), "True is neither"),
        (("x",), (Step("y", "add", ("x", 0.5)),), "0.5 is neither"),  # type: ignore[arg-type]
        (("α",), (), "'α' is not a name"),
        (("x",), (Step("2x", "neg", ("x",)),), "'2x' is not a name"),
    ],
)
def test_program_refuses_malformed_steps(inputs, steps, complaint):
    with pytest.raises(ValueError, match=complaint):
        Program("bad", inputs, steps)


def test_a_selection_in_a_program_may_choose_between_truth_values():
    program = program_of("choice", ("x",), "p = x > 0\nq = x > 1\nr = p ? q : p")
    assert [evaluate(program, EXACT, {"x": x})["r"] for x in (-1, 1, 2)] == [False, False, True]


@pytest.mark.parametrize("formula", FORMULAS.values(), ids=lambda formula: formula.name)
def test_the_listing_of_a_program_is_read_back_as_the_same_steps(formula):
    assert steps_of("\n".join(map(line_of, formula.program.steps))) == formula.program.steps


@pytest.mark.parametrize("line", ["y = x", "y = x + 1 + 2", "x + 1", "y = x ** 2", "y = sin x", "y = p ? x , 1"])
def test_steps_of_refuses_a_line_that_is_no_step(line):
    with pytest.raises(ValueError, match="is not a step"):
        steps_of(line)


def test_evaluate_gives_every_intermediate_value():
    assert evaluate(SMALL, EXACT, {"x": 1, "y": 2}) == {
        "x": 1,
        "y": 2,
        "s": 3,
        "t": 9,
        "unused": -1,
        "large": True,
        "answer": 9,
    }


@pytest.mark.parametrize("formula", FORMULAS.values(), ids=lambda formula: formula.name)
def test_outputs_of_a_program_are_the_values_of_its_whole_evaluation(formula):
    inputs = {**ROW, "b_s": 1, "d_s": 1, "l": 1, "cosine": Fraction(3, 5), "sine": Fraction(4, 5), "lambda_": 1}
    whole = evaluate(formula.program, EXACT, inputs)
    wanted = (formula.answer, *(step.name for step in formula.program.steps[::7]))
    assert outputs(formula.program, EXACT, inputs, wanted) == tuple(whole[name] for name in wanted)


def test_evaluating_a_program_raises_an_error_only_for_a_missing_input_that_it_reads():
    with pytest.raises(ValueError, match="program small needs a value for y"):
        evaluate(SMALL, EXACT, {"x": 1})
    assert outputs(program_of("p", ("x", "y"), "s = x + 1\nt = y + 1"), EXACT, {"x": 1}, ("s",)) == (2,)


def test_evaluating_a_program_raises_an_error_for_an_operation_that_the_arithmetic_lacks():
    with pytest.raises(ValueError, match="bare arithmetic has no add"):
        evaluate(SMALL, Arithmetic("bare", Fraction, {}), {"x": 1, "y": 2})


def test_outputs_raises_an_error_for_a_name_that_the_program_lacks():
    with pytest.raises(KeyError, match="program small has no z"):
        outputs(SMALL, EXACT, {"x": 1, "y": 2}, ("z",))


class _Boxed:
    """A number whose living instances can be counted; unlike Fraction it is equal to itself alone."""

    def __init__(self, number):
        self.number = number


def test_outputs_frees_values_that_no_later_step_reads():
    formula = FORMULAS["table-2"]
    alive, counts = weakref.WeakSet(), []

    def boxed(number):
        box = _Boxed(Fraction(number))
        alive.add(box)
        counts.append(len(alive))
        return box

    def on_boxes(function, box):
        return lambda *boxes: box(function(*(each.number for each in boxes)))

    names = ("add", "sub", "mul", "neg")
    operations = {name: on_boxes(getattr(operator, name), boxed) for name in names}
    operations["div"] = on_boxes(operator.truediv, boxed)
    operations |= {name: on_boxes(getattr(operator, name), bool) for name in ("gt", "lt")}
    arithmetic = Arithmetic("boxed", boxed, {**operations, "and": operator.and_})

    evaluate(formula.program, arithmetic, ROW)
    everything = max(counts)
    counts.clear()
    answers(formula, arithmetic, ROW)
    assert everything > 40
    assert max(counts) < 20


def test_cut_turns_known_steps_into_inputs_and_drops_unneeded_steps():
    part = cut(SMALL, ("t",), ("answer",))
    assert part.inputs == ("t",)
    assert [step.name for step in part.steps] == ["large", "answer"]
    assert cut(SMALL, ("s",), ("unused", "t")).inputs == ("s", "x", "y")
    with pytest.raises(KeyError):
        cut(SMALL, ("nothing",), ("t",))


@pytest.mark.parametrize("formula", FORMULAS.values(), ids=lambda formula: formula.name)
def test_every_step_of_every_formula_is_needed(formula):
    assert needed(formula.program, (formula.answer,)) == formula.program.steps


def test_operations_of_table_2_are_those_counted_by_hand():
    # Before the loop: α/b, γ/d, their squares, A·B, + A, − B, and what the table prints inside though it is constant:
    # b², A − B + 1, 27·c0².
    parts = hoist(FORMULAS["table-2"].program, SIZES)
    assert count(parts.outside) == Operations(additions=4, multiplications=6, divisions=2)
    # Inside: x² + y² and its quotient; (z/d)²; + B·P − A·Q; − P − Q; then Δ: 4 + 2 + 3 + 3 products and 4 sums.
    assert count(parts.inside) == Operations(
        additions=1 + 2 + 2 + 4,
        multiplications=2 + 1 + 2 + 4 + 2 + 3 + 3,
        divisions=2,
        comparisons=3,
        logical=2,
    )
    assert count(parts.inside).rounded == 28


def test_count_leaves_out_sign_changes_and_counts_roots_and_selections():
    program = program_of("p", ("x",), "n = - x\na = abs n\nr = sqrt a\np = r >= 1\nq = not p\ns = q ? r : a")
    assert count(program.steps) == Operations(square_roots=1, comparisons=1, logical=1, selections=1)


def test_hoisting_an_unknown_input_raises_an_error():
    with pytest.raises(ValueError, match="has no input height"):
        hoist(SMALL, ("height",))
    assert [step.name for step in hoist(SMALL, ("x", "y")).inside] == []
    assert [step.name for step in hoist(SMALL, ()).outside] == []
