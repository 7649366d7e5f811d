"""What can go wrong, as types: each is one sentence for a person and one exit code for a program."""

from __future__ import annotations

import errno
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import IntEnum

from hypcheck.messages import sentence


class Exit(IntEnum):
    """A process's status; others' scripts depend on the numbers."""

    HELD = 0
    WRONG = 1
    USAGE = 2
    SLOWER = 3
    INCONCLUSIVE = 4
    NOT_STARTED = 5
    ORACLES_DISAGREE = 6
    INTERNAL = 70
    INTERRUPTED = 130
    CLOSED_PIPE = 141
    TERMINATED = 143

    @property
    def meaning(self) -> str:
        """What the status says, in a few words."""
        return _MEANINGS[self]


_MEANINGS = {
    Exit.HELD: "all held",
    Exit.WRONG: "a wrong, lost or changing answer, or known failures drifted",
    Exit.USAGE: "wrong usage or bad input",
    Exit.SLOWER: "slower than the baseline allows",
    Exit.INCONCLUSIVE: "too noisy to tell, or undecided",
    Exit.NOT_STARTED: "an implementation could not be started or broke the protocol",
    Exit.ORACLES_DISAGREE: "our oracles disagree",
    Exit.INTERNAL: "an internal error of hypcheck",
    Exit.INTERRUPTED: "interrupted",
    Exit.CLOSED_PIPE: "the reader of our output left",
    Exit.TERMINATED: "terminated",
}

PRECEDENCE = (
    Exit.INTERRUPTED,
    Exit.TERMINATED,
    Exit.CLOSED_PIPE,
    Exit.INTERNAL,
    Exit.USAGE,
    Exit.ORACLES_DISAGREE,
    Exit.NOT_STARTED,
    Exit.WRONG,
    Exit.SLOWER,
    Exit.INCONCLUSIVE,
    Exit.HELD,
)
"""Of several reasons to end with, the first of these is told."""


def first_that_applies(reasons: Iterable[int]) -> Exit:
    """The one exit code of a run that may have several: HELD where there is no reason for another."""
    return min(map(Exit, reasons), key=PRECEDENCE.index, default=Exit.HELD)


@dataclass
class RunOutcome:
    """What decides how a run ends: sentences by the exit code that they are reasons for."""

    because: defaultdict[Exit, list[str]] = field(default_factory=lambda: defaultdict(list))

    @property
    def exit_code(self) -> Exit:
        """The first that applies, HELD where there is no reason for another."""
        return first_that_applies(code for code, reasons in self.because.items() if reasons)


class HypcheckError(Exception):
    """An expected failure: its text is the whole message a user sees, and `exit_code` the process's status.

    Whatever it quotes, the text is one line, printable, and at most visible.LONGEST characters long.
    """

    exit_code = Exit.INTERNAL

    def __init__(self, text: object = "") -> None:
        super().__init__(sentence(text))


class InputError(HypcheckError):
    """A bad option, file or value. The sentence says what, where, which value, and what would be right."""

    exit_code = Exit.USAGE


class NothingJudgedError(HypcheckError):
    """A run that asked or judged nothing; it proves nothing, so it is never a pass."""

    exit_code = Exit.USAGE


class UnavailableError(HypcheckError):
    """An optional part (an oracle, a plot) cannot run here; the sentence says why and what would enable it."""

    exit_code = Exit.USAGE


class SystemLimitError(HypcheckError):
    """The system has no more files, processes, memory or semaphores for us; nothing is at fault that is tested."""

    exit_code = Exit.USAGE


SCARCE = (errno.EMFILE, errno.ENFILE, errno.EAGAIN, errno.ENOMEM)
"""Files that may be open, processes and memory, of which this account or all together have as many as they may."""


def limit_reached(error: BaseException) -> SystemLimitError | None:
    """What to raise in place of an error that a limit of the system led to; None for any other."""
    if isinstance(error, OSError) and error.errno in SCARCE:
        return SystemLimitError(f"the system gives no more: {system_reason(error)}; see `ulimit -a`")
    return None


class Terminated(BaseException):
    """The system asked the process to end (SIGTERM), or its terminal has gone (SIGHUP)."""


def system_reason(error: OSError) -> str:
    """Why the system refused, in its own words, as the end of a sentence."""
    return (error.strerror or str(error)).lower()
