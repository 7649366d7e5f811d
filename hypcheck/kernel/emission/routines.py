"""Routines printed in each language: a head, a statement for each part, and a result.

A language says in its phrases (dialects.py) how a function begins and ends, how a number is kept from round to round,
and what a loop and a call are; nothing here knows a language. Steps are printed as those of programs are.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from hypcheck.derivation.program import NUMBER, Step
from hypcheck.derivation.routines import (
    PAIR,
    Call,
    Half,
    Loop,
    Part,
    Result,
    Routine,
    Stored,
    called,
    kind_of_part,
    names_read,
)
from hypcheck.kernel.emission.dialects import Dialect
from hypcheck.kernel.printing.languages import Spelling, argument_of, spelling_of, value_of

INDENT = "    "
WIDTH = 120


def routines_text(routines: Sequence[Routine], dialect: Dialect, precision: str) -> str:
    """The code of the routines, of all routines that they call, each once and before its callers, and of their records.

    Raises ValueError for a name that the language reserves.
    """
    printer = _Printer(dialect, precision)
    every = {part.name: part for routine in routines for part in (*called(routine), routine)}
    pairs = any(PAIR in (*part.takes, part.gives) for part in every.values())
    texts = [dialect.say("pair type")] if pairs else []
    texts += [
        text
        for part in every.values()
        for text in (*printer.tables(part.needed), printer.record(part), printer.text(part))
        if text
    ]
    return ("\n\n\n" if dialect.name == "python" else "\n\n").join(texts) + "\n"


@dataclass(frozen=True)
class _Printer:
    dialect: Dialect
    precision: str

    @property
    def spelling(self) -> Spelling:
        """The spelling of steps in the language."""
        return spelling_of(self.dialect.name, self.dialect.number_of(self.precision))

    def say(self, phrase: str, **words: object) -> str:
        """A phrase of the language."""
        return self.dialect.say(phrase, number=self.dialect.number_of(self.precision), **words)

    def type_of(self, kind: str) -> str:
        """The name of the language's type for this kind."""
        if kind in self.dialect.types:
            return self.dialect.types[kind]
        return self.spelling.number if kind == NUMBER else self.spelling.boolean

    def record(self, routine: Routine) -> str:
        """The type of its record; nothing where it has none, or the language needs none."""
        if not routine.record:
            return ""
        lines = (self._named("record field", name, routine) for name in routine.record)
        return self.say("record", record=self._type_of_record(routine), fields="\n".join(INDENT + one for one in lines))

    def tables(self, parts: Iterable[Part]) -> Iterator[str]:
        """The code of the tables whose rows the loops of the parts read."""
        for part in parts:
            if isinstance(part, Loop):
                if part.table is not None:
                    rows = (", ".join(map(repr, row)) for row in part.table.rows)
                    body = "\n".join(f"{INDENT}{self.say('table row', values=row)}," for row in rows)
                    size = {"rows": part.times, "columns": len(part.given)}
                    yield self.say("table", name=part.table.name, body=body, **size)
                yield from self.tables(part.body)

    def text(self, routine: Routine) -> str:
        """The function."""
        inputs = ", ".join(self._named("input", name, routine) for name in routine.inputs)
        if routine.record:
            of = ", ".join(self._named("input", name, routine) for name in routine.record)
            inputs += self.say("given record", inputs=of, record=self._type_of_record(routine))
        unpacked = [self._named("unpack", name, routine) for name in routine.record]
        read = names_read(routine)
        constants = [
            self.say("constant", name=name, value=repr(value))
            for name, value in routine.constants.items()
            if name in read
        ]
        head = self.say(
            "function", type=self.type_of(routine.gives), name=routine.name, inputs=inputs, meaning=routine.meaning
        )
        parts = self._parts(routine.needed, dict(routine.given))
        body = [*filter(None, unpacked), *constants, *parts, *self._result(routine.result)]
        return "\n".join([*_broken(head), *_indented(body), *filter(None, [self.say("end")])])

    def _named(self, phrase: str, name: str, routine: Routine) -> str:
        return self.say(phrase, name=name, type=self.type_of(routine.given[name]))

    def _type_of_record(self, routine: Routine) -> str:
        words = routine.record_name.split("_")
        return "".join(map(str.capitalize, words)) if self.dialect.capitals else routine.record_name

    def _parts(self, parts: Iterable[Part], kinds: dict[str, str]) -> Iterator[str]:
        """The statements; `kinds`, of the names before, gets those of the names that they make."""
        several = list(parts)
        for part, next_part in zip(several, (*several[1:], None), strict=False):
            if isinstance(part, Loop):
                yield from self._loop(part, kinds)
                continue
            self._require_free(part.name)
            if part.name in kinds:  # it came with the half before
                continue
            kinds[part.name] = kind_of_part(part, kinds)
            low = _low_half(part, next_part) if self.dialect.phrases["both"] else None
            if low is not None:
                kinds[low.name] = NUMBER
                yield self.say("both", high=part.name, low=low.name, pair=low.pair)
            elif isinstance(part, Stored):
                phrase = "opaque" if part.opaque else "stored"
                yield self.say(phrase, name=part.name, value=part.value, type=self.type_of(NUMBER))
            else:
                words = {"type": self.type_of(kinds[part.name]), "name": part.name, "value": self._value(part)}
                yield self.spelling.declaration.format(**words)

    def _value(self, part: Step | Call | Half) -> str:
        if isinstance(part, Step):
            return value_of(part, self.spelling)
        if isinstance(part, Half):
            return self.say("low" if part.low else "high", pair=part.pair)
        arguments = ", ".join(argument_of(argument, self.spelling) for argument in part.arguments)
        return f"{part.routine.name}({arguments})"

    def _loop(self, loop: Loop, kinds: dict[str, str]) -> Iterator[str]:
        for name, start, _ in loop.kept:
            kinds[name] = NUMBER
            self._require_free(name)
            yield self.say("keep", name=name, value=start)
        table = loop.table
        if table is None:
            yield self.say("loop", times=loop.times)
        else:
            yield self.say("loop over", times=loop.times, table=table.name)
            cells = enumerate(table.columns)
            yield from _indented(self.say("cell", name=name, index=index, table=table.name) for index, name in cells)
        inside = {**kinds, **dict.fromkeys(loop.given, NUMBER)}
        ends = [self.say("keep on", name=name, value=end) for name, _, end in loop.kept]
        until = [] if loop.until is None else self.say("leave if", condition=loop.until).splitlines()
        yield from _indented([*self._parts(loop.body, inside), *ends, *until])
        yield from filter(None, [self.say("end if")])

    def _require_free(self, name: str) -> None:
        if name in self.spelling.reserved:
            raise ValueError(f"{name} is not a name in {self.dialect.name}")

    def _result(self, result: Result) -> Iterator[str]:
        if isinstance(result, str):
            yield self.say("return", value=result)
        elif isinstance(result, tuple):
            high, low = (argument_of(argument, self.spelling) for argument in result)
            yield self.say("return", value=self.say("pair", high=high, low=low))
        else:
            for name, value in result.choices:
                yield from self.say("return if", condition=name, value=value).splitlines()
            yield self.say("return", value=result.otherwise)


def _low_half(part: Part, next_part: Part | None) -> Half | None:
    """The next part, where the two are the halves of one pair, the first number first."""
    if isinstance(part, Half) and isinstance(next_part, Half) and part.pair == next_part.pair:
        return next_part if next_part.low and not part.low else None
    return None


def _broken(head: str) -> Iterator[str]:
    """The lines of a function's head; a line that is too long is broken after commas."""
    for line in head.splitlines():
        inputs = line.split(", ") if len(line) > WIDTH else [line]
        begun, *others = inputs
        for parameter in others:
            if len(begun) + len(parameter) + 3 > WIDTH:
                yield f"{begun},"
                begun = f"{2 * INDENT}{parameter}"
            else:
                begun = f"{begun}, {parameter}"
        yield begun


def _indented(lines: Iterable[str]) -> list[str]:
    return [f"{INDENT}{line}" for line in lines]
