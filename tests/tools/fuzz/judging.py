"""The allowed results of an input: a value, or one sentence for a person. Everything else is a finding."""

from __future__ import annotations

import signal
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass

from hypcheck.errors import HypcheckError
from hypcheck.implementations.session import FaultError

LONGEST = 1000
"""Characters of a sentence, however long what it speaks of."""

EXPECTED = (1, 2, 5)
"""Exit codes of what is somebody else's fault: an implementation that fails, bad input, one that does not start."""


class HangError(BaseException):
    """An input took too long; no reader may catch it."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """What became of an input: `value`, `refused` or `finding`, and the sentence or what is wrong."""

    kind: str
    says: str = ""


def judged(read: Callable[[bytes], object], data: bytes, seconds: float = 1.0) -> Verdict:
    """Read the input, and judge what comes of it; it may take so many seconds of processor time."""
    before = time.process_time()
    try:
        verdict = _read(read, data, seconds)
    except HangError:
        verdict = Verdict("finding", "hang: it was stopped")
    spent = time.process_time() - before
    if spent > seconds and verdict.kind != "finding":
        return Verdict("finding", f"hang: {spent:.1f} s")
    return verdict


def _read(read: Callable[[bytes], object], data: bytes, seconds: float) -> Verdict:
    signal.setitimer(signal.ITIMER_VIRTUAL, 1.25 * seconds)
    try:
        read(data)
    except (HypcheckError, FaultError) as error:
        return _of_sentence(error)
    except Exception as error:  # noqa: BLE001 - that is what is looked for
        return Verdict("finding", f"{type(error).__name__}: {str(error)[:300]!r} ({_origin(error)})")
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
    return Verdict("value")


def _of_sentence(error: HypcheckError | FaultError) -> Verdict:
    text = str(error)
    if isinstance(error, HypcheckError) and error.exit_code not in EXPECTED:
        return Verdict("finding", f"exit code {error.exit_code}: {text[:300]!r}")
    wrong = trouble_with(text)
    return Verdict("finding", f"{wrong}: {text[:300]!r} ({_origin(error)})") if wrong else Verdict("refused", text)


def trouble_with(text: str) -> str | None:
    """Why a text is no sentence for a person; None where it is one."""
    if not text.strip():
        return "says nothing"
    if not text.isprintable():
        return f"says {next(character for character in text if not character.isprintable())!r}"
    if len(text) > LONGEST:
        return f"says {len(text)} characters"
    if "Traceback" in text:
        return "says a traceback"
    return None


def require_sentence(text: str) -> None:
    """Raise AssertionError where the text is no sentence for a person."""
    wrong = trouble_with(text)
    if wrong:
        raise AssertionError(f"{wrong}: {text[:300]!r}")


def _origin(error: BaseException) -> str:
    """Where it was raised: the last of our own lines."""
    trace, place = error.__traceback__, "?"
    while trace is not None:
        file = trace.tb_frame.f_code.co_filename
        if "hypcheck" in file:
            place = f"{file.rpartition('hypcheck/')[2]}:{trace.tb_lineno}"
        trace = trace.tb_next
    return place


def stop_hangs() -> None:
    """From here on, an input that takes too long is stopped where the interpreter can be, and a warning is an error."""
    warnings.simplefilter("error")

    def stop(_signal: int, _frame: object) -> None:
        raise HangError

    signal.signal(signal.SIGVTALRM, stop)
