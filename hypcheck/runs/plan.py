"""The plan of a conformance run: its options, and the cases, steps and rules that they determine."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

from hypcheck.errors import InputError
from hypcheck.geometry.rows import PAIRS, SWEEPS, Rows, fits
from hypcheck.implementations import domain
from hypcheck.implementations.description import Description
from hypcheck.implementations.domain import Domain
from hypcheck.implementations.session import Limits
from hypcheck.processes import usable_processors
from hypcheck.runs import border_search
from hypcheck.runs.border_search import SearchStep
from hypcheck.runs.cases import (
    PACE,
    CaseChunk,
    Pace,
    family_chunks,
    fresh_chunks,
    frozen_count,
    frozen_vectors,
    searched_chunks,
)
from hypcheck.runs.judge import DEFAULT_TOLERANCE, Criterion
from hypcheck.runs.known_failures import KnownFailure, read_known_failures
from hypcheck.runs.results import InvalidRows, JudgingRules
from hypcheck.runs.schedule import ImplementationOpener, Step, steps_of_chunks
from hypcheck.vectors import fixed_sizes
from hypcheck.vectors.border_lines import SEARCHED
from hypcheck.vectors.draw import BLOCK, Family
from hypcheck.vectors.families import ALL, select
from hypcheck.vectors.invalid_rows import INVALID_CONTENTS

FAIL_ON = ("wrong", "false-clear")

LARGE_RUN = 1 << 20
"""From this number of cases on, several processes save more time than it takes to start them."""

LOCAL_CLUSTER = re.compile(r"local:([1-9]\d{0,3})")
"""`local:N`: a dask scheduler on this machine, with N workers."""


@dataclass(frozen=True, slots=True)
class ConformancePlan:
    """Options of a conformance run.

    `specs` name the implementations. `families` are names and globs (none: all families but the extreme ones); the
    frozen vectors and `count` generated rows of each family are asked. With `fresh`, a seed that was not known before
    the run, as many rows of this seed are tested for each family too. `precision`, `question` and `domain` replace what
    an implementation declares. `fail_on` is one of FAIL_ON: any wrong answer, or only "clear" in contact. `workers`
    processes test; None: this process, or in a large run one for each processor. `cluster` is the address of a dask
    scheduler whose workers test instead. `pace` does not change which answers are right or wrong.
    """

    specs: tuple[str, ...]
    families: tuple[str, ...] = ()
    count: int = 400
    seed: int = 1
    fresh: int | None = None
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
    pace: Pace = PACE

    def __post_init__(self) -> None:
        if not self.specs:
            raise InputError("no implementation is given; give one as builtin:, python:, library: or command:")
        if self.fail_on not in FAIL_ON:
            raise InputError(f"--fail-on is {self.fail_on!r}; it must be one of {', '.join(FAIL_ON)}")
        if self.max_abstained < 0:
            raise InputError(f"--max-abstained is {self.max_abstained}; it must be 0 or more")
        if self.fresh == self.seed:
            raise InputError(f"--fresh is {self.fresh}, which is --seed too; fresh rows must be of another seed")
        if self.cluster is not None:
            check_cluster_address(self.cluster)
            if self.workers is not None:
                raise InputError("--workers is for a run on this machine; a cluster has workers of its own")

    @property
    def pool_workers(self) -> int | None:
        """The number of processes of a pool on this machine; None if this process tests, which needs no start."""
        return self.workers or (usable_processors() if planned_size(self) >= LARGE_RUN else None)

    def opener(self, number: int) -> ImplementationOpener:
        """Return the opener of the implementation with this number."""
        return ImplementationOpener(self.specs[number], self.limits, self.precision, self.question, self.domain)

    @property
    def filtered(self) -> bool:
        """Whether families were chosen, so that known failures in other families are not tested."""
        return bool(self.families)


def check_cluster_address(address: str) -> None:
    """Raise InputError if the text is not the address of a cluster."""
    named = re.fullmatch(r"(?!local:)((tcp|tls|ws|wss|ucx)://)?[^\s/:][^\s/]*:(?P<port>\d{1,5})", address)
    if not LOCAL_CLUSTER.fullmatch(address) and not (named and int(named["port"]) < 1 << 16):
        right = "that of a dask.distributed scheduler, such as tcp://10.0.0.1:8786, or local:N for N workers here"
        raise InputError(f"--cluster is {address!r}; it must be {right}")


def planned_cases(plan: ConformancePlan, used: Description) -> dict[str, int]:
    """Return the number of cases of each family for an implementation with this description, skipped cases included.

    A domain with fixed sizes has its own families. An implementation that refuses invalid rows is tested with them too.
    Raises InputError naming a family that does not exist.
    """
    families = chosen_families(plan, used)
    chunks: list[CaseChunk | SearchStep | InvalidRows] = [*searches(plan, used), *invalid_rows(used)]
    if _asks_everything(plan, used):
        families, chunks = (*families, *fixed_sizes.families_for(used.domain.settings)), [*searched_chunks(), *chunks]
    cases = _cases_of(plan, families) | {chunk.family: len(chunk) for chunk in chunks}
    return {family: number for family, number in cases.items() if number}


def _asks_everything(plan: ConformancePlan, used: Description) -> bool:
    """Return whether cases outside the chosen families are tested too.

    These are the vectors that a search found, those of fixed sizes, and the directed searches.
    """
    return not (plan.filtered or used.asked.layout.has_end)


def searches(plan: ConformancePlan, used: Description) -> tuple[SearchStep, ...]:
    """Return the directed searches of a run of all families, by the seed of its fresh rows if there are any.

    There are none for sweeps, whose truth takes milliseconds a row, and none for fixed sizes.
    """
    if not _asks_everything(plan, used) or used.domain.settings or not plan.count:
        return ()
    seed = plan.seed if plan.fresh is None else plan.fresh
    return tuple(
        SearchStep(family.name, seed, min(plan.count * family.times, border_search.MOST))
        for family in SEARCHED.values()
        if family.groups <= used.groups
    )


def invalid_rows(used: Description) -> tuple[InvalidRows, ...]:
    """Return the invalid rows for an implementation, with groups that it takes; none if it does not refuse them.

    Invalid rows with heights also have an axis, so they need an implementation that takes both.
    """
    names = [name for name, content in INVALID_CONTENTS.items() if fits(content.groups, used.groups)]
    return tuple(map(InvalidRows, names)) if used.refuses else ()


def chosen_families(plan: ConformancePlan, used: Description) -> tuple[Family, ...]:
    """Return the families of the plan that an implementation with this description can answer.

    Raises InputError naming a family that does not exist.
    """
    return tuple(family for family in select(plan.families, None) if fits(family.groups, used.groups))


def _lacking(used: Description, family: Family) -> str:
    """Return the reason why an implementation cannot answer a family, a key of domain.FAMILIES; "" if it can."""
    if family.layout != used.asked.layout:
        return "question"
    more = family.groups - used.groups
    return "heights" if "heights" in more else "tilt" if more else ""


def planned_size(plan: ConformancePlan) -> int:
    """Return the number of cases for each implementation, skipped cases included.

    The number is for an implementation that answers about upright spheroids, or about all chosen families. Others have
    more or fewer cases, known after they send their descriptions.
    """
    if plan.filtered:
        return sum(_cases_of(plan, select(plan.families, None)).values())
    return sum(planned_cases(plan, Description("")).values())


def _cases_of(plan: ConformancePlan, families: Iterable[Family]) -> dict[str, int]:
    """Return the number of frozen vectors and of generated rows of each family, fresh ones included."""
    seeds = 1 if plan.fresh is None else 2
    return {family.name: frozen_count(family.name) + plan.count * family.times * seeds for family in families}


def known_failures_of(plan: ConformancePlan) -> tuple[KnownFailure, ...]:
    """Return the known failures that the plan lists. Raises InputError as read_known_failures does."""
    return read_known_failures(plan.known_failures) if plan.known_failures is not None else ()


def families_not_asked(plan: ConformancePlan, used: Description) -> dict[str, dict[str, int]]:
    """Return the families of which an implementation gets no row, with their numbers of rows.

    They are grouped by the reason, a key of domain.FAMILIES.
    """
    planned, by_reason = planned_cases(plan, used), {reason: dict[str, int]() for reason in domain.FAMILIES}
    chosen = {family.name for family in select(plan.families, None)}
    for name, cases in _cases_of(plan, ALL.values()).items():
        if name in planned or not cases:
            continue
        unwanted = "filter" if plan.filtered else "extreme" if ALL[name].extreme else ""
        reason = unwanted if name not in chosen and unwanted else _lacking(used, ALL[name])
        by_reason[reason][name] = cases
    searched = () if not plan.filtered or used.asked.layout.has_end else searched_chunks()
    by_reason["filter"] |= {chunk.family: len(chunk) for chunk in searched}
    return {reason: families for reason, families in by_reason.items() if families}


def require_named(plan: ConformancePlan, used: Description) -> None:
    """Raise InputError if the plan has the full name of a family of which no row can be tested.

    Only the frozen vectors and the first rows of a large family are examined for this.
    """
    rules = rules_of(plan, used)
    for name in (name for name in plan.families if name in ALL):
        family = ALL[name]
        lacking = _lacking(used, family)
        if lacking == "question":
            raise InputError(
                f"--families names {name}, which has no cases for the question {used.question!r}; "
                f"leave it out, or name an implementation whose question is {_QUESTION_ABOUT[family.layout]}"
            )
        if lacking:
            kind, declared = _LACKING[lacking]
            raise InputError(
                f"--families names {name}, a family of {kind}, and {used.name} takes none; leave it out, or let its "
                f"description say {declared}"
            )
        reasons = _reasons_for(plan, family, rules)
        if reasons:
            raise InputError(
                f"--families names {name}, and {used.name} can be tested on none of its rows: "
                f"{' and '.join(f'{number:,} are {domain.ROWS[reason]}' for reason, number in reasons.items())}; "
                "leave it out, or set --precision or --domain"
            )


_QUESTION_ABOUT = {PAIRS: "position", SWEEPS: "passage"}

_LACKING = {
    "tilt": ("tilted spheroids", '"tilt": true'),
    "heights": ("hyperboloids that end", '"takes": ["heights"], and "axis" besides where spheroids are tilted'),
}
"""For each reason of _lacking: what the families are about, and what the description of an implementation must have."""


def _reasons_for(plan: ConformancePlan, family: Family, rules: JudgingRules) -> dict[str, int]:
    """Return the reasons why none of a family's frozen vectors and first generated rows is tested; empty if one is."""
    counts: Counter[str] = Counter()
    for rows in rows_of(plan, family, BLOCK):
        inside, reasons = rules.asked_of(family.name, rows)
        if len(inside):
            return {}
        counts.update(reasons)
    return dict(counts)


def rows_of(plan: ConformancePlan, family: Family, most: int) -> Iterator[Rows]:
    """Yield a family's frozen vectors, then at most `most` of its rows of each seed, which are made when needed."""
    if frozen_count(family.name):
        yield frozen_vectors(family.name).rows
    for seed in (plan.seed, plan.fresh):
        if seed is not None and plan.count:
            yield family.rows(seed, min(plan.count * family.times, most))


def steps_of(plan: ConformancePlan, used: Description) -> Iterator[Step]:
    """Yield the steps for an implementation that is judged by this description.

    Raises InputError if the plan names only families that the implementation cannot answer: with tilted spheroids if it
    takes no tilt, or with the other layout.
    """
    families = chosen_families(plan, used)
    if not families:
        names, lacking = ", ".join(plan.families), {_lacking(used, family) for family in select(plan.families, None)}
        for reason, (kind, declared) in _LACKING.items():
            if reason in lacking:
                raise InputError(
                    f"{names}: these are families of {kind}, and {used.name} takes none; its description must say "
                    f"{declared}"
                )
        raise InputError(f"{names}: none of these families has cases for the question {used.question!r}")
    last: tuple[SearchStep | InvalidRows, ...] = (*searches(plan, used), *invalid_rows(used))
    return steps_of_chunks(_chunks(plan, families, used), last, plan.pace)


def rules_of(plan: ConformancePlan, used: Description) -> JudgingRules:
    """Return the rules for judging an implementation with this description.

    Raises InputError as known_failures_of does.
    """
    criterion = Criterion(used.question, used.precision, plan.tolerance)
    named = frozenset(name for name in plan.families if name in ALL)
    return JudgingRules(criterion, used.domain, known_failures_of(plan), plan.seed, plan.fresh, named)


def _chunks(plan: ConformancePlan, families: tuple[Family, ...], used: Description) -> Iterator[CaseChunk]:
    """Yield the chunks of a run; a domain with fixed sizes has its own families."""
    yield from _chunks_of(plan, families)
    if _asks_everything(plan, used):
        yield from searched_chunks()
        yield from _chunks_of(plan, fixed_sizes.families_for(used.domain.settings))


def _chunks_of(plan: ConformancePlan, families: Iterable[Family]) -> Iterator[CaseChunk]:
    """Yield the chunks of these families: frozen vectors, rows of the seed, fresh rows."""
    for family in families:
        yield from family_chunks(family, plan.seed, plan.count * family.times, plan.pace.chunk_rows)
        if plan.fresh is not None:
            yield from fresh_chunks(family, plan.fresh, plan.count * family.times, plan.pace.chunk_rows)
