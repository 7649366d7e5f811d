"""The kernel in use: the functions of a module that answers rows, and the module that choice.py chooses."""

from __future__ import annotations

from functools import cache
from typing import Protocol

import numpy as np

from hypcheck.geometry.pair import REFUSED, Axis, Lengths, Sizes
from hypcheck.geometry.rows import CANNOT_SAY, PAIRS, Columns, Floats, Positions, Rows
from hypcheck.kernel import compiled_kernel
from hypcheck.kernel.choice import Question, answers_to, choice


class Kernel(Protocol):
    """The functions of a kernel. answer_rows and answer_scene also return the number of invalid rows, answered 127."""

    def fill_valid_scene(
        self, sizes: Sizes, columns: Columns, out: Positions, threads: int | None = None, axis: Axis | None = None
    ) -> bool:
        """Fill `out`, which shares no memory with the columns, with positions; return False if a centre is invalid.

        It also returns False, without output, if the kernel gains nothing by this function.
        """

    def prepared(self, sizes: Sizes, like: Columns, axis: Axis | None = None) -> bytes:
        """Return data prepared from valid sizes, a valid axis and sample centres; only the same kernel can use them."""

    def answer_rows(self, rows: Rows, question: Question, threads: int | None = None) -> tuple[Positions, int]:
        """Return answers for C-contiguous rows, (n, 7) or (n, 10); `threads` None is as many as are worth it."""

    def answer_scene(
        self,
        sizes: Sizes,
        columns: Columns,
        question: Question,
        threads: int | None = None,
        axis: Axis | None = None,
    ) -> tuple[Positions, int]:
        """Return answers for valid sizes and the centres of three columns.

        Without an axis the spheroid is upright. For an invalid axis all answers are 127.
        """

    def answer_sweeps(self, rows: Rows) -> tuple[Positions, Floats]:
        """Return contact on sweeps, C-contiguous rows (n, 10), (n, 13) or (n, 16) as geometry.rows.SWEEPS has them.

        Hits, int8 (n,): 1 and 0 are exact, 2 means that bounds do not decide, 127 is an invalid row. Times, float64
        (n,): no contact comes before them; NaN if there is no hit, or if bounds do not give its time.
        """

    def answer_ended(self, rows: Rows, threads: int | None = None) -> Positions:
        """Return exact positions for C-contiguous rows (n, 13); 2 if bounds do not decide, 127 for an invalid row."""


def kernel() -> Kernel:
    """Return the module that choice() names. Raises InputError if the environment requires a missing one."""
    return _kernel_named(choice().kernel)


@cache
def _kernel_named(name: str) -> Kernel:
    """Return the module of the kernel with this name."""
    if name == "compiled":
        return compiled_kernel
    from hypcheck.kernel import numpy_kernel  # noqa: PLC0415 - the compiled kernel does without

    return numpy_kernel


def positions_of_rows(rows: Rows, question: Question, threads: int | None = None) -> tuple[Positions, int]:
    """Return answers for C-contiguous rows of any width, 127 for invalid ones, and how many these are."""
    if not PAIRS.has_heights(rows):
        return kernel().answer_rows(rows, question, threads)
    positions = kernel().answer_ended(rows, threads)
    left = np.flatnonzero(positions == CANNOT_SAY)
    if len(left):
        from hypcheck.truth import exact  # noqa: PLC0415 - the only exact decision about ends; few rows need it

        positions[left] = [exact.position(Lengths.of(row)) for row in rows[left].tolist()]
    refused = positions == REFUSED
    return answers_to(question, positions), int(refused.sum())
