"""Prints the modules in kernel/printed: numpy statements over reused buffers, and scalar Python.

    python -m hypcheck.kernel.printing.modules

writes them again; a test compares the committed files with what this prints.

Each step becomes one call of a ufunc of numpy, over a chunk of rows. It writes into a buffer that is used again as soon
as its value has been read for the last time. Temporary arrays make a numpy expression slow: memory is allocated, filled
and read back for each one. The buffers of a chunk stay in the cache. Each call is one IEEE operation, so this is the
program's arithmetic to the bit.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from hypcheck.derivation.program import NUMBER, Program, Step, kind_of, line_of, needed
from hypcheck.geometry.pair import CENTER, COLUMNS, TILTED_COLUMNS
from hypcheck.kernel.printing.languages import statements_in
from hypcheck.kernel.programs import certified, lines, tilted

_UFUNCS = {
    "add": "np.add",
    "sub": "np.subtract",
    "mul": "np.multiply",
    "div": "np.divide",
    "neg": "np.negative",
    "abs": "np.absolute",
    "sqrt": "np.sqrt",
    "gt": "np.greater",
    "lt": "np.less",
    "ge": "np.greater_equal",
    "le": "np.less_equal",
    "eq": "np.equal",
    "ne": "np.not_equal",
    "and": "np.logical_and",
    "or": "np.logical_or",
    "not": "np.logical_not",
}


@dataclass(frozen=True, slots=True)
class InPlace:
    """Statements over buffers: n0, n1, … hold numbers and t0, t1, … truth values.

    `numbers` and `truths` are how many of each there are. `place` has the buffer of each wanted name.
    """

    statements: tuple[str, ...]
    numbers: int
    truths: int
    place: dict[str, str]


def in_place_statements(program: Program, wanted: tuple[str, ...], copied: tuple[str, ...] = ()) -> InPlace:
    """Return the needed steps of the program as calls of ufuncs on arrays of one shape.

    The inputs are in scope under their own names, as arrays or floats, and are left as they are; a step that depends
    on floats alone would still fill a buffer. The inputs in `copied` are first put into a buffer, rounded to its type.
    Raises ValueError for a selection, and KeyError for a name that is not there.
    """
    steps = needed(program, wanted)
    last_read = {name: index for index, step in enumerate(steps) for name in step.reads}
    kinds = dict.fromkeys(program.inputs, NUMBER)
    place: dict[str, str] = {}
    free: dict[str, list[str]] = {"n": [], "t": []}
    made = {"n": 0, "t": 0}
    lines = []

    def buffer(name: str, letter: str) -> str:
        if not free[letter]:
            free[letter].append(f"{letter}{made[letter]}")
            made[letter] += 1
        place[name] = free[letter].pop()
        return place[name]

    for index, step in enumerate(steps):
        kinds[step.name] = kind_of(step, kinds)
        new = [name for name in dict.fromkeys(step.reads) if name in copied and name not in place]
        lines += [f'np.copyto({buffer(name, "n")}, {name}, casting="same_kind")' for name in new]
        arguments = _arguments(step, place)
        for name in dict.fromkeys(step.reads):
            if last_read[name] == index and name not in wanted and name in place:
                free[place[name][0]].append(place[name])
        target = buffer(step.name, "n" if kinds[step.name] == NUMBER else "t")
        lines.append(f"{_ufunc(program, step)}({arguments}, {target})  # {line_of(step)}")
    return InPlace(tuple(lines), made["n"], made["t"], {name: place[name] for name in wanted})


def _ufunc(program: Program, step: Step) -> str:
    """Return the ufunc of a step. Raises ValueError for an operation without one."""
    if step.operation not in _UFUNCS:
        raise ValueError(f"program {program.name}: step {step.name}: there is no ufunc in place for {step.operation}")
    return _UFUNCS[step.operation]


def _arguments(step: Step, place: dict[str, str]) -> str:
    """Return the arguments of a step: buffers, inputs, and integers as floats."""
    return ", ".join(place.get(a, a) if isinstance(a, str) else f"{a}.0" for a in step.arguments)


FOLDER = Path(__file__).parents[1] / "printed"
COMMAND = "python -m hypcheck.kernel.printing.modules"
INDENT = "    "


def modules() -> dict[str, str]:
    """Return the text of each module by its file name."""
    return {"chunks.py": _chunks(), "scalars.py": _scalars(), "tilted.py": _tilted()}


_ARRAYS = (
    "from collections.abc import Mapping, Sequence",
    "",
    "import numpy as np",
    "from numpy.typing import NDArray",
    "",
    "Floats = NDArray[np.float64]",
    "Mask = NDArray[np.bool_]",
)


def _chunks() -> str:
    """Return the text of chunks.py."""
    wanted = ("R_plus_T", "exterior", "interior", "decided")
    return _module(
        "The line stage and the certified stage over chunks of rows, in buffers that the caller keeps.",
        [*_ARRAYS, "Singles = NDArray[np.float32]"],
        [
            _in_place("plane", lines.PLANE, ("R", "T"), dict.fromkeys(CENTER, "Floats"), single=True),
            _in_place(
                "parallel_lines",
                lines.PARALLEL_LINES,
                wanted[1:],
                {"R": "Singles", "T": "Singles"},
                single=True,
            ),
            _in_place("two_lines", lines.TWO_LINES, wanted, dict.fromkeys(CENTER, "Floats")),
            _in_place("certified", certified.CERTIFIED, wanted[1:], dict.fromkeys(COLUMNS, "Floats")),
        ],
    )


def _tilted() -> str:
    """Return the text of tilted.py."""
    form = ("p", "s", "t", "k0", "k1", "m", "radius", "height", "cross_squared", "level")
    row = dict.fromkeys(TILTED_COLUMNS, "Floats")
    return _module(
        "The stage of tilted rows over chunks, in buffers that the caller keeps.",
        _ARRAYS,
        [
            _in_place("tilted_form", tilted.VALUES, form, row),
            _in_place("tilted", tilted.TILTED, ("exterior", "interior", "decided"), {**row, "l": "Floats"}),
        ],
        ignored="E741, PLR0915",
    )


def _in_place(
    name: str, program: Program, wanted: tuple[str, ...], arrays: Mapping[str, str], *, single: bool = False
) -> list[str]:
    """Return the lines of a function over chunks; `arrays` has the types of its inputs.

    With `single` its buffers of numbers are float32.
    """
    numbers = "Singles" if single else "Floats"
    copied = tuple(symbol for symbol, kind in arrays.items() if kind != numbers)
    printed = in_place_statements(program, wanted, copied)
    read = {symbol for step in needed(program, wanted) for symbol in step.reads}
    constants = [symbol for symbol in program.inputs if symbol not in arrays and symbol in read]
    counts = {"n": printed.numbers, "t": printed.truths}
    buffers = {letter: [f"{letter}{k}" for k in range(count)] for letter, count in counts.items()}
    results = [printed.place[symbol] for symbol in wanted]
    kinds = [numbers if place.startswith("n") else "Mask" for place in results]
    upper = name.upper()
    return [
        f"{upper}_BUFFERS = ({printed.numbers}, {printed.truths})",
        f'"""How many buffers of numbers and of truth values {name} needs."""',
        "",
        "",
        f"def {name}(",
        *(f"{INDENT}{symbol}: {kind}," for symbol, kind in arrays.items()),
        *([f"{INDENT}constants: Mapping[str, float],"] if constants else []),
        f"{INDENT}numbers: Sequence[{numbers}],",
        *([f"{INDENT}truths: Sequence[Mask],"] if buffers["t"] else []),
        f") -> tuple[{', '.join(kinds)}]:",
        f'{INDENT}"""{", ".join(wanted)} of "{program.name}"; they lie in the buffers."""',
        *(f'{INDENT}{symbol} = constants["{symbol}"]' for symbol in constants),
        *_unpacked(buffers["n"], "numbers"),
        *_unpacked(buffers["t"], "truths"),
        *(f"{INDENT}{line}" for line in printed.statements),
        f"{INDENT}return {', '.join(results)}",
    ]


ON_A_LINE = 20
"""How many buffers one line unpacks at most."""


def _unpacked(names: Sequence[str], source: str) -> Iterator[str]:
    """Yield the lines that give the buffers their names."""
    if 1 < len(names) <= ON_A_LINE:
        yield f"{INDENT}{', '.join(names)} = {source}"
    elif len(names) == 1:
        yield f"{INDENT}({names[0]},) = {source}"
    else:
        for start in range(0, len(names), ON_A_LINE):
            some = names[start : start + ON_A_LINE]
            yield f"{INDENT}{', '.join(some)} = {source}[{start}:{start + len(some)}]"


def _scalars() -> str:
    """Return the text of scalars.py."""
    return _module(
        "Programs over Python's floats: one pair, and the constants of a scene's half planes.",
        [
            *(
                f"{name.upper()} = 2.0**{exponent}"
                for name, exponent in (("least", -100), ("greatest", 100), ("farthest", 200))
            ),
            '"""Where the bounds of `single` hold: b, d, A and B lie between, and P + Q is below FARTHEST."""',
            "",
            f"SLACK = {certified.SLACK!r}  # 1 + 2**-20",
        ],
        [
            _function("single", certified.SINGLE, certified.SINGLE_RESULTS),
            _function("tangent_beyond", lines.TANGENT_BEYOND, ("K_most", "M_most", "gap_least")),
            _function("tangent_within", lines.TANGENT_WITHIN, ("K_least", "M_least", "across_least")),
            _function("chord", lines.CHORD, ("below", "above")),
        ],
    )


def _function(name: str, program: Program, wanted: tuple[str, ...]) -> list[str]:
    """Return the lines of a scalar function."""
    kind = "bool" if name == "chord" else "float"
    of_lines = {"u_8": lines.U_8, "more": lines.MORE, "less": lines.LESS}
    constants = certified.SINGLE_CONSTANTS if program is certified.SINGLE else of_lines
    parameters = [symbol for symbol in program.inputs if symbol not in constants]
    read = {symbol for step in needed(program, wanted) for symbol in step.reads}
    return [
        f"def {name}({', '.join(f'{symbol}: float' for symbol in parameters)}) -> tuple[{kind}, ...]:",
        f'{INDENT}"""{", ".join(wanted)} of the program "{program.name}"."""',
        *(
            f"{INDENT}{symbol} = {constants[symbol]!r}  # {constants[symbol].hex()}"
            for symbol in constants
            if symbol in read
        ),
        *(f"{INDENT}{line}" for line in statements_in("python", program, wanted)),
        f"{INDENT}return {', '.join(wanted)}",
    ]


def _module(summary: str, imports: Iterable[str], functions: Iterable[list[str]], ignored: str = "PLR0915") -> str:
    """Return the text of a module; `ignored` has the rules of the linter that do not hold in it."""
    head = [f'"""{summary}', "", f"Printed by `{COMMAND}`. Change the programs, not this.", '"""', ""]
    head += [
        f"# ruff: noqa: {ignored}",
        "",
        "from __future__ import annotations",
        "",
        *imports,
    ]
    bodies = ["\n".join(function) for function in functions]
    return "\n".join(head).rstrip() + "\n\n\n" + "\n\n\n".join(bodies) + "\n"


if __name__ == "__main__":
    for file_name, module_text in modules().items():
        (FOLDER / file_name).write_text(module_text, encoding="utf-8")
