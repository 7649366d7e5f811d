"""One run of an implementation, from its start to its end, as the runner sees it."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from hypcheck.methods.description import Description
from hypcheck.rows import Rows

Answers = NDArray[np.signedinteger[Any]]


class Session(Protocol):
    """Questions raise FaultError; a fatal one leaves the session good for kill() alone. Beginning raises StartError."""

    description: Description
    longest: int
    """Rows of one question, at most."""

    most: int | None
    """Rows of a family that it is fast enough for; None where nothing is known of that."""

    scene: bool
    """Whether questions can be asked by scene: one set of sizes, many centres."""

    def classify(self, rows: Rows, *, by_scene: bool = False) -> Answers:
        """An integer for each row, not looked at."""
        ...

    def time(self, rows: Rows, repeat: int, *, by_scene: bool = False, each: bool = False) -> tuple[int, int] | None:
        """Nanoseconds for `repeat` times the rows and the sum of the answers; None where that is not offered.

        `each`: by a call for each row.
        """
        ...

    @property
    def evidence(self) -> str:
        """What it said on standard error since the last question, as the end of a sentence."""
        ...

    @property
    def stderr(self) -> tuple[str, ...]:
        """The last lines of its standard error, safe to print."""
        ...

    def close(self) -> None:
        """Let it leave."""
        ...

    def kill(self) -> None:
        """End it now."""
        ...
