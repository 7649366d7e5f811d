"""TOML files that users write, as text of a bounded length; an error in a file is one sentence."""

from __future__ import annotations

import os
import re
import stat
import sys
from typing import Any

from hypcheck.errors import InputError, system_reason

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

LARGEST = 1 << 20
"""Bytes of a file, at most: enough for ten thousand trees of a scene. A larger file that is slow to read would take
minutes and gigabytes."""


def text_of(path: str) -> str:
    """The text of a regular file, without a byte order mark. Raises FileNotFoundError, else InputError."""
    try:
        # Non-blocking: opening a pipe would wait until another process writes to it.
        with open(os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0)), "rb") as file:
            if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
                raise InputError(f"cannot read {path}: it is a pipe or a device; it must be a regular file")
            content = file.read(LARGEST + 1)
    except FileNotFoundError:
        raise
    except OSError as error:
        raise InputError(f"cannot read {path}: {system_reason(error)}") from None
    except ValueError as error:  # a NUL in the name
        raise InputError(f"cannot read {path}: {error}") from None
    if len(content) > LARGEST:
        raise InputError(f"{path}: has more than {LARGEST >> 20} MiB; it must be smaller")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{path}, line {line}: is not UTF-8 text: {error.reason} at byte {error.start}; save it as UTF-8"
        ) from None


_LONG_INTEGER = re.compile(r"0[xob][0-9A-Fa-f_]{400}")
_TOO_LONG = "has an integer with too many digits; a number must fit into float64"

MOST_DOTS = 100
"""Dots of a line, decimal points and runs of dots apart, at most: the parser's time and memory grow with the square of
the number of parts of a key such as a.b.c, which is on one line."""

_NO_KEY = re.compile(r"(?<![\w.])\d+\.\d+(?:[eE][+-]?\d+)?(?!\s*[\w.])|\.{2,}")


def parsed(text: str, name: str) -> dict[str, Any]:
    """The content of a TOML text; `name` is that of its file. Raises InputError."""
    if _LONG_INTEGER.search(text):  # Python would read it, and could not print it in a message
        raise InputError(f"{name}: {_TOO_LONG}")
    for number, line in enumerate(text.split("\n"), start=1):
        if line.count(".") > MOST_DOTS and _NO_KEY.sub("", line).count(".") > MOST_DOTS:
            raise InputError(f"{name}, line {number}: has more than {MOST_DOTS} dots; a key or text must be shorter")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{name}: is not valid TOML: {error}") from None
    except RecursionError:
        raise InputError(f"{name}: cannot be read as TOML: it is nested too deeply") from None
    except ValueError:  # an integer of more than 4300 digits
        raise InputError(f"{name}: {_TOO_LONG}") from None
