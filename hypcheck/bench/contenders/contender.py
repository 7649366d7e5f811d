"""What is compared: a method, what it is written in, and how it is loaded in a process that measures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from hypcheck.bench.contenders.ways import InPython, Way
from hypcheck.methods.domain import Domain, claimed
from hypcheck.methods.formula import ByScene
from hypcheck.methods.method import Method
from hypcheck.rows import Rows


@dataclass(frozen=True)
class Contender:
    """A method as it is compared.

    `name`, `title`, `question`, `precision`, `exact` and `domain` are as a Method has them. `tier` is what it is
    written in, and kin are compared inside one: "C", "numpy", "python", "FCL" or "foreign"; `kind` what it does.
    `judged` rows of a workload are asked of it at most, and `timed` rows make a timed batch, of which the first
    `singles` are asked one by one, enough that a branch predictor does not learn them. `amortised` says of a mesh
    whether it is built once for a scene or for each row. `load` makes the way to call it; it `needs` what may be absent
    here, or nothing (""). It is asked about `scenes` pairs of sizes at most, and timed on one, where that is not None.
    A `quick` run leaves those out that are too slow for it, unless they are named.
    """

    name: str
    title: str
    tier: str
    kind: str
    precision: str
    question: str
    domain: Domain
    load: Callable[[], Way]
    exact: bool = False
    judged: int | None = None
    timed: int | None = None
    singles: int = 32
    amortised: str | None = None
    accuracy_only: bool = False
    note: str = ""
    needs: str = ""
    scenes: int | None = None
    quick: bool = True

    def asked(self, rows: Rows) -> NDArray[np.intp]:
        """The places of the rows it is asked to be right about: inside its domain, and numbers of its format."""
        if self.scenes is not None and len(np.unique(rows[:, :4], axis=0)) > self.scenes:
            return np.empty(0, dtype=np.intp)
        return claimed(rows, self.domain, self.precision)[: self.judged]


def of_method(
    method: Method,
    tier: str,
    kind: str,
    *,
    name: str = "",
    scene: ByScene | None = None,
    judged: int | None = None,
    timed: int | None = None,
    singles: int = 32,
    accuracy_only: bool = False,
    note: str = "",
) -> Contender:
    """A built-in method as a contender."""
    return Contender(
        name=name or method.name,
        title=method.title,
        tier=tier,
        kind=kind,
        precision=method.precision,
        question=method.question,
        domain=method.domain,
        load=partial(InPython, method.answer, scene),
        exact=method.exact,
        judged=judged,
        timed=timed,
        singles=singles,
        accuracy_only=accuracy_only,
        note=note,
    )
