"""Writes hypcheck.h: the parts of this folder put together, with the arithmetic printed from the programs.

    python -m hypcheck.kernel.core.generate

rewrites hypcheck/kernel/core/hypcheck.h; a test compares the committed file with what this prints. In a part, a line
with a name between two @ is replaced by printed text.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from hypcheck.derivation.program import Program, Step, needed
from hypcheck.geometry.pair import COLUMNS, TILTED_COLUMNS
from hypcheck.kernel import clearance_bounds
from hypcheck.kernel.printing.languages import INFIX, Spelling, c_statements, literal, statements
from hypcheck.kernel.programs import certified, fixed, integers, lines, tilted
from hypcheck.version import VERSION

HERE = Path(__file__).parent
TARGET = HERE / "hypcheck.h"
COMMAND = "python -m hypcheck.kernel.core.generate"

CONSTANTS = {
    **certified.CONSTANTS,
    **tilted.CONSTANTS,
    **lines.SPACE_CONSTANTS,
    "u_1536": certified.SINGLE_CONSTANTS["u_1536"],
    "more": lines.MORE,
    "less": lines.LESS,
    "cap": lines.CAP,
    "least_constant": lines.LEAST_CONSTANT,
    "greatest_slope": lines.GREATEST_SLOPE,
    "least_size": lines.LEAST_SIZE,
    "greatest_size": lines.GREATEST_SIZE,
    "least_height": 2.0**-150,
    "greatest_height": 2.0**150,
    **clearance_bounds.CONSTANTS,
}
QUESTIONS = {
    "position": {"plus": "exterior", "minus": "interior", "decided": "decided"},
    "exterior": {"plus": "exterior", "decided": "exterior_decided"},
    "interior": {"plus": "interior", "decided": "interior_decided"},
    "contact": {"plus": "contact", "decided": "decided"},
}
"""Which steps of the line programs answer a question."""

_COMPARISONS = {name: f"HC_{name.upper()}({{0}}, {{1}})" for name in ("gt", "lt", "ge", "le", "and", "or")}
VECTOR = Spelling(
    operations={**INFIX, **_COMPARISONS, "abs": "HC_ABS({0})"},
    number="HC_NUMBER",
    boolean="HC_TRUTH",
    declaration="const {type} {name} = {value};",
    constant=lambda value: f"HC_SET({value}.0)",
)
"""C over vectors of any width: the operators of the compiler, and macros for what they do not cover."""

PLAIN = Spelling(
    operations={**INFIX, "abs": "hc_size({0})"},
    number="double",
    boolean="int",
    declaration="const {type} {name} = {value};",
    constant=literal(),
)
"""C over single doubles, without libm."""

PARTS = (
    "platform",
    "integers",
    "fixed",
    "tangency",
    "tilted_integers",
    "levels",
    "scene",
    "tilted_scene",
    "dispatch",
    "tilted",
    "sweeps",
    "twins",
    "sweep_times",
    "fine_sections",
    "ended_integers",
    "ended",
    "ended_sweeps",
    "near",
)


def header() -> str:
    """The text of hypcheck.h."""
    body = "\n".join(_part(f"{name}.h") for name in PARTS)
    text = (
        f"{_part('contract.h')}\n"
        "#if defined(HYPCHECK_IMPLEMENTATION) && !defined(HC_LEVEL) && !defined(HC_IMPLEMENTED)\n"
        f"#define HC_IMPLEMENTED\n\n{body}\n#if HC_PRECISE\n#pragma float_control(pop)\n#endif\n#endif\n"
        f"#elif defined(HC_LEVEL)\n#define @EDITION@\n\n{_part('level.h')}\n#endif\n"
    )
    return text.replace("@EDITION@", f"HC_EDITION_{hashlib.sha256(text.encode()).hexdigest()[:16]}")


def _part(name: str) -> str:
    text = (HERE / "parts" / name).read_text(encoding="utf-8")
    printed = {key: make() for key, make in _TEXTS.items() if f"@{key}@" in text}
    values = {"COMMAND": COMMAND, "STACK_KILOBYTES": str(kilobytes()), "TILTED_KILOBYTES": str(tilted_kilobytes())}
    values["VERSION"] = VERSION
    return re.sub(r"@(\w+)@", lambda match: values.get(match[1], match[0]), _filled(text, printed))


def _filled(text: str, printed: Mapping[str, Iterable[str]]) -> str:
    """The text with every line that is a name between two @ replaced by the printed lines of that name, indented."""

    def lines_of(match: re.Match[str]) -> str:
        return "\n".join(match[1] + line for line in printed[match[2]])

    return re.sub(r"^( *)@(\w+)@$", lines_of, text, flags=re.MULTILINE)


def _constants() -> list[str]:
    return [f"#define HC_{name} {value!r} /* {value.hex()} */" for name, value in CONSTANTS.items()]


def _set(names: Iterable[str]) -> list[str]:
    return [f"const HC_NUMBER {name} = HC_SET(HC_{name});" for name in names]


def _loaded(columns: Iterable[str]) -> list[str]:
    return [f"const HC_NUMBER {name} = HC_LOAD(columns + {k} * stride + at);" for k, name in enumerate(columns)]


def _first_stage(
    part: str, total: str, constants: Iterable[str], functions: Iterable[tuple[Program, str, str]]
) -> list[str]:
    """The functions of programs of lines.py: of each the program, its name in C, and the question that it answers.

    The struct of a scene keeps K_beyond_1 of the constants as beyond[1].K, and others under their own names. `total`
    is the step whose sum over a block has to be below `cap`.
    """
    text = (HERE / "parts" / part).read_text(encoding="utf-8")
    fields = {name: "{1}[{2}].{0}".format(*name.split("_")) if name[0] in "aKM" else name for name in constants}
    texts = []
    for program, name, question in functions:
        results = QUESTIONS[question]
        wanted = (total, *results.values())
        read = {symbol for step in needed(program, wanted) for symbol in step.reads}
        parts = {
            "FIELDS": [
                f"const HC_NUMBER {symbol} = HC_SET(scene->{at});" for symbol, at in fields.items() if symbol in read
            ],
            "STEPS": statements(program, wanted, VECTOR),
            "RESULTS": [f"found.{field} |= HC_BITS({step}) << at;" for field, step in results.items()],
        }
        texts.append(_filled(text.replace("@NAME@", name).replace("@PROGRAM@", program.name), parts))
    return "\n".join(texts).splitlines()


def _line_functions() -> list[str]:
    programs = (("one_line", lines.ONE_LINE), ("two_lines", lines.TWO_LINES))
    functions = [(program, f"{name}_{question}", question) for name, program in programs for question in QUESTIONS]
    return _first_stage("line_function.h", "R_plus_T", (*lines.LINE_CONSTANTS, "reach"), functions)


def _plane_functions() -> list[str]:
    functions = [(lines.ONE_PLANE, "one_plane", "position"), (lines.TWO_PLANES, "two_planes", "position")]
    constants = (*lines.PLANE_CONSTANTS, *lines.BASIS, "reach")
    return _first_stage("plane_function.h", "distance", constants, functions)


_LIMBED = {
    **{
        operation: f"HC_INTEGER({{name}}, {{bits}}); hc_{call}(&{{name}}, &{{0}}, &{{1}});"
        for operation, call in (("add", "add"), ("sub", "subtract"), ("mul", "multiply"))
    },
    "scale": "HC_INTEGER({name}, {bits}); hc_scale(&{name}, {0}, &{1});",
}
"""Integers that have room of their own."""


def _integers(wanted: tuple[str, ...], known: tuple[str, ...] = ()) -> list[str]:
    return integers.integer_statements(integers.INTEGERS, wanted, _LIMBED, known)


_MOVED = {"p_t": "by_t", "s_t": "by_t", "q_s": "by_q", "p_q": "by_q"}


def _fixed(program: Program, ranges: Mapping[str, fixed.Range], wanted: tuple[str, ...]) -> list[str]:
    """The steps in fixed point, by the functions for the signs that their numbers can have."""
    return [f"const hc_fixed {step.name} = {_fixed_value(step, ranges)};" for step in needed(program, wanted)]


def _fixed_value(step: Step, ranges: Mapping[str, fixed.Range]) -> str:
    left, right = step.arguments
    if step.operation != "mul":
        return f"hc_fixed_{'plus' if step.operation == 'add' else 'minus'}({left}, {right})"
    if isinstance(left, int):
        return f"hc_fixed_times({left}, {right})"
    if left == right:
        return f"hc_fixed_square({left})"
    negative = [str(name) for name in (left, right) if ranges[str(name)].low < 0]
    first, *rest = sorted((str(left), str(right)), key=lambda name: name not in negative)
    return f"hc_fixed_{('', 'signed_', 'both_signed_')[len(negative)]}product({first}, {', '.join(rest)})"


def _fixed_poles(pole: str) -> list[str]:
    """The products with `whole_q` and `whole_t` that it reads, moved as n2 is, and the offset and the slope."""
    wanted = (f"offset_at_{pole}", f"slope_at_{pole}")
    read = {name for step in needed(fixed.POLES, wanted) for name in step.reads}
    ranges = fixed.RANGES["terms"]
    moved = [
        f"const hc_fixed {name} = hc_fixed_down({_fixed_value(fixed.TERMS.step(name), ranges)}, terms->{by});"
        for name, by in _MOVED.items()
        if name in read
    ]
    return moved + _fixed(fixed.POLES, fixed.RANGES["poles"], wanted)


_DELTA = ("delta", "n2", "n1")


def kilobytes() -> int:
    """The most stack for an upright row: the integers, and the functions that call them."""
    limbs = sum(bits // 64 + 2 for bits in integers.bits_counted(integers.INTEGERS).values())
    return -(-(8 * limbs + 24 * 70 + 16 * 1024) // 1024)


KEPT = ("p", "q", "s", "t", "k0", "k1", "k2", *integers.COEFFICIENTS)
"""What hc_quartic_of keeps, in the order of the program."""

CUT_BITS = 128


def pool_bits() -> tuple[int, int]:
    """The most bits that the integers of hc_exact_tilted_position have at any time, and the most numbers these are."""
    quartic = integers.bits_counted(integers.QUARTIC)
    kept = sum(quartic[name] for name in KEPT)
    invariants = _bits_of(integers.INVARIANTS, {name: quartic[name] for name in integers.COEFFICIENTS})
    discriminant = _bits_of(integers.DISCRIMINANT, {name: invariants[name] for name in ("I", "J")})
    phases = (
        sum(quartic.values()),
        kept + 5 * (CUT_BITS + 64) + sum(invariants.values()),
        kept + 5 * (CUT_BITS + 64) + sum(discriminant.values()),
        kept + max(_bits_about_a_pole(quartic)),
    )
    return max(phases), len(integers.QUARTIC.steps) + len(TILTED_COLUMNS)


def tilted_kilobytes() -> int:
    """The most stack for a row whose axis is tilted: the integers, and the functions that call them."""
    bits, numbers = pool_bits()
    return -(-(bits // 8 + 16 * numbers + 24 * 1024) // 1024)


def _bits_of(program: Program, inputs: Mapping[str, int]) -> dict[str, int]:
    bits = integers.bits_counted(program, max(inputs.values()))
    return {**bits, **inputs}


def _bits_about_a_pole(k: Mapping[str, int]) -> list[int]:
    """The bits in use at each step of hc_coefficient_sign and hc_sign_with_root."""
    n, scale = k["k0"] + k["k2"], max(k["k2"], k["q"])
    u, v, power, bits = scale + 3, 0, 1, []
    for name in ("f3", "f2", "f1", "minus_f0"):
        term = k[name] + power
        v_n, v_k1, u_p = v + n, v + k["k1"], u + k["p"]
        next_u, next_v, next_power = max(v_n, term + 3, u_p) + 1, max(u, v_k1) + 1, power + scale
        bits.append(n + u + v + power + 2 * term + 3 + v_n + v_k1 + u_p + next_u + next_v + next_power)
        u, v, power = next_u, next_v, next_power
    U, D = max(u + 2, v + k["k1"]) + 1, max(2 * k["k1"], n + 3) + 1
    bits.append(n + u + v + power + u + 2 + v + k["k1"] + U + 2 * U + 2 * v + 2 * k["k1"] + n + 3 + D + 2 * v + D)
    bits[-1] += max(2 * U, 2 * v + D) + 1
    return bits


_POOLED = {
    "add": "const hc_integer {name} = hc_sum(POOL, &{0}, &{1}, 1);",
    "sub": "const hc_integer {name} = hc_sum(POOL, &{0}, &{1}, -1);",
    "mul": "const hc_integer {name} = hc_product(POOL, &{0}, &{1});",
    "scale": "const hc_integer {name} = hc_multiple(POOL, {0}, &{1});",
}
"""Integers in a pool that all of them share."""


def _pool_statements(program: Program, wanted: tuple[str, ...], pool: str) -> list[str]:
    return [line.replace("POOL", pool) for line in integers.integer_statements(program, wanted, _POOLED)]


def _pool_size() -> list[str]:
    bits, numbers = pool_bits()
    return [
        f"#define HC_CUT_BITS {CUT_BITS}",
        f"#define HC_TILTED_LIMBS ({bits} / HC_LIMB_BITS + {2 * numbers}) /* counted from the programs */",
    ]


def _tilted() -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The program of a row that is tilted, before a multiplier is chosen, and after it."""
    both = statements(tilted.TILTED, ("exterior", "interior", "decided"), VECTOR)
    first = len([step for step in tilted.TILTED.steps if step.name in tilted.BEFORE])
    return both[:first], both[first:]


_TEXTS: dict[str, Callable[[], Iterable[str]]] = {
    "TILTED_POOL": _pool_size,
    "TILTED_QUARTIC": lambda: _pool_statements(integers.QUARTIC, KEPT, "pool"),
    "TILTED_INVARIANTS": lambda: _pool_statements(integers.INVARIANTS, ("I", "J"), "&pool"),
    "TILTED_DISCRIMINANT": lambda: _pool_statements(integers.DISCRIMINANT, ("delta",), "&pool"),
    "TILTED_LEVEL": lambda: _part("tilted_level.h").splitlines(),
    "NEAR_LEVEL": lambda: _part("near_level.h").splitlines(),
    "TILTED_CONSTANTS": lambda: _set(tilted.CONSTANTS),
    "TILTED_INPUTS": lambda: _loaded(tilted.ROW),
    "PLANE_FUNCTIONS": _plane_functions,
    "TILTED_FORM": lambda: _tilted()[0],
    "TILTED_AT_MULTIPLIER": lambda: _tilted()[1],
    "CONSTANTS": _constants,
    "CERTIFIED_CONSTANTS": lambda: _set(certified.CONSTANTS),
    "CERTIFIED_INPUTS": lambda: _loaded(COLUMNS),
    "CERTIFIED": lambda: statements(certified.CERTIFIED, ("exterior", "interior", "decided"), VECTOR),
    "LINE_FUNCTIONS": _line_functions,
    "FIXED_ERRORS": lambda: [f"#define HC_fixed_{name} {value}" for name, value in fixed.ERRORS.items()],
    "FIXED_TERMS": lambda: _fixed(fixed.TERMS, fixed.RANGES["terms"], fixed.TERM_RESULTS),
    "FIXED_DISCRIMINANT": lambda: _fixed(fixed.DISCRIMINANT, fixed.RANGES["discriminant"], ("delta", "middle")),
    "FIXED_AT_B": lambda: _fixed_poles("B"),
    "FIXED_AT_A": lambda: _fixed_poles("A"),
    "TANGENCY_BEFORE": lambda: integers.statements_of(integers.TANGENCY, integers.BEFORE, short=False),
    "TANGENCY_EQUATIONS": lambda: integers.statements_of(
        integers.TANGENCY, integers.EQUATIONS, integers.BEFORE, short=False
    ),
    "TANGENCY_LAST": lambda: integers.statements_of(
        integers.TANGENCY, integers.LAST, (*integers.BEFORE, *integers.EQUATIONS), short=False
    ),
    "TANGENCY_SHORT_BEFORE": lambda: integers.statements_of(integers.TANGENCY, ("D", "K", "inner"), short=True),
    "TANGENCY_SHORT": lambda: integers.statements_of(
        integers.TANGENCY, (*integers.EQUATIONS, *integers.LAST), ("D", "K", "inner"), short=True
    ),
    "WAIST_BEFORE": lambda: integers.statements_of(integers.WAIST, ("W", "opposite", "p_2", "q_2"), short=False),
    "WAIST_EXCESS": lambda: integers.statements_of(
        integers.WAIST, ("excess",), ("W", "opposite", "p_2", "q_2"), short=False
    ),
    "WAIST_SIDES": lambda: integers.statements_of(
        integers.WAIST, ("W_p_2", "room"), ("excess", "W", "opposite"), short=False
    ),
    "INTEGER_INPUTS": lambda: [f"HC_INTEGER({name}, {integers.FLOAT64_BITS});" for name in COLUMNS],
    "INTEGERS": lambda: _integers(_DELTA),
    "INTEGERS_AT_B": lambda: _integers(("offset_at_B", "slope_at_B"), _DELTA),
    "INTEGERS_AT_A": lambda: _integers(("offset_at_A", "slope_at_A"), _DELTA),
    "INTEGERS_OF_RING": lambda: _integers(("slope_at_B", "ring_excess"), _DELTA),
    "SINGLE": lambda: c_statements(certified.SINGLE, certified.SINGLE_RESULTS, number="double"),
    "TANGENT_BEYOND": lambda: c_statements(lines.TANGENT_BEYOND, ("K_most", "M_most", "gap_least")),
    "TANGENT_WITHIN": lambda: c_statements(lines.TANGENT_WITHIN, ("K_least", "M_least", "across_least")),
    "TANGENT_HIGH": lambda: c_statements(lines.TANGENT_HIGH, ("across_least", "fall_most", "M_least")),
    "PIECE": lambda: statements(lines.PIECE, ("here", "slope", "bend", "size"), PLAIN),
    "CHORD": lambda: c_statements(lines.CHORD, ("below", "above")),
}


if __name__ == "__main__":
    TARGET.write_text(header(), encoding="utf-8")
