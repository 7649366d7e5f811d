"""Checks of a page's text, each of which returns what is wrong: it loads nothing and runs nothing but its own."""

from __future__ import annotations

import base64
import hashlib
import re
from html.parser import HTMLParser

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


def external(text, elements):
    """What the page would load from elsewhere, or embed."""
    attributes = ("src", "href", "xlink:href", "action", "data", "poster", "srcset")
    named = [found[each] for _, found in elements.found for each in attributes if found.get(each) is not None]
    loaded = [value for value in named if not value.startswith(("#", "data:image/png;base64,")) and value != "data:,"]
    embedded = [tag for tag, _ in elements.found if tag in {"iframe", "object", "embed", "form", "base"}]
    return [*loaded, *embedded, *(words for words in ("@import", "url(http") if words in text)]


def unprotected(elements):
    """What its security policy allows besides its own style and script, and what of the page it would not allow."""
    policy = next(attributes["content"] for _, attributes in elements.found if "http-equiv" in attributes)
    rules = dict(part.strip().split(" ", 1) for part in policy.split(";"))
    needed = {"default-src": "'none'", "base-uri": "'none'", "form-action": "'none'"}
    for kind in ("script", "style"):
        (text,) = elements.texts[kind]
        needed[f"{kind}-src"] = f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
    attributes = {name for _, found in elements.found for name in found}
    wrong = [f"{name} {rules.get(name)}" for name, rule in needed.items() if rules.get(name) != rule]
    refused = [name for name in attributes if name == "style" or name.startswith("on")]
    return [*wrong, *refused, *(["unsafe"] if "unsafe" in policy else [])]


def broken(text, elements):
    """Ids that are there twice, and links, labels and clips that lead nowhere."""
    ids = [attributes["id"] for _, attributes in elements.found if "id" in attributes]
    links = [attributes.get("href") or "" for _, attributes in elements.found]
    labels = [name for _, found in elements.found for name in (found.get("aria-labelledby") or "").split()]
    wanted = {*(each[1:] for each in links if each.startswith("#")), *labels, *re.findall(r"url\(#([^)]+)\)", text)}
    return [*(name for name in ids if ids.count(name) > 1), *(wanted - set(ids))]


def faults(text):
    """All of these."""
    elements = Elements(text)
    return [*external(text, elements), *unprotected(elements), *broken(text, elements)]
