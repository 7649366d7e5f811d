"""Why rows and families are not asked: an implementation is asked what it claims, and what the run is about.

A row that is not asked is not right. Every report says how many there are, and why.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from hypcheck.geometry.rows import PAIRS, UNBOUNDED, Layout, Mask, Rows
from hypcheck.implementations.domain import Domain, representable

ROWS: Mapping[str, str] = MappingProxyType(
    {
        "precision": "not zero or normal in its precision",
        "regime": "outside the regimes of its domain",
        "sizes": "of other sizes or places than its domain's",
        "ratio": "of ratios outside its domain",
        "magnitude": "of magnitudes outside its domain",
        "slow": "beyond what a slow method is asked",
    }
)
"""Why rows of a family that is asked are not, in words, by the reasons' names in a record."""

FAMILIES: Mapping[str, str] = MappingProxyType(
    {
        "filter": "left out by --families",
        "extreme": "of extreme lengths (--families extreme asks them)",
        "tilt": "of tilted spheroids (it takes none)",
        "heights": "of hyperboloids that end (it takes no heights)",
        "question": "about another question",
    }
)
"""Why no row of a family is asked, likewise."""


FEWEST, SHARE = 100, 100
"""Where the domain or the precision leaves out most rows, at least FEWEST must be judged, and one in SHARE of all."""


def too_few(judged: int, skipped: int) -> bool:
    """Whether so few rows were judged, beside those skipped, that the run says nothing of the implementation."""
    return skipped > judged and judged < max(FEWEST, (judged + skipped) // SHARE)


def reasons(
    rows: Rows, domain: Domain, precision: str, *, extreme: bool, subnormal: bool, layout: Layout = PAIRS
) -> dict[str, int]:
    """The number of rows that domain.claimed leaves out, by the first of ROWS that is the reason; of no others."""
    if not len(rows):
        return {}
    free = replace(domain, ratio=UNBOUNDED, magnitude=UNBOUNDED)
    conditions: Mapping[str, Callable[[Rows], Mask]] = {
        "precision": lambda some: representable(some, precision, subnormal=subnormal),
        "regime": lambda some: replace(free, settings=()).holds(some, layout=layout),
        "sizes": lambda some: replace(free, regimes=()).holds(some, layout=layout),
        "ratio": lambda some: replace(domain, magnitude=UNBOUNDED).holds(some, extreme=extreme, layout=layout),
        "magnitude": lambda some: domain.holds(some, extreme=extreme, layout=layout),
    }
    found, left = dict[str, int](), rows
    with np.errstate(all="ignore"):
        for reason, holds in conditions.items():
            held = holds(left)
            if not held.all():
                found[reason] = len(left) - int(np.count_nonzero(held))
                left = left[held]
    return found
