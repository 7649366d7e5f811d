"""report.html: one file that needs no other file and no network, for any screen, keyboard, printer or colours.

Its content security policy allows only its own style and script, given by their hashes; templates escape all text. A
reader can move the bodies in its explorer: the script templates/explorer.js decides and draws. It runs the same
programs that are proved and printed, step by step.
"""

from __future__ import annotations

import base64
import hashlib
import json
import math
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import resources
from typing import Any

import jinja2
import markupsafe

from hypcheck.derivation.formulas import FORMULAS, REPAIRED
from hypcheck.derivation.program import needed
from hypcheck.errors import UnavailableError
from hypcheck.messages import escaped
from hypcheck.record import Record
from hypcheck.report import document
from hypcheck.report.colours import colour_rules
from hypcheck.report.drawings import ALONE, Drawings, ReportContext, drawn_plots
from hypcheck.report.messages import short_row
from hypcheck.report.sections import ON_THE_RING, can_be_drawn, content
from hypcheck.version import VERSION

_TAGS = {document.Strong: "strong", document.Emphasis: "em"}


def html_text(words: document.Text) -> markupsafe.Markup:
    """Convert running text to the content of an element: foreign text is escaped, and cut if it is very long."""
    if isinstance(words, str):
        edges = (" " * words[:1].isspace(), " " * words[-1:].isspace())
        return markupsafe.escape(edges[0] + escaped(document.bounded(words)) + edges[1])
    if isinstance(words, document.Code):
        shown = escaped(document.bounded(words.text))
        if can_be_drawn(words.row):
            drawn, numbers = small_picture(words.row), row_as_text(words.row)
            return markupsafe.Markup('<code data-row="{}">{}</code> {}').format(numbers, shown, _trusted(drawn))
        return markupsafe.Markup("<code>{}</code>").format(shown) if words.text else markupsafe.Markup()
    if isinstance(words, document.ShownFormula):
        return markupsafe.Markup("<code>{}</code> {}").format(words.text, words.remark)
    if isinstance(words, (document.Strong, document.Emphasis)):
        tag = _TAGS[type(words)]
        return markupsafe.Markup(f"<{tag}>") + html_text(words.text) + markupsafe.Markup(f"</{tag}>")  # noqa: S704
    return markupsafe.Markup().join(map(html_text, words))


_KINDS: dict[type, str] = {
    document.Paragraph: "paragraph",
    document.Bullets: "bullets",
    document.TableBlock: "table",
    document.Explorer: "explorer",
}


@dataclass(frozen=True, slots=True)
class _TemplateBlock:
    """A block for the templates: its kind, and the blocks or plots that it holds."""

    kind: str
    value: Any
    blocks: tuple[_TemplateBlock, ...] = ()
    plots: tuple[dict[str, Any], ...] = ()
    missing: str = ""


def render(record: Record, context: ReportContext = ALONE) -> bytes:
    """Render the page in UTF-8. Without matplotlib it has no plots."""
    whole = content(record, context.against)
    sections = list(_sections(whole.sections, record, context.drawings))
    return _page(title=whole.title, verdict=whole.verdict, sections=sections, source="from the record alone")


def explorer_page() -> bytes:
    """Render the explorer as a separate page, in UTF-8; its first case is on the ring."""
    block = _TemplateBlock("explorer", document.Explorer(ON_THE_RING))
    section = {"title": "Move the bodies", "level": 2, "anchor": "explorer", "blocks": [block]}
    return _page(title="Spheroid and hyperboloid", verdict=None, sections=[section], source="")


def _page(**parts: Any) -> bytes:  # noqa: ANN401 - what the template shows
    """Render page.html with these parts, its style and script, and their hashes."""
    style = colour_rules() + _template("style.css")
    script = "\n".join(map(_template, ("script.js", "ends.js", "explorer.js")))
    own = {"style": _trusted(style), "script": _trusted(script)}
    hashes = {"style_hash": _hash(style), "script_hash": _hash(script)}
    page: str = _environment().get_template("page.html").render(**parts, **own, **hashes, version=VERSION)
    return (page + "\n").encode("utf-8", "replace")


def _template(name: str) -> str:
    """Read a file of the folder templates."""
    return resources.files("hypcheck.report").joinpath("templates", name).read_text(encoding="utf-8").strip()


def _hash(text: str) -> str:
    """Return the hash of a text in the form of a content security policy."""
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode("ascii")


def _trusted(text: str) -> markupsafe.Markup:
    """Mark text of hypcheck, or SVG in which plots/style.py has escaped foreign text, as not to be escaped."""
    return markupsafe.Markup(text)  # noqa: S704


def _environment() -> jinja2.Environment:
    """Make the environment of jinja2: templates escape all text and may use no undefined name."""
    environment = jinja2.Environment(
        loader=jinja2.FunctionLoader(_template),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"text": html_text, "plain": document.plain, "numbers": row_as_text}
    environment.globals["formulas"] = formulas_as_json
    return environment


def _sections(sections: tuple[document.Section, ...], record: Record, drawings: Drawings) -> Iterator[dict[str, Any]]:
    """Yield each section as the template reads it: title, level, anchor and blocks."""
    for number, section in enumerate(sections):
        words = re.sub(r"[^a-z0-9]+", "-", document.plain(section.title).lower())[:40].strip("-")
        blocks = [_template_block(block, record, drawings) for block in section.blocks]
        anchor = f"s{number}-{words}"
        yield {"title": section.title, "level": section.level, "anchor": anchor, "blocks": blocks}


def _template_block(block: document.Block, record: Record, drawings: Drawings) -> _TemplateBlock:
    """Convert a block for the templates; of two forms it takes the one for the page."""
    if isinstance(block, document.Either):
        return _template_block(block.page, record, drawings)
    if isinstance(block, document.Details):
        return _TemplateBlock(
            "details", block, tuple(_template_block(inner, record, drawings) for inner in block.blocks)
        )
    if isinstance(block, document.Figures):
        return _figures(block, record, drawings)
    return _TemplateBlock(_KINDS[type(block)], block)


def _figures(block: document.Figures, record: Record, drawings: Drawings) -> _TemplateBlock:
    """Convert a block of plots, which it draws; without matplotlib the block has the reason."""
    try:
        drawn = drawn_plots(block.name, record, drawings)
    except UnavailableError as error:
        return _TemplateBlock("figures", block, missing=f"The plots are missing: {error}")
    return _TemplateBlock("figures", block, plots=tuple({"title": title, "svg": _trusted(svg)} for title, svg in drawn))


WIDTH, HEIGHT = 96.0, 64.0
"""The size of a small picture, in its own units."""

_STEEPEST = 1e300
"""A limit of the scale, so that no place in a picture is infinity times zero."""

_FINE = 500
"""The greatest exponent of a length after tiny ones are scaled, far from that at which products of two overflow."""

_FILLED = 0.8
"""The part of a small picture's width that the spheroid, the wall and the gap fill if the gap is wide."""

_DOT = 1.5
"""The least half width of a spheroid in a small picture."""

_POINTS = 16
"""Straight pieces of the meridian in a small picture."""


def small_picture(row: Sequence[float]) -> str:
    """Draw the spheroid of a row of seven numbers and the wall, as an SVG element without foreign text.

    Heights have a different scale if the spheroid would be too thin to be seen. A spheroid whose centre is more than
    two radii from the wall is drawn smaller, at least as a dot, so that both are in the picture.
    """
    # Tiny lengths are first scaled by a power of two: otherwise their scale in the picture would overflow.
    shift = max(0, min(-math.frexp(row[2])[1], _FINE - math.frexp(max(map(abs, row)))[1]))
    alpha, gamma, b, d, x, y, z = (math.ldexp(length, shift) for length in row)
    r = min(math.hypot(x, y), sys.float_info.max)
    wide, tall = min(WIDTH / 4 / b, _STEEPEST), min(HEIGHT / 4 / d, _STEEPEST)
    if max(wide, tall) <= 4 * min(wide, tall):
        wide = tall = min(wide, tall)
    gap, middle = _limited_gap(alpha * math.hypot(1, z / gamma) - r), 0.0
    if abs(gap) > 2 * b:
        low, high = min(-b, gap), max(b, gap)
        wide = tall = WIDTH * _FILLED / (high - low)
        middle = (low + high) / 2
    centre = WIDTH / 2 - middle * wide
    points = []
    for step in range(_POINTS + 1):
        height = z + (step / _POINTS - 0.5) * HEIGHT / tall
        across = centre + (alpha * math.hypot(1, height / gamma) - r) * wide
        up = HEIGHT / 2 - (height - z) * tall
        points.append(f"{_limited(across, WIDTH):.2f},{_limited(up, HEIGHT):.2f}")
    wall = " ".join(points)
    drawn = (
        f'<polygon class="inside" points="{wall} {-WIDTH:g},0 {-WIDTH:g},{HEIGHT:g}"/>'
        f'<polyline class="wall" points="{wall}"/>'
        f'<ellipse class="body" cx="{centre:.4g}" cy="{HEIGHT / 2:g}"'
        f' rx="{max(b * wide, _DOT):.3g}" ry="{max(min(d * tall, HEIGHT), _DOT):.3g}"/>'
    )
    head = f'<svg class="bodies" viewBox="0 0 {WIDTH:g} {HEIGHT:g}" role="img" aria-label="{short_row(row)}">'
    return f"{head}{drawn}</svg>"


def _limited_gap(gap: float) -> float:
    """Limit a distance to the wall to ±_STEEPEST, so that it stays finite."""
    return min(max(gap, -_STEEPEST), _STEEPEST)


def _limited(place: float, size: float) -> float:
    """Limit a coordinate to at most one picture width outside the picture."""
    return min(max(place, -size), 2 * size)


def row_as_text(row: Sequence[float]) -> str:
    """Return the numbers of a row as the script reads them, each the shortest text of the same float64."""
    return " ".join(map(repr, row))


def formulas_as_json() -> str:
    """Return every formula about a pair as JSON, Table 2 first.

    Each has its name, title, question, regimes and steps, and the name of the step that is the answer.
    """
    listed = [
        {
            "name": formula.name,
            "title": formula.title,
            "question": formula.question,
            "regimes": formula.regimes,
            "answer": formula.answer,
            "steps": [
                (step.name, step.operation, *step.arguments) for step in needed(formula.program, (formula.answer,))
            ],
        }
        for formula in (*FORMULAS.values(), *REPAIRED.values())
        if formula.classifies_pairs
    ]
    return json.dumps(listed, ensure_ascii=False, separators=(",", ":"))
