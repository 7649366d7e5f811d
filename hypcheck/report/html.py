"""report.html: one file that needs no other file and no network, for any screen, keyboard, paper or colours.

Its content security policy allows only its own style and script, which it names by their hashes; templates escape all
text.
"""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import resources
from typing import Any

import jinja2
import markupsafe

from hypcheck.errors import UnavailableError
from hypcheck.messages import escaped
from hypcheck.record import Record
from hypcheck.report import explorer
from hypcheck.report.contents import content
from hypcheck.report.document import (
    Block,
    Bullets,
    Code,
    Details,
    Either,
    Emphasis,
    Explorer,
    Figures,
    Paragraph,
    Section,
    Strong,
    TableBlock,
    Text,
    bounded,
    plain,
)
from hypcheck.report.drawings import Drawings, ReportContext, drawn_plots
from hypcheck.report.plots.colours import colour_rules
from hypcheck.version import VERSION

_TAGS = {Strong: "strong", Emphasis: "em"}


def html_text(words: Text) -> markupsafe.Markup:
    """Running text as the content of an element: foreign text is escaped, and cut if it is very long."""
    if isinstance(words, str):
        edges = (" " * words[:1].isspace(), " " * words[-1:].isspace())
        return markupsafe.escape(edges[0] + escaped(bounded(words)) + edges[1])
    if isinstance(words, Code):
        shown = escaped(bounded(words.text))
        if explorer.can_be_drawn(words.row):
            drawn = explorer.small_picture(words.row)
            numbers = explorer.row_as_text(words.row)
            return markupsafe.Markup('<code data-row="{}">{}</code> {}').format(numbers, shown, _trusted(drawn))
        return markupsafe.Markup("<code>{}</code>").format(shown) if words.text else markupsafe.Markup()
    if isinstance(words, (Strong, Emphasis)):
        tag = _TAGS[type(words)]
        return markupsafe.Markup(f"<{tag}>") + html_text(words.text) + markupsafe.Markup(f"</{tag}>")  # noqa: S704
    return markupsafe.Markup().join(map(html_text, words))


_KINDS: dict[type, str] = {Paragraph: "paragraph", Bullets: "bullets", TableBlock: "table", Explorer: "explorer"}


@dataclass(frozen=True, slots=True)
class _TemplateBlock:
    """A block for the templates: its kind, and the blocks or plots that it holds."""

    kind: str
    value: Any
    blocks: tuple[_TemplateBlock, ...] = ()
    plots: tuple[dict[str, Any], ...] = ()
    missing: str = ""


def render(record: Record, context: ReportContext | None = None) -> bytes:
    """The page in UTF-8. Without matplotlib it has no plots."""
    whole = content(record, context.against if context else None)
    sections = list(_sections(whole.sections, record, context.drawings if context else {}))
    return _page(title=whole.title, verdict=whole.verdict, sections=sections, source="from the record alone")


def explorer_page() -> bytes:
    """The explorer as a page of its own, in UTF-8; it begins on the ring."""
    block = _TemplateBlock("explorer", Explorer(explorer.ON_THE_RING))
    section = {"title": "Move the bodies", "level": 2, "anchor": "explorer", "blocks": [block]}
    return _page(title="Spheroid and hyperboloid", verdict=None, sections=[section], source="")


def _page(**parts: Any) -> bytes:  # noqa: ANN401 - what the template shows
    style, script = colour_rules() + _template("style.css"), _template("script.js") + "\n" + _template("explorer.js")
    page: str = (
        _environment()
        .get_template("page.html")
        .render(
            **parts,
            version=VERSION,
            style=_trusted(style),
            script=_trusted(script),
            style_hash=_hash(style),
            script_hash=_hash(script),
        )
    )
    return (page + "\n").encode("utf-8", "replace")


def _template(name: str) -> str:
    return resources.files("hypcheck.report").joinpath("templates", name).read_text(encoding="utf-8").strip()


def _hash(text: str) -> str:
    """The hash of a text in the form of a content security policy."""
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode("ascii")


def _trusted(text: str) -> markupsafe.Markup:
    """Our own text, or SVG in which svg.py has escaped foreign text: it needs no escaping."""
    return markupsafe.Markup(text)  # noqa: S704


def _environment() -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.FunctionLoader(_template),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"text": html_text, "plain": plain, "numbers": explorer.row_as_text}
    environment.globals["formulas"] = explorer.formulas_as_json
    return environment


def _sections(sections: tuple[Section, ...], record: Record, drawings: Drawings) -> Iterator[dict[str, Any]]:
    for number, section in enumerate(sections):
        words = re.sub(r"[^a-z0-9]+", "-", plain(section.title).lower())[:40].strip("-")
        blocks = [_template_block(block, record, drawings) for block in section.blocks]
        anchor = f"s{number}-{words}"
        yield {"title": section.title, "level": section.level, "anchor": anchor, "blocks": blocks}


def _template_block(block: Block, record: Record, drawings: Drawings) -> _TemplateBlock:
    if isinstance(block, Either):
        return _template_block(block.page, record, drawings)
    if isinstance(block, Details):
        return _TemplateBlock("details", block, tuple(_template_block(each, record, drawings) for each in block.blocks))
    if isinstance(block, Figures):
        return _figures(block, record, drawings)
    return _TemplateBlock(_KINDS[type(block)], block)


def _figures(block: Figures, record: Record, drawings: Drawings) -> _TemplateBlock:
    try:
        plots = tuple(
            {"title": plot.title, "svg": _trusted(plot.svg)} for plot in drawn_plots(block.name, record, drawings)
        )
    except UnavailableError as error:
        return _TemplateBlock("figures", block, missing=f"The plots are missing: {error}")
    return _TemplateBlock("figures", block, plots=plots)
