"""The kernel in use, compiled or numpy, with the same answers; what a call may ask of it; and the accuracy it promises.

The compiled kernel answers if it was built and loads, otherwise numpy. Environment variables, read when a kernel is
first asked for:

    HYPCHECK_KERNEL   "compiled" or "numpy" forces that one
    HYPCHECK_LEVEL    "avx512", "avx2", "sse2", "neon" or "plain" forces the instruction set of the compiled one
    HYPCHECK_THREADS  the most threads it may use; by default the processors this process may run on
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from operator import index
from types import ModuleType
from typing import TYPE_CHECKING, Literal, TypeVar

from hypcheck.errors import InputError
from hypcheck.geometry.pair import REFUSED
from hypcheck.scene.model import QUESTIONS

if TYPE_CHECKING:  # it loads numpy, and one pair does without
    from hypcheck.geometry.rows import Positions

EXTENSION = "hypcheck.kernel._compiled"
KERNELS = ("compiled", "numpy")
LEVELS = ("avx512", "avx2", "sse2", "neon", "plain")


@dataclass(frozen=True)
class KernelChoice:
    """The kernel in use, a name in KERNELS, the instruction set of the compiled one, and the reason as words."""

    kernel: str
    level: str | None
    reason: str


@cache
def choice() -> KernelChoice:
    """Return the choice for all calls of this process. Raises InputError if a variable asks for a missing part."""
    wanted = os.environ.get("HYPCHECK_KERNEL", "")
    if wanted not in ("", *KERNELS):
        raise InputError(f"HYPCHECK_KERNEL is {wanted!r}; it must be {' or '.join(KERNELS)}, or unset")
    if wanted == "numpy":
        return KernelChoice("numpy", None, "HYPCHECK_KERNEL asks for it")
    try:
        module = compiled()
    except ImportError as error:
        if wanted:
            raise InputError(f"HYPCHECK_KERNEL is 'compiled', but there is no compiled kernel: {error}") from None
        return KernelChoice("numpy", None, f"there is no compiled kernel: {error}")
    reason = "HYPCHECK_KERNEL asks for it" if wanted else "it was compiled at install"
    return KernelChoice("compiled", _level(module), reason)


def compiled() -> ModuleType:
    """Return the extension module. Raises ImportError where it was not built or does not load."""
    try:
        return import_module(EXTENSION)
    except ModuleNotFoundError as error:
        if error.name != EXTENSION:
            raise
        raise ImportError("it was not built at install, which takes a C compiler and Python's headers") from None


def _level(module: ModuleType) -> str:
    """Return the instruction set that the compiled kernel uses. Raises InputError if another one is required."""
    wanted = os.environ.get("HYPCHECK_LEVEL", "")
    if wanted and wanted not in LEVELS:
        raise InputError(f"HYPCHECK_LEVEL is {wanted!r}; it must be one of {', '.join(LEVELS)}, or unset")
    if wanted and not module.use_level(wanted):
        raise InputError(f"HYPCHECK_LEVEL is {wanted!r}, but this machine or build has no more than {module.level()}")
    return str(module.level())


def most_threads() -> int:
    """Return HYPCHECK_THREADS, or the number of processors that this process may run on. Raises InputError."""
    wanted = os.environ.get("HYPCHECK_THREADS", "")
    if not wanted:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if not (wanted.isascii() and wanted.isdigit() and int(wanted) > 0):
        raise InputError(f"HYPCHECK_THREADS is {wanted!r}; it must be a whole number greater than 0, or unset")
    return int(wanted)


Question = Literal["position", "exterior", "interior", "contact"]
"""`position` is answered by +1, 0 or −1, the others by 1 (yes) or 0 (no)."""

NUMBER_OF = {question: number for number, question in enumerate(QUESTIONS)}
"""The number of each question, as in core/hypcheck.h."""

POSITION_OF = {"exterior": 1, "interior": -1, "contact": 0}
"""The position to which a question is answered yes."""


def answers_to(question: str, positions: Positions) -> Positions:
    """Return the answers to a question from positions, int8 (n,); 127, for an invalid row, stays."""
    if question == "position":
        return positions
    answers: Positions = (positions == POSITION_OF[question]).astype(positions.dtype)
    answers[positions == REFUSED] = REFUSED
    return answers


def required(question: str, threads: int | None, on_invalid: str) -> int | None:
    """Check the options of a call, and return the number of threads. Raises InputError."""
    if not isinstance(on_invalid, str) or on_invalid not in ("raise", "flag"):
        raise InputError(f"on_invalid is {on_invalid!r}; it must be 'raise' or 'flag'")
    if question not in QUESTIONS:
        raise InputError(f"question is {question!r}; it must be one of {', '.join(QUESTIONS)}")
    if threads is None:
        return None
    try:
        number = 0 if isinstance(threads, bool) else index(threads)
    except TypeError:
        number = 0
    if number < 1:
        raise InputError(f"threads is {threads!r}; it must be a whole number greater than 0")
    return number


_PROMISED = 2.0**-29
"""How far apart the bounds of a distance may be, in units of the distance and the spheroid's longer semi-axis."""

Number = TypeVar("Number")


def are_apart(low: Number, high: Number, longer: Number) -> Number:
    """Whether bounds of distances, numbers or arrays, are farther apart than promised, or the upper bound is inf."""
    return high - low > _PROMISED * (low + longer)  # type: ignore[operator, no-any-return]
