"""A built-in method behind the door of all others; ours, so it runs in our process."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

from hypcheck.methods.builtin import builtin
from hypcheck.methods.description import Description
from hypcheck.methods.frames import LARGEST
from hypcheck.methods.session import Answers
from hypcheck.rows import Rows
from hypcheck.version import VERSION


class BuiltinSession:
    """A method of builtin_methods(). Raises InputError where there is none of that name."""

    longest = LARGEST
    scene = False
    evidence = ""
    stderr: tuple[str, ...] = ()

    def __init__(self, name: str) -> None:
        self.method = builtin(name)
        self.most = self.method.most
        self.description = Description(
            name=self.method.name,
            version=VERSION,
            language="python",
            precision=self.method.precision,
            question=self.method.question,
            domain=self.method.domain,
            binary=True,
            time=True,
        )

    def classify(self, rows: Rows, *, by_scene: bool = False) -> Answers:  # noqa: ARG002 - the runner asks who offers it
        """The method's answers."""
        return self.method.answer(rows)

    def time(
        self,
        rows: Rows,
        repeat: int,
        *,
        by_scene: bool = False,  # noqa: ARG002
        each: bool = False,
    ) -> tuple[int, int]:
        """Nanoseconds for `repeat` times the rows and the sum of the answers; `each`: by a call for each row."""
        parts = [rows[place : place + 1] for place in range(len(rows))] if each else [rows]
        answers: list[NDArray[np.int8]] = []
        start = time.perf_counter_ns()
        for _ in range(repeat):
            answers = [self.method.answer(part) for part in parts]
        return time.perf_counter_ns() - start, sum(int(each.sum(dtype=np.int64)) for each in answers)

    def close(self) -> None:
        """There is nothing to end."""

    def kill(self) -> None:
        """There is nothing to end."""
