"""The table of all families, and the names by which a family or one of its cases is asked for."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

from hypcheck.casebook import (
    borders,
    changes,
    everyday,
    extremes,
    fixed_sizes,
    ladder,
    ring,
    scenes,
    stiff,
    tangency,
    whole_domain,
)
from hypcheck.casebook.family import BLOCK, Family
from hypcheck.errors import InputError
from hypcheck.pairs import Pair
from hypcheck.suggesting import advice

FAMILIES: dict[str, Family] = {
    family.name: family
    for group in (
        scenes.FAMILIES,
        everyday.FAMILIES,
        changes.FAMILIES,
        tangency.FAMILIES,
        ladder.FAMILIES,
        ring.FAMILIES,
        borders.FAMILIES,
        stiff.FAMILIES,
        whole_domain.FAMILIES,
        extremes.FAMILIES,
    )
    for family in group
}
EXTREME = "extreme"
"""The pattern that asks for every extreme family."""

_NUMBER = "(0|[1-9][0-9]{0,99})"
_CASE_ID = re.compile(rf"([a-z0-9-]+(?:@[a-z0-9.,:=+-]+)?)/{_NUMBER}/{_NUMBER}/{_NUMBER}", re.ASCII)
_LONGEST_PATTERN = 100
"""Characters: fnmatch's time grows with the square of the length of what it is given."""


@dataclass(frozen=True, slots=True)
class CaseId:
    """A generated case: row `index` of the family's rows for the seed."""

    family: Family
    seed: int
    index: int


def select(patterns: Sequence[str] = ()) -> tuple[Family, ...]:
    """The families of these names and globs in the order of the table; without patterns all but the extreme ones.

    A glob reaches every family whose name it matches, the extreme ones too: "*" is all; "extreme" is all of the extreme
    ones. Raises InputError for a pattern that names nothing, with the names nearest to it.
    """
    if not patterns:
        return tuple(family for family in FAMILIES.values() if not family.extreme)
    chosen: set[str] = set()
    for pattern in patterns:
        known = FAMILIES if len(pattern) <= _LONGEST_PATTERN else {}
        named = {name for name, family in known.items() if _asks_for(pattern, family)}
        if not named:
            raise InputError(f"there is no family {pattern!r}; {_advice(pattern)}")
        chosen |= named
    return tuple(family for name, family in FAMILIES.items() if name in chosen)


def family_of(name: str) -> Family:
    """The family of exactly this name, one for given sizes (razor@2.0,…) too. Raises InputError where there is none."""
    family = fixed_sizes.family_at(name) if fixed_sizes.MARK in name else FAMILIES.get(name)
    if family is None:
        raise InputError(f"there is no family {name!r}; {_advice(name)}")
    return family


def is_extreme(name: str) -> bool:
    """Whether a family of this name, or a case of this id, is of the extreme ones: their names all begin alike."""
    return name.startswith(f"{EXTREME}-")


def case_id(family: Family, seed: int, index: int) -> str:
    """The name of a generated case, the same for ever: family/generator-version/seed/index."""
    return f"{family.name}/{family.version}/{seed}/{index}"


def parse_case_id(text: str) -> CaseId:
    """What a case id names. Raises InputError where it names nothing, or rows of another generator version."""
    match = _CASE_ID.fullmatch(text)
    if match is None:
        raise InputError(f"{text!r} is no case id; it must be family/version/seed/index, as in tower-body/1/0/17")
    name, version, seed, index = match.group(1), *map(int, match.groups()[1:])
    try:
        family = family_of(name)
    except InputError as error:
        raise InputError(f"case {text!r}: {error}") from None
    if version != family.version:
        raise InputError(f"case {text!r}: this version makes {name} by generator {family.version}, not {version}")
    return CaseId(family, seed, index)


def row_of(text: str) -> Pair:
    """The pair that a case id names. Raises InputError as parse_case_id does."""
    case = parse_case_id(text)
    number, place = divmod(case.index, BLOCK)
    return Pair.from_row(case.family.block(case.seed, number)[place].tolist())


def _asks_for(pattern: str, family: Family) -> bool:
    return family.extreme if pattern == EXTREME else fnmatchcase(family.name, pattern)


def _advice(name: str) -> str:
    return advice(name, [*FAMILIES, EXTREME])
