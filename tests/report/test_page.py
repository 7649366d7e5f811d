"""report.html is one file that loads nothing, runs nothing but its own, and lets no foreign text be more than text."""

from __future__ import annotations

import base64
import hashlib
import re
from html.parser import HTMLParser

import pytest

from hypcheck.report import html, markdown
from hypcheck.report.contents import IN_TABLE, LISTED
from tests.report import record_samples
from tests.report.pages import page_of

VOID = {"meta", "link", "br", "img", "input", "rect", "use", "path", "image"}


class Elements(HTMLParser):
    """Every element's tag and attributes, and the text of scripts and styles; a tag that is not closed is an error."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.found, self.texts, self.open = [], {"script": [], "style": [], "code": []}, []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        """One that must be closed, if it is not of VOID."""
        self.found.append((tag, dict(attributes)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        """One that is closed already."""
        self.found.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        """The end of the one that was opened last."""
        if tag in VOID:
            return
        assert self.open.pop() == tag

    def handle_data(self, data):
        """Collects the text of scripts, styles and code."""
        if self.open and self.open[-1] in self.texts:
            self.texts[self.open[-1]].append(data)


RECORDS = ("verify", "bench", "hostile")


@pytest.fixture(scope="module")
def pages():
    return {name: page_of(name).decode("utf-8") for name in RECORDS}


@pytest.mark.parametrize("name", RECORDS)
def test_page_loads_no_external_resource(pages, name):
    for tag, attributes in Elements(pages[name]).found:
        for attribute in ("src", "href", "xlink:href", "action", "data", "poster", "srcset"):
            value = attributes.get(attribute)
            assert value is None or value.startswith(("#", "data:image/png;base64,")) or value == "data:,", (tag, value)
        assert tag not in {"iframe", "object", "embed", "form", "base"}
    assert "@import" not in pages[name]
    assert "url(http" not in pages[name]


@pytest.mark.parametrize("name", RECORDS)
def test_the_security_policy_allows_only_the_pages_own_style_and_script(pages, name):
    elements = Elements(pages[name])
    policy = next(attributes["content"] for tag, attributes in elements.found if "http-equiv" in attributes)
    rules = dict(part.strip().split(" ", 1) for part in policy.split(";"))
    assert rules["default-src"] == "'none'"
    assert rules["base-uri"] == rules["form-action"] == "'none'"
    assert "unsafe" not in policy
    for kind in ("script", "style"):
        (text,) = elements.texts[kind]
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert rules[f"{kind}-src"] == f"'sha256-{digest}'"
    for tag, attributes in elements.found:
        assert "style" not in attributes, tag
        assert not any(name.startswith("on") for name in attributes), tag


def test_page_shows_hostile_names_as_text(pages):
    elements = Elements(pages["hostile"])
    assert len(elements.texts["script"]) == len(elements.texts["style"]) == 1
    assert not any(tag in {"b", "img"} for tag, _ in elements.found)
    assert any("<script>alert(1)</script>" in text for text in elements.texts["code"])
    assert "{{7*7}}" in pages["hostile"]  # no template of ours runs what is in a name
    assert r"\u202e" in pages["hostile"]
    assert f"{'e' * 50}… (1,000,000 characters)" in pages["hostile"]


@pytest.mark.parametrize("name", RECORDS)
def test_ids_in_the_page_are_unique_and_links_lead_to_them(pages, name):
    found = Elements(pages[name]).found
    ids = [attributes["id"] for _, attributes in found if "id" in attributes]
    assert len(ids) == len(set(ids))
    links = {attributes["href"][1:] for _, attributes in found if (attributes.get("href") or "").startswith("#")}
    labels = {name for _, attributes in found for name in (attributes.get("aria-labelledby") or "").split()}
    clips = {found for each in re.findall(r"url\(#([^)]+)\)", pages[name]) for found in [each]}
    assert links | labels | clips <= set(ids)


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
