"""Routines printed in each language: a head, a statement for each part, and a result.

A language says in its phrases (dialects.py) how a function begins and ends, how a number is kept from round to round,
and what a loop and a call are; nothing here knows a language. Steps are printed as those of programs are.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from hypcheck.derivation.program import NUMBER, Step, kind_of
from hypcheck.derivation.routines import Answer, Loop, Part, Routine, called, needed_parts, result_names
from hypcheck.kernel.emission.dialects import Dialect
from hypcheck.kernel.printing.languages import Spelling, argument_of, declared, spelling_of, value_of

INDENT = "    "
WIDTH = 120


def routines_text(routine: Routine, dialect: Dialect, precision: str) -> str:
    """The record of the routine, the routines that it calls, and itself.

    Raises ValueError for a name that the language reserves.
    """
    printer = _Printer(dialect, precision)
    texts = [printer.text(each) for each in (*called(routine), routine)]
    between = "\n\n\n" if dialect.name == "python" else "\n\n"
    fields = "\n".join(f"{INDENT}{printer.say('record field', name=name)}" for name in routine.record)
    record = printer.say("record", fields=fields) if routine.record else ""
    return between.join(filter(None, [record, *texts])) + "\n"


@dataclass(frozen=True)
class _Printer:
    dialect: Dialect
    precision: str

    @property
    def spelling(self) -> Spelling:
        """How the language writes steps."""
        return spelling_of(self.dialect.name, self.dialect.number_of(self.precision))

    def say(self, phrase: str, **words: object) -> str:
        """A phrase of the language."""
        return self.dialect.say(phrase, number=self.dialect.number_of(self.precision), **words)

    def text(self, routine: Routine) -> str:
        """The function."""
        parts = needed_parts(routine.parts, result_names(routine.result))
        inputs = ", ".join(self.say("input", name=name) for name in routine.inputs)
        unpacked = [self.say("unpack", name=name) for name in routine.record]
        if routine.record:
            inputs += self.say(
                "given record", inputs=", ".join(self.say("input", name=name) for name in routine.record)
            )
        gives = "answer" if isinstance(routine.result, Answer) else routine.gives
        head = self.say(f"function of {gives}", name=routine.name, inputs=inputs, meaning=routine.meaning)
        kinds = dict.fromkeys((*routine.inputs, *routine.record), NUMBER)
        body = [*filter(None, unpacked), *self._parts(parts, kinds), *self._result(routine.result)]
        return "\n".join([*_broken(head), *_indented(body), *filter(None, [self.say("end")])])

    def _parts(self, parts: Iterable[Part], kinds: dict[str, str]) -> Iterator[str]:
        """The statements; `kinds`, of the names before, gets those of the names that they make."""
        for part in parts:
            if isinstance(part, Loop):
                yield from self._loop(part, kinds)
                continue
            if isinstance(part, Step):
                kinds[part.name], value = kind_of(part, kinds), value_of(part, self.spelling)
            else:
                given = ", ".join(argument_of(argument, self.spelling) for argument in part.arguments)
                kinds[part.name], value = part.routine.gives, f"{part.routine.name}({given})"
            self._require_free(part.name)
            yield declared(part.name, kinds[part.name], value, self.spelling)

    def _loop(self, loop: Loop, kinds: dict[str, str]) -> Iterator[str]:
        for name, start, _ in loop.kept:
            kinds[name] = NUMBER
            self._require_free(name)
            yield self.say("keep", name=name, value=start)
        yield self.say("loop", times=loop.times)
        ends = [self.say("keep on", name=name, value=end) for name, _, end in loop.kept]
        yield from _indented([*self._parts(loop.body, dict(kinds)), *ends])
        yield from filter(None, [self.say("end if")])

    def _require_free(self, name: str) -> None:
        if name in self.spelling.reserved:
            raise ValueError(f"{name} is no name in {self.dialect.name}")

    def _result(self, result: str | Answer) -> Iterator[str]:
        if isinstance(result, str):
            yield self.say("return", value=result)
            return
        for name, value in result.choices:
            yield from self.say("return if", condition=name, value=value).splitlines()
        yield self.say("return", value=result.otherwise)


def _broken(head: str) -> Iterator[str]:
    """The lines of a head, one that is too long as several, each of which ends behind a comma."""
    for line in head.splitlines():
        inputs = line.split(", ") if len(line) > WIDTH else [line]
        begun, *others = inputs
        for each in others:
            if len(begun) + len(each) + 3 > WIDTH:
                yield f"{begun},"
                begun = f"{2 * INDENT}{each}"
            else:
                begun = f"{begun}, {each}"
        yield begun


def _indented(lines: Iterable[str]) -> list[str]:
    return [f"{INDENT}{line}" for line in lines]
