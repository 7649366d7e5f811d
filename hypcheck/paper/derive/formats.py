"""The writers of `hypcheck derive`: each yields the lines of a selection in one format of FORMATS."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from hypcheck.paper.derive import as_json, erratum, latex
from hypcheck.paper.derive.content import Selection, sections
from hypcheck.report import markdown, text

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
"""The beginning of docs/paper.md, which is the ledger and the costs in Markdown."""


def markdown_lines(chosen: Selection) -> Iterator[str]:
    """Yield the page: a document in Markdown after an introduction."""
    lines = [_INTRODUCTION, "", *markdown.section_lines(sections(chosen))]
    yield from lines[:-1]  # the last line is empty


WRITERS: Mapping[str, Callable[[Selection], Iterator[str]]] = {
    "text": lambda chosen: text.lines(sections(chosen)),
    "latex": lambda chosen: latex.lines(sections(chosen)),
    "json": as_json.lines,
    "markdown": markdown_lines,
    "erratum": erratum.lines,
}
