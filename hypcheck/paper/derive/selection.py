"""The selection that `hypcheck derive` shows, and the common parts of its formats: titles, details, costs in columns.

A selection is whole parts (PARTS), or one claim of the paper with all evidence for its verdict.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from hypcheck.derivation.chain_book import chains
from hypcheck.derivation.formulas import Cost, costs
from hypcheck.derivation.links import Chain, Identity, Part
from hypcheck.derivation.walk import walk
from hypcheck.paper.ledger.book import entries, entries_of, faults
from hypcheck.paper.ledger.entry import FALSE, HOLDS, VERDICTS, LedgerEntry


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
    """A chain's name, where there is one, and the names of those that it needs."""
    return (
        (name, *(chain_name for needed in chains()[name].needs for chain_name in _with_needs(needed))) if name else ()
    )


CHECKED, FAILS = "checked", "FAILS"


def remark(holds: bool) -> str:
    """The remark at a formula or at a reason."""
    return CHECKED if holds else FAILS


def matrix_of(part: Part) -> tuple[str, list[list[str]]] | None:
    """The name and the rows of the matrix in "H = [a, b; c, d]"; None if a part is not about a matrix."""
    if not (isinstance(part, Identity) and part.text.endswith("]")):
        return None
    name, _, inside = part.text.partition(" = ")
    return name, [row.split(", ") for row in inside.strip("[]").split("; ")]


def tally(entries: Sequence[LedgerEntry]) -> str:
    """The number of statements, in total and by verdict."""
    counts = Counter(entry.verdict for entry in entries)
    return f"{len(entries)} statements: {', '.join(f'{counts[name]} {name}' for name in VERDICTS)}."


def is_brief(entry: LedgerEntry) -> bool:
    """Whether an entry needs only one line: a formula that holds as printed."""
    return entry.why == HOLDS and entry.confirmed


SCENE_COLUMNS = ("+ −", "×", "÷", "√")
QUERY_COLUMNS = ("+ −", "×", "÷", "√", "cos", "<", "rounded")
COST_COLUMNS = (*SCENE_COLUMNS, *QUERY_COLUMNS)

COSTS_EXPLAINED = (
    "Once for a scene: what depends on the sizes alone. A position: the rest, for each new centre; rounded: those of "
    "them that round (+ − × ÷ √ and cosines); <: comparisons. ÷ in brackets: of these, by a number that the sizes fix."
)


def faults_in_words() -> str:
    """The number of false statements of the ledger, and of the faults behind them, in words."""
    false = sum(entry.verdict == FALSE for entry in entries())
    return f"{false} statements are false for {len(faults())} independent faults; a fault counts once"


def verdict(entry: LedgerEntry) -> str:
    """The verdict, with a remark that it fails if the evidence does not support it."""
    return entry.verdict if entry.confirmed else f"{FAILS}: {entry.verdict}"


def details(entry: LedgerEntry, *, in_full: bool = False) -> Iterator[tuple[str, str]]:
    """The details with their titles: reason, finding, correction, fault, where it is harmless, consequences.

    `in_full`: with the printed formula, and without the finding, which follows with its proof.
    """
    if in_full and entry.printed:
        yield "printed", entry.printed
    yield "why", entry.why
    if entry.proved_by:
        yield "by", ", ".join(entry.proved_by)
    for evidence in entry.evidence:
        if not evidence.holds:
            yield FAILS, evidence.text
        elif (evidence.witnesses or evidence.tilted) and not in_full:
            yield "found", evidence.text
    if entry.correction:
        yield "right", entry.correction
    if entry.faults:
        yield "fault", ", ".join(entry.faults)
    if entry.harmless:
        yield "harmless", entry.harmless
    yield "so", entry.follows


def cost_cells(cost: Cost) -> list[str]:
    """The numbers of a formula under COST_COLUMNS."""
    scene, query = cost.scene, cost.query
    divisions = f"{query.divisions}({cost.by_fixed})" if cost.by_fixed else str(query.divisions)
    numbers = (
        *(scene.additions, scene.multiplications, scene.divisions, scene.square_roots),
        *(query.additions, query.multiplications, divisions, query.square_roots, query.functions, query.comparisons),
        query.rounded,
    )
    return list(map(str, numbers))
