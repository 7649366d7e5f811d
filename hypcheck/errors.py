"""The errors of hypcheck: each is one sentence for a user and one exit code for a program."""

from __future__ import annotations

import errno
from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import IntEnum

from hypcheck.messages import sentence


class Exit(IntEnum):
    """The exit codes; scripts of users depend on the numbers."""

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
        """The meaning of the code, in a few words."""
        return _MEANINGS[self]


_MEANINGS = {
    Exit.HELD: "all held",
    Exit.WRONG: "a wrong, lost or changing answer, or known failures drifted",
    Exit.USAGE: "wrong usage or bad input",
    Exit.SLOWER: "slower than the baseline allows",
    Exit.INCONCLUSIVE: "too noisy to tell, undecided, or too few rows judged",
    Exit.NOT_STARTED: "an implementation could not be started or broke the protocol",
    Exit.ORACLES_DISAGREE: "oracles disagree",
    Exit.INTERNAL: "an internal error of hypcheck",
    Exit.INTERRUPTED: "interrupted",
    Exit.CLOSED_PIPE: "the reader of the output closed it",
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
"""If there are several reasons to end, the first of these is the exit code."""


def first_that_applies(reasons: Iterable[int]) -> Exit:
    """Return the exit code of a run with these reasons; HELD without any."""
    return min(map(Exit, reasons), key=PRECEDENCE.index, default=Exit.HELD)


@dataclass
class RunOutcome:
    """The exit codes for which a run has a reason; the lines of its record have the reasons."""

    codes: set[Exit] = field(default_factory=set)

    @property
    def exit_code(self) -> Exit:
        """The first code that applies; HELD without any reason."""
        return first_that_applies(self.codes)


class HypcheckError(Exception):
    """An expected failure: its text is the whole message that a user sees, `exit_code` that of the process.

    The text is one printable line of at most messages.LONGEST characters, whatever it quotes.
    """

    exit_code = Exit.INTERNAL

    def __init__(self, text: object = "") -> None:
        super().__init__(sentence(text))


class InputError(HypcheckError):
    """A bad option, file or value. The sentence names the error, its place, the value, and the allowed values."""

    exit_code = Exit.USAGE


class NothingJudgedError(HypcheckError):
    """A run that tested or judged nothing. It proves nothing, so it does not pass."""

    exit_code = Exit.USAGE


class UnavailableError(HypcheckError):
    """An optional part (an oracle, a plot) cannot run here; the sentence gives the reason and the remedy."""

    exit_code = Exit.USAGE


class SystemLimitError(HypcheckError):
    """The system has no more files, processes, memory or semaphores; the implementation under test is not at fault."""

    exit_code = Exit.USAGE


SCARCE = (errno.EMFILE, errno.ENFILE, errno.EAGAIN, errno.ENOMEM)
"""The errors about open files, processes and memory, if this account or the system has reached a limit."""


def limit_reached(error: BaseException) -> SystemLimitError | None:
    """Return the error to raise if a limit of the system caused `error`; None for any other."""
    if isinstance(error, OSError) and error.errno in SCARCE:
        return SystemLimitError(f"a limit of the system is reached: {system_reason(error)}; see `ulimit -a`")
    return None


class Terminated(BaseException):
    """The process received SIGTERM, or SIGHUP because its terminal was closed."""


def system_reason(error: OSError) -> str:
    """Return the reason that the system gives, as the end of a sentence."""
    return (error.strerror or str(error)).lower()
