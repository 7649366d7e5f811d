"""How a question to a foreign implementation can end without an answer, as values and as exceptions."""

from __future__ import annotations

from enum import IntEnum

from hypcheck.errors import Exit, HypcheckError


class Outcome(IntEnum):
    """What became of a row: an answer, or one of the ways to fail; the labels are those of judge.Status."""

    ANSWERED = 0
    ERROR = 1
    CRASH = 2
    TIMEOUT = 3
    PROTOCOL = 4
    NOT_RUN = 5

    @property
    def label(self) -> str:
        """The outcome as records and reports name it."""
        return self.name.lower().replace("_", "-")


class FaultError(Exception):
    """A question that was not answered: how, why, and whether the process is lost with it (`fatal`).

    Raised by sessions and caught by the runner; a user never sees it.
    """

    def __init__(self, outcome: Outcome, reason: str, *, fatal: bool) -> None:
        super().__init__(reason)
        self.outcome = outcome
        self.reason = reason
        self.fatal = fatal


class StartError(HypcheckError):
    """An implementation could not be started; the sentence says which, why, and what it said itself."""

    exit_code = Exit.NOT_STARTED


class TimingError(HypcheckError):
    """An implementation failed while it was timed; the sentence says how."""

    exit_code = Exit.WRONG
