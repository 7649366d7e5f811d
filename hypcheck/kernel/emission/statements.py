"""Statements that every writer of a setting's code needs: constants, and programs printed in the language."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from hypcheck.derivation.program import Program, needed
from hypcheck.kernel.emission.dialects import Dialect
from hypcheck.kernel.specialise.plan import Plan, Stages


class Statements:
    """A setting's stages, written in one language and number format for the plan's question."""

    def __init__(self, plan: Plan, stages: Stages, dialect: Dialect) -> None:
        self._question, self._precision = plan.question, plan.format.name
        self._stages, self._dialect = stages, dialect
        self._number = dialect.number_of(self._precision)

    def _entry(self, wanted: tuple[str, ...]) -> Iterator[str]:
        """What the stages are asked with, out of x, y and z, and the constants that this takes."""
        program, constants = self._stages.entry, self._stages.entry_constants
        read = {name for step in needed(program, wanted) for name in step.reads}
        yield from self._constants({name: value for name, value in constants.items() if name in read})
        yield from self._printed(program, wanted)

    def _constants(self, constants: Mapping[str, float]) -> Iterator[str]:
        for name, value in constants.items():
            yield self._say("constant", name=name, value=self._literal(value))

    def _printed(self, program: Program, wanted: tuple[str, ...]) -> tuple[str, ...]:
        return self._dialect.printer(program, wanted, self._number)

    def _literal(self, value: float) -> str:
        return self._dialect.literal(value, self._precision)

    def _say(self, phrase: str, **words: object) -> str:
        return self._dialect.say(phrase, **{"number": self._number, **words})
