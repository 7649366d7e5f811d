"""Arithmetic of double-double as routines: a number is a pair, the sum of two doubles, the second a rest of the first.

The sum and the product of two doubles are exact as pairs (Knuth; Dekker, who splits a double into halves of 26 bits).
The other algorithms are from Joldes, Muller and Popescu, ACM TOMS 44, 2017; tilted.py uses their error bounds. Where
an FMA would skip a rounding on which the next step relies, the number is stored, which rounds it.
"""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.derivation.program import Argument, Program, Step, needed, steps_of
from hypcheck.derivation.routines import Call, Half, Part, Routine, Stored


def halves(*pairs: str) -> tuple[Half, ...]:
    """Return the parts that take each pair apart: a pair called `one` into one_high and one_low."""
    return tuple(Half(f"{pair}_{'low' if low else 'high'}", pair, low) for pair in pairs for low in (False, True))


def _quick_sum(name: str, large: str, small: str) -> tuple[Part, ...]:
    """Return the steps to the sum of two doubles, `name`_high, and its error, `name`_low; `small` is not the larger."""
    return steps_of(
        f"""
        {name}_high = {large} + {small}
        {name}_added = {name}_high - {large}
        {name}_low = {small} - {name}_added
        """
    )


def _exact_sum(name: str, one: str, other: str) -> tuple[Part, ...]:
    """Return the steps to the sum of any two doubles, `name`_high, and its rounding error, `name`_low."""
    return steps_of(
        f"""
        {name}_high = {one} + {other}
        {name}_shadow = {name}_high - {one}
        {name}_near_one = {name}_high - {name}_shadow
        {name}_rest_of_one = {one} - {name}_near_one
        {name}_rest_of_other = {other} - {name}_shadow
        {name}_low = {name}_rest_of_one + {name}_rest_of_other
        """
    )


def _split(number: str) -> tuple[Part, ...]:
    """Return the parts that split a double: `number`_top, its 26 leading bits, and `number`_end, the rest.

    They read the constant `splitter`.
    """
    return (
        *steps_of(f"{number}_times = splitter * {number}"),
        Stored(f"{number}_spread", f"{number}_times"),
        *steps_of(
            f"""
            {number}_beyond = {number}_spread - {number}
            {number}_top = {number}_spread - {number}_beyond
            {number}_end = {number} - {number}_top
            """
        ),
    )


def _exact_product(name: str, one: str, other: str) -> tuple[Part, ...]:
    """Return the parts to the product of two doubles, `name`_high, and its error, `name`_low; both are split before."""
    return (
        *steps_of(f"{name}_times = {one} * {other}"),
        Stored(f"{name}_high", f"{name}_times"),
        *steps_of(
            f"""
            {name}_tops = {one}_top * {other}_top
            {name}_error_1 = {name}_tops - {name}_high
            {name}_top_end = {one}_top * {other}_end
            {name}_error_2 = {name}_error_1 + {name}_top_end
            {name}_end_top = {one}_end * {other}_top
            {name}_error_3 = {name}_error_2 + {name}_end_top
            {name}_ends = {one}_end * {other}_end
            {name}_low = {name}_error_3 + {name}_ends
            """
        ),
    )


def _sum(first: tuple[str, str], second: tuple[str, str]) -> tuple[Part, ...]:
    """Return the steps to the sum of two double-doubles, total_high and total_low."""
    return (
        *_exact_sum("highs", first[0], second[0]),
        *_exact_sum("lows", first[1], second[1]),
        *steps_of("carried = highs_low + lows_high"),
        *_quick_sum("both", "highs_high", "carried"),
        *steps_of("rest = both_low + lows_low"),
        *_quick_sum("total", "both_high", "rest"),
    )


_TOTAL = ("total_high", "total_low")
_TWO = frozenset({"one", "other"})
_ONE = frozenset({"value"})
_SPLITTER = {"splitter": 2.0**27 + 1}

WHOLE = Routine("whole", "A double as a double-double.", ("value",), (), ("value", 0))

SQUARE = Routine(
    "exact_square",
    "The square of a double and its rounding error.",
    ("value",),
    (*_split("value"), *_exact_product("square", "value", "value")),
    ("square_high", "square_low"),
    constants=_SPLITTER,
)

QUICK_SUM = Routine(
    "quick_sum",
    "The sum of two doubles and its rounding error, the first not the smaller one.",
    ("large", "small"),
    _quick_sum("total", "large", "small"),
    _TOTAL,
)

NEGATED = Routine(
    "dd_neg",
    "The number with the other sign.",
    ("value",),
    (*halves("value"), *steps_of("high = - value_high\n low = - value_low")),
    ("high", "low"),
    pairs=_ONE,
)

SUM = Routine(
    "dd_add",
    "The sum.",
    ("one", "other"),
    (*halves("one", "other"), *_sum(("one_high", "one_low"), ("other_high", "other_low"))),
    _TOTAL,
    pairs=_TWO,
)

DIFFERENCE = Routine(
    "dd_sub",
    "The difference.",
    ("one", "other"),
    (
        *halves("one", "other"),
        *steps_of("less_high = - other_high\n less_low = - other_low"),
        *_sum(("one_high", "one_low"), ("less_high", "less_low")),
    ),
    _TOTAL,
    pairs=_TWO,
)

PRODUCT = Routine(
    "dd_mul",
    "The product.",
    ("one", "other"),
    (
        *halves("one", "other"),
        *_split("one_high"),
        *_split("other_high"),
        *_exact_product("highs", "one_high", "other_high"),
        *steps_of(
            """
            high_low = one_high * other_low
            low_high = one_low * other_high
            crossed = high_low + low_high
            rest = highs_low + crossed
            """
        ),
        *_quick_sum("total", "highs_high", "rest"),
    ),
    _TOTAL,
    pairs=_TWO,
    constants=_SPLITTER,
)

QUOTIENT = Routine(
    "dd_div",
    "The quotient.",
    ("one", "other"),
    (
        *halves("one", "other"),
        *steps_of("first = one_high / other_high"),
        Call("nearly", WHOLE, ("first",)),
        Call("times", PRODUCT, ("nearly", "other")),
        Call("rest", DIFFERENCE, ("one", "times")),
        *halves("rest"),
        *steps_of("more = rest_high / other_high"),
        Call("quotient", QUICK_SUM, ("first", "more")),
    ),
    "quotient",
    pairs=_TWO,
)

SIZE = Routine(
    "dd_abs",
    "The number without its sign.",
    ("value",),
    (
        *halves("value"),
        *steps_of("is_negative = value_high < 0"),
        Call("negated", NEGATED, ("value",)),
        *steps_of("size = is_negative ? negated : value"),
    ),
    "size",
    pairs=_ONE,
)

ROOT = Routine(
    "dd_sqrt",
    "The root; 0 of what is not above 0.",
    ("value",),
    (
        *halves("value"),
        *steps_of("is_positive = value_high > 0\n square = is_positive ? value_high : 1\n first = sqrt square"),
        Call("times", SQUARE, ("first",)),
        Call("rest", DIFFERENCE, ("value", "times")),
        *halves("rest"),
        *steps_of("twice_first = first + first\n more = rest_high / twice_first"),
        Call("nearly", QUICK_SUM, ("first", "more")),
        Call("nothing", WHOLE, (0,)),
        *steps_of("root = is_positive ? nearly : nothing"),
    ),
    "root",
    pairs=_ONE,
)

_CALLED = {
    "add": SUM, "sub": DIFFERENCE, "mul": PRODUCT, "div": QUOTIENT, "neg": NEGATED, "abs": SIZE, "sqrt": ROOT,
}  # fmt: skip


def in_double_double(program: Program, wanted: tuple[str, ...]) -> tuple[Part, ...]:
    """Return the parts that compute the wanted names of a program in double-double, from inputs that are pairs.

    Comparisons compare the first numbers of the pairs.
    """
    return tuple(part for step in needed(program, wanted) for part in _parts_of(step))


def _parts_of(step: Step) -> Iterator[Part]:
    """Yield the parts that compute a step in double-double; integers become pairs first."""
    if step.operation == "select":
        yield step
        return
    compared = step.operation not in _CALLED
    arguments: list[Argument] = []
    for place, argument in enumerate(step.arguments):
        if isinstance(argument, int) and not compared:
            arguments.append(f"{step.name}_{place}")
            yield Call(f"{step.name}_{place}", WHOLE, (argument,))
        elif isinstance(argument, str) and compared:
            arguments.append(f"{step.name}_{place}")
            yield Half(f"{step.name}_{place}", argument)
        else:
            arguments.append(argument)
    if compared:
        yield Step(step.name, step.operation, tuple(arguments))
    else:
        yield Call(step.name, _CALLED[step.operation], tuple(arguments))
