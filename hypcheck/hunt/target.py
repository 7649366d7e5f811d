"""What is hunted: an implementation, what counts as wrong of it, and where it claims to be right."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Protocol

import numpy as np

from hypcheck.judge import DEFAULT_TOLERANCE, Criterion
from hypcheck.methods.asking import Answered
from hypcheck.methods.description import Description
from hypcheck.methods.domain import Domain, Mask, representable
from hypcheck.rows import Rows


class Askable(Protocol):
    """What a hunt wants of an implementation; methods.implementation.Implementation is one."""

    description: Description

    def classify(self, rows: Rows) -> Answered:
        """What becomes of rows, float64 (n, 7)."""
        ...


@dataclass(frozen=True, slots=True)
class Target:
    """An implementation with its SPEC, the criterion by which it is judged, and the domain in which it is asked.

    `options` are the command line's, as name and value, that stand for what it declares: reports repeat them.
    `extreme`: it is asked at the ends of the float formats too, where it has not declared otherwise.
    """

    spec: str
    implementation: Askable
    criterion: Criterion
    domain: Domain
    options: tuple[tuple[str, str], ...] = ()
    extreme: bool = False

    def claimed(self, rows: Rows) -> Mask:
        """A mask (n,) of the rows that the implementation claims to answer."""
        with np.errstate(all="ignore"):
            return self.domain.holds(rows, extreme=self.extreme) & representable(rows, self.criterion.precision)


def target_of(
    spec: str,
    implementation: Askable,
    *,
    regimes: tuple[str, ...] | None = None,
    tolerance: Fraction = DEFAULT_TOLERANCE,
    options: tuple[tuple[str, str], ...] = (),
) -> Target:
    """The implementation as it describes itself; `regimes`, where given, stand for those it declares.

    Raises InputError where a regime is unknown or the tolerance negative.
    """
    said = implementation.description
    domain = said.domain if regimes is None else replace(said.domain, regimes=regimes)
    return Target(spec, implementation, Criterion(said.question, said.precision, tolerance), domain, options)
