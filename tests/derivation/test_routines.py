"""Routines: malformed ones raise errors; well-formed ones are run round by round, and parts that nothing needs go."""

from __future__ import annotations

from fractions import Fraction

import pytest

from hypcheck.derivation.evaluation import EXACT
from hypcheck.derivation.program import Step, steps_of
from hypcheck.derivation.routines import Call, Half, Loop, Return, Routine, Stored, called, needed_parts, run

TWICE = Routine("twice", "Twice a number.", ("x",), steps_of("y = x + x"), "y")
IS_ABOVE = Routine("is_above", "Whether it is above 9.", ("x",), steps_of("above = x > 9"), "above")
FIBONACCI = Routine(
    "fibonacci",
    "0 if the seventh number of Fibonacci from a and b on is above 9, else 1.",
    ("a", "b"),
    (
        Loop(
            6,
            (("one", "a", "old"), ("next", "b", "sum")),
            steps_of("sum = one + next\nold = next + 0\nidle = one - 1"),
        ),
        Call("above", IS_ABOVE, ("one",)),
    ),
    Return((("above", 0),), 1),
)

SWAPPED = Routine(
    "swapped",
    "The halves in the other order, the second of them half as large.",
    ("p",),
    (Half("high", "p"), Half("low", "p", low=True), Stored("kept", "high"), *steps_of("half = kept * share")),
    ("low", "half"),
    pairs=frozenset({"p"}),
    constants={"share": 0.5},
)


def looping(times=2, kept=(("k", "x", "y"),), body="y = k + 1", result="k"):
    return Routine("r", "", ("x",), (Loop(times, kept, steps_of(body)),), result)


@pytest.mark.parametrize(
    ("malformed", "complaint"),
    [
        (lambda: Routine("r", "", ("x", "x"), (), "x"), "x is defined twice"),
        (lambda: Routine("r", "", ("x-1",), (), "x"), "'x-1' is not a name"),
        (lambda: Routine("r", "", ("x",), (), "y"), "there is no y"),
        (lambda: Routine("r", "", ("x",), (), Return((("x", 1),), 0)), "x is not a condition"),
        (lambda: Routine("r", "", ("x",), (Step("y", "add", ("x",)),), "y"), "y: add takes 2 arguments, not 1"),
        (lambda: Routine("r", "", ("x",), (Call("y", TWICE, ("x", "x")),), "y"), "y: twice takes 1 arguments, not 2"),
        (lambda: Routine("r", "", ("x",), (Call("y", TWICE, ("z",)),), "y"), "z is not a number"),
        (lambda: looping(times=0), "a loop has 0 rounds"),
        (lambda: looping(kept=(("k", "z", "y"),)), "keeps z, which is not a number"),
        (lambda: looping(kept=(("x", "x", "y"),)), "x is defined twice"),
        (lambda: looping(body="y = k > 1"), "keeps y, which is not a number"),
        (lambda: looping(kept=(("k", "x", "k"),)), "the loop keeps k, which its body does not compute"),
        (lambda: looping(result="y"), "there is no y"),
        (lambda: Routine("r", "", ("x",), (Half("h", "x"),), "h"), "h: x is not a pair"),
        (lambda: Routine("r", "", ("x",), (Stored("s", "x"),), "s", pairs=frozenset("x")), "s: x is not a number"),
        (
            lambda: Routine("r", "", ("x",), (Call("y", SWAPPED, ("x",)),), "y"),
            "x is not a pair that is defined before",
        ),
        (lambda: Routine("r", "", ("x",), (), ("x", 0), pairs=frozenset("x")), "x is not a number"),
        (lambda: Routine("r", "", ("x",), (), "x", constants={"x": 2.0}), "x is defined twice"),
    ],
)
def test_a_malformed_routine_is_refused(malformed, complaint):
    with pytest.raises(ValueError, match=complaint):
        malformed()


def test_a_loop_passes_all_its_kept_values_to_the_next_round_at_the_same_time():
    numbers = Routine("f", "", ("a", "b"), FIBONACCI.parts, "one")
    assert run(numbers, EXACT, {"a": 0, "b": 1}) == 8  # 0 1 1 2 3 5 8


@pytest.mark.parametrize(("first", "second", "answer"), [(0, 1, 1), (1, 1, 0)])
def test_a_routine_returns_the_answer_of_the_first_condition_that_holds(first, second, answer):
    assert run(FIBONACCI, EXACT, {"a": first, "b": second}) == answer


def test_a_routine_is_run_in_the_given_arithmetic():
    halves = looping(times=3, body="y = k / 2")
    assert run(halves, EXACT, {"x": 1}) == Fraction(1, 8)


@pytest.mark.parametrize(("start", "answer"), [(1, 8), (3, 12), (100, 200)])
def test_a_loop_ends_after_the_round_in_which_its_condition_first_holds(start, answer):
    """Of three rounds that double a number, those until it is above 7: the last one counts."""
    body = steps_of("y = k * 2\nenough = y > 7")
    doubling = Routine("d", "", ("x",), (Loop(3, (("k", "x", "y"),), body, "enough"),), "k")
    assert run(doubling, EXACT, {"x": start}) == answer


def test_a_routine_can_divide_select_and_make_pairs():
    assert run(SWAPPED, EXACT, {"p": (3, 4)}) == (4, Fraction(3, 2))
    either = Routine(
        "either",
        "The pair, swapped where x is above 0.",
        ("x", "p"),
        (Call("q", SWAPPED, ("p",)), *steps_of("above = x > 0"), Step("r", "select", ("above", "q", "p"))),
        "r",
        pairs=frozenset({"p"}),
    )
    assert either.gives == "pair"
    assert [run(either, EXACT, {"x": x, "p": (3, 4)}) for x in (1, 0)] == [(4, Fraction(3, 2)), (3, 4)]


def test_needed_parts_omits_parts_that_no_requested_value_needs():
    (loop, _) = needed_parts(FIBONACCI.parts, ("above",))
    assert [step.name for step in loop.body] == ["sum", "old"]
    assert needed_parts(FIBONACCI.parts, ("a",)) == ()


def test_called_lists_each_called_routine_once_and_before_its_caller():
    outer = Routine("outer", "", ("x",), (Call("y", FIBONACCI, ("x", 1)), Call("z", IS_ABOVE, ("x",))), "y")
    assert [routine.name for routine in called(outer)] == ["is_above", "fibonacci"]
