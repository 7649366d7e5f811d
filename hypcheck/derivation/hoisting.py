"""Taking out of a loop over centres what depends on the sizes alone, as the paper's Table 2 does."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from hypcheck.derivation.evaluation import Arithmetic, Evaluator
from hypcheck.derivation.program import NUMBER, Program, Step, cut, kind_of


@dataclass(frozen=True, slots=True)
class Hoisting:
    """A program's steps in two parts: those that depend on fixed inputs alone, and those that move with the rest."""

    outside: tuple[Step, ...]
    inside: tuple[Step, ...]


def hoist(program: Program, fixed: Collection[str]) -> Hoisting:
    """The program's steps, parted by whether they depend on the `fixed` inputs (and constants) alone.

    Raises ValueError where one of these is no input of the program.
    """
    unknown = sorted(set(fixed) - set(program.inputs))
    if unknown:
        raise ValueError(f"program {program.name} has no input {', '.join(unknown)}")
    known = set(fixed)
    outside, inside = [], []
    for step in program.steps:
        if known.issuperset(step.reads):
            known.add(step.name)
            outside.append(step)
        else:
            inside.append(step)
    return Hoisting(tuple(outside), tuple(inside))


def split(program: Program, wanted: tuple[str, ...], fixed: tuple[str, ...]) -> tuple[Program, Program]:
    """A program in two: what the fixed inputs alone decide, and what is left, up to the wanted names.

    Inputs of a program are numbers, so a comparison of fixed numbers stays in the second part: it costs one operation.
    Raises KeyError where a wanted name does not exist.
    """
    kinds = dict.fromkeys(program.inputs, NUMBER)
    for step in program.steps:
        kinds[step.name] = kind_of(step, kinds)
    numbers = [step.name for step in hoist(program, fixed).outside if kinds[step.name] == NUMBER]
    left = cut(program, numbers, wanted)
    read = {name for step in left.steps for name in step.reads} | set(wanted)
    known = [name for name in numbers if name in read]
    return cut(program, fixed, known), cut(program, known, wanted)


def loop_body(
    program: Program, arithmetic: Arithmetic, constants: Mapping[str, Any], wanted: Iterable[str]
) -> Evaluator:
    """From the other inputs to the wanted values, bit for bit as without hoisting.

    Every number that depends on the constants alone is computed here, once. The constants may be arrays (the sizes of
    many trees). Raises KeyError where a wanted name does not exist.
    """
    names = tuple(wanted)
    before, body = split(program, names, tuple(constants))
    known = tuple(step.name for step in before.steps)
    values = Evaluator(before, arithmetic, known)(constants)
    return Evaluator(body, arithmetic, names, {**constants, **dict(zip(known, values, strict=True))})
