"""What the worker holds: foreign code, loaded, behind one interface."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from hypcheck.rows import Rows

Answers = NDArray[np.signedinteger[Any]]


class LoadError(Exception):
    """Foreign code that cannot be loaded; the text is a sentence about it."""


class ContractError(Exception):
    """Foreign code that was called and did not do what the contract says; the text is a sentence about it."""


class Subject(Protocol):
    """Foreign code that can be asked. Calls raise ContractError, or whatever foreign code raises."""

    description: str
    """JSON; empty where it says nothing of itself."""

    scene: bool
    """Whether classify_scene can be called."""

    def classify(self, rows: Rows) -> Answers:
        """Answers to rows."""
        ...

    def classify_scene(self, rows: Rows) -> Answers:
        """The same, of rows that share their sizes, through the entry for many centres."""
        ...

    def seconds(self, rows: Rows, repeat: int, *, by_scene: bool) -> tuple[int, int]:
        """Nanoseconds of `repeat` calls, and the sum of the answers of the last."""
        ...

    def seconds_each(self, rows: Rows, repeat: int) -> tuple[int, int]:
        """Nanoseconds of `repeat` times a call for each row, and the sum of the last answers.

        Of a library no rows stand for a call that does nothing.
        """
        ...


def as_json(description: object) -> str:
    """A description that code holds, as the text that goes to our process; raises LoadError."""
    try:
        return json.dumps(dict(description) if isinstance(description, Mapping) else description)
    except (TypeError, ValueError, RecursionError):
        raise LoadError(
            "its description holds what JSON cannot say; it must be a mapping of texts and numbers"
        ) from None


def room_at(shift: int, size: int) -> NDArray[np.uint8]:
    """Bytes that begin `shift` bytes after a multiple of 64.

    What depends on alignment must not pass because memory happened to be aligned alike each time.
    """
    room = np.empty(size + 128, dtype=np.uint8)
    start = -room.ctypes.data % 64 + shift % 64
    return room[start : start + size]
