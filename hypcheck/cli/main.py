"""Beginning and end of the process: whatever happens, the user gets an exit code and a sentence, never a traceback."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from io import TextIOWrapper
from typing import TYPE_CHECKING, Any, NoReturn

from hypcheck.cli import COMPLETE
from hypcheck.errors import Terminated

if TYPE_CHECKING:
    import click

INTERRUPTED = (130, 143)


def process() -> NoReturn:
    """Run the command line of this process and end it.

    An interrupt may leave a lock of a pool of workers held for ever, and Python waits for the pool's threads when it
    ends. Everything is written by then, and the workers are gone, so an interrupted process ends without waiting.
    """
    code = _fill_closed_descriptors() or main()
    if code not in INTERRUPTED:
        sys.exit(code)
    with suppress(OSError, ValueError, AttributeError):
        sys.stderr.flush()
    os._exit(code)


def _fill_closed_descriptors() -> int:
    """Open the null device for each closed standard stream, so that no other file gets its number.

    A library may write to that number. Returns 0, or the exit code if that fails.
    """
    try:
        while _is_closed(0) or _is_closed(1) or _is_closed(2):
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)
    except OSError as error:
        with suppress(OSError):
            reason = (error.strerror or str(error)).lower()
            os.write(2, f"hypcheck: error: cannot open {os.devnull} for a closed standard stream: {reason}\n".encode())
        return 2
    return 0


def _is_closed(stream: int) -> bool:
    """Return whether the descriptor `stream` is closed."""
    try:
        os.fstat(stream)
    except OSError:
        return True
    return False


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line (the process's own, unless `arguments` are given) and return the exit code."""
    words, code = list(sys.argv[1:] if arguments is None else arguments), 0
    try:
        with _terminable():
            import click

            try:
                with _command_line(words) as context:
                    context.command.invoke(context)
            except click.exceptions.Exit as done:
                code = done.exit_code
            if sys.stdout is not None:
                sys.stdout.flush()
            return code
    except BaseException as error:  # noqa: BLE001 - every error ends here
        return _end(error, debug="--debug" in words)


@contextmanager
def _command_line(words: list[str]) -> Iterator[click.Context]:
    """Enter a block with the context of the words, to invoke.

    click's own main() is not used, because it would handle errors and closed pipes itself.
    """
    import click

    from hypcheck.cli.commands import context_of, hypcheck

    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):  # for a terminal that cannot show α
            stream.reconfigure(errors="backslashreplace")
    if shell := os.environ.get(COMPLETE):
        from hypcheck.cli.commands import answer_shell

        answer_shell(shell)
        raise click.exceptions.Exit(0)
    try:
        with hypcheck.make_context("hypcheck", list(words)) as context:
            yield context
    except click.UsageError as error:
        error.ctx = error.ctx or context_of(words)  # click leaves it out if an option lacks its value
        raise


def _end(error: BaseException, *, debug: bool) -> int:
    """Print the message about an error, and return the exit code."""
    from hypcheck.cli.commands import ending_of
    from hypcheck.errors import Exit

    ending = ending_of(error)
    with suppress(OSError):
        if debug and ending.code != Exit.CLOSED_PIPE:
            import traceback

            traceback.print_exception(error)
        for line in ending.lines if sys.stderr is not None else ():  # print would use standard output
            print(line, file=sys.stderr)  # noqa: T201 - the one place that prints errors
    _silence_stdout()
    return int(ending.code)


def _silence_stdout() -> None:
    """Prevent Python from writing failed output again at its end, and from printing an error about it."""
    with suppress(OSError, ValueError, AttributeError):
        sys.stdout.flush()
        return
    with suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@contextmanager
def _terminable() -> Iterator[None]:
    """Enter a block in which SIGTERM unwinds the stack as Ctrl-C does, so that half-written files are removed.

    So does SIGHUP, which a closed terminal sends, unless it is ignored (nohup).
    """
    wanted = [
        number for number in _ENDING if number == signal.SIGTERM or signal.getsignal(number) is not signal.SIG_IGN
    ]
    try:
        before = {number: signal.signal(number, _terminate) for number in wanted}
    except ValueError:  # not in the main thread, where no handler can be set
        yield
        return
    hook, sys.unraisablehook = sys.unraisablehook, _unraisable
    try:
        yield
    finally:
        sys.unraisablehook = hook
        for number, handler in before.items():
            signal.signal(number, handler)


_ENDING = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]


def _terminate(_signal: int, _frame: object) -> NoReturn:
    """Handle a signal: raise Terminated."""
    raise Terminated  # imported at the top: at this moment any other module may be half imported


def _unraisable(lost: Any) -> None:  # noqa: ANN401 - only typeshed has a name for its type
    """Send an interrupt again, a moment later, that came while an object was freed and nothing could be raised."""
    if issubclass(lost.exc_type, Exception) or not hasattr(signal, "pthread_kill"):
        sys.__unraisablehook__(lost)
        return
    from threading import Timer, main_thread

    number = signal.SIGINT if lost.exc_type is KeyboardInterrupt else signal.SIGTERM
    Timer(_MOMENT, signal.pthread_kill, (main_thread().ident, number)).start()


_MOMENT = 0.01
