"""What a setting's kernel does before its search, counted from its programs and its own comparisons."""

from __future__ import annotations

from dataclasses import replace

from hypcheck.derivation.counting import Operations, count
from hypcheck.derivation.program import needed
from hypcheck.kernel.specialise.centre import CENTRE
from hypcheck.kernel.specialise.plan import ONE_SIDED, Stages
from hypcheck.pairs import Position


def thresholds_asked(stages: Stages, question: str) -> tuple[tuple[Position, float], ...]:
    """The thresholds that the question needs: exterior above the first one, interior below the other."""
    found = stages.thresholds
    if found is None:
        return ()
    outer, inner = (Position.EXTERIOR, found.outer), (Position.INTERIOR, found.inner)
    sides = [outer] if inner[1] is None else [outer, (inner[0], inner[1])]
    return tuple(side for side in sides if question not in ONE_SIDED or side[0] is Position[question.upper()])


def needs_side(stages: Stages, question: str) -> bool:
    """Whether the side of the centre is asked, before the discriminant or in its place."""
    delta = stages.discriminant
    tells_sides = question == "position" and delta is not None and delta.clear_where_positive
    return bool(stages.centre) and (question in ONE_SIDED or tells_sides)


def operations_before(stages: Stages, question: str) -> Operations:
    """The operations of all stages before the search, each of which a centre may have to pass."""
    if stages.always is not None:
        return Operations()
    asked = thresholds_asked(stages, question)
    if stages.thresholds is not None:
        return replace(count(needed(stages.entry, ("R",)) if asked else ()), comparisons=len(asked))
    steps, comparisons = list(stages.entry.steps), 0
    for line in stages.lines:
        steps += line.program.steps
    if stages.search is not None:
        comparisons += 2  # neither R nor zz overflows
    if needs_side(stages, question):
        steps += CENTRE.steps
    if stages.discriminant is not None:
        steps += stages.discriminant.program.steps
        comparisons += 4 if stages.discriminant.clear_where_positive else 3  # where the bound holds, then the bound
    found = count(steps)
    return replace(found, comparisons=found.comparisons + comparisons)


def told(operations: Operations) -> str:
    """The operations in words."""
    return ", ".join(
        _many(number, noun)
        for number, noun in (
            (operations.additions, "addition"),
            (operations.multiplications, "multiplication"),
            (operations.divisions, "division"),
            (operations.comparisons, "comparison"),
        )
    )


def _many(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
