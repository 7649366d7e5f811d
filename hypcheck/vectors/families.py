"""The table of all families, and the names of families and of their cases."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase

from hypcheck.errors import InputError
from hypcheck.geometry.pair import NO_GROUPS, Groups
from hypcheck.geometry.rows import fits
from hypcheck.messages import suggestion
from hypcheck.vectors import (
    border_lines,
    coincidences,
    crossed,
    ended,
    extremes,
    random_pairs,
    sweeps,
    tilted,
)
from hypcheck.vectors.border_lines import SEARCHED
from hypcheck.vectors.draw import MARK, Family, in_turn
from hypcheck.vectors.fixed_sizes import family_at


def _table(*families: Family, groups: Sequence[str] = ()) -> dict[str, Family]:
    """Return the families by name, each with these groups."""
    return {family.name: replace(family, groups=frozenset(groups)) for family in families}


# Traps of several columns in one row. A program may be right for the traps of each column beside ordinary values of the
# others, and wrong where two traps meet, such as an axis that is not normalised beside an end.

_TILTS = (tilted.slight, tilted.any_length, tilted.spheres, tilted.upright, tilted.stiff, extremes.tilted_whole_domain)
"""Traps of the axis, and of sizes, as rows of ten numbers."""

_SWEEP_TILTS = in_turn(*map(sweeps.beside_rows, _TILTS))
_ENDED_TILTS = in_turn(*map(ended.given_ends, _TILTS), ended.rim(tilted.nearly_along), ended.disc(tilted.nearly_along))
_SWEEP_DOMAIN = sweeps.beside_rows(extremes.whole_domain)
_ENDED_LENGTHS = in_turn(
    *map(ended.sweeps_given_ends, (sweeps.still, sweeps.very_short, sweeps.very_long, _SWEEP_DOMAIN))
)


FAMILIES = _table(
    Family("forest-type-1", random_pairs.forest_type_1, 120, by_place=True),
    Family("forest-type-2", random_pairs.forest_type_2, 120, by_place=True),
    Family("tower-body", random_pairs.tower_body, 120, by_place=True),
    Family("tower-rotors", random_pairs.tower_rotors, 120, by_place=True),
    Family("flight", random_pairs.flight, 128, by_place=True, movement=random_pairs.FLIGHT_STEPS),
    Family("uniform", random_pairs.uniform, 160, by_place=True),
    Family("far-centers", random_pairs.far_centers, 120, by_place=True),
    Family("giant-spheroids", random_pairs.giant_spheroids, 120, by_place=True),
    Family("tiny-spheroids", random_pairs.tiny_spheroids, 120, by_place=True),
    Family("float32-exact", random_pairs.exact_in(24, 2.0**-126), 160, by_place=True),
    Family("float16-exact", random_pairs.exact_in(11, 2.0**-14), 160, by_place=True),
    Family("small-integers", random_pairs.small_integers, 240, version=2, by_place=True),
    Family("symmetric-images", random_pairs.symmetric_images, 160, by_place=True),
    Family("one-number-changed", random_pairs.one_number_changed, 168),
    Family("tangent", coincidences.tangent, 270),
    Family("near-tangent-outside", coincidences.near_tangent(outer=True), 240),
    Family("near-tangent-inside", coincidences.near_tangent(outer=False), 240),
    Family("degenerate-crossing", coincidences.degenerate_crossing, 120),
    Family("degenerate-neighbourhood", coincidences.degenerate_neighbourhood, 160),
    Family("on-surface", coincidences.on_surface, 120),
    Family("tangent-ladder", coincidences.ladder, 492),
    Family("ring", coincidences.ring, 240),
    Family("ring-neighbourhood", coincidences.ring_neighbourhood, 240),
    Family("osculation", coincidences.osculation, 240),
    Family("near-axis", coincidences.near_axis, 200),
    Family("coefficient-zero", coincidences.coefficient_zero, 240),
    Family("axis", coincidences.axis, 160),
    Family("waist", coincidences.waist, 160),
    Family("regime-borders", coincidences.regime_borders, 240),
    Family("out-of-regime", coincidences.out_of_regime, 240),
    Family("stiff-radial", extremes.stiff(radial=True, axial=False), 160),
    Family("stiff-axial", extremes.stiff(radial=False, axial=True), 160),
    Family("stiff-both", extremes.stiff(radial=True, axial=True), 160),
    Family("whole-domain", extremes.whole_domain, 240),
    Family("coincidences", crossed.crossed("coincidences"), 300),
    Family("strata", border_lines.upright, 240, times=10),
    Family("nearly-zero", coincidences.nearly_zero),
    Family("extreme-float16", extremes.at_the_ends_of("float16"), 180, extreme=True),
    Family("extreme-float32", extremes.at_the_ends_of("float32"), 180, extreme=True),
    Family("extreme-float64", extremes.at_the_ends_of("float64"), 180, extreme=True),
    Family("extreme-subnormal", extremes.subnormal, 120, extreme=True),
    Family("extreme-magnitude", extremes.magnitudes, 120, extreme=True),
    Family("extreme-hair", extremes.almost_zero, 60, extreme=True),
)
"""The families of upright spheroids."""

TILTED_FAMILIES = _table(
    Family("tilted-uniform", tilted.uniform, 160),
    Family("tilted-tower", tilted.tower, 160),
    Family("tilted-near-contact", tilted.near_contact, 200),
    Family("tilted-tangent", tilted.tangent, 200),
    Family("tilted-near-tangent", tilted.near_tangent, 240),
    Family("tilted-crossing", tilted.crossing, 120),
    Family("tilted-symmetric", tilted.symmetric, 200),
    Family("tilted-sphere", tilted.spheres, 120),
    Family("tilted-upright", tilted.upright, 120),
    Family("tilted-slight", tilted.slight, 180),
    Family("tilted-twins", tilted.twins, 180),
    Family("tilted-ring", tilted.ring, 200),
    Family("tilted-stiff", tilted.stiff, 180),
    Family("tilted-axis-length", tilted.any_length, 160),
    Family("tilted-small-integers", tilted.small_integers, 200),
    Family("tilted-coincidences", crossed.crossed("tilted-coincidences"), 370, times=2),
    Family("tilted-strata", border_lines.tilted, 200, times=10),
    Family("tilted-one-number-changed", tilted.one_number_changed),
    Family("tilted-nearly-zero", tilted.nearly_zero),
    Family("tilted-whole-domain", extremes.tilted_whole_domain),
    Family("extreme-tilted", tilted.whole_domain, 120, extreme=True),
    groups=("axis",),
)
"""The families of spheroids whose axis may point anywhere: rows of ten numbers."""

SWEEP_FAMILIES = _table(
    Family("way-anywhere", sweeps.anywhere, 108),
    Family("way-tunnelling", sweeps.tunnelling, 108),
    Family("way-uniform", sweeps.uniform, 108),
    Family("way-tower", sweeps.tower, 108),
    Family("way-across", sweeps.across, 108),
    Family("way-grazing", sweeps.grazing, 108),
    Family("way-near-graze", sweeps.near_graze, 108),
    Family("way-ring", sweeps.ring, 108),
    Family("way-end", sweeps.at_an_end, 108),
    Family("way-begun-in-contact", sweeps.begun_in_contact, 108),
    Family("way-still", sweeps.still, 108),
    Family("way-along-a-line", sweeps.along_a_line, 108),
    Family("way-vertical", sweeps.vertical, 108),
    Family("way-horizontal", sweeps.horizontal, 108),
    Family("way-long", sweeps.very_long, 108),
    Family("way-short", sweeps.very_short, 108),
    Family("way-stiff", sweeps.stiff, 108),
    Family("way-small-integers", sweeps.small_integers, 108),
    Family("way-one-number-changed", sweeps.one_number_changed(sweeps.at_an_end, 10)),
    Family("way-nearly-zero", sweeps.beside_rows(coincidences.nearly_zero)),
    Family("way-whole-domain", _SWEEP_DOMAIN),
    Family("way-coincidences", crossed.crossed("way-coincidences"), 353),
    groups=("end",),
) | _table(
    Family("tilted-way-uniform", sweeps.tilted_uniform, 40),
    Family("tilted-way-end", sweeps.tilted_end, 40),
    Family("tilted-way-ring", sweeps.tilted_ring, 40),
    Family("tilted-way-small-integers", sweeps.tilted_integers, 40),
    Family("tilted-way-one-number-changed", sweeps.one_number_changed(sweeps.tilted_end, 13)),
    Family("tilted-way-traps", _SWEEP_TILTS),
    Family("tilted-way-coincidences", crossed.crossed("tilted-way-coincidences"), 80, times=3),
    groups=("end", "axis"),
)
"""The families of sweeps between two positions: rows as geometry.rows.SWEEPS has them, upright or tilted."""

ENDED_FAMILIES = _table(
    Family("ended-uniform", ended.uniform(), 48),
    Family("ended-rim", ended.rim(), 60),
    Family("ended-rim-tangent", ended.rim_tangent, 60),
    Family("ended-rim-neighbourhood", ended.rim_neighbourhood, 60),
    Family("ended-opening", ended.opening, 48),
    Family("ended-thin", ended.thin(), 48),
    Family("ended-swallowed", ended.swallowed, 48),
    Family("ended-disc", ended.disc(), 48),
    Family("ended-groove", ended.groove, 60),
    Family("ended-waist", ended.waist, 40),
    Family("ended-far", ended.far, 40),
    Family("ended-stiff", ended.stiff, 40),
    Family("ended-small-integers", ended.integers(), 48),
    Family("ended-one-number-changed", ended.one_number_changed),
    Family("ended-nearly-zero", ended.given_ends(coincidences.nearly_zero)),
    Family("ended-whole-domain", ended.given_ends(extremes.whole_domain)),
    groups=("heights",),
) | _table(
    Family("tilted-ended-uniform", ended.uniform(tilted.uniform, (2, 3)), 48),
    Family("tilted-ended-rim", ended.rim(tilted.anywhere), 48),
    Family("tilted-ended-thin", ended.thin(tilted.near_contact), 40),
    Family("tilted-ended-disc", ended.disc(tilted.anywhere), 48),
    Family("tilted-ended-small-integers", ended.integers(10), 60),
    Family("tilted-ended-nearly-zero", ended.given_ends(tilted.nearly_zero)),
    Family("tilted-ended-traps", _ENDED_TILTS, times=2),
    Family("tilted-ended-coincidences", ended.given_ends(crossed.crossed("tilted-coincidences"))),
    groups=("axis", "heights"),
)
"""The families of hyperboloids that end: rows of thirteen numbers, of upright spheroids and of tilted ones."""

ENDED_SWEEP_FAMILIES = _table(
    Family("ended-way-uniform", ended.sweeps_about(ended.uniform()), 16),
    Family("ended-way-over", ended.sweeps_over(ended.rim()), 20),
    Family("ended-way-landing", ended.sweeps_landing(ended.rim()), 16),
    Family("ended-way-disc", ended.sweeps_landing(ended.disc()), 16),
    Family("ended-way-opening", ended.sweeps_through_opening, 16),
    Family("ended-way-thin", ended.sweeps_through_thin, 12),
    Family("ended-way-touch", ended.sweeps_touching, 20),
    Family("ended-way-one-number-changed", ended.sweeps_with_one_number_changed),
    Family("ended-way-lengths", _ENDED_LENGTHS),
    Family("ended-way-coincidences", ended.sweeps_given_ends(crossed.crossed("way-coincidences"))),
    groups=("end", "heights"),
) | _table(
    Family("tilted-ended-way-uniform", ended.sweeps_about(ended.uniform(tilted.uniform, (2, 3))), 12),
    Family("tilted-ended-way-over", ended.sweeps_over(ended.rim(tilted.anywhere)), 12),
    Family("tilted-ended-way-traps", ended.sweeps_given_ends(_SWEEP_TILTS)),
    Family("tilted-ended-way-coincidences", ended.sweeps_given_ends(crossed.crossed("tilted-way-coincidences"))),
    groups=("end", "axis", "heights"),
)
"""The families of sweeps beside hyperboloids that end: rows of sixteen numbers, upright and tilted."""

ALL = {**FAMILIES, **TILTED_FAMILIES, **SWEEP_FAMILIES, **ENDED_FAMILIES, **ENDED_SWEEP_FAMILIES}
"""All families, in the order in which they are listed."""

WORST_CANCELLATION = "worst-cancellation"
"""The name of the file of the rows that cancellation.py finds; no family makes them."""

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


def select(patterns: Sequence[str] = (), taken: Groups | None = NO_GROUPS) -> tuple[Family, ...]:
    """Select the families of these names and globs, in the order of the tables; without patterns all but extreme ones.

    `taken` are the groups of columns that the implementation takes: only families whose rows it can answer are
    selected, or all if it is None. A glob selects every family whose name it matches, extreme ones too: "*" selects all
    families, "extreme" all extreme ones.
    Raises InputError for a pattern that matches no family, with the most similar names, or that matches only families
    with other groups.
    """
    known = {name: family for name, family in ALL.items() if taken is None or fits(family.groups, taken)}
    if not patterns:
        return tuple(family for family in known.values() if not family.extreme)
    chosen: set[str] = set()
    for pattern in patterns:
        named = _named(pattern, known)
        if not named:
            raise InputError(_why_none(pattern, taken or NO_GROUPS))
        chosen |= named
    return tuple(family for name, family in known.items() if name in chosen)


_NOT_ASKED = {
    "heights": "hyperboloids that end; only implementations that take heights are tested on them",
    "end": "sweeps, which only the question passage is about",
    "axis": "tilted spheroids; only implementations with tilt are tested on them",
}
"""By group: what rows with it are, and why an implementation that does not take it is not tested on them."""


def _why_none(pattern: str, taken: Groups) -> str:
    """Say why a pattern selects no family for an implementation that takes these groups."""
    named = _named(pattern, ALL)
    if not named:
        return f"there is no family {pattern!r}; {_advice(pattern)}"
    lacking = next(family.groups for name, family in ALL.items() if name in named) - taken
    reasons = [reason for group, reason in _NOT_ASKED.items() if group in lacking]
    return f"{pattern!r} names {reasons[0] if reasons else 'pairs; the question passage is about sweeps alone'}"


def _named(pattern: str, known: Mapping[str, Family]) -> set[str]:
    """Return the names of the known families that a pattern matches; none if it is too long."""
    if len(pattern) > _LONGEST_PATTERN:
        return set()
    return {name for name, family in known.items() if _asks_for(pattern, family)}


def family_of(name: str) -> Family:
    """Return the family with exactly this name; it may also be one for fixed sizes (razor@2.0,…) or of a search.

    Raises InputError where there is none.
    """
    family = family_at(name) if MARK in name else ALL.get(name) or SEARCHED.get(name)
    if family is None:
        raise InputError(f"there is no family {name!r}; {_advice(name)}")
    return family


def is_extreme(name: str) -> bool:
    """Decide by the beginning of `name` whether it is the name of an extreme family, or the id of a case of one."""
    return name.startswith(f"{EXTREME}-")


def case_id(family: Family, seed: int, index: int) -> str:
    """Return the permanent name of a generated case: family/generator-version/seed/index."""
    return f"{family.name}/{family.version}/{seed}/{index}"


def parse_case_id(text: str) -> CaseId:
    """Split a case id into its parts. Raises InputError if it names no case, or one of another generator version."""
    match = _CASE_ID.fullmatch(text)
    if match is None:
        raise InputError(f"{text!r} is not a case id; it must be family/version/seed/index, as in tower-body/1/0/17")
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


def _asks_for(pattern: str, family: Family) -> bool:
    """Decide whether a pattern matches a family."""
    return family.extreme if pattern == EXTREME else fnmatchcase(family.name, pattern)


def _advice(name: str) -> str:
    """Suggest names that are similar to an unknown one."""
    return suggestion(name, [*ALL, EXTREME])
