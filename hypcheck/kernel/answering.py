"""The kernel in use, as something that answers whole arrays."""

from __future__ import annotations

from typing import Protocol

from hypcheck.kernel.choice import choice
from hypcheck.kernel.question import Question
from hypcheck.pairs import Sizes
from hypcheck.rows import Columns, Positions, Rows


class Kernel(Protocol):
    """What a module that answers has. Both return the answers, 127 for invalid rows, and how many those are."""

    def answer_rows(self, rows: Rows, question: Question, threads: int | None = None) -> tuple[Positions, int]:
        """Answers for C-contiguous rows (n, 7); `threads` None is as many as are worth it."""

    def answer_scene(
        self, sizes: Sizes, columns: Columns, question: Question, threads: int | None = None
    ) -> tuple[Positions, int]:
        """Answers for valid sizes and the centres of three columns."""


def kernel() -> Kernel:
    """The module that choice() names. Raises InputError where the environment asks for one that is not there."""
    if choice().kernel == "compiled":
        from hypcheck.kernel import compiled_path  # noqa: PLC0415 - only where it is there

        return compiled_path
    from hypcheck.kernel import numpy_path  # noqa: PLC0415 - the compiled kernel does without

    return numpy_path
