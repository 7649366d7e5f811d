"""The plan of a conformance run: its options, and the cases, steps and rules that follow from them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

from hypcheck.errors import InputError
from hypcheck.implementations.description import Description, Domain
from hypcheck.implementations.session import Limits
from hypcheck.processes import usable_processors
from hypcheck.runs.cases import CaseChunk, family_chunks, frozen_count, searched_chunks
from hypcheck.runs.cluster import check_address
from hypcheck.runs.judge import DEFAULT_TOLERANCE, Criterion
from hypcheck.runs.known_failures import KnownFailure, read_known_failures
from hypcheck.runs.results import JudgingRules
from hypcheck.runs.schedule import ImplementationOpener, Step, steps_of_chunks
from hypcheck.vectors import families as fixed_sizes
from hypcheck.vectors import frozen
from hypcheck.vectors.families import select
from hypcheck.vectors.family import Family

FAIL_ON = ("wrong", "false-clear")

LARGE_RUN = 1 << 20
"""Cases that are worth the start of several processes."""


@dataclass(frozen=True, slots=True)
class ConformancePlan:
    """Options of a gating run.

    `specs` name the implementations; `families` are names and globs (none: all but the extreme ones), of each of which
    the frozen vectors and `count` generated rows are asked. `precision`, `question` and `domain` stand for what an
    implementation declares. `fail_on` is one of FAIL_ON: any wrong answer, or only one that claims clear in contact.
    `workers` is how many processes ask; None: this one, but for a large run as many as there are processors.
    `cluster` is the address of a scheduler whose workers ask instead.
    """

    specs: tuple[str, ...]
    families: tuple[str, ...] = ()
    count: int = 400
    seed: int = 1
    tolerance: Fraction = DEFAULT_TOLERANCE
    max_abstained: int = 0
    fail_on: str = "wrong"
    deterministic: bool = False
    known_failures: Path | None = None
    precision: str | None = None
    question: str | None = None
    domain: Domain | None = None
    limits: Limits = field(default_factory=Limits)
    workers: int | None = None
    cluster: str | None = None

    def __post_init__(self) -> None:
        if not self.specs:
            raise InputError("no implementation is named; name one as builtin:, python:, library: or command:")
        if self.fail_on not in FAIL_ON:
            raise InputError(f"--fail-on is {self.fail_on!r}; it must be one of {', '.join(FAIL_ON)}")
        if self.max_abstained < 0:
            raise InputError(f"--max-abstained is {self.max_abstained}; it must be 0 or more")
        if self.cluster is not None:
            check_address(self.cluster)
            if self.workers is not None:
                raise InputError("--workers is for a run on this machine; a cluster has workers of its own")

    def processes(self, cases: int) -> int | None:
        """How many processes of our own ask so many cases; None: none but this one, which takes no time to begin."""
        return self.workers or (usable_processors() if cases >= LARGE_RUN else None)

    def opening(self, number: int) -> ImplementationOpener:
        """How one of its implementations is opened."""
        return ImplementationOpener(self.specs[number], self.limits, self.precision, self.question, self.domain)

    @property
    def filtered(self) -> bool:
        """Whether families were chosen, so that not everything a list of known failures speaks of is asked."""
        return bool(self.families)


def planned_cases(plan: ConformancePlan, domain: Domain | None = None, *, refuses: bool = False) -> dict[str, int]:
    """The cases of each family that one implementation is asked, skipped ones included.

    A domain of given sizes alone has families of its own, and one that `refuses` is asked the invalid rows too. Raises
    InputError naming a family that does not exist.
    """
    cases = {family.name: frozen_count(family.name) + plan.count for family in select(plan.families)}
    if not plan.filtered:
        cases |= {chunk.family: len(chunk) for chunk in searched_chunks()}
        settings = domain.settings if domain is not None else ()
        cases |= {family.name: plan.count for family in fixed_sizes.families_for(settings)}
    if refuses:
        cases[frozen.INVALID_NAME] = len(frozen.load_invalid_rows().rows)
    return {family: number for family, number in cases.items() if number}


def chosen_families(plan: ConformancePlan) -> tuple[Family, ...]:
    """The families of the plan. Raises InputError naming one that does not exist."""
    return select(plan.families)


def planned_size(plan: ConformancePlan) -> int:
    """The cases that each implementation is asked, those that it will skip included."""
    return sum(planned_cases(plan).values())


def known_failures_of(plan: ConformancePlan) -> tuple[KnownFailure, ...]:
    """Those that the plan lists. Raises InputError as read_known_failures does."""
    return read_known_failures(plan.known_failures) if plan.known_failures is not None else ()


def steps_of(plan: ConformancePlan, used: Description) -> Iterator[Step]:
    """The steps that ask an implementation which is judged by this description."""
    return steps_of_chunks(_chunks(plan, used.domain), refuses=used.refuses)


def rules_of(plan: ConformancePlan, used: Description, listed: tuple[KnownFailure, ...]) -> JudgingRules:
    """How an implementation is judged by this description."""
    return JudgingRules(Criterion(used.question, used.precision, plan.tolerance), used.domain, listed, plan.seed)


def _chunks(plan: ConformancePlan, domain: Domain | None = None) -> Iterator[CaseChunk]:
    """The chunks of a run; a domain of given sizes alone has families made for them."""
    for family in chosen_families(plan):
        yield from family_chunks(family, plan.seed, plan.count)
    if plan.filtered:
        return
    yield from searched_chunks()
    for family in fixed_sizes.families_for(domain.settings) if domain is not None else ():
        yield from family_chunks(family, plan.seed, plan.count)
