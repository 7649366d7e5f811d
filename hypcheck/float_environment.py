"""Default float64 arithmetic during a call: rounded to nearest, with subnormal numbers.

A host process may round in another direction (fesetround), or flush subnormal numbers to zero: a library that was built
with -ffast-math sets that for the thread that loads it. Bounds of rounding errors hold under both in the compiled
kernel. Python, numpy and mpmath work only in the default environment: in another one a subnormal size compares equal to
0, TwoSum loses its error term, and a text is read as a different number. So public functions run in the default
environment, and restore the caller's when they return or raise. Threads that are started in the meantime begin with the
default.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache, wraps
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")

_ONE, _TINY = 1.0, 2.0**-55
"""If results are rounded to nearest, the sum and the difference of these numbers are both 1. If they are rounded
upward, the sum is more than 1; in the other directions the difference is less."""

_LEAST_NORMAL, _HALF = sys.float_info.min, 0.5
"""The product of these numbers is subnormal. It is 0 if results are flushed to zero, and equal to 0 if operands are."""

_ROOM = 1024
"""A number of bytes that is enough for the fenv_t of any platform."""


def is_default() -> bool:
    """Return whether this thread rounds to nearest and keeps subnormal numbers."""
    return _ONE + _TINY == _ONE - _TINY and _LEAST_NORMAL * _HALF != 0


def in_default_environment(function: Callable[P, R]) -> Callable[P, R]:
    """Return a function that calls this one in the default environment, whatever the caller's is.

    A caller in the default pays 0.1 µs.
    """

    @wraps(function)
    def guarded(*arguments: P.args, **options: P.kwargs) -> R:
        if _ONE + _TINY == _ONE - _TINY and _LEAST_NORMAL * _HALF:  # is_default, without the cost of its call
            return function(*arguments, **options)
        with default_environment():
            return function(*arguments, **options)

    return guarded


@contextmanager
def default_environment() -> Iterator[None]:
    """Set the default environment for a block, and restore the caller's afterwards, with its flags of exceptions."""
    room, get, put, default = _functions()
    before = room()
    get(before)
    put(default)
    try:
        if not is_default():
            from hypcheck.errors import HypcheckError  # noqa: PLC0415 - it loads json; see __main__.py

            raise HypcheckError(
                "this thread does not round float64 to nearest, or flushes subnormal numbers to zero, and that cannot "
                "be changed here; call hypcheck from a thread with the default floating-point environment"
            )
        yield
    finally:
        put(before)


@cache
def _functions() -> tuple[Any, Any, Any, Any]:
    """Return the type of a fenv_t, the C functions fegetenv and fesetenv, and FE_DFL_ENV.

    The functions are called without releasing the interpreter's lock, so no other Python thread runs in between.
    """
    import ctypes  # noqa: PLC0415 - only where the environment is another

    library = ctypes.PyDLL(None)
    if not hasattr(library, "fesetenv"):
        library = ctypes.PyDLL("libm.so.6")
    try:  # macOS has the default environment as an object, Linux as an address that stands for it
        default: Any = ctypes.byref(ctypes.c_char.in_dll(library, "_FE_DFL_ENV"))
    except ValueError:
        default = ctypes.c_void_p(-1)
    return ctypes.c_char * _ROOM, library.fegetenv, library.fesetenv, default
