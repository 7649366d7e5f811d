"""The page of rows says what takes which groups of columns as it is today."""

from __future__ import annotations

import re

import pytest

from tests.tools.seams import ASKED, PAGE, SETS, page, reason_of

SLOW = re.compile("verify|replay|minimise|hunt|bench")


def said():
    """What the page says of each thing that is asked: for each set of groups the reason, None where it is taken."""
    text = PAGE.read_text(encoding="utf-8")
    reasons = dict(re.findall(r"^(\d+)\. (.*)$", text, re.MULTILINE))
    for line in text.splitlines():
        name, *cells = (cell.strip() for cell in line.strip("|").split("|"))
        if name in ASKED:
            yield name, [None if cell == "yes" else reasons[cell] for cell in cells]


def test_page_of_rows_has_a_line_for_every_question():
    assert [name for name, _ in said()] == list(ASKED)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "reasons"), [each for each in said() if not SLOW.search(each[0])])
def test_line_of_the_page_of_rows_is_the_one_of_today(name, reasons):
    assert [reason_of(ASKED[name], groups) for groups in SETS] == reasons, "make seams"


@pytest.mark.thorough  # each command with each set of groups: a minute
def test_table_of_what_takes_which_groups_is_the_one_of_today():
    text = PAGE.read_text(encoding="utf-8")
    assert page(text) == text, "make seams"
