"""The whole ledger: displayed formulas first, then what the text states, section by section."""

from __future__ import annotations

from functools import cache

from hypcheck.paper.ledger.costs import costs
from hypcheck.paper.ledger.entry import Entry
from hypcheck.paper.ledger.equations import equations, regime_of_section_4
from hypcheck.paper.ledger.procedures import procedures
from hypcheck.paper.ledger.propositions import propositions


@cache
def entries() -> tuple[Entry, ...]:
    """Every entry, in order."""
    stated = (*propositions(), regime_of_section_4(), *procedures(), *costs())
    return (*equations(), *sorted(stated, key=lambda entry: entry.section))
