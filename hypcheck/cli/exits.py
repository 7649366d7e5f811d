"""How the program ends: one table from errors to exit code and message.

A closed pipe ends quietly with 141, as a program that the system stops for it would: a reader that left early must not
turn a failure into a pass, nor a run into an error of ours.
"""

from __future__ import annotations

import errno
from collections.abc import Callable
from dataclasses import dataclass

import click

from hypcheck.errors import Exit, HypcheckError, Terminated, limit_reached, system_reason
from hypcheck.suggesting import advice
from hypcheck.visible import sentence


@dataclass(frozen=True, slots=True)
class Ending:
    """A status and the lines for standard error, none where it ends quietly."""

    code: int
    lines: tuple[str, ...] = ()


def ending_of(error: BaseException) -> Ending:
    """How the program ends that `error` reached: by the first row of the table that fits."""
    for kind, ending in _ENDINGS:
        if isinstance(error, kind):
            return ending(error)
    return _internal(error)


def _expected(error: BaseException) -> Ending:
    code = error.exit_code if isinstance(error, HypcheckError) else Exit.INTERNAL
    return Ending(code, (f"hypcheck: error: {sentence(error)}",))


def _usage(error: BaseException) -> Ending:
    message = sentence(_said(error)).rstrip(".")
    context = error.ctx if isinstance(error, click.UsageError) else None
    command = context.command_path if context else "hypcheck"
    return Ending(
        Exit.USAGE,
        (
            f"hypcheck: error: {message[:1].lower()}{message[1:]}",
            f"hypcheck: '{command} --help' tells what is possible",
        ),
    )


def _said(error: BaseException) -> str:
    if isinstance(error, click.NoSuchOption):
        meant = advice(error.option_name, error.possibilities or (), most=1)
        return f"there is no option {error.option_name!r}" + f"; {meant}" * meant.startswith("did you mean")
    context = error.ctx if isinstance(error, click.UsageError) else None
    if context is not None and isinstance(context.command, click.Group) and str(error) == "Missing command.":
        return f"missing command; there are {', '.join(context.command.list_commands(context))}"
    return error.format_message() if isinstance(error, click.ClickException) else str(error)


def _system(error: BaseException) -> Ending:
    if isinstance(error, OSError) and error.errno in _FULL_OR_BROKEN:
        return Ending(Exit.USAGE, (f"hypcheck: error: cannot write: {sentence(system_reason(error))}",))
    limit = limit_reached(error)
    return _internal(error) if limit is None else _expected(limit)


_FULL_OR_BROKEN = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EROFS)


def _internal(error: BaseException) -> Ending:
    what = sentence(f"{type(error).__name__}: {error}".rstrip(": "))
    ask = "this is a fault of hypcheck; please report it, with what `hypcheck --debug` and the same arguments print"
    return Ending(Exit.INTERNAL, (f"hypcheck: internal error: {what}", f"hypcheck: {ask}"))


_ENDINGS: tuple[tuple[type[BaseException], Callable[[BaseException], Ending]], ...] = (
    (HypcheckError, _expected),
    (click.ClickException, _usage),
    (KeyboardInterrupt, lambda _: Ending(Exit.INTERRUPTED, ("hypcheck: interrupted",))),
    (click.Abort, lambda _: Ending(Exit.INTERRUPTED, ("hypcheck: interrupted",))),
    (Terminated, lambda _: Ending(Exit.TERMINATED, ("hypcheck: terminated",))),
    (BrokenPipeError, lambda _: Ending(Exit.CLOSED_PIPE)),
    (OSError, _system),
)
