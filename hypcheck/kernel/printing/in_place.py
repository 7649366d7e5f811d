"""numpy over chunks: a ufunc call a step, into buffers that are used again as soon as their value has been read.

Temporaries are what makes a numpy expression slow: each is memory to find, to fill and to read back. A chunk's buffers
stay in the cache. Each call is one IEEE operation, so this is the program's arithmetic to the bit.
"""

from __future__ import annotations

from dataclasses import dataclass

from hypcheck.derivation.listing import line_of
from hypcheck.derivation.program import NUMBER, Program, Step, kind_of, needed

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
    """Statements over buffers n0, n1, … of numbers and t0, t1, … of truth values.

    `place` says in which buffer each wanted name is found.
    """

    statements: tuple[str, ...]
    numbers: int
    truths: int
    place: dict[str, str]


def in_place_statements(program: Program, wanted: tuple[str, ...], copied: tuple[str, ...] = ()) -> InPlace:
    """The needed part of the program as calls of ufuncs on arrays of one shape.

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
    if step.operation not in _UFUNCS:
        raise ValueError(f"program {program.name}: step {step.name}: there is no ufunc in place for {step.operation}")
    return _UFUNCS[step.operation]


def _arguments(step: Step, place: dict[str, str]) -> str:
    return ", ".join(place.get(a, a) if isinstance(a, str) else f"{a}.0" for a in step.arguments)
