"""All chains by name, each after those it needs."""

from __future__ import annotations

from functools import cache

from hypcheck.derivation.chains.all_sizes import all_sizes
from hypcheck.derivation.chains.local_maximum import local_maximum
from hypcheck.derivation.chains.positions import positions
from hypcheck.derivation.chains.procedure_1 import procedure_1
from hypcheck.derivation.chains.proposition_3 import proposition_3
from hypcheck.derivation.chains.proposition_5 import proposition_5
from hypcheck.derivation.chains.roots import roots
from hypcheck.derivation.chains.rule import rule
from hypcheck.derivation.chains.theorem_1 import theorem_1
from hypcheck.derivation.links import Chain

MAKERS = (theorem_1, rule, roots, positions, proposition_3, procedure_1, proposition_5, all_sizes, local_maximum)


@cache
def chains() -> dict[str, Chain]:
    """The chains by name, in an order in which each comes after those it needs."""
    return {chain.name: chain for chain in (make() for make in MAKERS)}


def proved(name: str) -> bool:
    """Whether every link of a chain holds, and of the chains that it needs."""
    chain = chains()[name]
    return chain.holds and all(proved(needed) for needed in chain.needs)
