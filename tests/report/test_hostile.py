"""Hostile names are harmless text in every report, with escapes, and never endless."""

from __future__ import annotations

import json
import re
from xml.etree import ElementTree

import pytest

from hypcheck.report import REPORTS
from hypcheck.report.document import LONGEST
from hypcheck.report.write import render
from tests.report.hostile import SCRIPT, hostile_record
from tests.report.pages import page_of
from tests.report.test_markdown import PARSER

UNSEEN = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u200e\u200f\ud800-\udfff]")
WHOLE = ("json", "junit", "csv")
"""Formats for programs, in which a name is whole, however long it is."""


@pytest.fixture(scope="module")
def record():
    return hostile_record()


@pytest.fixture(scope="module")
def texts(record):
    others = {name: render(name, record) for name in REPORTS if name != "html"}
    return {name: content.decode("utf-8") for name, content in {**others, "html": page_of("hostile")}.items()}


@pytest.mark.parametrize("name", REPORTS)
def test_reports_escape_invisible_characters_of_foreign_text(texts, name):
    assert not UNSEEN.search(texts[name]) or name == "json"
    if name == "json":  # whose strings have escapes of their own
        assert not re.search(r"[\x00-\x09\x0b-\x1f]", texts[name])


@pytest.mark.parametrize("name", [name for name in REPORTS if name not in WHOLE])
def test_reports_for_people_cut_very_long_foreign_text(texts, name):
    assert len(texts[name]) < 2_000_000
    assert "e" * (LONGEST + 1) not in texts[name]


@pytest.mark.parametrize("name", [name for name, each in REPORTS.items() if each.file.endswith((".svg", ".xml"))])
def test_reports_in_xml_stay_valid_with_foreign_text(texts, name):
    root = ElementTree.fromstring(texts[name])  # noqa: S314 - just written
    assert not [each for each in root.iter() if each.tag.endswith(("script", "img"))]


def test_summary_json_keeps_foreign_names_unchanged(texts, record):
    found = json.loads(texts["json"])
    assert any(SCRIPT in each["name"] for each in found["methods"])


@pytest.mark.parametrize("name", ["markdown", "overview"])
def test_markdown_holds_no_foreign_html(texts, name):
    tokens = PARSER.parse(texts[name])
    inside = [child for token in tokens for child in token.children or ()]
    html = {token.content for token in (*tokens, *inside) if token.type in ("html_inline", "html_block")}
    assert html <= {"<code>", "</code>"}
    assert any(SCRIPT.partition("</script>")[2] in token.content for token in inside if token.type == "code_inline")
