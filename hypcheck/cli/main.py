"""Where the process begins and ends: whatever happens, the user gets a status and a sentence, never a traceback."""

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
    """The whole of a process: main, and its end.

    An interrupt can come while a pool of workers holds a lock, which nobody will then let go, and Python waits for the
    pool's threads as it ends. Everything is written by now, and the workers are gone, so there is no waiting.
    """
    code = _fill_closed_descriptors() or main()
    if code not in INTERRUPTED:
        sys.exit(code)
    with suppress(OSError, ValueError, AttributeError):
        sys.stderr.flush()
    os._exit(code)


def _fill_closed_descriptors() -> int:
    """Let no file of ours take the place of a closed standard stream, into which a library may write.

    0, or the exit code where that cannot be done.
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
    except BaseException as error:  # noqa: BLE001 - this is the end of the line for every error
        return _end(error, debug="--debug" in words)


@contextmanager
def _command_line(words: list[str]) -> Iterator[click.Context]:
    """The context of the words, to invoke. Not click's own main(): it decides how errors and closed pipes end."""
    import click

    from hypcheck.cli.commands import context_of, hypcheck

    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):  # a terminal that cannot show α still gets an answer
            stream.reconfigure(errors="backslashreplace")
    if asked := os.environ.get(COMPLETE):
        from hypcheck.cli.commands import answer

        answer(asked)
        raise click.exceptions.Exit(0)
    try:
        with hypcheck.make_context("hypcheck", list(words)) as context:
            yield context
    except click.UsageError as error:
        error.ctx = error.ctx or context_of(words)  # click leaves it out where an option lacks its value
        raise


def _end(error: BaseException, *, debug: bool) -> int:
    from hypcheck.cli.commands import ending_of
    from hypcheck.errors import Exit

    ending = ending_of(error)
    with suppress(OSError):
        if debug and ending.code != Exit.CLOSED_PIPE:
            import traceback

            traceback.print_exception(error)
        for line in ending.lines if sys.stderr is not None else ():  # print would take standard output then
            print(line, file=sys.stderr)  # noqa: T201 - the one place that speaks of errors
    _silence_stdout()
    return int(ending.code)


def _silence_stdout() -> None:
    """Keep what could not be written from being tried, and complained about, once more when the interpreter ends."""
    with suppress(OSError, ValueError, AttributeError):
        sys.stdout.flush()
        return
    with suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@contextmanager
def _terminable() -> Iterator[None]:
    """While it lasts, SIGTERM unwinds the stack as Ctrl-C does, so that half-written files are removed.

    So does SIGHUP, with which a terminal takes leave, unless it is ignored, as nohup has it.
    """
    wanted = [each for each in _ENDING if each == signal.SIGTERM or signal.getsignal(each) is not signal.SIG_IGN]
    try:
        before = {each: signal.signal(each, _terminate) for each in wanted}
    except ValueError:  # not in the main thread, where no handler can be set
        yield
        return
    hook, sys.unraisablehook = sys.unraisablehook, _unraisable
    try:
        yield
    finally:
        sys.unraisablehook = hook
        for each, handler in before.items():
            signal.signal(each, handler)


_ENDING = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]


def _terminate(_signal: int, _frame: object) -> NoReturn:
    raise Terminated  # imported above: here any module may be half imported, click too


def _unraisable(lost: Any) -> None:  # noqa: ANN401 - its type has a name in typeshed alone
    """An interrupt that came while an object was freed, where nothing can be raised, comes again a moment later."""
    if issubclass(lost.exc_type, Exception) or not hasattr(signal, "pthread_kill"):
        sys.__unraisablehook__(lost)
        return
    from threading import Timer, main_thread

    number = signal.SIGINT if lost.exc_type is KeyboardInterrupt else signal.SIGTERM
    Timer(_MOMENT, signal.pthread_kill, (main_thread().ident, number)).start()


_MOMENT = 0.01
