"""report.html lets no foreign text be more than text, and counts what it leaves out.

The goldens of recorded runs show the page whole, and that it loads nothing and runs nothing but its own.
"""

from __future__ import annotations

from hypcheck.report import html, markdown
from hypcheck.report.sections import IN_TABLE, LISTED
from tests.report import record_samples
from tests.report.hostile import hostile_record
from tests.report.page_structure import Elements, faults


def test_page_shows_hostile_names_as_text():
    page = html.render(hostile_record(methods=2, workloads=2)).decode("utf-8")
    assert faults(page) == []
    elements = Elements(page)
    assert len(elements.texts["script"]) == len(elements.texts["style"]) == 1
    assert not any(tag in {"b", "img"} for tag, _ in elements.found)
    assert any("<script>alert(1)</script>" in text for text in elements.texts["code"])
    assert "{{7*7}}" in page  # no template of ours runs what is in a name
    assert r"\u202e" in page
    assert f"{'e' * 50}… (1,000,000 characters)" in page


def test_failures_beyond_the_length_of_the_table_or_of_the_list_are_counted():
    proof = {"type": "proof", "formula": "f", "holds": False, "statement": "x"}
    many = [{**proof, "quantity": f"quantity-{number}"} for number in range(IN_TABLE + 6)]
    record = record_samples.record(many, exit_code=6)
    text = html.render(record).decode("utf-8")
    assert "… and 6 more failures; <code>junit.xml</code> and <code>summary.json</code> list them all." in text
    assert f"quantity-{IN_TABLE - 1}" in text
    assert f"quantity-{IN_TABLE}" not in text
    left_out = len(many) - LISTED
    assert (
        f"… and {left_out} more failures; `junit.xml` and `summary.json` list them" in markdown.render(record).decode()
    )
