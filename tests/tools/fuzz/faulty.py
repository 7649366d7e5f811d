"""Readers that the fuzz must reject, each with its fault."""

from __future__ import annotations

import os
import time

from hypcheck.errors import InputError


def raises(data: bytes) -> None:
    """A traceback."""
    raise KeyError(data)


def speaks_in_colours(_: bytes) -> None:
    """A sentence with control characters."""
    error = InputError("")
    error.args = ("\x1b[31m",)
    raise error


def loops(_: bytes) -> None:
    """A hang that Python can stop."""
    while True:
        pass


def sleeps(_: bytes) -> None:
    """A hang that takes no processor time."""
    time.sleep(600)


def takes_a_gigabyte(_: bytes) -> None:
    """Memory at once."""
    bytearray(1 << 30)


_KEPT: list[bytes] = []


def keeps(_: bytes) -> None:
    """Memory little by little."""
    _KEPT.append(b"x" * (1 << 19))


def dies(_: bytes) -> None:
    """No end that anybody could catch."""
    os._exit(3)
