"""The summary on the terminal is short, begins with the verdict, and cannot be used to write anything else there."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import click
import pytest
from hypothesis import given, settings
from msgspec import structs

from hypcheck.record import read
from hypcheck.record.fields import as_json
from hypcheck.record.lines import CauseLine, ImplementationLine
from hypcheck.record.reader import line_of
from hypcheck.report import WrittenReport
from hypcheck.report.terminal import MOST_LINES, WIDTH, summary_lines
from tests.report import bench_lines, record_samples
from tests.report.record_samples import DISAGREEMENT, EXACT_WRONG, UNPROVED

WRITTEN = [
    WrittenReport(Path("out/summary.json")),
    WrittenReport(Path("out/map.svg"), "no matplotlib"),
    WrittenReport(Path("out/report.md")),
]


def shown(*extra, exit_code=0, body=None, options=None, **how):
    lines = [*(record_samples.lines() if body is None else body), *extra]
    return summary_lines(record_samples.record(lines, exit_code, options), WRITTEN, **how)


def test_the_terminal_shows_at_most_25_lines():
    many = [bench_lines.line("cost", claim=f"claim {name}") for name in "abcdefghijklmnop"]
    lines = shown(*many, {**UNPROVED, "statement": "x" * 1000}, *[UNPROVED] * 49, exit_code=6, width=WIDTH)
    assert len(lines) == MOST_LINES == 25
    assert lines[9] == "  ✗ and 42 more failures; junit.xml lists them all"
    assert "claim holds, the tower: claim a" in lines
    assert lines[-2:] == ["reports in out/: summary.json, report.md", "no map.svg: no matplotlib"]
    assert max(map(len, lines)) == WIDTH + 2  # and the two spaces before a failure


def test_lines_of_a_summary_in_a_pipe_or_a_file_are_not_cut():
    lines = shown({**UNPROVED, "statement": "x" * 1000}, exit_code=6)
    assert lines[1] == f"  ✗ hessian: not proved: {'x' * 1000}"
    assert not any("…" in line for line in lines)


ONE = {"counts": {"right": 9, "tolerated": 1}, "cases": [record_samples.worst("ring/1/1/7", "tolerated", 9.0e15)]}


@pytest.mark.parametrize(
    ("group", "options", "says"),
    [
        (
            ONE,
            {"tolerance": 1e18},
            "0 of 1 method beyond the tolerance of 1.0e18 u; farthest off: m, 9.0e15 u at ring/1/1/7 (tolerated)",
        ),
        (
            {"counts": {"right": 9, "excused": 1}, "cases": [record_samples.worst("r/7", "excused", 9.0e15)]},
            {"tolerance": 8.0},
            "0 of 1 method beyond the tolerance of 8 u; farthest off: m, 9.0e15 u at r/7 (excused as a known failure)",
        ),
        (
            {"counts": {"error": 10}},
            {"tolerance": 0},
            "0 of 1 method beyond the tolerance of 0 u; no answer was judged",
        ),
        (
            {"counts": {"error": 9, "right": 1}},
            {"tolerance": 0},
            "0 of 1 method beyond the tolerance of 0 u; no answer is wrong",
        ),
    ],
)
def test_terminal_shows_why_the_worst_answer_is_within_the_tolerance(group, options, says):
    lines = shown(body=[record_samples.group("m", "float64", "ring", **group)], options=options)
    assert f"float64: {says}" in lines


@pytest.mark.parametrize("code", [0, 6, None])
def test_terminal_summary_has_colour_only_if_requested(code):
    plain, coloured = shown(exit_code=code), shown(exit_code=code, colour=True)
    assert not any("\x1b" in line for line in plain)
    assert coloured[0].startswith("\x1b[32m" if code == 0 else "\x1b[31m")
    assert list(map(click.unstyle, coloured)) == plain


@pytest.mark.parametrize("old", ["table-2-float32", "ring/1/1/7", "python-fcl cannot be imported", "fast path", "ring"])
@settings(max_examples=12)
@given(foreign=record_samples.FOREIGN)
def test_terminal_summary_escapes_control_characters_of_foreign_text(old, foreign):
    changed = record_samples.rewritten([*record_samples.lines(), DISAGREEMENT, EXACT_WRONG], old, foreign)
    for line in summary_lines(record_samples.record(changed, 6), WRITTEN):
        assert line.isprintable()


def test_the_terminal_shows_six_causes_and_counts_the_answers_of_the_others():
    golden = read(Path(__file__).parent / "goldens" / "wrong" / "record.jsonl")
    first = as_json(golden.of(CauseLine)[0])
    causes = [{**first, "cases": 100 - number} for number in range(8)]
    lines = summary_lines(replace(golden, lines=(*golden.lines[:1], *map(line_of, causes))), ())
    assert sum(" wrong: " in line for line in lines) == 6
    assert "  187 wrong for 2 other causes; report.md has them all" in lines
    few = summary_lines(replace(golden, lines=(*golden.lines[:1], *map(line_of, causes[:6]))), ())
    assert not any("other cause" in line for line in few)


def test_a_bounding_volume_has_a_share_of_false_contacts_only_if_a_clear_row_was_tested():
    bounding = bench_lines.line("bounding")
    said = f"a bounding {bounding['shape']} in the spheroid's place, "
    assert any(line.startswith(said) for line in shown(bounding))
    none = {**bounding, "asked": 0, "false_contact": 0, "overlap": []}
    assert not any(line.startswith(said) for line in shown(none))


def test_summary_of_a_benchmark_has_errors_time_and_best_rival_of_the_users_method():
    golden = Path(__file__).parent / "goldens" / "bench" / "record.jsonl"
    lines = summary_lines(read(golden), ())
    own = [line for line in lines if line.startswith("mine.py:position")]
    assert own[0] == "mine.py:position: 458 of 3,000 answers wrong, errors end at 3.0e-8"
    assert own[1].startswith("mine.py:position, uniform around the tower: 1,210 (1,100 to 1,710) ns a row in a batch, ")
    assert lines[-1] == "mine.py:position: takes 1,150 times as long as fast, the fastest that is as reliable"
    assert "never a wrong answer: fast, 13.6 times as fast as table-2-float64" in lines


def test_a_benchmark_of_a_users_method_leaves_the_papers_claims_of_cost_to_the_other_reports():
    golden = read(Path(__file__).parent / "goldens" / "bench" / "record.jsonl")
    claim = line_of(bench_lines.line("cost"))
    others = [line for line in golden.lines if getattr(line, "kind", "") != "foreign"]
    mine = replace(golden, lines=[*golden.lines, claim])
    ours = replace(golden, lines=[*others, claim])
    claims = [[line for line in summary_lines(record, ()) if line.startswith("claim ")] for record in (mine, ours)]
    assert claims == [[], ["claim holds, the tower: " + bench_lines.line("cost")["claim"]]]


def test_summary_of_a_passing_run_lists_untested_families_unless_the_verdict_names_them():
    golden = read(Path(__file__).parent / "goldens" / "held" / "record.jsonl")
    options = {name: value for name, value in golden.header.options.items() if name != "families"}
    lines = [
        structs.replace(line, not_asked={"heights": {"ended-far": 9}}) if isinstance(line, ImplementationLine) else line
        for line in golden.lines
    ]
    whole = replace(golden, header=structs.replace(golden.header, options=options), lines=lines)
    claims = [[line for line in summary_lines(record, ()) if "not asked: " in line] for record in (golden, whole)]
    assert [line[: line.index(": ")] for line in claims[0]] == ["HELD"]
    assert claims[1] == [
        "mine.py:position: not asked: 1 family of hyperboloids that end (it takes no heights)",
    ]
