"""What `hypcheck derive` is asked for: whole parts, or one claim of the paper with all that its verdict rests on."""

from __future__ import annotations

import re
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property

from hypcheck.derivation.chains.book import chains
from hypcheck.derivation.costs import Cost, costs
from hypcheck.derivation.links import Chain
from hypcheck.derivation.walk import walk
from hypcheck.errors import InputError
from hypcheck.paper.ledger import entries
from hypcheck.paper.ledger.entry import Entry


@dataclass(frozen=True)
class Chosen:
    """What is to be shown: parts by name, or where `claim` is given the entries and chains of that claim, in full.

    A part is worked out when it is first looked at, so that what comes first can be read while the rest is derived.
    """

    parts: tuple[str, ...]
    claim: str | None = None

    @cached_property
    def sections(self) -> tuple[Chain, ...]:
        """Those of the derivation."""
        return tuple(walk()) if "derivation" in self.parts else ()

    @cached_property
    def chains(self) -> tuple[Chain, ...]:
        """The propositions, or those that a claim rests on."""
        if self.claim is not None:
            named = {
                name for entry in self.entries for evidence in entry.evidence for name in _with_needs(evidence.chain)
            }
            return tuple(chain for name, chain in chains().items() if name in named)
        return tuple(chains().values()) if "propositions" in self.parts else ()

    @cached_property
    def entries(self) -> tuple[Entry, ...]:
        """The ledger, or the entries of a claim. Raises InputError where there is no such claim."""
        if self.claim is not None:
            return entries_of(self.claim)
        return entries() if "ledger" in self.parts else ()

    @cached_property
    def costs(self) -> tuple[Cost, ...]:
        """Of every way to the answer."""
        return costs() if "costs" in self.parts else ()

    @property
    def failing(self) -> tuple[str, ...]:
        """The names of all that is shown and does not hold, or whose verdict is not borne out."""
        shown = (chain.name for chain in (*self.sections, *self.chains) if not chain.holds)
        return (*shown, *(entry.number for entry in self.entries if not entry.confirmed))


def entries_of(claim: str) -> tuple[Entry, ...]:
    """The entries of one number; "Proposition 3" has several. Raises InputError where there is none."""
    asked = _plain(claim)
    found = tuple(entry for entry in entries() if _is_of(_plain(entry.number), asked))
    if not found:
        raise InputError(f"there is no claim {claim!r} in the ledger; {_advice(asked)}")
    return found


def _with_needs(name: str) -> tuple[str, ...]:
    """A chain's name, where there is one, and the names of those that it needs."""
    return (name, *(each for needed in chains()[name].needs for each in _with_needs(needed))) if name else ()


def _plain(number: str) -> str:
    """A claim's number without what people leave out or write otherwise: "(12)", "eq. 12" and "12" are one."""
    bare = re.sub(r"[()§]", " ", number.lower()).strip()
    bare = re.sub(r"^(equation|eq\.?|appendix)\s*(?=[\da])", "", bare)
    bare = re.sub(r"^prop(\.|\s)\s*", "proposition ", bare)
    return " ".join(bare.split())


def _is_of(number: str, asked: str) -> bool:
    """Whether a number is the one asked for or one of its parts: "proposition 3" has "proposition 3.1"."""
    return number == asked or bool(asked and re.match(re.escape(asked) + r"[.,:]\s?", number))


def _advice(asked: str) -> str:
    numbers = {_plain(entry.number): entry.number for entry in entries()}
    near = get_close_matches(asked, numbers, n=1)
    if near:
        return f"did you mean {numbers[near[0]]!r}?"
    return "give an equation's number such as 12, or Proposition 3, Remark 4, Table 2, A.2b"
