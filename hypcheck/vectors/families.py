"""The table of all families, and the names of families and of their cases."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

from hypcheck.errors import InputError
from hypcheck.geometry.pair import Pair
from hypcheck.geometry.rows import PAIRS, Layout
from hypcheck.messages import suggestion
from hypcheck.truth.tilted.pair import TiltedPair
from hypcheck.vectors import borders, extremes, random_pairs, scenes, tangency
from hypcheck.vectors.family import BLOCK, Family
from hypcheck.vectors.fixed_sizes import MARK, family_at
from hypcheck.vectors.tilted import families as tilted_families
from hypcheck.vectors.ways import families as way_families

FAMILIES: dict[str, Family] = {
    family.name: family
    for group in (
        scenes.SCENE_FAMILIES,
        random_pairs.RANDOM_FAMILIES,
        random_pairs.CHANGE_FAMILIES,
        tangency.TANGENT_FAMILIES,
        tangency.LADDER_FAMILIES,
        tangency.RING_FAMILIES,
        borders.BORDER_FAMILIES,
        extremes.STIFF_FAMILIES,
        extremes.WHOLE_DOMAIN_FAMILIES,
        extremes.EXTREME_FAMILIES,
    )
    for family in group
}
"""The families of upright spheroids."""

TILTED_FAMILIES: dict[str, Family] = {family.name: family for family in tilted_families.TILTED_FAMILIES}
"""Those of spheroids whose axis may point anywhere: rows of ten numbers."""

WAY_FAMILIES: dict[str, Family] = {family.name: family for family in way_families.FAMILIES}
"""Those of ways between two positions: rows as geometry.rows.WAYS has them, upright or tilted."""

_ALL = {**FAMILIES, **TILTED_FAMILIES, **WAY_FAMILIES}

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


def select(patterns: Sequence[str] = (), *, tilted: bool = False, layout: Layout | None = PAIRS) -> tuple[Family, ...]:
    """The families of these names and globs in the order of the tables; without patterns all but the extreme ones.

    Only those of rows with this layout, or of all layouts where it is None. With `tilted` those of tilted spheroids are
    among them. A glob reaches every family whose name it matches, the
    extreme ones too: "*" is all; "extreme" is all of the extreme ones. Raises InputError for a pattern that names
    nothing, with the names nearest to it, or nothing but tilted spheroids where these are not wanted.
    """
    known = {
        name: family
        for name, family in _ALL.items()
        if (tilted or not family.tilted) and layout in (None, family.layout)
    }
    if not patterns:
        return tuple(family for family in known.values() if not family.extreme)
    chosen: set[str] = set()
    for pattern in patterns:
        named = _named(pattern, known)
        if not named and _named(pattern, TILTED_FAMILIES):
            raise InputError(
                f"{pattern!r} names tilted spheroids, which only an implementation with tilt is asked about"
            )
        if not named and _named(pattern, WAY_FAMILIES):
            raise InputError(f"{pattern!r} names ways, which only the question passage is about")
        if not named:
            raise InputError(f"there is no family {pattern!r}; {_advice(pattern)}")
        chosen |= named
    return tuple(family for name, family in known.items() if name in chosen)


def _named(pattern: str, known: Mapping[str, Family]) -> set[str]:
    if len(pattern) > _LONGEST_PATTERN:
        return set()
    return {name for name, family in known.items() if _asks_for(pattern, family)}


def family_of(name: str) -> Family:
    """The family of exactly this name, one for given sizes (razor@2.0,…) too. Raises InputError where there is none."""
    family = family_at(name) if MARK in name else _ALL.get(name)
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
        raise InputError(
            f"case {text!r}: this version of hypcheck has generator {family.version} of {name}, not generator {version}"
        )
    return CaseId(family, seed, index)


def row_of(text: str) -> Pair | TiltedPair:
    """The pair that a case id names. Raises InputError as parse_case_id does, and where it names a way."""
    case = parse_case_id(text)
    if case.family.layout is not PAIRS:
        raise InputError(f"case {text!r} is a way between two positions, not one position")
    number, place = divmod(case.index, BLOCK)
    row = case.family.block(case.seed, number)[place].tolist()
    return TiltedPair.from_row(row) if case.family.tilted else Pair.from_row(row)


def _asks_for(pattern: str, family: Family) -> bool:
    return family.extreme if pattern == EXTREME else fnmatchcase(family.name, pattern)


def _advice(name: str) -> str:
    return suggestion(name, [*_ALL, EXTREME])
