"""report.md shows failures first and the record's numbers, and foreign text cannot change its structure."""

from __future__ import annotations

import re

import pytest
from hypothesis import example, given, settings
from markdown_it import MarkdownIt

from hypcheck.messages import escaped
from hypcheck.report import markdown
from hypcheck.report.drawings import ReportContext
from hypcheck.report.markdown import render
from tests.report import record_samples
from tests.report.test_verdict import CRASHED, DISAGREEMENT, DRIFT, EXACT_WRONG, UNPROVED

PARSER = MarkdownIt("commonmark", {"html": True}).enable(["table", "strikethrough"])


def report(*extra, exit_code=0, body=None, picture=()):
    lines = [*(record_samples.lines() if body is None else body), *extra]
    return render(record_samples.record(lines, exit_code), ReportContext(picture)).decode("utf-8")


def headings(text):
    return re.findall(r"^##+ (.*)$", text, re.MULTILINE)


def rows(text, heading):
    """The cells of the first table after a heading, its rule left out."""
    part = re.search(rf"^##+ {heading}\n(.*?)(?=^##|\Z)", text, re.MULTILINE | re.DOTALL)
    table = re.search(r"(?:^\|.*\n)+", part[1], re.MULTILINE)
    cells = [re.split(r" ?\| ?", line.strip("| ")) for line in table[0].splitlines()]
    return [cells[0], *cells[2:]]


def test_markdown_begins_with_the_verdict():
    assert report().splitlines()[:3] == [
        "# hypcheck verify",
        "",
        f"**{record_samples.HELD}**",
    ]
    assert report(exit_code=None).splitlines()[2].startswith("**TRUNCATED: ")


def test_markdown_has_its_sections_in_order():
    assert headings(report()) == [
        "The oracles",
        "The paper's equations",
        "The proofs",
        "Mathematical findings",
        "Methods that promise to be exact",
        "Numerical findings",
        "float32",
        "float64",
        "Where it goes wrong",
        "Timings",
        "The run",
    ]
    assert headings(report(body=[])) == ["The run"]


def test_markdown_shows_failures_first_with_cases_and_commands():
    text = report(DRIFT, EXACT_WRONG, CRASHED, UNPROVED, DISAGREEMENT, exit_code=6)
    assert headings(text)[0] == "What failed"
    failed = text[text.index("## What failed") : text.index("## The oracles")]
    items = re.findall(r"^- (.*)$", failed, re.MULTILINE)
    assert [item.split(",")[0] for item in items] == ["**oracle", "**proof", *["**implementation"] * 2, "**findings"]
    assert "`tangent/1/1/3`" in items[0]
    assert "`hypcheck classify --alpha 1.0 --gamma 2.0 --b 1.0 --d 1.0 --center 2.5 -0.0 0.0`" in items[0]


def test_markdown_shows_the_counts_of_each_oracle():
    table = rows(report(), "The oracles")
    assert table[0] == ["oracle", "asked", "agreed", "undecided", "disagreed", "how it answered", "seconds"]
    assert table[1] == ["`exact`", "40", "40", "0", "0", "proved 40", "0.5"]
    assert table[3] == ["`roots`", "5", "3", "2", "0", "signs suffice 3, undecided 2", "4.0e-4"]
    assert "- `mesh` was not asked: python-fcl cannot be imported" in report()
    assert rows(report(DISAGREEMENT), "The oracles")[2][4] == "**1**"


def test_markdown_shows_equations_and_their_corrections():
    text = report()
    assert "1 of 2 hold: (1)." in text
    start = text.index("- **(12)** misprint: the coefficient of λ² lacks − z\\_c².")
    assert text[start:].splitlines()[1:3] == [
        "  - printed: `g = λ³ + x_c²`",
        "  - derived: `g = λ³ + x_c² − z_c²`",
    ]


def test_mathematical_findings_with_one_witness_share_a_line():
    table = rows(report(), "Mathematical findings")
    witness = "alpha 1, gamma 2, b 1, d 1, centre (2.5, -0, 0)"
    assert table[1:] == [
        [
            "`table-2`, `procedure-1`",
            "`ring`",
            "**inside**",
            "12 of 60",
            "the ring: Δ = 0 without contact",
            witness,
            "`ring/1/1/0`",
        ],
        [
            "`table-2`",
            "`out-of-regime`",
            "outside",
            "12 of 60",
            "it claims nothing here; cause: none known",
            witness,
            "`out-of-regime/1/1/0`",
        ],
    ]
    unknown = record_samples.finding("hessian", "ring", inside=True, reason=None)
    assert "**not a known finding; cause: ring**" in report(unknown)


def test_markdown_shows_numerical_findings():
    text = report()
    assert rows(text, "float32")[1] == [
        "`table-2`",
        "position",
        "39",
        "28",
        "5",
        "**6**",
        "1",
        "∞",
        "`ring/1/1/7`",
    ]
    assert rows(text, "float64")[1] == ["`table-2`", "position", "20", "20", "0", "0", "0", "·", "·"]
    assert text.count("`table-2`: what table-2-float32 is") + text.count("`table-2`: what table-2-float64 is") == 1
    assert "at most 8 u is *tolerated*" in text
    assert "- `theirs` also ended: crash 2" in report(CRASHED, exit_code=1)


def test_markdown_shows_wrong_answers_by_method_and_family():
    text = report()
    low, high = text[text.index("### float32") :], text[text.index("### float64") :]
    assert "| `ring` | 6 |" in low
    assert "| `tower-body` | · |" in low[: low.index("### float64")]
    assert "| `ring` | · |" in high
    assert "| `tower-body` | – |" in high  # all skipped


def test_markdown_shows_timings():
    assert rows(report(), "Timings")[1:] == [
        ["fast path", "how fast path works", "1,000", "80", "50 to 90", "0.5"],
        ["plain numpy formula", "how plain numpy formula works", "1,000", "100", "100 to 200", "1"],
    ]
    alone = [line for line in record_samples.lines() if line.get("name") != "plain numpy formula"]
    assert rows(report(body=alone), "Timings")[1][-1] == "–"


def test_markdown_links_the_map_only_if_it_was_written():
    assert "](map.svg)" in report(picture=("map.svg",))
    assert "](" not in report()
    assert "- the ring: `table-2-float32` is wrong at 4 of 9 grid points" in report()


def inline(text):
    """What a reader sees of a table's only cell, and of nothing more."""
    tokens = PARSER.parse("\n".join(markdown.table_lines(["head"], [[text]])))
    kinds = [token.type for token in tokens]
    assert kinds.count("td_open") == 1
    assert kinds.count("tr_open") == 2
    assert [token.type for token in tokens if token.level == 0] == ["table_open", "table_close"]
    return next(tokens[place + 1] for place, kind in enumerate(kinds) if kind == "td_open")


@given(record_samples.FOREIGN)
@example("a|b")
@example("\\|")
@example("`|`")
@example("**x** [y](z) <b> &amp; ~~s~~ `c`")
def test_markdown_escapes_foreign_text_in_a_table_cell(foreign):
    children = inline(markdown.escape_text(foreign)).children
    assert {child.type for child in children} <= {"text", "text_special"}
    assert "".join(child.content for child in children) == escaped(foreign)


@given(record_samples.FOREIGN)
@example("a|b")
@example("`")
@example("\\")
@example("<script>|")
def test_markdown_escapes_foreign_code_in_a_table_cell(foreign):
    children = inline(markdown.code_span(foreign)).children
    shown = "".join(child.content for child in children if child.type != "html_inline")
    assert {child.type for child in children} <= {"text", "text_special", "code_inline", "html_inline"}
    assert {child.content for child in children if child.type == "html_inline"} <= {"<code>", "</code>"}
    assert shown == escaped(foreign)


@given(record_samples.FOREIGN)
@example("- x")
@example("1. x")
@example("# x")
@example("===")
def test_markdown_escapes_foreign_text_at_the_start_of_a_line(foreign):
    tokens = PARSER.parse(f"- {markdown.escape_text(foreign)}")
    kinds = [token.type for token in tokens if token.type.endswith("_open")]
    assert kinds in (["bullet_list_open", "list_item_open", "paragraph_open"], ["bullet_list_open", "list_item_open"])
    assert (kinds[-1] == "paragraph_open") == bool(escaped(foreign))


@pytest.mark.parametrize("old", ["table-2-float32", "ring", "the ring: Δ = 0 without contact", "how fast path works"])
@settings(max_examples=12)
@given(foreign=record_samples.FOREIGN)
def test_markdown_table_is_not_broken_by_foreign_text(old, foreign):
    changed = record_samples.rewritten(record_samples.lines(), old, foreign)
    text = render(record_samples.record(changed), ReportContext(["map.svg"])).decode("utf-8")
    assert not re.search(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\ud800-\udfff]", text)
    for table in re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE):
        lines = table.splitlines()
        assert {line.count("|") for line in lines} == {lines[0].count("|")}
    assert [heading for heading in headings(text) if not heading.startswith("float")] == [
        heading for heading in headings(report()) if not heading.startswith("float")
    ]
