"""What a call must leave as it was: rounding, floating point, signals, locale, working directory, descriptors.

libm knows the rounding mode of one unit only (on x86 the old one), so the mode of the arithmetic in use is measured
too, by sums whose result depends on it.
"""

from __future__ import annotations

import ctypes
import locale
import os
import signal
from collections.abc import Iterator
from contextlib import suppress
from typing import NamedTuple

try:
    from hypcheck.implementations import _calls
except ImportError:  # not compiled: handlers and control words are not looked at
    _calls = None  # type: ignore[assignment]


class ContractError(Exception):
    """Foreign code that did not keep the contract of a call; the text is a sentence about it."""


_ONE, _TINY = 1.0, 2.0**-60


def mode_in_use() -> str:
    """The rounding mode of float64 sums now."""
    if _ONE + _TINY > _ONE:
        return "upward"
    if -_ONE - _TINY < -_ONE:
        return "downward"
    return "towards zero" if _ONE - _TINY < _ONE else "to nearest"


def _libm() -> ctypes.CDLL | None:
    try:
        libm = ctypes.CDLL(None)
        libm.fegetround, libm.fesetround  # noqa: B018 - raises AttributeError without them
    except (OSError, TypeError, AttributeError):
        return None
    return libm


_SSE = {
    "flushing results to zero (FTZ)": 1 << 15,
    "denormals are zero (DAZ)": 1 << 6,
    "the mask of floating point exceptions": 0x3F << 7,
}
_X87 = {"the mask of the x87 unit's exceptions": 0x3F, "the precision of the x87 unit": 3 << 8}
"""The bits of the control words of x86 by their meaning; Intel's manual, volume 1, 8.1.5 and 10.2.3."""


class _State(NamedTuple):
    """What only libraries are held to: a Python function may open a file in its first call and keep it."""

    directory: str
    language: str
    handlers: bytes
    free: int
    streams: tuple[tuple[int, int], ...]


class Leftovers:
    """The state before a call; restore() restores it, and raises if a call changed it.

    `whole`: libraries are held to all of it, Python functions to rounding and floating point.
    """

    def __init__(self, *, whole: bool) -> None:
        self._libm = _libm()
        self._mode = self._by_libm()
        self._control = _calls.control() if _calls else (0, 0)
        self._state = _state() if whole else None

    def _by_libm(self) -> int:
        return int(self._libm.fegetround()) if self._libm else 0

    def restore(self) -> None:
        """Raise ContractError about the first thing that is not as it was."""
        found, by_libm = mode_in_use(), self._by_libm()
        control = _calls.control() if _calls else (0, 0)
        if found != "to nearest" or by_libm != self._mode:
            self._restore_arithmetic()
            where = found if found != "to nearest" else "outside of the unit that computes float64"
            raise ContractError(f"it left the rounding mode changed: {where}; a call must leave it as it was")
        if control != self._control:
            self._restore_arithmetic()
            raise ContractError(f"it left changed: {_control_change(self._control, control)}; {_MUST}")
        if self._state is not None and (now := _state()) != self._state:
            before, self._state = self._state, now
            raise ContractError(f"it left changed: {', '.join(_changes(before, now))}; {_MUST}")

    def _restore_arithmetic(self) -> None:
        if self._libm:
            self._libm.fesetround(self._mode)
        if _calls:
            _calls.set_control(*self._control)


_MUST = "a call must leave it as it was"


def _control_change(before: tuple[int, int], now: tuple[int, int]) -> str:
    changed = [name for name, bits in _SSE.items() if (before[0] ^ now[0]) & bits]
    changed += [name for name, bits in _X87.items() if (before[1] ^ now[1]) & bits]
    return ", ".join(changed) or "the control word of floating point"


def _state() -> _State:
    return _State(
        os.getcwd(),
        locale.setlocale(locale.LC_ALL),
        _calls.handlers() if _calls else b"",
        _lowest_free_descriptor(),
        tuple((found.st_dev, found.st_ino) for found in map(os.fstat, range(3))),
    )


def _lowest_free_descriptor() -> int:
    """The number of the next opened file: greater if a file was left open, less if one of hypcheck was closed."""
    with suppress(OSError):
        number = os.dup(2)
        os.close(number)
        return number
    return -1


def _changes(before: _State, now: _State) -> Iterator[str]:
    if before.directory != now.directory:
        yield f"the working directory, which is {now.directory!r} now"
    if before.language != now.language:
        yield f"the locale, which is {now.language!r} now"
    if before.handlers != now.handlers:
        pointers = (memoryview(each).cast("P") for each in (before.handlers, now.handlers))
        names = [_name(number) for number, (old, new) in enumerate(zip(*pointers, strict=True)) if old != new]
        yield f"the handler of {', '.join(names)}"
    if before.free != now.free:
        yield "the open descriptors"
    if before.streams != now.streams:
        yield "the files behind the standard descriptors"


def _name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
