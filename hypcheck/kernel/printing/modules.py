"""Writes the Python modules of kernel/printed, as core/generate.py writes hypcheck.h.

python -m hypcheck.kernel.printing.modules
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from hypcheck.derivation.program import Program, needed
from hypcheck.kernel.printing.in_place import in_place_statements
from hypcheck.kernel.printing.python import python_statements
from hypcheck.kernel.programs import certified, lines, parallel_lines, single
from hypcheck.pairs import CENTER, COLUMNS

FOLDER = Path(__file__).parents[1] / "printed"
COMMAND = "python -m hypcheck.kernel.printing.modules"
INDENT = "    "


def modules() -> dict[str, str]:
    """The text of each module by its file name."""
    return {"chunks.py": _chunks(), "scalars.py": _scalars()}


def _chunks() -> str:
    wanted = ("R_plus_T", "exterior", "interior", "decided")
    return _module(
        "The line stage and the certified stage over chunks of rows, in buffers that the caller keeps.",
        [
            "from collections.abc import Mapping, Sequence",
            "",
            "import numpy as np",
            "from numpy.typing import NDArray",
            "",
            "Floats = NDArray[np.float64]",
            "Singles = NDArray[np.float32]",
            "Mask = NDArray[np.bool_]",
        ],
        [
            _in_place("plane", parallel_lines.PLANE, ("R", "T"), dict.fromkeys(CENTER, "Floats"), single=True),
            _in_place(
                "parallel_lines",
                parallel_lines.PARALLEL_LINES,
                wanted[1:],
                {"R": "Singles", "T": "Singles"},
                single=True,
            ),
            _in_place("two_lines", lines.TWO_LINES, wanted, dict.fromkeys(CENTER, "Floats")),
            _in_place("certified", certified.CERTIFIED, wanted[1:], dict.fromkeys(COLUMNS, "Floats")),
        ],
    )


def _in_place(
    name: str, program: Program, wanted: tuple[str, ...], arrays: Mapping[str, str], *, single: bool = False
) -> list[str]:
    """The function of that name; `arrays` has the types of its inputs. Buffers are float32 where `single` is set."""
    numbers = "Singles" if single else "Floats"
    copied = tuple(each for each, kind in arrays.items() if kind != numbers)
    printed = in_place_statements(program, wanted, copied)
    read = {each for step in needed(program, wanted) for each in step.reads}
    constants = [each for each in program.inputs if each not in arrays and each in read]
    counts = {"n": printed.numbers, "t": printed.truths}
    buffers = {letter: [f"{letter}{k}" for k in range(count)] for letter, count in counts.items()}
    results = [printed.place[each] for each in wanted]
    kinds = [numbers if place.startswith("n") else "Mask" for place in results]
    upper = name.upper()
    unpacked = {
        letter: ", ".join(each) if len(each) > 1 else f"({each[0]},)" for letter, each in buffers.items() if each
    }
    return [
        f"{upper}_BUFFERS = ({printed.numbers}, {printed.truths})",
        f'"""How many buffers of numbers and of truth values {name} needs."""',
        "",
        "",
        f"def {name}(",
        *(f"{INDENT}{each}: {kind}," for each, kind in arrays.items()),
        *([f"{INDENT}constants: Mapping[str, float],"] if constants else []),
        f"{INDENT}numbers: Sequence[{numbers}],",
        *([f"{INDENT}truths: Sequence[Mask],"] if buffers["t"] else []),
        f") -> tuple[{', '.join(kinds)}]:",
        f'{INDENT}"""{", ".join(wanted)} of the program "{program.name}"; they lie in the buffers."""',
        *(f'{INDENT}{each} = constants["{each}"]' for each in constants),
        f"{INDENT}{unpacked['n']} = numbers",
        *([f"{INDENT}{unpacked['t']} = truths"] if buffers["t"] else []),
        *(f"{INDENT}{line}" for line in printed.statements),
        f"{INDENT}return {', '.join(results)}",
    ]


def _scalars() -> str:
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
            _function("single", single.SINGLE, single.RESULTS),
            _function("tangent_beyond", lines.TANGENT_BEYOND, ("K_most", "M_most", "gap_least")),
            _function("tangent_within", lines.TANGENT_WITHIN, ("K_least", "M_least", "across_least")),
            _function("chord", lines.CHORD, ("below", "above")),
        ],
    )


def _function(name: str, program: Program, wanted: tuple[str, ...]) -> list[str]:
    kind = "bool" if name == "chord" else "float"
    of_lines = {"u_8": lines.U_8, "more": lines.MORE, "less": lines.LESS}
    constants = single.CONSTANTS if program is single.SINGLE else of_lines
    given = [each for each in program.inputs if each not in constants]
    read = {each for step in needed(program, wanted) for each in step.reads}
    return [
        f"def {name}({', '.join(f'{each}: float' for each in given)}) -> tuple[{kind}, ...]:",
        f'{INDENT}"""{", ".join(wanted)} of the program "{program.name}"."""',
        *(f"{INDENT}{each} = {constants[each]!r}  # {constants[each].hex()}" for each in constants if each in read),
        *(f"{INDENT}{line}" for line in python_statements(program, wanted)),
        f"{INDENT}return {', '.join(wanted)}",
    ]


def _module(summary: str, imports: Iterable[str], functions: Iterable[list[str]]) -> str:
    head = [f'"""{summary}', "", f"Printed by `{COMMAND}`. Change the programs, not this.", '"""', ""]
    head += [
        "# ruff: noqa: PLR0915",
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
