"""What one gating run is asked to do."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

from hypcheck.errors import InputError
from hypcheck.gate.cluster import check_address
from hypcheck.gate.tasks import Opening
from hypcheck.judge import DEFAULT_TOLERANCE
from hypcheck.methods.domain import Domain
from hypcheck.methods.limits import Limits
from hypcheck.processes import usable_processors

FAIL_ON = ("wrong", "false-clear")

LARGE = 1 << 20
"""Cases that are worth the start of several processes."""


@dataclass(frozen=True, slots=True)
class GatePlan:
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
        return self.workers or (usable_processors() if cases >= LARGE else None)

    def opening(self, number: int) -> Opening:
        """How one of its implementations is opened."""
        return Opening(self.specs[number], self.limits, self.precision, self.question, self.domain)

    @property
    def filtered(self) -> bool:
        """Whether families were chosen, so that not everything a list of known failures speaks of is asked."""
        return bool(self.families)
