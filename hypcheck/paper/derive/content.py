"""The content of `hypcheck derive`: a selection, and the document made from it, which every format for people renders.

A selection is whole parts (PARTS), or one claim of the paper with all evidence for its verdict.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import sympy

from hypcheck.derivation.chain_book import chains
from hypcheck.derivation.formulas import Cost, costs
from hypcheck.derivation.links import Chain
from hypcheck.derivation.walk import walk
from hypcheck.geometry.pair import Pair
from hypcheck.paper.derive import PARTS
from hypcheck.paper.ledger.book import coverage, entries, entries_of, faults_with_entries, sentences
from hypcheck.paper.ledger.entry import FALSE, HOLDS, VERDICTS, Evidence, LedgerEntry, described
from hypcheck.proof_text import proof_lines
from hypcheck.report.document import (
    Block,
    Bullets,
    Code,
    Emphasis,
    Item,
    Paragraph,
    Section,
    ShownFormula,
    Text,
    bullets,
    prose,
    table,
    terms,
)
from hypcheck.report.messages import classify_command
from hypcheck.truth.certificate import Certificate


@dataclass(frozen=True)
class Selection:
    """The selected output: parts by name or, if `claim` is given, the entries and chains of this claim, in full.

    A part is computed when it is first read, so that the first parts can be shown while later ones are derived.
    """

    parts: tuple[str, ...]
    claim: str | None = None

    @cached_property
    def sections(self) -> tuple[Chain, ...]:
        """The sections of the derivation."""
        return tuple(walk()) if "derivation" in self.parts else ()

    @cached_property
    def chains(self) -> tuple[Chain, ...]:
        """The chains of the propositions, or the chains that a claim rests on."""
        if self.claim is not None:
            named = {
                name for entry in self.entries for evidence in entry.evidence for name in _with_needs(evidence.chain)
            }
            return tuple(chain for name, chain in chains().items() if name in named)
        return tuple(chains().values()) if "propositions" in self.parts else ()

    @cached_property
    def entries(self) -> tuple[LedgerEntry, ...]:
        """The ledger, or the entries of a claim. Raises InputError if there is no such claim."""
        if self.claim is not None:
            return entries_of(self.claim)
        return entries() if "ledger" in self.parts else ()

    @cached_property
    def costs(self) -> tuple[Cost, ...]:
        """The costs of every method."""
        return costs() if "costs" in self.parts else ()

    @property
    def failing(self) -> tuple[str, ...]:
        """The names of shown formulas and chains that do not hold, and of entries whose verdict lacks support."""
        shown = (chain.name for chain in (*self.sections, *self.chains) if not chain.holds)
        return (*shown, *(entry.number for entry in self.entries if not entry.confirmed))


def _with_needs(name: str) -> tuple[str, ...]:
    """Return a chain's name, where there is one, and the names of those that it needs."""
    return (
        (name, *(chain_name for needed in chains()[name].needs for chain_name in _with_needs(needed))) if name else ()
    )


FAILS = "FAILS"


def remark(holds: bool) -> str:
    """Return the remark at a formula or at a reason."""
    return "checked" if holds else FAILS


def sections(chosen: Selection) -> Iterator[Section]:
    """Yield the content, section by section; each is computed when it is read."""
    if "derivation" in chosen.parts:
        how = f"Each formula marked {remark(True)} was held against what sympy {sympy.__version__} makes of the two "
        yield _part("derivation", Paragraph(f"{how}surfaces, now."))
        yield from map(_chain, chosen.sections)
    if chosen.claim is not None:
        yield from _ledger(chosen)
    if chosen.chains:
        yield _part("propositions", Paragraph("A = a² = (α/b)², B = c² = (γ/d)², P = (x0² + y0²)/b², Q = (z0/d)²."))
        yield from map(_chain, chosen.chains)
    if "ledger" in chosen.parts:
        yield from _ledger(chosen)
    if "costs" in chosen.parts:
        yield _part("costs", *_costs(chosen.costs))


def _part(name: str, *blocks: Block) -> Section:
    return Section(f"{name.capitalize()}: {PARTS[name]}", blocks)


def _chain(chain: Chain) -> Section:
    """Return the links of a chain as numbered steps, each with its formulas."""
    steps = tuple(
        Item(
            (prose(link.statement), " ", Emphasis(f"({link.because})")),
            tuple(ShownFormula(part.text, remark(part.holds)) for part in link.parts),
        )
        for link in chain.links
    )
    needs = f" (with {' and '.join(chain.needs)})" if chain.needs else ""
    blocks = (Paragraph(prose(chain.statement)), Bullets(steps, numbered=True))
    return Section(f"{chain.name[:1].upper()}{chain.name[1:]}{needs}", blocks, level=3)


_LEDGER = (
    "Formulas without a reason have right − left = 0. a = α/b, c = γ/d, C is the centre in the scaled space; A.n is "
    "the n-th display of Appendix A. `hypcheck derive --claim NUMBER` shows one with its proof."
)


def _ledger(chosen: Selection) -> Iterator[Section]:
    """Yield the sections of the ledger, or those of a claim with all details.

    In the ledger, formulas that hold as printed are in one table, and each other entry has a section.
    """
    shown, whole = chosen.entries, chosen.entries == entries()
    if chosen.claim is not None:
        yield from map(_entry_in_full, shown)
        return
    blocks: list[Block] = [Paragraph(prose(f"{_tally(shown)} {_LEDGER}"))]
    if whole:
        false = sum(entry.verdict == FALSE for entry in shown)
        faults = [(name, prose(what), "; ".join(numbers)) for name, what, numbers in faults_with_entries()]
        in_words = f"{false} statements are false for {len(faults)} independent faults; a fault counts once:"
        blocks += [
            Paragraph(coverage()),
            Paragraph(in_words),
            table("faults", "fault | what it is | statements", faults),
        ]
    brief = [entry for entry in shown if entry.why == HOLDS and entry.confirmed]
    if brief:
        rows = [(entry.number, prose(entry.statement), entry.verdict, prose(entry.follows)) for entry in brief]
        blocks.append(Paragraph("Formulas that hold as printed, right − left = 0:"))
        blocks.append(table("formulas that hold", "number | what it is | verdict | what follows", rows))
    yield _part("ledger", *blocks)
    for entry in shown:
        if entry not in brief:
            blocks = [Paragraph(prose(entry.statement)), terms(details(entry))]
            yield Section(f"{entry.number}: {verdict(entry)}", tuple(blocks), level=3)
    if whole:
        yield _sentences()


def _tally(shown: Sequence[LedgerEntry]) -> str:
    """Return the number of statements, in total and by verdict."""
    counts = Counter(entry.verdict for entry in shown)
    return f"{len(shown)} statements: {', '.join(f'{counts[name]} {name}' for name in VERDICTS)}."


def verdict(entry: LedgerEntry) -> str:
    """Return the verdict, with a remark that it fails if the evidence does not support it."""
    return entry.verdict if entry.confirmed else f"{FAILS}: {entry.verdict}"


def _entry_in_full(entry: LedgerEntry) -> Section:
    """Return an entry with its section and all evidence."""
    evidence = [item for evidence in entry.evidence for item in _evidence(evidence)]
    blocks = (Paragraph(prose(entry.statement)), terms(details(entry, in_full=True)), bullets(evidence))
    return Section(f"{entry.number} (section {entry.section}): {verdict(entry)}", blocks)


def details(entry: LedgerEntry, *, in_full: bool = False) -> Iterator[tuple[Text, Text]]:
    """Return the details with their titles: reason, finding, correction, fault, where it is harmless, consequences.

    `in_full`: with the printed formula, and without the finding, which follows with its proof.
    """
    detailed = [
        ("printed", entry.printed if in_full else ""),
        ("why", entry.why),
        ("by", ", ".join(entry.proved_by)),
        *((FAILS, evidence.text) for evidence in entry.evidence if not evidence.holds),
        *(
            ("found", evidence.text)
            for evidence in entry.evidence
            if evidence.holds and (evidence.witnesses or evidence.tilted) and not in_full
        ),
        ("right", entry.correction),
        ("fault", ", ".join(entry.faults)),
        ("harmless", entry.harmless),
        ("so", entry.follows),
    ]
    return ((Emphasis(title), prose(text)) for title, text in detailed if text)


def _evidence(evidence: Evidence) -> Iterator[Item]:
    """Yield a reason and whether it holds; witnesses as rows that can be classified, each with its certificate."""
    if not (evidence.witnesses or evidence.tilted):
        yield Item((prose(f"{evidence.kind}: {evidence.text}"), f": {remark(evidence.holds)}"))
    for witness in evidence.witnesses:
        pair = witness.facts.point.pair
        shown = ShownFormula(described(witness.facts), remark(evidence.holds and witness.holds))
        yield Item(shown, (witness.shows, Code(classify_command(pair.row)), _proof(pair, witness.certificate)))
    for tilted in evidence.tilted:
        upright = f"Without --axis: {_proof(tilted.upright, tilted.vertical)}"
        below = (
            tilted.shows,
            Code(classify_command(tilted.pair.row)),
            _proof(tilted.pair, tilted.certificate),
            upright,
        )
        yield Item(ShownFormula(tilted.text, remark(evidence.holds and tilted.holds)), below)


def _proof(pair: Pair, certificate: Certificate) -> str:
    return " ".join(proof_lines(pair, certificate))


def _sentences() -> Section:
    rows = [
        (sentence.section, sentence.words, "; ".join(sentence.rows) or Emphasis(sentence.reason))
        for sentence in sentences()
    ]
    heads = "section | the sentence begins | rows, or why it has none"
    title = "Sentences: the paper's text in order, and what judges each"
    return Section(title, (table("sentences", heads, rows),))


_COSTS = (
    "Once for a scene: what depends on the sizes alone. A position: the rest, for each new centre; rounded: those of "
    "them that round (+ − × ÷ √ and cosines); <: comparisons. ÷ in brackets: of these, by a number that the sizes fix."
)
_SIGNS = ("+ −", "×", "÷", "√")
_COST_HEADS = " | # ".join(["method", *(f"scene {sign}" for sign in _SIGNS), *_SIGNS, "cos", "<", "rounded"])


def _costs(counted: Sequence[Cost]) -> Iterator[Block]:
    yield Paragraph(_COSTS)
    yield table("costs", _COST_HEADS, [(Code(cost.name), *_cost_cells(cost)) for cost in counted])
    yield terms((Code(cost.name), f"{cost.title} ({cost.source})") for cost in counted)


def _cost_cells(cost: Cost) -> list[str]:
    """Return the numbers of a formula, for a scene and for a position."""
    scene, query = cost.scene, cost.query
    divisions = f"{query.divisions}({cost.by_fixed})" if cost.by_fixed else str(query.divisions)
    numbers = (
        *(scene.additions, scene.multiplications, scene.divisions, scene.square_roots),
        *(query.additions, query.multiplications, divisions, query.square_roots, query.functions, query.comparisons),
        query.rounded,
    )
    return list(map(str, numbers))
