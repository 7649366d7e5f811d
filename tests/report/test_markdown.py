"""Foreign text cannot change the structure of report.md; the goldens of recorded runs show its sections."""

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

PARSER = MarkdownIt("commonmark", {"html": True}).enable(["table", "strikethrough"])


def report(body=None, picture=()):
    return render(record_samples.record(body), ReportContext(picture)).decode("utf-8")


def headings(text):
    return re.findall(r"^##+ (.*)$", text, re.MULTILINE)


def test_markdown_of_a_record_without_lines_has_only_the_section_about_the_run():
    assert headings(report([])) == ["The run"]


def test_markdown_refers_to_the_map_only_if_it_was_written():
    assert "](map.svg)" in report(picture=("map.svg",))
    assert "](" not in report()


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
    text = report(changed, ["map.svg"])
    assert not re.search(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\ud800-\udfff]", text)
    for table in re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE):
        lines = table.splitlines()
        assert {line.count("|") for line in lines} == {lines[0].count("|")}
    assert [heading for heading in headings(text) if not heading.startswith("float")] == [
        heading for heading in headings(report()) if not heading.startswith("float")
    ]
