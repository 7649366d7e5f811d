"""Writes the functions of a setting: one for one centre, in any language, and one for many centres, in C and C++.

A setting is one pair of sizes: one spheroid beside one hyperboloid (specialise/settings.py).

The function for one centre runs the stages of the plan in their order. The first stage that decides gives the answer.

The function for many centres runs the stages as loops without branches, a block of centres at a time. The first loop
tests the lines. If they leave a centre of the block undecided, a second loop computes the discriminant. Centres that
are undecided after that go to the setting's function one by one. After a block with an undecided centre, the next
blocks skip the lines: where centres are spread all over a region, nearly every block has one, and along a path hardly
any.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from math import isfinite

import numpy as np

from hypcheck.derivation.program import Program, needed
from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.kernel.emission.dialects import INDENT, Dialect
from hypcheck.kernel.emission.plan_text import needs_side, notes, thresholds_asked
from hypcheck.kernel.specialise.first_stages import CENTRE, Thresholds
from hypcheck.kernel.specialise.last_stages import Discriminant, DualSearch, TiltedSearch
from hypcheck.kernel.specialise.plan import ONE_SIDED, ScenePlan, Stages


def answer(position: Position, question: str) -> int:
    """Return the answer about a spheroid in this position: the position, or 1 for yes and 0 for no."""
    return int(position) if question == "position" else int(position is Position[question.upper()])


def setting_function(plan: ScenePlan, stages: Stages, place: int, dialect: Dialect, *, shared: bool = False) -> str:
    """Return the text of the function for one setting; `place` is the number in the function's name.

    If `shared`, several settings share the function. It then takes two more arguments: c, the numbers of one setting,
    and s, the number of that setting. Its head has no comment about one setting.
    """
    parts = list(_Body(plan, stages, place, dialect).lines())
    read = set(re.findall(r"\w+", "\n".join(parts)))
    parameters = ("x", "y", "z", *(("axis",) if plan.free else ()), *(("c", "s") if shared else ()))
    unused = (dialect.say("unused", name=name) for name in parameters if name not in read)
    lines = [line for part in (*unused, *parts) for line in part.splitlines() or [""]]
    heads = [] if shared else [dialect.say("note", text=line) for line in notes(plan, stages)]
    indented = [f"{INDENT}{line}" if line else "" for line in (*heads, *lines)]
    axis = dialect.axis["axis"] if plan.free else ""
    begin = dialect.say("begin", place=place, number=dialect.number_of(plan.format.name), axis=axis)
    return "\n".join([begin, *indented, dialect.say("end")]).rstrip()


class _Statements:
    """Writes the stages of a setting in one language and number format, for the plan's question."""

    def __init__(self, plan: ScenePlan, stages: Stages, dialect: Dialect) -> None:
        self._question, self._precision = plan.question, plan.format.name
        self._stages, self._dialect = stages, dialect
        self._number = dialect.number_of(self._precision)

    def _entry(self, wanted: tuple[str, ...]) -> Iterator[str]:
        """Yield the statements from x, y and z to the wanted inputs of the stages, after the constants they read."""
        program, constants = self._stages.entry, self._stages.entry_constants
        read = {name for step in needed(program, wanted) for name in step.reads}
        yield from self._constants({name: value for name, value in constants.items() if name in read})
        yield from self._printed(program, wanted)

    def _constants(self, constants: Mapping[str, float]) -> Iterator[str]:
        """Yield a declaration for each constant."""
        for name, value in constants.items():
            yield self._say("constant", name=name, value=self._literal(value))

    def _printed(self, program: Program, wanted: tuple[str, ...]) -> tuple[str, ...]:
        """Return a statement for each step of the program that the wanted names need."""
        return self._dialect.statements(program, wanted, self._precision)

    def _literal(self, value: float) -> str:
        """Return the number as the language writes it in the plan's format."""
        return self._dialect.literal(value, self._precision)

    def _beyond_height(self) -> list[str]:
        """Return a condition for each end of the modelled height: z is beyond that end.

        An end that overflows in the format has no condition.

        Rounding is monotone: no z within the height is beyond the rounded ends once it is rounded itself.
        """
        cut = self._stages.setting.cut
        if cut is None:
            return []
        with np.errstate(over="ignore", under="ignore"):
            ends = [float(np.dtype(self._precision).type(end)) for end in (cut.low, cut.high)]
        return [f"z {sign} {self._literal(end)}" for sign, end in zip("<>", ends, strict=True) if isfinite(end)]

    def _beyond_thresholds(self) -> Iterator[tuple[str, int]]:
        """Yield, for each threshold, the condition that R is on its position's side, and the answer there."""
        for position, threshold in thresholds_asked(self._stages, self._question):
            sign = ">" if position is Position.EXTERIOR else "<"
            yield f"R {sign} {self._literal(threshold)}", answer(position, self._question)

    def _side(self) -> Iterator[str]:
        """Yield the statements that compute `outside`: whether the centre lies outside the hyperboloid."""
        yield from self._constants(self._stages.centre)
        yield from self._printed(CENTRE, ("outside",))

    def _say(self, phrase: str, **words: object) -> str:
        """Return a phrase of the language with its words filled in."""
        return self._dialect.say(phrase, **{"number": self._number, **words})


class _Body(_Statements):
    """Writes the statements of the function for one centre."""

    def __init__(self, plan: ScenePlan, stages: Stages, place: int, dialect: Dialect) -> None:
        super().__init__(plan, stages, dialect)
        self._place = place

    def lines(self) -> Iterator[str]:
        """Yield all statements, from the test of the height to the last answer."""
        stages = self._stages
        if stages.setting.cut is not None:
            yield self._note("beyond the modelled height")
            for beyond in self._beyond_height():
                yield self._say("return_if", condition=beyond, value=CANNOT_SAY)
        if isinstance(stages.last, Position):
            yield self._say("return", value=answer(stages.last, self._question))
        elif isinstance(stages.last, Thresholds):
            yield from self._thresholds()
        else:
            yield from self._stages_in_turn(stages.last)

    def _thresholds(self) -> Iterator[str]:
        """Yield the statements for one fixed height: R is compared with each threshold; all else is contact."""
        conditions = list(self._beyond_thresholds())
        if conditions:
            yield from self._entry(("R",))
        for condition, value in conditions:
            yield self._say("return_if", condition=condition, value=value)
        yield self._say("return", value=answer(Position.CONTACT, self._question))

    def _stages_in_turn(self, search: DualSearch | TiltedSearch) -> Iterator[str]:
        """Yield the statements of all stages in order: lines, limits, the centre's side, discriminant, search."""
        stages = self._stages
        yield from self._entry(("R", "zz", "height") if isinstance(search, DualSearch) else ("R", "zz"))
        for line in stages.lines:
            yield ""
            yield self._note(f"lambda = {float(line.multiplier)!r} proves {line.side.name.lower()} beyond this line")
            yield from self._constants(line.constants)
            yield from self._printed(line.program, (line.holds,))
            yield self._return_if(line.holds, line.side)
        yield ""
        yield self._note("so far out, or no number, that something overflows")
        yield self._say("return_if", condition=self._say("not", value=f"({self._within(search)})"), value=CANNOT_SAY)
        if needs_side(stages, self._question):
            yield ""
            yield from self._centre()
        if stages.discriminant is not None:
            yield ""
            yield from self._discriminant(stages.discriminant)
        yield ""
        yield from self._searched(search)

    def _within(self, stage: Discriminant | DualSearch | TiltedSearch) -> str:
        """Return the condition that R and zz are within the limits up to which the stage holds."""
        widest, highest = self._literal(stage.widest), self._literal(stage.highest)
        return self._say("and", left=f"R <= {widest}", right=f"zz <= {highest}")

    def _centre(self) -> Iterator[str]:
        """Yield the statements that compute the centre's side; a one-sided question is answered no on the other."""
        yield self._note("the side of the centre")
        yield from self._side()
        if self._question in ONE_SIDED:
            never = "outside" if self._question == "interior" else self._say("not", value="outside")
            yield self._say("return_if", condition=never, value=0)

    def _discriminant(self, delta: Discriminant) -> Iterator[str]:
        """Yield the statements that compute the discriminant and answer where its sign is certain."""
        yield self._note("the sign of three times the discriminant, where it is certain")
        yield from self._constants(delta.constants)
        yield from self._printed(delta.program, ("delta_3",))
        bound = self._literal(delta.bound)
        near, below = self._within(delta), f"delta_3 < -{bound}"
        if not delta.clear_where_positive:
            yield self._return_if(self._say("and", left=near, right=below), Position.CONTACT)
            return
        above = self._say("return_if", condition=f"delta_3 > {bound}", value=self._clear())
        yield self._say("if", condition=near)
        for part in (self._return_if(below, Position.CONTACT), above):
            yield from (f"{INDENT}{line}" for line in part.splitlines())
        yield from filter(None, [self._say("end_if")])

    def _clear(self) -> str:
        """Return the expression for the answer about a clear spheroid; for positions it reads `outside`."""
        if self._question == "position":
            return self._say("select", condition="outside", left="1", right="-1")
        return "0" if self._question == "contact" else "1"

    def _searched(self, search: DualSearch | TiltedSearch) -> Iterator[str]:
        """Yield the statements that call the search and turn its result into the answer to the question."""
        if isinstance(search, TiltedSearch):
            answer = self._say("free_search" if search.free else "fixed_search", place=self._place)
        else:
            answer = self._say("search", place=self._place)
        if self._question == "position":
            yield self._say("return", value=answer)
            return
        if isinstance(search, TiltedSearch):  # it may not settle a centre, which is no answer to any question
            yield self._say("found", value=answer)
            answer = "found"
            yield self._say("return_if", condition=f"{answer} == {CANNOT_SAY}", value=CANNOT_SAY)
        compared = {"exterior": f"{answer} > 0", "interior": f"{answer} < 0", "contact": f"{answer} == 0"}
        yield self._say("return", value=self._say("truth", condition=compared[self._question]))

    def _return_if(self, condition: str, position: Position) -> str:
        """Return the statement that answers for this position if the condition holds."""
        return self._say("return_if", condition=condition, value=answer(position, self._question))

    def _note(self, text: str) -> str:
        """Return a comment."""
        return self._say("note", text=text)


BLOCK = 256
"""Centres in a block."""

PASSED_OVER = 15
"""After a block with an undecided centre, so many blocks skip the lines and go straight to the discriminant."""

OPEN = 3
"""The code of a centre that is not decided yet."""


def batch_function(plan: ScenePlan, stages: Stages, place: int, dialect: Dialect) -> str:
    """Return the text of the function for many centres of a setting; `place` is the number in the function's name."""
    batch, number = _Batch(plan, stages, dialect), dialect.number_of(plan.format.name)
    second = "\n".join(batch.second())
    words = {
        "place": str(place),
        "number": number,
        "block": str(BLOCK),
        "open": batch.code(OPEN),
        "centre": ", ".join(f"({number}){name}s[i]" for name in "xyz"),
        **{name: dialect.axis[name] if plan.free else "" for name in ("axis", "given")},
        "first": "\n".join(batch.first()),
        "second": dialect.filled("many_open", {"passed": str(PASSED_OVER), "body": second}) if second else "",
    }
    return dialect.filled("many", words).rstrip()


class _Batch(_Statements):
    """Writes the statements for many centres: a quick first loop, and a second one for centres that are still OPEN."""

    def code(self, value: int) -> str:
        """Return an answer, or OPEN, as a number of the format: compilers make vectors of code with one type only."""
        return self._dialect.literal(float(value), self._precision)

    def first(self) -> Iterator[str]:
        """Yield the statements of the first loop: all tests that cost a few operations. Undecided centres are OPEN."""
        stages, choices, rest = self._stages, self._unmodelled(), OPEN
        yield from self._centre_read()
        if isinstance(stages.last, Position):
            rest = answer(stages.last, self._question)
        elif isinstance(stages.last, Thresholds):
            conditions = list(self._beyond_thresholds())
            if conditions:
                yield from self._entry(("R",))
            choices += conditions
            rest = answer(Position.CONTACT, self._question)
        elif stages.lines or self._question in ONE_SIDED:
            yield from self._entry(("R", "zz"))
            for line in stages.lines:
                yield from self._constants(line.constants)
                yield from self._printed(line.program, (line.holds,))
                choices.append((line.holds, answer(line.side, self._question)))
            if self._question in ONE_SIDED:
                widest, highest = self._literal(stages.last.widest), self._literal(stages.last.highest)
                choices.append((f"!((R <= {widest}) & (zz <= {highest}))", CANNOT_SAY))
                yield from self._side()
                choices.append(("outside" if self._question == "interior" else "!outside", 0))
        yield f"code[i] = {self._chosen(choices, self.code(rest))};"

    def second(self) -> Iterator[str]:
        """Yield the statements of the second loop, the discriminant for OPEN centres; none if the setting has none."""
        delta = self._stages.discriminant
        if delta is None:
            return
        yield f"const {self._number} before = code[i];"
        yield from self._centre_read()
        yield from self._entry(("R", "zz"))
        clear = self.code(0)
        if self._question != "contact" and delta.clear_where_positive:
            yield from self._side()
            sides = (answer(side, self._question) for side in (Position.EXTERIOR, Position.INTERIOR))
            clear = "(outside ? {} : {})".format(*map(self.code, sides))
        yield from self._constants(delta.constants)
        yield from self._printed(delta.program, ("delta_3",))
        bound, widest, highest = map(self._literal, (delta.bound, delta.widest, delta.highest))
        yield f"const {self._truth} within = (R <= {widest}) & (zz <= {highest});"
        yield f"const {self._truth} touching = within & (delta_3 < -{bound});"
        rest = self.code(OPEN)
        if delta.clear_where_positive:
            yield f"const {self._truth} clear = within & (delta_3 > {bound});"
            yield f"const {self._number} told = clear ? {clear} : {rest};"
            rest = "told"
        yield f"const {self._number} now = touching ? {self.code(answer(Position.CONTACT, self._question))} : {rest};"
        yield f"const {self._number} here = before == {self.code(OPEN)} ? now : before;"
        yield f"code[i] = {self._chosen(self._unmodelled(), 'here')};"

    @property
    def _truth(self) -> str:
        """The type of truth values."""
        return "bool" if self._dialect.name == "cpp" else "int"

    def _centre_read(self) -> Iterator[str]:
        """Yield the statements that read x, y and z of centre i."""
        for name in "xyz":
            yield f"const {self._number} {name} = ({self._number}){name}s[i];"
        yield "(void)x; (void)y; (void)z;"

    def _unmodelled(self) -> list[tuple[str, int]]:
        """Return the condition that z is beyond the modelled height, with the answer there; [] without such a test."""
        if self._stages.setting.cut is None:
            return []
        return [(" | ".join(f"({condition})" for condition in self._beyond_height()) or "0", CANNOT_SAY)]

    def _chosen(self, choices: list[tuple[str, int]], rest: str) -> str:
        """Return the expression for the value of the first condition that holds, else `rest`."""
        text = rest
        for condition, value in reversed(choices):
            text = f"({condition}) ? {self.code(value)} : ({text})"
        return text
