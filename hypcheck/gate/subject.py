"""Who is asked in a run: an implementation, or what stands for one where asking it ends our own processes."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from hypcheck.methods.asking import Answered
from hypcheck.methods.faults import Outcome
from hypcheck.methods.runs import Allowance
from hypcheck.rows import CANNOT_SAY, Rows


class Subject(Protocol):
    """What a run uses of an Implementation, where each of these is described."""

    @property
    def most(self) -> int | None: ...  # noqa: D102

    @property
    def stands(self) -> int: ...  # noqa: D102

    @property
    def allowance(self) -> Allowance: ...  # noqa: D102

    def allow(self, allowance: Allowance) -> None: ...  # noqa: D102

    def fresh(self) -> None: ...  # noqa: D102

    def classify(self, rows: Rows, *, batch: int | None = None) -> Answered: ...  # noqa: D102


class Crashed:
    """Stands for an implementation of which nothing is known but that every question ends as CRASH, for one `reason`.

    It costs nothing of the allowance: no process of its own was lost that we know of.
    """

    stands = 1

    def __init__(self, most: int | None, reason: str, allowance: Allowance) -> None:
        self.most = most
        self.allowance = allowance
        self._reason = reason

    def allow(self, allowance: Allowance) -> None:
        """From here on it may cost so much."""
        self.allowance = allowance

    def fresh(self) -> None:
        """There is no process to begin afresh."""

    def classify(self, rows: Rows, *, batch: int | None = None) -> Answered:  # noqa: ARG002 - however it is asked
        """No row has an answer."""
        n = len(rows)
        status = np.full(n, Outcome.CRASH, dtype=np.int8)
        return Answered(np.full(n, CANNOT_SAY, dtype=np.int8), status, dict.fromkeys(range(n), self._reason))
