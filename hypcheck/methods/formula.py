"""A formula as a method in numpy: chunk by chunk, and, for one scene, with what depends on sizes alone computed once.

A program is turned once into a list of ufuncs and places, so that what is timed is the arithmetic and little else.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.derivation.counting import hoisted
from hypcheck.derivation.evaluation import Arithmetic
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import Formula
from hypcheck.derivation.program import KNOWN, NUMBER, Program, Step, cut, needed
from hypcheck.methods.method import Answers
from hypcheck.pairs import COLUMNS, SIZES
from hypcheck.rows import Rows

CHUNK = 8192
"""Rows at a time: the temporaries of one chunk stay in the cache."""

Floats = NDArray[np.float64]
Sizes = tuple[float, float, float, float]
ByRows = Callable[[Rows], Answers]
ByScene = Callable[[Sizes, Floats, Floats, Floats], Answers]
Columns = Mapping[str, Any]
"""Numbers or arrays by the names of a program's inputs."""


class Ready:
    """A program made ready for one float format: from columns to the values of the wanted names, in that order."""

    def __init__(self, program: Program, wanted: Iterable[str], format_name: str) -> None:
        self._arithmetic = float_arithmetic(format_name)
        names = tuple(wanted)
        steps = needed(program, names)
        read = {name for step in steps for name in step.reads} | set(names)
        self.inputs = tuple(name for name in program.inputs if name in read)
        constants = sorted({argument for step in steps for argument in step.arguments if isinstance(argument, int)})
        self._constants = [self._arithmetic.convert(constant) for constant in constants]
        labels: list[str | int] = [*self.inputs, *constants, *(step.name for step in steps)]
        place = {label: index for index, label in enumerate(labels)}
        self._wanted = [place[name] for name in names]
        self._moves = list(_moves(steps, place, self._arithmetic, keep=self._wanted, fixed=len(self.inputs)))

    def __call__(self, columns: Columns) -> list[Any]:
        """The values; infinities and NaN go through in silence."""
        with self._arithmetic.guard():
            values = [self._arithmetic.convert(columns[name]) for name in self.inputs]
            values += self._constants
            values += [None] * len(self._moves)
            for move in self._moves:
                values[move.gives] = move.does(*[values[index] for index in move.takes])
                for index in move.spends:
                    values[index] = None  # so that arrays take no more room than they must
        return [values[index] for index in self._wanted]


@dataclass(frozen=True, slots=True)
class _Move:
    """A step by places: what it does, takes and gives, and what no later one takes."""

    does: Callable[..., Any]
    takes: tuple[int, ...]
    gives: int
    spends: tuple[int, ...]


def _moves(
    steps: Iterable[Step], place: Mapping[str | int, int], arithmetic: Arithmetic, *, keep: list[int], fixed: int
) -> Iterator[_Move]:
    """The steps by places; the first `fixed` places and those to `keep` are never spent."""
    listed = list(steps)
    last = {place[argument]: number for number, step in enumerate(listed) for argument in step.arguments}
    for number, step in enumerate(listed):
        takes = tuple(place[argument] for argument in step.arguments)
        spent = {index for index in takes if last[index] == number and index >= fixed and index not in keep}
        yield _Move(arithmetic.operations[step.operation], takes, place[step.name], tuple(spent))


def by_rows(formula: Formula, format_name: str) -> ByRows:
    """The formula on rows, everything in one float format: a function to answers, int8 (n,)."""
    ready = Ready(formula.program, (formula.answer,), format_name)
    return lambda rows: in_chunks(len(rows), lambda part: ready(dict(zip(COLUMNS, rows[part].T, strict=True)))[0])


def by_scene(formula: Formula, format_name: str) -> ByScene:
    """The same for many centres and one α, γ, b, d: what these alone decide is evaluated once a call."""
    first, then = parts(formula)
    outside, inside = Ready(first, _numbers(first), format_name), Ready(then, (formula.answer,), format_name)

    def answers(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> Answers:
        fixed = dict(zip(SIZES, sizes, strict=True))
        known = {**fixed, **dict(zip(_numbers(first), outside(fixed), strict=True))}
        return in_chunks(len(x), lambda part: inside({**known, "x": x[part], "y": y[part], "z": z[part]})[0])

    return answers


@cache
def parts(formula: Formula) -> tuple[Program, Program]:
    """The formula's program in two: what sizes alone decide, and what is left for each centre."""
    return split(formula.program, (formula.answer,), SIZES)


def split(program: Program, wanted: tuple[str, ...], fixed: tuple[str, ...]) -> tuple[Program, Program]:
    """A program in two: what the fixed inputs alone decide, and what is left, up to the wanted names."""
    steps = hoisted(program, fixed).outside
    # A program's inputs are numbers, so a comparison of fixed ones stays with the rest: it costs one of two scalars.
    numbers = [step.name for step in steps if KNOWN[step.operation].gives == NUMBER]
    left = cut(program, numbers, wanted)
    read = {name for step in left.steps for name in step.reads}
    known = [name for name in numbers if name in read]
    return cut(program, fixed, known), cut(program, known, wanted)


def _numbers(outside: Program) -> tuple[str, ...]:
    return tuple(step.name for step in outside.steps)


def in_chunks(count: int, answer: Callable[[slice], Any]) -> Answers:
    """The answers of `count` rows, CHUNK at a time; int8 (n,)."""
    found = np.empty(count, dtype=np.int8)
    for start in range(0, count, CHUNK):
        part = slice(start, start + CHUNK)
        found[part] = answer(part)
    return found
