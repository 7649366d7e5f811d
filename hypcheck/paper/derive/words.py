"""What every format says in the same words and in the same order."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.derivation.costs import Cost
from hypcheck.paper.ledger.entry import Entry

CHECKED, FAILS = "checked", "FAILS"

SCENE_COLUMNS = ("+ −", "×", "÷", "√")
QUERY_COLUMNS = ("+ −", "×", "÷", "√", "cos", "<", "rounded")
COST_COLUMNS = (*SCENE_COLUMNS, *QUERY_COLUMNS)

COSTS_EXPLAINED = (
    "Once for a scene: what depends on the sizes alone. A position: the rest, for each new centre; “rounded” are those "
    "of them that round (+ − × ÷ √ and cosines), “<” comparisons. ÷ in brackets: of these, by a number that the sizes "
    "fix."
)


def verdict(entry: Entry) -> str:
    """The verdict, and that it fails where the evidence does not bear it out."""
    return entry.verdict if entry.confirmed else f"{FAILS}: {entry.verdict}"


def details(entry: Entry, *, in_full: bool = False) -> Iterator[tuple[str, str]]:
    """Why, what was found, what is right instead, where it is harmless, and what follows, each with its title.

    `in_full`: a formula as it is printed too, and not what was found, which follows with its proof.
    """
    if in_full and entry.printed:
        yield "printed", entry.printed
    yield "why", entry.why
    if entry.proved_by:
        yield "by", ", ".join(entry.proved_by)
    for evidence in entry.evidence:
        if not evidence.holds:
            yield FAILS, evidence.text
        elif evidence.witnesses and not in_full:
            yield "found", evidence.text
    if entry.correction:
        yield "right", entry.correction
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
