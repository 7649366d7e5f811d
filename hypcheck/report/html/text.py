"""Running text as HTML: what is foreign in it means itself, is seen, and is cut where it is endless."""

from __future__ import annotations

from markupsafe import Markup, escape

from hypcheck.report.content.blocks import Code, Emphasis, Strong, Text, bounded
from hypcheck.visible import visible

_TAGS = {Strong: "strong", Emphasis: "em"}


def text(words: Text) -> Markup:
    """The text as an element's content."""
    if isinstance(words, str):
        edges = (" " * words[:1].isspace(), " " * words[-1:].isspace())
        return escape(edges[0] + visible(bounded(words)) + edges[1])
    if isinstance(words, Code):
        return Markup("<code>{}</code>").format(visible(bounded(words.text))) if words.text else Markup()
    if isinstance(words, (Strong, Emphasis)):
        tag = _TAGS[type(words)]
        return Markup(f"<{tag}>") + text(words.text) + Markup(f"</{tag}>")  # noqa: S704 - our own tags
    return Markup().join(map(text, words))
