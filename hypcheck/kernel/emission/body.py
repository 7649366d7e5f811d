"""A setting's function in any language: the stages of its plan, one after the other, until one answers."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from math import isfinite

import numpy as np

from hypcheck.kernel.emission.costs import needs_side, thresholds_asked
from hypcheck.kernel.emission.dialects import Dialect
from hypcheck.kernel.emission.header import notes
from hypcheck.kernel.emission.statements import Statements
from hypcheck.kernel.specialise.centre import CENTRE
from hypcheck.kernel.specialise.discriminant import Discriminant
from hypcheck.kernel.specialise.plan import ONE_SIDED, Plan, Stages
from hypcheck.kernel.specialise.search import Search
from hypcheck.pairs import Position
from hypcheck.rows import CANNOT_SAY
from hypcheck.scene.model import Span

INDENT = "    "


def answer(position: Position, question: str) -> int:
    """What a position is answered with: itself, or 1 for yes and 0 for no."""
    return int(position) if question == "position" else int(position is Position[question.upper()])


def function(plan: Plan, stages: Stages, place: int, dialect: Dialect) -> str:
    """The function of the setting at this place, from the first line to the last."""
    parts = list(_Body(plan, stages, place, dialect).lines())
    read = set(re.findall(r"\w+", "\n".join(parts)))
    unused = (dialect.say("unused", name=name) for name in "xyz" if name not in read)
    lines = [line for part in (*unused, *parts) for line in part.splitlines() or [""]]
    heads = [dialect.say("note", text=line) for line in notes(plan, stages)]
    indented = [f"{INDENT}{line}" if line else "" for line in (*heads, *lines)]
    begin = dialect.say("begin", place=place, number=dialect.number_of(plan.format.name))
    return "\n".join([begin, *indented, dialect.say("end")]).rstrip()


def beyond_height(cut: Span, precision: str, literal: Callable[[float], str]) -> Iterator[str]:
    """The conditions under which z is beyond the modelled height; an end that the format does not reach has none.

    Rounding is monotone: no z within the height is beyond the rounded ends once it is rounded itself.
    """
    with np.errstate(over="ignore", under="ignore"):
        ends = [float(np.dtype(precision).type(end)) for end in (cut.low, cut.high)]
    for sign, end in zip("<>", ends, strict=True):
        if isfinite(end):
            yield f"z {sign} {literal(end)}"


def beyond_threshold(position: Position, threshold: str) -> str:
    """The condition under which R is on this position's side of its threshold."""
    return f"R {'>' if position is Position.EXTERIOR else '<'} {threshold}"


class _Body(Statements):
    """The statements of one function."""

    def __init__(self, plan: Plan, stages: Stages, place: int, dialect: Dialect) -> None:
        super().__init__(plan, stages, dialect)
        self._place = place

    def lines(self) -> Iterator[str]:
        stages = self._stages
        if stages.setting.cut is not None:
            yield self._note("beyond the modelled height")
            for beyond in beyond_height(stages.setting.cut, self._precision, self._literal):
                yield self._say("return if", condition=beyond, value=CANNOT_SAY)
        if stages.always is not None:
            yield self._say("return", value=answer(stages.always, self._question))
        elif stages.thresholds is not None:
            yield from self._thresholds()
        else:
            yield from self._stages_in_turn()

    def _thresholds(self) -> Iterator[str]:
        asked = thresholds_asked(self._stages, self._question)
        if asked:
            yield from self._entry(("R",))
        for position, threshold in asked:
            yield self._return_if(beyond_threshold(position, self._literal(threshold)), position)
        yield self._say("return", value=answer(Position.CONTACT, self._question))

    def _stages_in_turn(self) -> Iterator[str]:
        stages = self._stages
        yield from self._entry(("R", "zz", "height") if stages.search is not None else ("R", "zz"))
        for line in stages.lines:
            yield ""
            yield self._note(f"lambda = {float(line.multiplier)!r} proves {line.side.name.lower()} beyond this line")
            yield from self._constants(line.constants)
            yield from self._printed(line.program, (line.holds,))
            yield self._return_if(line.holds, line.side)
        yield ""
        yield from self._too_far()
        if needs_side(stages, self._question):
            yield ""
            yield from self._centre()
        if stages.discriminant is not None:
            yield ""
            yield from self._discriminant()
        if stages.search is not None:
            yield ""
            yield self._say("return", value=self._searched())

    def _too_far(self) -> Iterator[str]:
        last = self._stages.search
        if last is not None:
            yield self._note("so far out, or no number, that something overflows")
            yield self._say("return if", condition=self._say("not", value=f"({self._within(last)})"), value=CANNOT_SAY)

    def _within(self, stage: Discriminant | Search) -> str:
        widest, highest = self._literal(stage.widest), self._literal(stage.highest)
        return self._say("and", left=f"R <= {widest}", right=f"zz <= {highest}")

    def _centre(self) -> Iterator[str]:
        yield self._note("the side of the centre")
        yield from self._constants(self._stages.centre)
        yield from self._printed(CENTRE, ("outside",))
        if self._question in ONE_SIDED:
            never = "outside" if self._question == "interior" else self._say("not", value="outside")
            yield self._say("return if", condition=never, value=0)

    def _discriminant(self) -> Iterator[str]:
        delta = self._stages.discriminant
        assert delta is not None  # noqa: S101 - the caller has looked
        yield self._note("the sign of three times the discriminant, where it is certain")
        yield from self._constants(delta.constants)
        yield from self._printed(delta.program, ("delta_3",))
        bound = self._literal(delta.bound)
        near, below = self._within(delta), f"delta_3 < -{bound}"
        if not delta.clear_where_positive:
            yield self._return_if(self._say("and", left=near, right=below), Position.CONTACT)
            return
        above = self._say("return if", condition=f"delta_3 > {bound}", value=self._clear())
        yield self._say("if", condition=near)
        for part in (self._return_if(below, Position.CONTACT), above):
            yield from (f"{INDENT}{line}" for line in part.splitlines())
        yield from filter(None, [self._say("end if")])

    def _clear(self) -> str:
        """The answer about a clear spheroid, once `outside` is known where it matters."""
        if self._question == "position":
            return self._say("select", condition="outside", left="1", right="-1")
        return "0" if self._question == "contact" else "1"

    def _searched(self) -> str:
        call = self._say("search", place=self._place)
        compared = {"exterior": f"{call} > 0", "interior": f"{call} < 0", "contact": f"{call} == 0"}
        if self._question == "position":
            return call
        return self._say("truth", condition=compared[self._question])

    def _return_if(self, condition: str, position: Position) -> str:
        return self._say("return if", condition=condition, value=answer(position, self._question))

    def _note(self, text: str) -> str:
        return self._say("note", text=text)
