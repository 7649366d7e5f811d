"""Many centres of one setting at once, in C and C++: the stages as loops without branches, block by block.

The first loop asks the lines, the second, where they leave a centre of the block open, the discriminant; what is open
after that goes to the setting's function one by one. After an open block the lines are passed over for a while: where
centres are spread all over a region, nearly every block is open, and along a path hardly any.
"""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.kernel.emission.body import answer, beyond_height, beyond_threshold
from hypcheck.kernel.emission.costs import thresholds_asked
from hypcheck.kernel.emission.dialects import Dialect
from hypcheck.kernel.emission.statements import Statements
from hypcheck.kernel.specialise.centre import CENTRE
from hypcheck.kernel.specialise.plan import ONE_SIDED, Plan, Stages
from hypcheck.pairs import Position
from hypcheck.rows import CANNOT_SAY

BLOCK = 256
PASSED_OVER = 15
"""Blocks that go straight to the discriminant after an open one."""

OPEN = 3
"""The code of a centre that is not decided yet."""

_MANY = """static void many_{place}(size_t n, const double *all_x, const double *all_y, const double *all_z,
                         int8_t *positions)
{{
    int pass_over = 0;
    for (size_t start = 0; start < n; start += {block}) {{
        const double *xs = all_x + start, *ys = all_y + start, *zs = all_z + start;
        const size_t count = n - start < {block} ? n - start : {block};
        {number} code[{block}];
        if (pass_over > 0) {{
            for (size_t i = 0; i < count; i++) code[i] = {open};
        }} else {{
            for (size_t i = 0; i < count; i++) {{
{first}
            }}
        }}
        int left = any_open(code, count);
{second}        for (size_t i = 0; i < count; i++) positions[start + i] = (int8_t)code[i];
        if (left) {{
            for (size_t i = 0; i < count; i++)
                if (code[i] == {open})
                    positions[start + i] = (int8_t)position_{place}(({number})xs[i], ({number})ys[i], ({number})zs[i]);
        }}
    }}
}}"""

_SECOND = """        if (left) {{
            pass_over = pass_over > 0 ? pass_over - 1 : {passed};
            for (size_t i = 0; i < count; i++) {{
{body}
            }}
            left = any_open(code, count);
        }}
"""


def many(plan: Plan, stages: Stages, place: int, dialect: Dialect) -> str:
    """The function for many centres of the setting at this place."""
    batch = _Batch(plan, stages, dialect)
    second = "\n".join(batch.second())
    words = {"place": place, "block": BLOCK, "number": dialect.number_of(plan.format.name), "open": batch.code(OPEN)}
    loop = _SECOND.format(body=_indented(second), passed=PASSED_OVER) if second else ""
    return _MANY.format(**words, first=_indented("\n".join(batch.first())), second=loop)


def _indented(text: str) -> str:
    return "\n".join(f"                {line}" if line else "" for line in text.splitlines())


class _Batch(Statements):
    """The bodies of the two loops of one setting."""

    def code(self, value: int) -> str:
        """An answer, or OPEN, as a number: comparisons and selections of one type become vectors."""
        return self._dialect.literal(float(value), self._precision)

    def first(self) -> Iterator[str]:
        """Everything that costs a few operations; what it leaves is OPEN."""
        stages, choices, rest = self._stages, self._beyond_height(), OPEN
        yield from self._centre_read(("x", "y", "z"))
        if stages.always is not None:
            rest = answer(stages.always, self._question)
        elif stages.thresholds is not None:
            if thresholds_asked(stages, self._question):
                yield from self._entry(("R",))
            choices += self._thresholds()
            rest = answer(Position.CONTACT, self._question)
        elif stages.lines or self._question in ONE_SIDED:
            yield from self._entry(("R", "zz"))
            for line in stages.lines:
                yield from self._constants(line.constants)
                yield from self._printed(line.program, (line.holds,))
                choices.append((line.holds, answer(line.side, self._question)))
            if self._question in ONE_SIDED:
                if stages.search is not None:
                    widest, highest = self._literal(stages.search.widest), self._literal(stages.search.highest)
                    choices.append((f"!((R <= {widest}) & (zz <= {highest}))", CANNOT_SAY))
                yield from self._side()
                choices.append(("outside" if self._question == "interior" else "!outside", 0))
        yield f"code[i] = {self._chosen(choices, self.code(rest))};"

    def second(self) -> Iterator[str]:
        """The discriminant, for those that are open."""
        delta = self._stages.discriminant
        if delta is None:
            return
        yield f"const {self._number} before = code[i];"
        yield from self._centre_read(("x", "y", "z"))
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
        told = self.code(OPEN)
        if delta.clear_where_positive:
            yield f"const {self._truth} clear = within & (delta_3 > {bound});"
            yield f"const {self._number} told = clear ? {clear} : {told};"
            told = "told"
        yield f"const {self._number} now = touching ? {self.code(answer(Position.CONTACT, self._question))} : {told};"
        yield f"const {self._number} here = before == {self.code(OPEN)} ? now : before;"
        yield f"code[i] = {self._chosen(self._beyond_height(), 'here')};"

    @property
    def _truth(self) -> str:
        return "bool" if self._dialect.name == "cpp" else "int"

    def _centre_read(self, names: tuple[str, ...]) -> Iterator[str]:
        for name in names:
            yield f"const {self._number} {name} = ({self._number}){name}s[i];"
        yield " ".join(f"(void){name};" for name in names)

    def _beyond_height(self) -> list[tuple[str, int]]:
        cut = self._stages.setting.cut
        if cut is None:
            return []
        beyond = (f"({each})" for each in beyond_height(cut, self._precision, self._literal))
        return [(" | ".join(beyond) or "0", CANNOT_SAY)]

    def _thresholds(self) -> Iterator[tuple[str, int]]:
        for position, threshold in thresholds_asked(self._stages, self._question):
            yield beyond_threshold(position, self._literal(threshold)), answer(position, self._question)

    def _chosen(self, choices: list[tuple[str, int]], rest: str) -> str:
        text = rest
        for condition, value in reversed(choices):
            text = f"({condition}) ? {self.code(value)} : ({text})"
        return text

    def _side(self) -> Iterator[str]:
        yield from self._constants(self._stages.centre)
        yield from self._printed(CENTRE, ("outside",))
