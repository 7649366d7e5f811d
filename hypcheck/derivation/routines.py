"""A routine: a program that calls named routines and loops a fixed number of times.

Its parts are steps of programs, calls and loops, in the order of evaluation, and nothing branches: a decision is a
`select`. The steps of its bodies are those of derivation/program.py, so what is proved of a program is proved of every
round of a loop over it. Kernels are printed from routines (kernel/emission/routines.py); `run` evaluates one.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from hypcheck.derivation.evaluation import Arithmetic
from hypcheck.derivation.program import BOOLEAN, NUMBER, Argument, Step, kind_of


@dataclass(frozen=True, slots=True)
class Answer:
    """A whole number by conditions: that of the first one that holds, else the last one."""

    choices: tuple[tuple[str, int], ...]
    otherwise: int


@dataclass(frozen=True, slots=True)
class Call:
    """`name` becomes the result of the routine for these arguments, numbers in the order of its inputs."""

    name: str
    routine: Routine
    arguments: tuple[Argument, ...]

    @property
    def reads(self) -> tuple[str, ...]:
        """The names among the arguments."""
        return tuple(argument for argument in self.arguments if isinstance(argument, str))


@dataclass(frozen=True, slots=True)
class Loop:
    """The parts of `body` again and again, so many `times`, one at least.

    `kept` are numbers that go from round to round: the name of each, what it is before the first round, and the name
    that it has in the body when a round ends. After the loop they are what the last round made of them; what else
    the body names is forgotten.
    """

    times: int
    kept: tuple[tuple[str, str, str], ...]
    body: tuple[Part, ...]


Part = Step | Call | Loop


@dataclass(frozen=True)
class Routine:
    """Parts that turn named inputs into one value: `result` is a name, or an answer by conditions.

    `meaning` is a sentence about the result. All inputs are numbers; those of `record` are given as one, a setting's
    constants. Raises ValueError on construction as Program does, and where a loop has no rounds, keeps what is no
    number, or a call gives another number of arguments than the routine takes.
    """

    name: str
    meaning: str
    inputs: tuple[str, ...]
    parts: tuple[Part, ...]
    result: str | Answer
    record: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        kinds: dict[str, str] = {}
        for name in (*self.inputs, *self.record):
            self._define(name, NUMBER, kinds)
        self._check(self.parts, kinds)
        for name in result_names(self.result):
            if name not in kinds:
                raise ValueError(f"routine {self.name}: there is no {name}")
            if isinstance(self.result, Answer) and kinds[name] != BOOLEAN:
                raise ValueError(f"routine {self.name}: {name} is no condition")

    @property
    def gives(self) -> str:
        """NUMBER or BOOLEAN: the kind of the result; of an answer NUMBER, a whole one."""
        if isinstance(self.result, Answer):
            return NUMBER
        return kinds_in(self.parts, dict.fromkeys((*self.inputs, *self.record), NUMBER))[self.result]

    def _check(self, parts: Iterable[Part], kinds: dict[str, str]) -> None:
        for part in parts:
            if isinstance(part, Loop):
                self._check_loop(part, kinds)
                continue
            try:
                kind = kind_of(part, kinds) if isinstance(part, Step) else _kind_of_call(part, kinds)
            except ValueError as error:
                raise ValueError(f"routine {self.name}: {part.name}: {error}") from None
            self._define(part.name, kind, kinds)

    def _check_loop(self, loop: Loop, kinds: dict[str, str]) -> None:
        if loop.times < 1:
            raise ValueError(f"routine {self.name}: a loop has {loop.times} rounds")
        for _, start, _ in loop.kept:
            self._require_number(start, kinds)
        for name, _, _ in loop.kept:
            self._define(name, NUMBER, kinds)
        inside = dict(kinds)
        self._check(loop.body, inside)
        for _, _, end in loop.kept:
            self._require_number(end, inside)
            if end in kinds:  # what a kept number becomes could be lost while the others are set
                raise ValueError(f"routine {self.name}: a round ends with {end}, which its body does not make")

    def _define(self, name: str, kind: str, kinds: dict[str, str]) -> None:
        if not (name.isascii() and name.isidentifier()):
            raise ValueError(f"routine {self.name}: {name!r} is not a name")
        if name in kinds:
            raise ValueError(f"routine {self.name}: {name} is defined twice")
        kinds[name] = kind

    def _require_number(self, name: str, kinds: Mapping[str, str]) -> None:
        if kinds.get(name) != NUMBER:
            raise ValueError(f"routine {self.name}: a loop keeps {name}, which is no number")


def _kind_of_call(call: Call, kinds: Mapping[str, str]) -> str:
    takes = call.routine.inputs + call.routine.record
    if len(call.arguments) != len(takes):
        raise ValueError(f"{call.routine.name} takes {len(takes)} arguments, not {len(call.arguments)}")
    for name in call.reads:
        if kinds.get(name) != NUMBER:
            raise ValueError(f"{name} is no number that is defined before it is used")
    return call.routine.gives


def kinds_in(parts: Iterable[Part], before: Mapping[str, str]) -> dict[str, str]:
    """The kind of every name that is there after the parts, given those before them."""
    kinds = dict(before)
    for part in parts:
        if isinstance(part, Loop):
            kinds.update({name: NUMBER for name, _, _ in part.kept})
        else:
            kinds[part.name] = kind_of(part, kinds) if isinstance(part, Step) else part.routine.gives
    return kinds


def result_names(result: str | Answer) -> tuple[str, ...]:
    """The names that a result reads."""
    return (result,) if isinstance(result, str) else tuple(name for name, _ in result.choices)


def needed_parts(parts: tuple[Part, ...], wanted: Iterable[str]) -> tuple[Part, ...]:
    """The parts that the wanted names depend on, in order; a loop is left whole but for steps that no round needs."""
    alive, found = set(wanted), list[Part]()
    for part in reversed(parts):
        if isinstance(part, Loop):
            if not alive.intersection(name for name, _, _ in part.kept):
                continue
            body = needed_parts(part.body, (end for _, _, end in part.kept))
            alive.update(start for _, start, _ in part.kept)
            alive.update(_read(body))
            found.append(Loop(part.times, part.kept, body))
        elif part.name in alive:
            alive.update(part.reads)
            found.append(part)
    return tuple(reversed(found))


def _read(parts: Iterable[Part]) -> Iterator[str]:
    for part in parts:
        if isinstance(part, Loop):
            yield from (start for _, start, _ in part.kept)
            yield from _read(part.body)
        else:
            yield from part.reads


def called(routine: Routine) -> tuple[Routine, ...]:
    """The routines that it calls, directly or not, each once and before what calls it."""
    found: dict[str, Routine] = {}
    for call in _calls(routine.parts):
        for each in (*called(call.routine), call.routine):
            found.setdefault(each.name, each)
    return tuple(found.values())


def _calls(parts: Iterable[Part]) -> Iterator[Call]:
    for part in parts:
        if isinstance(part, Loop):
            yield from _calls(part.body)
        elif isinstance(part, Call):
            yield part


def run(routine: Routine, arithmetic: Arithmetic, inputs: Mapping[str, Any]) -> Any:
    """The result for these inputs, converted into the arithmetic first, those of the record too.

    Raises KeyError where an input is missing or the arithmetic lacks an operation.
    """
    values = {name: arithmetic.convert(inputs[name]) for name in (*routine.inputs, *routine.record)}
    parts = needed_parts(routine.parts, result_names(routine.result))
    _run(parts, values, arithmetic)
    if isinstance(routine.result, str):
        return values[routine.result]
    held = (value for name, value in routine.result.choices if values[name])
    return next(held, routine.result.otherwise)


def _run(parts: tuple[Part, ...], values: dict[str, Any], arithmetic: Arithmetic) -> None:
    for part in parts:
        if isinstance(part, Loop):
            _run_loop(part, values, arithmetic)
            continue
        given = [values[each] if isinstance(each, str) else arithmetic.convert(each) for each in part.arguments]
        if isinstance(part, Step):
            values[part.name] = arithmetic.operations[part.operation](*given)
        else:
            names = (*part.routine.inputs, *part.routine.record)
            values[part.name] = run(part.routine, arithmetic, dict(zip(names, given, strict=True)))


def _run_loop(loop: Loop, values: dict[str, Any], arithmetic: Arithmetic) -> None:
    kept = {name: values[start] for name, start, _ in loop.kept}
    for _ in range(loop.times):
        inside = {**values, **kept}
        _run(loop.body, inside, arithmetic)
        kept = {name: inside[end] for name, _, end in loop.kept}
    values.update(kept)
