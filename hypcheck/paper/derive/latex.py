r"""The same in LaTeX: a document that any engine compiles, with packages that every distribution has."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from hypcheck.derivation.costs import Cost
from hypcheck.derivation.links import Chain, Identity, Link, Part
from hypcheck.paper.derive.asking import PARTS
from hypcheck.paper.derive.choosing import Chosen
from hypcheck.paper.derive.layout import broken
from hypcheck.paper.derive.tex import formula, plain, sentence
from hypcheck.paper.derive.words import CHECKED, COST_COLUMNS, COSTS_EXPLAINED, FAILS, cost_cells, details, verdict
from hypcheck.paper.ledger.entry import Entry

_BEGIN = r"""\documentclass{article}
\usepackage{amsmath,amssymb}
\usepackage[a4paper,margin=25mm]{geometry}
\setlength{\parindent}{0pt}
\begin{document}"""

_ROOM = 88
"""Columns of plain text that fit on a line as a display."""


def lines(chosen: Chosen) -> Iterator[str]:
    """The whole document."""
    yield _BEGIN
    if "derivation" in chosen.parts:
        yield _heading("derivation")
        for section in chosen.sections:
            yield from _chain(section, numbered=False)
    if chosen.claim is not None:
        yield from _ledger(chosen.entries)
    if chosen.chains:
        yield _heading("propositions")
        for chain in chosen.chains:
            yield from _chain(chain, numbered=True)
    if "ledger" in chosen.parts:
        yield from _ledger(chosen.entries)
    if "costs" in chosen.parts:
        yield _heading("costs")
        yield from _costs(chosen.costs)
    yield r"\end{document}"


def _heading(part: str) -> str:
    return rf"\section*{{{part.capitalize()}: {sentence(PARTS[part])}}}"


def _chain(chain: Chain, *, numbered: bool) -> Iterator[str]:
    yield rf"\subsection*{{{sentence(chain.name)}}}"
    yield sentence(chain.statement)
    for number, link in enumerate(chain.links, 1):
        yield ""
        before = rf"\textbf{{{number}.}} " if numbered else ""
        yield before + sentence(link.statement) + (f" [{_reason(link)}]" if numbered else "")
        yield from map(_display, link.parts)


def _reason(link: Link) -> str:
    return sentence(f"{link.reason}: {link.cites}" if link.cites else link.reason)


def _display(part: Part) -> str:
    """A formula on its own, with its check as its tag; one that is too long in several lines."""
    tag = rf"\tag*{{{CHECKED if part.holds else FAILS}}}"
    if isinstance(part, Identity) and part.text.endswith("]"):
        name, _, inside = part.text.partition(" = ")
        rows = (" & ".join(map(formula, row.split(", "))) for row in inside.strip("[]").split("; "))
        body = formula(name) + r" = \begin{pmatrix} " + r" \\ ".join(rows) + r" \end{pmatrix}"
    else:
        first, *others = map(formula, broken(part.text, _ROOM))
        body = first if not others else rf"\begin{{aligned}} & {first}{_continued(others)} \end{{aligned}}"
    return rf"\begin{{equation*}} {body} {tag} \end{{equation*}}"


def _continued(pieces: Iterable[str]) -> str:
    return "".join(rf" \\ & \quad {piece}" for piece in pieces)


def _ledger(entries: tuple[Entry, ...]) -> Iterator[str]:
    yield _heading("ledger")
    yield r"\begin{description}"
    for entry in entries:
        yield rf"\item[{{{plain(entry.number)}}}] \textbf{{{verdict(entry)}.}} {sentence(entry.statement)}"
        for title, text in details(entry):
            yield rf"\\ \emph{{{title}:}} {sentence(text)}"
    yield r"\end{description}"


def _costs(costs: tuple[Cost, ...]) -> Iterator[str]:
    yield sentence(COSTS_EXPLAINED)
    yield r"\medskip\par\small"
    yield rf"\begin{{tabular}}{{l{'r' * len(COST_COLUMNS)}}}"
    yield " & ".join(["", *map(sentence, COST_COLUMNS)]) + r" \\ \hline"
    for cost in costs:
        yield " & ".join([cost.name, *cost_cells(cost)]) + r" \\"
    yield r"\end{tabular}"
