"""The page of rows says what takes which groups of columns as it is today."""

from __future__ import annotations

import pytest

from tests.tools.seams import PAGE, page


@pytest.mark.thorough  # each command with each set of groups: a minute
def test_table_of_what_takes_which_groups_is_the_one_of_today():
    text = PAGE.read_text(encoding="utf-8")
    assert page(text) == text, "make seams"
