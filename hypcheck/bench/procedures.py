"""The paper's procedures for a quadcopter, and a certified one, in numpy and in C: whether its body or its rotors fit.

They are asked about positions of the body, with the cosine and the sine of its heading, in one tower. Procedure 2.a
asks all four rotors. Procedure 2.b asks the bounding spheroid first, and the rotors only if Δ ≤ 0. The certified
procedure asks the bounding spheroid by the certified path, and the rotors if it is in contact. Their answers differ:
2.a never asks whether the body fits. Both procedures of the paper exist as printed and repaired. In C a procedure
answers one position per call, as a craft does before each move.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache, partial
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from hypcheck.derivation.evaluation import Evaluator
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS, REPAIRED
from hypcheck.derivation.program import Program, split
from hypcheck.geometry.rows import Floats
from hypcheck.implementations.method import Answers, in_chunks
from hypcheck.kernel import numpy_kernel
from hypcheck.kernel.emission.dialects import filled
from hypcheck.kernel.printing.languages import c_statements

CRAFT = ("alpha", "gamma", "b", "d", "b_s", "d_s", "l")
"""Numbers that are constant along a flight: the tower, the body, its rotors, and the length of its arms."""

MOVING = ("x", "y", "z", "cosine", "sine")


@dataclass(frozen=True)
class CraftPath:
    """Positions of a craft and its headings: (n,) each, x, y, z in metres."""

    craft: Mapping[str, float]
    x: Floats
    y: Floats
    z: Floats
    cosine: Floats
    sine: Floats

    def __len__(self) -> int:
        return len(self.x)

    def part(self, places: slice | NDArray[np.intp]) -> CraftPath:
        """Return some of the positions."""
        return CraftPath(self.craft, *(getattr(self, name)[places] for name in MOVING))

    @property
    def columns(self) -> dict[str, Floats]:
        """The columns that change along the flight, by name."""
        return {name: getattr(self, name) for name in MOVING}


PRINTED, PUT_RIGHT = False, True
"""Whether a procedure is as printed, or repaired (REPAIRED in derivation/formulas.py)."""


@cache
def hull_programs(repaired: bool = PRINTED) -> tuple[Program, Program]:
    """Return procedure 2.b's steps for every position, `hull_steps`: before the flight, and in it."""
    formula = REPAIRED["procedure-2b-repaired"] if repaired else FORMULAS["procedure-2b"]
    return split(formula.program, hull_steps(repaired), CRAFT)


def hull_steps(repaired: bool = PRINTED) -> tuple[str, str]:
    """Return the steps that decide whether the rotors must be tested, and the answer if not."""
    return ("unclear" if repaired else "touching"), "inside"


@cache
def rotor_programs(repaired: bool = PRINTED) -> tuple[Program, Program]:
    """Return procedure 2.a: its steps before the flight, and in it."""
    formula = REPAIRED["procedure-2a-repaired"] if repaired else FORMULAS["procedure-2a"]
    fixed = tuple(name for name in CRAFT if name in formula.program.inputs)
    return split(formula.program, ("valid",), fixed)


def procedure_2a(flight: CraftPath, repaired: bool = PRINTED) -> Answers:
    """Return 1 if the procedure calls the movement valid, else 0; int8 (n,)."""
    rotors = _rotors(flight, repaired)
    return in_chunks(len(flight), lambda part: rotors(flight.part(part).columns)[0])


def procedure_2b(
    flight: CraftPath, on_rotors: Callable[[CraftPath], object] = lambda _: None, repaired: bool = PRINTED
) -> Answers:
    """Return the answers of Procedure 2.b, which asks the rotors only for some positions.

    Calls `on_rotors` with these.
    """
    hull = _loop_body(hull_programs(repaired), hull_steps(repaired), flight)
    rotors = _rotors(flight, repaired)

    def chunk(part: slice) -> Answers:
        here = flight.part(part)
        touching, inside = hull(here.columns)
        answers = np.asarray(inside).astype(np.int8)
        places = np.flatnonzero(touching)
        if len(places):
            on_rotors(left := here.part(places))
            answers[places] = rotors(left.columns)[0]
        return answers

    return in_chunks(len(flight), chunk)


def certified(flight: CraftPath) -> Answers:
    """Return 1 if the body is interior, or its four rotors are: exact except for the rounded centres of the rotors."""
    alpha, gamma, b, d, b_s, d_s, l = (flight.craft[name] for name in CRAFT)  # noqa: E741 - the paper's letter
    answers = np.zeros(len(flight), dtype=np.int8)
    hull = numpy_kernel.positions_of_scene((alpha, gamma, b, d), flight.x, flight.y, flight.z)
    answers[hull == -1] = 1
    places = np.flatnonzero(hull == 0)
    left = flight.part(places)
    fits = np.ones(len(places), dtype=bool)
    for across, aside in rotors_at(left.cosine, left.sine, l):
        rotor = numpy_kernel.positions_of_scene((alpha, gamma, b_s, d_s), left.x + across, left.y + aside, left.z)
        fits &= rotor == -1
    answers[places[fits]] = 1
    return answers


def rotors_at(cosine: Floats, sine: Floats, arm: float) -> list[tuple[Floats, Floats]]:
    """Return the offsets from the body's centre to those of its rotors, equation (15): x and y for each of the four."""
    half = arm * np.sqrt(2.0) / 2.0
    along, across = half * (cosine - sine), half * (cosine + sine)
    return [(along, across), (-across, along), (-along, -across), (across, -along)]


def _rotors(flight: CraftPath, repaired: bool) -> Evaluator:
    """Return the evaluator of Procedure 2.a for a flight."""
    return _loop_body(rotor_programs(repaired), ("valid",), flight)


def _loop_body(programs: tuple[Program, Program], wanted: tuple[str, ...], flight: CraftPath) -> Evaluator:
    """Return the second program in float64, with the values that the first computes from the craft."""
    first, then = programs
    names, arithmetic = tuple(step.name for step in first.steps), float_arithmetic("float64")
    known = Evaluator(first, arithmetic, names)(flight.craft)
    return Evaluator(then, arithmetic, wanted, {**flight.craft, **dict(zip(names, known, strict=True))})


PROCEDURES: Mapping[str, Callable[[CraftPath], Answers]] = MappingProxyType(
    {
        "procedure-2a": procedure_2a,
        "procedure-2b": procedure_2b,
        "certified": certified,
        "procedure-2a-repaired": partial(procedure_2a, repaired=PUT_RIGHT),
        "procedure-2b-repaired": partial(procedure_2b, repaired=PUT_RIGHT),
    }
)
"""The procedures by name, in numpy."""


def procedures_source() -> str:
    """Return the procedures in C.

    Hypcheck.h and math.h must be included before. templates/methods.c.tmpl has their driver.
    """
    before = _before("hull", hull_programs()[0]) + _before("rotors", rotor_programs()[0])
    return before + "".join(_both())


def _both() -> Iterator[str]:
    """Yield the printed and the repaired procedures, which store the same numbers of a craft."""
    for repaired, prefix in ((PRINTED, ""), (PUT_RIGHT, "repaired_")):
        in_contact, inside = hull_steps(repaired)
        (hull_before, hull), (rotor_before, rotors) = hull_programs(repaired), rotor_programs(repaired)
        yield _asked(f"{prefix}rotors", rotor_before, rotors, ("valid",), "return valid;")
        yield _asked(f"{prefix}hull", hull_before, hull, (in_contact, inside), f"return {in_contact} ? 2 : {inside};")
        yield filled("hypcheck.bench", "procedures.c.tmpl", {"prefix": prefix})


def _before(name: str, program: Program) -> str:
    """Return the steps that depend only on the craft, stored in an array.

    A real program would store them in a structure.
    """
    names = [step.name for step in program.steps]
    stored = "\n".join(f"    k[{place}] = {name};" for place, name in enumerate(names))
    statements = "\n".join(f"    {line}" for line in c_statements(program, tuple(names)))
    return f"\nstatic void {name}_before(const double *craft, double *k)\n{{\n{_craft()}\n{statements}\n{stored}\n}}\n"


def _asked(name: str, before: Program, program: Program, wanted: tuple[str, ...], end: str) -> str:
    """Return a function in C that asks one position: constants, inputs, statements, then `end`."""
    read = {name for step in program.steps for name in step.reads}
    constants = "\n".join(
        f"    const double {step.name} = k[{place}];" for place, step in enumerate(before.steps) if step.name in read
    )
    inputs = _craft(read)
    statements = "\n".join(f"    {line}" for line in c_statements(program, wanted))
    moving = ", ".join(f"double {name}" for name in MOVING)
    unused = "".join(f"    (void){name};\n" for name in MOVING if name not in read)
    return (
        f"\nstatic int {name}_asked(const double *craft, const double *k, {moving})\n"
        f"{{\n    (void)craft;\n{unused}{inputs}\n{constants}\n{statements}\n    {end}\n}}\n"
    )


def _craft(read: set[str] | None = None) -> str:
    """Return the C declarations of the craft's numbers that are read; None: all."""
    named = [(place, name) for place, name in enumerate(CRAFT) if read is None or name in read]
    fields = "\n".join(f"    const double {name} = craft[{place}];" for place, name in named)
    return fields + "".join(f"\n    (void){name};" for _, name in named)
