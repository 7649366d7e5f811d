"""docs/evidence.md shows the kept figures, and none of them has fallen."""

from __future__ import annotations

from tests.tools.evidence import floors
from tests.tools.evidence.page import page
from tests.tools.evidence.parts import KEPT, PAGE, PARTS, TABLES, kept, text_of


def test_evidence_page_equals_the_one_printed_from_the_kept_figures():
    """`make evidence` writes both; `python -m tests.tools.evidence PART --write` one part of them."""
    assert list(kept()) == list(PARTS)
    assert KEPT.read_text(encoding="utf-8") == text_of(kept())
    text, tables = page(kept())
    assert PAGE.read_text(encoding="utf-8") == text
    assert {path.name: path.read_text(encoding="utf-8") for path in TABLES.iterdir()} == tables


def test_every_kept_figure_of_evidence_is_within_its_floor_and_ceiling():
    assert [sentence for name, figures in kept().items() for sentence in floors.broken(name, figures)] == []


def test_every_floor_and_ceiling_belongs_to_a_part_of_the_evidence():
    assert {*floors.AT_LEAST, *floors.AT_MOST} <= set(PARTS)


def test_a_figure_below_its_floor_or_above_its_ceiling_is_named_in_a_sentence(monkeypatch):
    monkeypatch.setitem(floors.AT_LEAST, "some", {"file.share": 99})
    monkeypatch.setitem(floors.AT_MOST, "some", {"survivors": 0})
    assert floors.broken("some", {"file": {"share": 99}, "survivors": 0}) == []
    assert floors.broken("some", {"file": {"share": 98.5}, "survivors": 1}) == [
        "some: file.share is 98.5; it must be at least 99",
        "some: survivors is 1; it must be at most 0",
    ]
