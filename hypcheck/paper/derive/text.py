"""The output of `hypcheck derive` for a person at a terminal, in 100 columns of Unicode."""

from __future__ import annotations

import re
import textwrap
import unicodedata
from collections.abc import Iterable, Iterator, Sequence

import sympy

from hypcheck.derivation.formulas import Cost
from hypcheck.derivation.links import Chain, Part
from hypcheck.geometry.pair import CENTER, SIZES, Pair
from hypcheck.paper.derive import PARTS, selection
from hypcheck.paper.derive.selection import Selection
from hypcheck.paper.ledger.book import coverage, faults_with_entries
from hypcheck.paper.ledger.book import entries as whole_ledger
from hypcheck.paper.ledger.entry import Evidence, LedgerEntry, described
from hypcheck.proof_text import proof_lines

WIDTH = 100

_NUMBER, _VERDICT, _TITLE = 34, 49, 10
"""Columns of the ledger: where the number and the verdict end, and how wide the titles of further lines are."""


def lines(chosen: Selection) -> Iterator[str]:
    """The selected parts, each with a heading."""
    if "derivation" in chosen.parts:
        yield from _heading("derivation")
        yield from paragraph(
            f"Each formula marked {selection.CHECKED} was held against what sympy {sympy.__version__} makes of the two "
            "surfaces, now."
        )
        for number, section in enumerate(chosen.sections, 1):
            yield ""
            yield from _section(section, f"{number}.")
    if "propositions" in chosen.parts:
        yield from _heading("propositions")
        yield from paragraph("A = a² = (α/b)², B = c² = (γ/d)², P = (x0² + y0²)/b², Q = (z0/d)².")
        for chain in chosen.chains:
            yield ""
            yield from _chain(chain)
    if "ledger" in chosen.parts:
        yield from _ledger(chosen.entries)
    if "costs" in chosen.parts:
        yield from _heading("costs")
        yield from _costs(chosen.costs)
    if chosen.claim is not None:
        yield from _in_full(chosen)


def _heading(part: str) -> Iterator[str]:
    title = f"{part.upper()}: {PARTS[part]}"
    yield from ("", title, "═" * len(title), "")


def _section(section: Chain, number: str) -> Iterator[str]:
    yield f"{padded(number, 4)}{section.name}"
    yield from paragraph(section.statement, 4)
    for link in section.links:
        yield ""
        yield from paragraph(link.statement, 4)
        yield from _parts(link.parts, 8)


def _chain(chain: Chain) -> Iterator[str]:
    yield chain.name.upper() + (f"   (with {' and '.join(chain.needs)})" if chain.needs else "")
    yield from paragraph(chain.statement, 4)
    for number, link in enumerate(chain.links, 1):
        yield ""
        yield from paragraph(f"{link.statement} [{link.because}]", 4, f"{number}.")
        yield from _parts(link.parts, 8)


def _parts(parts: Iterable[Part], indent: int) -> Iterator[str]:
    for part in parts:
        named = selection.matrix_of(part)
        if named is not None:
            yield from matrix(*named, indent, selection.remark(part.holds))
        else:
            yield from formula(part.text, indent, selection.remark(part.holds))


def _ledger(entries: tuple[LedgerEntry, ...]) -> Iterator[str]:
    yield from _heading("ledger")
    yield from paragraph(
        f"{selection.tally(entries)} Formulas without a reason have right − left = 0. a = α/b, c = γ/d, C is the "
        "centre in the scaled space; A.n is the "
        "n-th display of Appendix A. `hypcheck derive --claim NUMBER` shows one with its proof."
    )
    yield from paragraph(coverage())
    if entries == whole_ledger():
        yield from ("", *paragraph(f"{selection.faults_in_words()}:"))
        for name, what, numbers in faults_with_entries():
            yield from paragraph(f"{what} ({'; '.join(numbers)})", _NUMBER, f"    {name}")
    before = False
    for entry in entries:
        brief = selection.is_brief(entry)
        if not (brief and before):
            yield ""
        yield from _entry(entry, brief=brief)
        before = brief


def _entry(entry: LedgerEntry, *, brief: bool) -> Iterator[str]:
    """One line for a formula that holds as printed, a few lines for other entries."""
    head = padded(entry.number, _NUMBER) + padded(selection.verdict(entry), _VERDICT - _NUMBER)
    if brief:
        yield from paragraph(f"{entry.statement}; {entry.follows}", _VERDICT, head)
        return
    yield from paragraph(entry.statement, _VERDICT, head)
    yield from _details(selection.details(entry), 4)


def _details(titled: Iterable[tuple[str, str]], start: int) -> Iterator[str]:
    for title, text in titled:
        yield from paragraph(text, start + _TITLE, " " * start + title)


def _in_full(chosen: Selection) -> Iterator[str]:
    """Claims one by one, with their evidence; then the chains, each once."""
    for entry in chosen.entries:
        yield ""
        yield from paragraph(f"{entry.number} (section {entry.section}) — {selection.verdict(entry).upper()}")
        yield from paragraph(entry.statement, 4)
        yield from _details(selection.details(entry, in_full=True), 4)
        for evidence in entry.evidence:
            yield from _evidence(evidence)
    for chain in chosen.chains:
        yield from ("", "─" * WIDTH)
        yield from _chain(chain)


def _evidence(evidence: Evidence) -> Iterator[str]:
    """A reason and whether it holds; witnesses as rows that can be classified, each with its certificate."""
    indent = 4 + _TITLE
    if not (evidence.witnesses or evidence.tilted):
        yield from formula(f"{evidence.kind}: {evidence.text}", indent, selection.remark(evidence.holds))
    for witness in evidence.witnesses:
        yield from formula(described(witness.facts), indent, selection.remark(evidence.holds and witness.holds))
        yield from paragraph(witness.shows, indent + 4)
        yield f"{'':{indent + 4}}{_command(witness.facts.point.pair)}"
        for line in proof_lines(witness.facts.point.pair, witness.certificate):
            yield from paragraph(line, indent + 4)
    for tilted in evidence.tilted:
        yield from formula(tilted.text, indent, selection.remark(evidence.holds and tilted.holds))
        yield from paragraph(tilted.shows, indent + 4)
        axis = " ".join(f"{number:g}" for number in tilted.pair.axis)
        yield f"{'':{indent + 4}}{_command(tilted.upright)} --axis {axis}"
        for line in (
            *proof_lines(tilted.pair, tilted.certificate),
            "Without --axis:",
            *proof_lines(tilted.upright, tilted.vertical),
        ):
            yield from paragraph(line, indent + 4)


def _command(pair: Pair) -> str:
    sizes = " ".join(f"--{name} {getattr(pair, name):g}" for name in SIZES)
    return f"hypcheck classify {sizes} --center {' '.join(f'{getattr(pair, name):g}' for name in CENTER)}"


def _costs(costs: tuple[Cost, ...]) -> Iterator[str]:
    yield from paragraph(selection.COSTS_EXPLAINED)
    yield ""
    left = 6 * len(selection.SCENE_COLUMNS)
    yield f"{'':22}{'a scene':>{left}}   {'a position':>{6 * len(selection.QUERY_COLUMNS) + 2}}"
    yield f"{'':22}{_cells(selection.COST_COLUMNS)}"
    for cost in costs:
        yield f"{cost.name:22}{_cells(selection.cost_cells(cost))}"
    yield ""
    for cost in costs:
        yield from paragraph(f"{cost.title} ({cost.source})", 22, cost.name)


def _cells(cells: Sequence[str]) -> str:
    """Numbers, or their titles, in columns; a gap separates a scene's numbers from a position's."""
    scene, query = cells[: len(selection.SCENE_COLUMNS)], cells[len(selection.SCENE_COLUMNS) :]
    return f"{''.join(f'{cell:>6}' for cell in scene)}   {''.join(f'{cell:>6}' for cell in query[:-1])}{query[-1]:>8}"


def columns(text: str) -> int:
    """The number of columns of a text; combining marks, as in H̄, take none."""
    return sum(not unicodedata.combining(character) for character in text)


def padded(text: str, width: int) -> str:
    """The text with spaces up to a width."""
    return text + " " * (width - columns(text))


def paragraph(text: str, indent: int = 0, first: str = "") -> Iterator[str]:
    """The text in lines, without a break inside a comparison; `first` replaces the indent of the first line."""
    glued = re.sub(r"(?<=\S) ([=<>≤≥≠]) (?=\S)", "\u00a0\\1\u00a0", text)
    glued = re.sub(r"(?<=\d), (?=[\d−]\S*\)|\d+, )", ",\u00a0", glued)  # a point's coordinates stay together
    lines = textwrap.wrap(glued, WIDTH - indent, break_long_words=False, break_on_hyphens=False)
    for number, line in enumerate(lines or [""]):
        yield (padded(first if number == 0 else "", indent) + line.replace("\u00a0", " ")).rstrip()


def formula(text: str, indent: int, remark: str) -> Iterator[str]:
    """A formula with a remark at the right edge; one that is too long is broken (see `broken`)."""
    first, *others = broken(text, WIDTH - indent - len(remark) - 2)
    lines = [first, *(f"    {line}" for line in others)]
    for line in lines[:-1]:
        yield " " * indent + line
    yield padded(" " * indent + lines[-1], WIDTH - len(remark)) + remark


def broken(text: str, room: int, depth: int = 0) -> list[str]:
    """The formula in lines of at most `room` columns, broken before signs that join terms, the outermost ones first."""
    lines = [""]
    for piece in _terms(text, depth):
        if columns(lines[-1] + piece) <= room or not lines[-1]:
            lines[-1] += piece
        else:
            lines.append(piece.lstrip())
    deeper = [broken(line, room, depth + 1) if columns(line) > room and depth < _DEEPEST else [line] for line in lines]
    return [line for parts in deeper for line in parts]


_DEEPEST = 4
"""No formula here nests further."""


def _terms(text: str, depth: int) -> Iterator[str]:
    """The text cut before each spaced sign, and after each comma, that stands in at most `depth` brackets."""
    start = level = 0
    for place, character in enumerate(text):
        level += (character in "([") - (character in ")]")
        joins = text[place : place + 3] in {" + ", " − ", " ⟺ ", " = "} and place > 0
        if level <= depth and (joins or text[place - 1 : place] == ","):
            yield text[start:place]
            start = place
    yield text[start:]


def matrix(name: str, rows: Sequence[Sequence[str]], indent: int, remark: str) -> Iterator[str]:
    """A matrix, one line for each row; the remark is at the end of the last line."""
    widths = [max(map(columns, column)) for column in zip(*rows, strict=True)]
    last = len(rows) - 1
    for number, row in enumerate(rows):
        left, right = ("⎡", "⎤") if number == 0 else ("⎣", "⎦") if number == last else ("⎢", "⎥")
        cells = "  ".join(padded(cell, width) for cell, width in zip(row, widths, strict=True))
        title = f"{name} = " if number == last // 2 else " " * (columns(name) + 3)
        line = f"{' ' * indent}{title}{left} {cells} {right}"
        yield line if number < last else padded(line, WIDTH - len(remark)) + remark
