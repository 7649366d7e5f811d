"""A routine: a program that calls named routines and loops a fixed number of times.

Its parts are steps of programs, calls and loops, in the order of evaluation, and nothing branches: a decision is a
`select`. The steps of its bodies are those of derivation/program.py, so what is proved of a program is proved of every
round of a loop over it. Kernels are printed from routines (kernel/emission/dialects.py); `run` evaluates one.

A name is a number, a truth value, a pair of numbers (whose sum a double-double is), or an answer, a whole number.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from hypcheck.derivation.evaluation import Arithmetic
from hypcheck.derivation.program import BOOLEAN, NUMBER, Argument, Step, kind_of

PAIR, ANSWER = "pair", "answer"
"""Kinds of names in addition to NUMBER and BOOLEAN."""


@dataclass(frozen=True, slots=True)
class Return:
    """A result by conditions: the whole number of the first of `choices` whose condition holds, else `otherwise`.

    A choice is the name of a condition and its number.
    """

    choices: tuple[tuple[str, int], ...]
    otherwise: int


@dataclass(frozen=True, slots=True)
class Call:
    """A part that gives `name` the result of the routine for these arguments, in the order of its inputs."""

    name: str
    routine: Routine
    arguments: tuple[Argument, ...]

    @property
    def reads(self) -> tuple[str, ...]:
        """The names among the arguments."""
        return tuple(argument for argument in self.arguments if isinstance(argument, str))


@dataclass(frozen=True, slots=True)
class Half:
    """A part that gives `name` one number of a pair: the first, or with `low` the second."""

    name: str
    pair: str
    low: bool = False

    @property
    def reads(self) -> tuple[str, ...]:
        """The names that this part reads: that of its pair."""
        return (self.pair,)


@dataclass(frozen=True, slots=True)
class Stored:
    """A part that gives `name` the number as it is stored in memory: rounded, even if a compiler could fuse operations.

    With `opaque` the compiler must not know the number either, so that it computes nothing from it before the program
    runs.
    """

    name: str
    value: str
    opaque: bool = False

    @property
    def reads(self) -> tuple[str, ...]:
        """The names that this part reads: that of its number."""
        return (self.value,)


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of numbers for a loop: in each round the names `columns` have the numbers of one row."""

    name: str
    columns: tuple[str, ...]
    rows: tuple[tuple[float, ...], ...]


@dataclass(frozen=True, slots=True)
class Loop:
    """The parts of `body`, repeated `times` times; at least once.

    `kept` are numbers that each round passes to the next: of each its name, the name of its value before the first
    round, and the name in the body of its next value. After the loop they have the values of the last round; other
    names of the body are not defined there. `until` is a truth value of the body: the round in which it holds is the
    last. With a `table` the body can read the numbers of a row of it, one row a round.
    """

    times: int
    kept: tuple[tuple[str, str, str], ...]
    body: tuple[Part, ...]
    until: str | None = None
    table: Table | None = None

    @property
    def given(self) -> tuple[str, ...]:
        """The names of the numbers of a table's row."""
        return () if self.table is None else self.table.columns

    @property
    def ends(self) -> tuple[str, ...]:
        """The names of the body that are read when a round ends."""
        return (*(end for _, _, end in self.kept), *filter(None, [self.until]))


Part = Step | Call | Half | Stored | Loop

Result = str | Return | tuple[Argument, Argument]
"""A name, an answer by conditions, or a pair of two numbers."""


@dataclass(frozen=True)
class Routine:
    """Parts that turn named inputs into one value.

    `meaning` is a sentence about the result. Inputs are numbers, or `pairs`; those of `record` are given as one, a
    setting's constants, whose type is called `record_name`. `constants` are numbers that parts may read. Raises
    ValueError on construction as Program does, and where a loop has no rounds or keeps a value that is not a number,
    and where a call has a wrong number of arguments.
    """

    name: str
    meaning: str
    inputs: tuple[str, ...]
    parts: tuple[Part, ...]
    result: Result
    record: tuple[str, ...] = ()
    pairs: frozenset[str] = frozenset()
    constants: Mapping[str, float] = field(default_factory=dict)
    record_name: str = "setting"

    def __post_init__(self) -> None:
        kinds: dict[str, str] = {}
        for name, kind in self.given.items():
            self._define(name, kind, kinds)
        if len(kinds) != len((*self.inputs, *self.record, *self.constants)):
            twice = next(name for name in kinds if (*self.inputs, *self.record, *self.constants).count(name) > 1)
            raise ValueError(f"routine {self.name}: {twice} is defined twice")
        self._check(self.parts, kinds)
        for name in result_names(self.result):
            if name not in kinds:
                raise ValueError(f"routine {self.name}: there is no {name}")
            if isinstance(self.result, Return) and kinds[name] != BOOLEAN:
                raise ValueError(f"routine {self.name}: {name} is not a condition")
            if isinstance(self.result, tuple) and kinds[name] != NUMBER:
                raise ValueError(f"routine {self.name}: {name} is not a number")

    @property
    def given(self) -> dict[str, str]:
        """The kind of each name that is defined before the first part: inputs, fields of the record, constants."""
        names = (*self.inputs, *self.record, *self.constants)
        return {name: PAIR if name in self.pairs else NUMBER for name in names}

    @property
    def takes(self) -> tuple[str, ...]:
        """The kinds of the arguments of a call."""
        return tuple(PAIR if name in self.pairs else NUMBER for name in (*self.inputs, *self.record))

    @property
    def gives(self) -> str:
        """The kind of the result."""
        if isinstance(self.result, Return):
            return ANSWER
        return PAIR if isinstance(self.result, tuple) else kinds_in(self.parts, self.given)[self.result]

    @property
    def needed(self) -> tuple[Part, ...]:
        """The parts that the result depends on."""
        return needed_parts(self.parts, result_names(self.result))

    def _check(self, parts: Iterable[Part], kinds: dict[str, str]) -> None:
        for part in parts:
            if isinstance(part, Loop):
                self._check_loop(part, kinds)
                continue
            try:
                kind = kind_of_part(part, kinds)
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
        for name in loop.given:
            self._define(name, NUMBER, inside)
        if loop.table is not None and {len(loop.table.columns)} != {len(row) for row in loop.table.rows}:
            raise ValueError(f"routine {self.name}: the table {loop.table.name} has a row of another length")
        if loop.table is not None and loop.times != len(loop.table.rows):
            raise ValueError(f"routine {self.name}: a loop over {loop.table.name} has {loop.times} rounds")
        self._check(loop.body, inside)
        for _, _, end in loop.kept:
            self._require_number(end, inside)
            if end in kinds:  # what a kept number becomes could be lost while the others are set
                raise ValueError(f"routine {self.name}: the loop keeps {end}, which its body does not compute")
        if loop.until is not None and inside.get(loop.until) != BOOLEAN:
            raise ValueError(f"routine {self.name}: a loop ends by {loop.until}, which is not a condition")

    def _define(self, name: str, kind: str, kinds: dict[str, str]) -> None:
        if not (name.isascii() and name.isidentifier()):
            raise ValueError(f"routine {self.name}: {name!r} is not a name")
        if name in kinds:
            raise ValueError(f"routine {self.name}: {name} is defined twice")
        kinds[name] = kind

    def _require_number(self, name: str, kinds: Mapping[str, str]) -> None:
        if kinds.get(name) != NUMBER:
            raise ValueError(f"routine {self.name}: a loop keeps {name}, which is not a number")


def kind_of_part(part: Step | Call | Half | Stored, kinds: Mapping[str, str]) -> str:
    """Return the kind of a part's result: NUMBER, BOOLEAN, PAIR or ANSWER.

    `kinds` are the kinds of the names before it. Raises ValueError as Routine does.
    """
    if isinstance(part, Call):
        return _kind_of_call(part, kinds)
    if isinstance(part, Step):
        chosen = [kinds.get(argument) for argument in part.arguments if isinstance(argument, str)]
        return PAIR if part.operation == "select" and chosen == [BOOLEAN, PAIR, PAIR] else kind_of(part, dict(kinds))
    wanted = PAIR if isinstance(part, Half) else NUMBER
    if kinds.get(part.reads[0]) != wanted:
        raise ValueError(f"{part.reads[0]} is not a {wanted}")
    return NUMBER


def _kind_of_call(call: Call, kinds: Mapping[str, str]) -> str:
    """Return the kind of the called routine's result. Raises ValueError if the arguments do not fit the routine."""
    takes = call.routine.takes
    if len(call.arguments) != len(takes):
        raise ValueError(f"{call.routine.name} takes {len(takes)} arguments, not {len(call.arguments)}")
    for argument, kind in zip(call.arguments, takes, strict=True):
        if (kinds.get(argument) if isinstance(argument, str) else NUMBER) != kind:
            raise ValueError(f"{argument} is not a {kind} that is defined before it is used")
    return call.routine.gives


def kinds_in(parts: Iterable[Part], before: Mapping[str, str]) -> dict[str, str]:
    """Return the kinds of all names that are defined after the parts, given those defined before them."""
    kinds = dict(before)
    for part in parts:
        if isinstance(part, Loop):
            kinds.update({name: NUMBER for name, _, _ in part.kept})
        else:
            kinds[part.name] = kind_of_part(part, kinds)
    return kinds


def result_names(result: Result) -> tuple[str, ...]:
    """Return the names that a result reads."""
    if isinstance(result, Return):
        return tuple(name for name, _ in result.choices)
    return tuple(name for name in ((result,) if isinstance(result, str) else result) if isinstance(name, str))


def needed_parts(parts: tuple[Part, ...], wanted: Iterable[str]) -> tuple[Part, ...]:
    """Return the parts that the wanted names depend on, in order.

    A loop that is needed keeps all its rounds and kept numbers; only the parts of its body that no round needs are
    omitted.
    """
    alive, parts_needed = set(wanted), list[Part]()
    for part in reversed(parts):
        if isinstance(part, Loop):
            if not alive.intersection(name for name, _, _ in part.kept):
                continue
            body = needed_parts(part.body, part.ends)
            alive.update(start for _, start, _ in part.kept)
            alive.update(_read(body))
            parts_needed.append(replace(part, body=body))
        elif part.name in alive:
            alive.update(part.reads)
            parts_needed.append(part)
    return tuple(reversed(parts_needed))


def _read(parts: Iterable[Part]) -> Iterator[str]:
    """Yield the names that the parts read, of loops too."""
    for part in parts:
        if isinstance(part, Loop):
            yield from (start for _, start, _ in part.kept)
            yield from _read(part.body)
        else:
            yield from part.reads


def names_read(routine: Routine) -> frozenset[str]:
    """Return all names that the needed parts and the result read."""
    return frozenset((*_read(routine.needed), *result_names(routine.result)))


def renamed(parts: Iterable[Part], names: Mapping[str, str]) -> Iterator[Part]:
    """Yield the parts with the names of their arguments replaced by `names`."""
    for part in parts:
        if isinstance(part, Half):
            yield replace(part, pair=names.get(part.pair, part.pair))
        elif isinstance(part, Step | Call):
            yield replace(part, arguments=tuple(names.get(str(argument), argument) for argument in part.arguments))
        else:
            raise TypeError(f"{type(part).__name__} has no arguments to rename")


def called(routine: Routine) -> tuple[Routine, ...]:
    """Return the routines that a routine calls, directly or not; each occurs once, before its callers."""
    routines: dict[str, Routine] = {}
    for call in _calls(routine.needed):
        for inner in (*called(call.routine), call.routine):
            routines.setdefault(inner.name, inner)
    return tuple(routines.values())


def _calls(parts: Iterable[Part]) -> Iterator[Call]:
    """Yield the calls among the parts and in the bodies of loops."""
    for part in parts:
        if isinstance(part, Loop):
            yield from _calls(part.body)
        elif isinstance(part, Call):
            yield part


def run(routine: Routine, arithmetic: Arithmetic, inputs: Mapping[str, Any]) -> Any:
    """Evaluate a routine in an arithmetic and return its result.

    `inputs` has a value for each input and for each field of the record; all are converted into the arithmetic first.
    A pair is a tuple of two numbers. Raises KeyError where an input is missing or the arithmetic lacks an operation.
    """
    values = {name: _converted(inputs[name], arithmetic) for name in (*routine.inputs, *routine.record)}
    values |= {name: arithmetic.convert(value) for name, value in routine.constants.items()}
    _run(routine.needed, values, arithmetic)
    if isinstance(routine.result, str):
        return values[routine.result]
    if isinstance(routine.result, tuple):
        return tuple(
            values[result_name] if isinstance(result_name, str) else arithmetic.convert(result_name)
            for result_name in routine.result
        )
    held = (value for name, value in routine.result.choices if values[name])
    return next(held, routine.result.otherwise)


def _converted(value: Any, arithmetic: Arithmetic) -> Any:
    return tuple(map(arithmetic.convert, value)) if isinstance(value, tuple) else arithmetic.convert(value)


def _run(parts: tuple[Part, ...], values: dict[str, Any], arithmetic: Arithmetic) -> None:
    for part in parts:
        if isinstance(part, Loop):
            _run_loop(part, values, arithmetic)
            continue
        if isinstance(part, Half | Stored):
            values[part.name] = values[part.pair][part.low] if isinstance(part, Half) else values[part.value]
            continue
        arguments = [
            values[argument] if isinstance(argument, str) else arithmetic.convert(argument)
            for argument in part.arguments
        ]
        if isinstance(part, Step) and part.operation == "select" and isinstance(arguments[1], tuple):
            values[part.name] = arguments[1] if arguments[0] else arguments[2]
        elif isinstance(part, Step):
            values[part.name] = arithmetic.operations[part.operation](*arguments)
        else:
            names = (*part.routine.inputs, *part.routine.record)
            values[part.name] = run(part.routine, arithmetic, dict(zip(names, arguments, strict=True)))


def _run_loop(loop: Loop, values: dict[str, Any], arithmetic: Arithmetic) -> None:
    kept = {name: values[start] for name, start, _ in loop.kept}
    for number in range(loop.times):
        row = () if loop.table is None else map(arithmetic.convert, loop.table.rows[number])
        inside = {**values, **kept, **dict(zip(loop.given, row, strict=True))}
        _run(loop.body, inside, arithmetic)
        kept = {name: inside[end] for name, _, end in loop.kept}
        if loop.until is not None and inside[loop.until]:
            break
    values.update(kept)
