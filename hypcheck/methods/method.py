"""What everything under test looks like: a name, what it claims, and a function from rows to answers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hypcheck.methods.domain import Domain
from hypcheck.rows import Rows

Answers = NDArray[np.int8]


@dataclass(frozen=True)
class Method:
    """One way to answer, under test.

    `question` and `precision` are those of judge.Criterion; `domain` is where the method claims to be right; `answer`
    maps valid rows, float64 (n, 7), to answers, int8 (n,): +1, 0, −1 for a position, 1 and 0 for yes and no.
    `exact` marks a method that promises never to be wrong; `most` limits a slow one's rows of each family. `measured`
    marks one that `verify` leaves to `bench`: it stands beside the paper's methods, and its errors are no finding.
    """

    name: str
    title: str
    question: str
    precision: str
    answer: Callable[[Rows], Answers] = field(repr=False)
    domain: Domain
    exact: bool = False
    most: int | None = None
    measured: bool = False
