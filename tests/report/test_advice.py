"""Which method to use when: rules that can be followed by hand on a few made-up methods."""

from __future__ import annotations

import math

import pytest

from hypcheck.report.advice import EVERYDAY, EVERYWHERE, best_rival_facts, dominated_methods, recommendations
from tests.report import bench_lines
from tests.report.bench_lines import bench_record


def method(name, ratio, reliable, *, interval=None, exact=False, tier="C", kind="algebraic", question="position"):
    """The lines of a method: `reliable` by workload, timed on uniform alone."""
    what = {"tier": tier, "kind": kind, "precision": "float64", "question": question, "exact": exact}
    yield bench_lines.line("method", method=name, **what)
    for workload, above in reliable.items():
        wrong = {} if above else {"wrong": 0, "worst": []}
        yield bench_lines.accuracy(name, workload, reliable_above="inf" if above == math.inf else above, **wrong)
    low, high = interval or (ratio * 0.99, ratio * 1.01)
    yield {**bench_lines.speed(name, "uniform", "batch", 10 * ratio, 10.0), "ratio_ci95": [low, high]}


def chosen(*methods, floor=None):
    body = [line for each in methods for line in each]
    if floor is not None:
        body.append(bench_lines.line("noise", floor=floor))
    return bench_record(body)


def advice(record):
    return {(each.need.what, each.need.where, each.need.asked): each for each in recommendations(record).advice}


EXACT = ("never a wrong answer", EVERYWHERE, "position")


def test_advice_is_the_fastest_exact_method_that_was_never_wrong():
    wrong = [
        {**line, "wrong": 1} if line["type"] == "accuracy" else line
        for line in method("liar", 1.0, {"uniform": 0.5}, exact=True)
    ]
    record = chosen(
        wrong,
        method("slow", 9.0, {"uniform": 0.0}, exact=True),
        method("quick", 3.0, {"uniform": 0.0}, exact=True),
        method("floats", 0.5, {"uniform": 0.0}),
    )
    found = advice(record)[EXACT]
    assert (found.use.name, found.alike) == ("quick", ())


@pytest.mark.parametrize(
    ("interval", "floor", "alike"),
    [((1.4, 1.8), None, []), ((0.9, 1.8), None, ["b"]), ((1.4, 1.8), 0.7, ["b"]), ((1.4, 1.8), 0.2, [])],
)
def test_advice_names_methods_that_are_as_fast_within_the_noise(interval, floor, alike):
    """By their intervals (a's ends at 1.01) or by the noise (1.5 is within 70 % of 1)."""
    record = chosen(
        method("a", 1.0, {"uniform": 0.0}, exact=True),
        method("b", 1.5, {"uniform": 0.0}, exact=True, interval=interval),
        floor=floor,
    )
    assert [each.name for each in advice(record)[EXACT].alike] == alike


def test_advice_beyond_a_distance_is_given_for_all_and_for_timed_workloads():
    record = chosen(
        method("narrow", 1.0, {"uniform": 1e-11, "ring": math.inf}),
        method("near", 9.0, {"uniform": 1e-13, "ring": 1e-13}),
        method("sound", 5.0, {"uniform": 1e-10, "ring": 1e-11}),
        method("rough", 0.5, {"uniform": 1e-4, "ring": 1e-4}),
    )
    found = {key: (each.use.name, each.errs) for key, each in advice(record).items()}
    assert found == {
        ("plain float64; errors end by 8.0e-13", EVERYWHERE, "position"): ("near", ()),
        ("reliable beyond 1e-9", EVERYWHERE, "position"): ("sound", ()),
        ("reliable beyond 1e-9", EVERYDAY, "position"): ("narrow", ("ring",)),
        ("reliable beyond 0.001", EVERYWHERE, "position"): ("rough", ()),
    }


@pytest.mark.parametrize(("farther", "name"), [(8e-13, "quick"), (1.7e-12, "near")])
def test_slow_method_is_not_advised_for_one_or_two_distance_exponents_only(farther, name):
    record = chosen(method("near", 50.0, {"uniform": 1e-13}), method("quick", 1.0, {"uniform": farther}))
    found = advice(record)["plain float64; errors end by 8.0e-13", EVERYWHERE, "position"]
    assert found.use.name == name


def test_advice_names_the_fastest_method_for_calls_from_python_row_by_row():
    in_c = method("in-c", 0.1, {"uniform": 0.0}, exact=True)
    by_row = [
        {**line, "tier": "python"} if line["type"] == "method" else line
        for line in method("by-row", 7.0, {"uniform": 0.0}, exact=True)
    ]
    found = advice(chosen(in_c, by_row))
    assert found[EXACT].use.name == "in-c"
    assert found["never a wrong answer, a call a row from Python", EVERYWHERE, "position"].use.name == "by-row"


def test_the_fastest_method_that_never_erred_is_advised():
    record = chosen(method("near", 50.0, {"uniform": 0.0}), method("quick", 1.0, {"uniform": 0.0}))
    assert advice(record)["plain float64; none wrong", EVERYWHERE, "position"].use.name == "quick"


def test_a_method_for_another_question_is_advised_only_for_that_question():
    record = chosen(
        method("all", 5.0, {"uniform": 1e-13}),
        method("half", 1.0, {"uniform": 1e-13}, question="exterior"),
    )
    found = {key: each.use.name for key, each in advice(record).items()}
    assert found == {
        ("plain float64; errors end by 8.0e-13", EVERYWHERE, "position"): "all",
        ("reliable beyond 1e-12", EVERYDAY, "clear or not"): "half",
    }


def test_a_method_whose_time_is_not_above_that_of_an_empty_call_is_not_advised():
    lost = [
        {**line, "median_ns": 0.01} if line["type"] == "speed" else line
        for line in method("a", 1e-9, {"uniform": 0.0}, exact=True)
    ]
    record = chosen(lost, method("b", 1.5, {"uniform": 0.0}, exact=True))
    assert advice(record)[EXACT].use.name == "b"


def test_a_bounding_volume_is_never_advised():
    record = chosen(method("sphere", 0.1, {"uniform": 0.0}, kind="bounding"), method("all", 5.0, {"uniform": 0.0}))
    assert {each.use.name for each in recommendations(record).advice} == {"all"}


def test_advice_lists_needs_that_no_method_meets():
    record = chosen(method("rough", 0.5, {"uniform": 0.25}))
    unmet = {(need.what, need.where) for need in recommendations(record).unmet}
    assert ("never a wrong answer", EVERYWHERE) in unmet
    assert ("reliable beyond 1e-12", EVERYWHERE) in unmet


def test_advice_names_methods_that_another_method_beats():
    record = chosen(
        method("good", 1.0, {"uniform": 1e-9, "ring": 1e-9}),
        method("slower", 2.0, {"uniform": 1e-6, "ring": 1e-9}),
        method("noisy", 2.0, {"uniform": 1e-6, "ring": 1e-6}, interval=(0.9, 3.0)),
        method("nearer", 2.0, {"uniform": 1e-12, "ring": 1e-6}),
        method("elsewhere", 2.0, {"uniform": 1e-6, "ring": 1e-6}, tier="numpy"),
        method("exact", 2.0, {"uniform": 0.0, "ring": 0.0}, exact=True),
    )
    assert [(loser.name, winner.name) for loser, winner in dominated_methods(record)] == [("slower", "good")]


def test_a_method_of_the_user_is_compared_only_with_one_that_errs_no_farther_from_contact():
    mine = bench_lines.line("method", "foreign-adapter", method="mine")
    own = [mine, *list(method("mine", 6.0, {"uniform": 1e-9}))[1:]]
    rough, near = (method(name, 2.0, {"uniform": above}) for name, above in (("rough", 1e-6), ("near", 1e-12)))
    assert list(best_rival_facts(chosen(own, rough))) == ["mine: no other method that was measured is as reliable"]
    assert list(best_rival_facts(chosen(own, near))) == [
        "mine: takes 3 times as long as near, the fastest that is as reliable"
    ]


def test_nothing_is_advised_without_times():
    body = [line for line in bench_lines.lines() if line["type"] != "speed"]
    assert recommendations(bench_record(body)) == recommendations(bench_record([]))
