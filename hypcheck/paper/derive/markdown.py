"""The output of `hypcheck derive` in Markdown; docs/paper.md is the ledger and the costs in this form."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from hypcheck.derivation.formulas import Cost
from hypcheck.derivation.links import Chain
from hypcheck.paper.derive import PARTS, selection
from hypcheck.paper.derive.selection import Selection
from hypcheck.paper.ledger.book import coverage, faults_with_entries, sentences
from hypcheck.paper.ledger.book import entries as whole_ledger
from hypcheck.paper.ledger.entry import LedgerEntry
from hypcheck.report.markdown import table_lines

_INTRODUCTION = """# The paper, claim by claim

For readers of the paper. Afterwards you know what became of each of its statements. Written by `hypcheck derive
--only ledger --only costs --format markdown`; a test keeps it fresh, so change the ledger and not this page.
`hypcheck derive --claim "Proposition 3"` shows one claim with its proof link by link, its witnesses and their
certificates; [mathematics.md](mathematics.md) has the proofs in words.

**Proved** means that sympy found right − left = 0, or that every link of a chain of identities and signs was checked,
and that no pair of a space of small rational numbers contradicts it; small claims are proved by counting.
A **definition** cannot be true or false; the derivation uses the same one. A **misprint** is put right by the
derivation, or by another place of the text. A misprint may be the transcription's (see below).
**False** means that a search of that space found a pair which contradicts the statement, the simplest there is, and
that an exact certificate proves the pair's position, or that a count contradicts it; each printed rule was evaluated as
it is printed, in the regime that it states. A **question** is for the authors: the printed figures raise it, and no
proof can answer it. Statements that are false for one and the same reason share a *fault*. Words in quotation marks are
the paper's own. a = α/b and c = γ/d are the semi-axes after Theorem 1, C is the centre, A = a², B = c². *The ring*:
z0 = 0, r² = (c² + 1)(a² + c²)/c², c² > a.

**The paper** is “Algorithms for Determining Relative Position between Spheroids and Hyperboloids with One Sheet”. The
text that was audited is a transcription. It names no authors, no journal, no year and no DOI, and it has neither the
figures nor the list of references; the works [1] to [16] were not read. So every *misprint*, and every verdict about
the wording or the figures of Table 5, must be looked up on the printed page before it is held against the authors."""


def lines(chosen: Selection) -> Iterator[str]:
    """The page."""
    yield _INTRODUCTION
    if "derivation" in chosen.parts:
        yield from _heading("derivation")
        for section in chosen.sections:
            yield from _chain(section)
    if "ledger" in chosen.parts or chosen.claim is not None:
        yield from _heading("ledger")
        yield from _ledger(chosen.entries)
    if chosen.chains:
        yield from _heading("propositions")
        for chain in chosen.chains:
            yield from _chain(chain)
    if "costs" in chosen.parts:
        yield from _heading("costs")
        yield from _costs(chosen.costs)


def _heading(part: str) -> Iterator[str]:
    yield from ("", f"## {part.capitalize()}: {PARTS[part]}")


def _chain(chain: Chain) -> Iterator[str]:
    yield from ("", f"### {chain.name}", "", chain.statement, "")
    for number, link in enumerate(chain.links, 1):
        yield f"{number}. {link.statement} *({link.because})*"
        for part in link.parts:
            yield f"   - `{part.text}` {selection.remark(part.holds)}"


def _ledger(entries: tuple[LedgerEntry, ...]) -> Iterator[str]:
    yield from ("", selection.tally(entries))
    if entries == whole_ledger():
        yield from ("", coverage())
        yield from _faults()
    brief = list(filter(selection.is_brief, entries))
    if brief:
        yield from ("", "Formulas that hold as printed, right − left = 0:", "")
        rows = ((entry.number, entry.statement, entry.verdict, entry.follows) for entry in brief)
        yield from _table(("number", "what it is", "verdict", "what follows"), rows)
    for entry in entries:
        if entry not in brief:
            yield from (
                "",
                f"### {entry.number}: {selection.verdict(entry)}",
                "",
                entry.statement,
                "",
            )
            yield from (f"- *{title}*: {text}" for title, text in selection.details(entry))
    if entries == whole_ledger():
        yield from _sentences()


def _faults() -> Iterator[str]:
    """The lines about faults, and the statements that each fault makes false."""
    yield from ("", f"{selection.faults_in_words()}:", "")
    rows = ((name, what, "; ".join(numbers)) for name, what, numbers in faults_with_entries())
    yield from _table(("fault", "what it is", "statements"), rows)


def _sentences() -> Iterator[str]:
    """The lines about sentences, and the rows that judge each of them."""
    yield from ("", "## Sentences: the paper's text in order, and what judges each", "")
    rows = (
        (sentence.section, sentence.words, "; ".join(sentence.rows) or f"*{sentence.reason}*")
        for sentence in sentences()
    )
    yield from _table(("section", "the sentence begins", "rows, or why it has none"), rows)


def _table(head: Sequence[str], rows: Iterable[Sequence[str]], numbers: Iterable[int] = ()) -> list[str]:
    """The lines of a table whose cells are Markdown except for bars; the columns `numbers` are aligned to the right."""
    return table_lines(head, ([cell.replace("|", "\\|") for cell in row] for row in rows), numbers)[:-1]


def _costs(costs: tuple[Cost, ...]) -> Iterator[str]:
    yield from ("", selection.COSTS_EXPLAINED, "")
    head = ("", *(f"scene {name}" for name in selection.SCENE_COLUMNS), *selection.QUERY_COLUMNS)
    yield from _table(head, ((f"`{cost.name}`", *selection.cost_cells(cost)) for cost in costs), range(1, len(head)))
    yield ""
    for cost in costs:
        yield f"- `{cost.name}`: {cost.title} ({cost.source})"
