"""What can go wrong, as types: each is one sentence for a person and one exit code for a program."""

from __future__ import annotations

from hypcheck.visible import sentence


class HypcheckError(Exception):
    """An expected failure: its text is the whole message a user sees, and `exit_code` the process's status.

    Whatever it quotes, the text is one line, printable, and at most visible.LONGEST characters long.
    """

    exit_code = 70

    def __init__(self, text: object = "") -> None:
        super().__init__(sentence(text))


class InputError(HypcheckError):
    """A bad option, file or value. The sentence says what, where, which value, and what would be right."""

    exit_code = 2


class NothingJudgedError(HypcheckError):
    """A run that asked or judged nothing; it proves nothing, so it is never a pass."""

    exit_code = 2


class UnavailableError(HypcheckError):
    """An optional part (an oracle, a plot) cannot run here; the sentence says why and what would enable it."""

    exit_code = 2


class Terminated(BaseException):
    """The system asked the process to end (SIGTERM), or its terminal has gone (SIGHUP)."""
