"""A formula as a straight-line program: a list of steps, each one rounded operation, in the order of evaluation.

Evaluation, operation counts, rounding bounds, proofs and printed kernels all read this one object, so what is proved
is what runs. A program has no loops and no branches: every step is evaluated, and a decision is a `select`.

In its written form, the listing, a program has one step a line:

    h1 = c2_squared - three_c1      two arguments, with one of + - * / > < >= <= == != and or between them
    root = sqrt h1                  one argument, after one of - abs sqrt not cos arccos
    side = inside ? -1 : 0          select: the condition, the value if it holds, the value if not
    # a remark

Nothing nests: what is written is what is rounded, and in that order.

`hoist` and `split` take the steps that depend on the sizes alone out of the loop over centres, as the paper's Table 2
does; `loop_body` of evaluation.py evaluates what stays inside.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable
from dataclasses import dataclass

NUMBER = "number"
BOOLEAN = "boolean"

Argument = str | int
"""An argument of a step: the name of an input or of an earlier step, or an integer constant."""

LARGEST_CONSTANT = 2048
"""Integers up to 2¹¹ are exact in binary16 and in every wider format (not in bfloat16 beyond 2⁸): none is rounded."""


@dataclass(frozen=True, slots=True)
class Operation:
    """One operation: the kind of each argument, the kind of the result, its sign in a listing.

    `counted` is the field of Operations that counts it; a change of the sign bit alone is not counted.
    """

    takes: tuple[str, ...]
    gives: str
    sign: str
    counted: str | None = None


OPERATIONS = {
    "add": Operation((NUMBER, NUMBER), NUMBER, "+", "additions"),
    "sub": Operation((NUMBER, NUMBER), NUMBER, "-", "additions"),
    "mul": Operation((NUMBER, NUMBER), NUMBER, "*", "multiplications"),
    "div": Operation((NUMBER, NUMBER), NUMBER, "/", "divisions"),
    "neg": Operation((NUMBER,), NUMBER, "-"),
    "abs": Operation((NUMBER,), NUMBER, "abs"),
    "sqrt": Operation((NUMBER,), NUMBER, "sqrt", "square_roots"),
    "gt": Operation((NUMBER, NUMBER), BOOLEAN, ">", "comparisons"),
    "lt": Operation((NUMBER, NUMBER), BOOLEAN, "<", "comparisons"),
    "ge": Operation((NUMBER, NUMBER), BOOLEAN, ">=", "comparisons"),
    "le": Operation((NUMBER, NUMBER), BOOLEAN, "<=", "comparisons"),
    "eq": Operation((NUMBER, NUMBER), BOOLEAN, "==", "comparisons"),
    "ne": Operation((NUMBER, NUMBER), BOOLEAN, "!=", "comparisons"),
    "and": Operation((BOOLEAN, BOOLEAN), BOOLEAN, "and", "logical"),
    "or": Operation((BOOLEAN, BOOLEAN), BOOLEAN, "or", "logical"),
    "not": Operation((BOOLEAN,), BOOLEAN, "not", "logical"),
    # select(condition, x, y) is x where the condition holds and y elsewhere; x and y are of one kind, and so is it.
    "select": Operation((BOOLEAN, NUMBER, NUMBER), NUMBER, "?", "selections"),
}

FUNCTIONS = {
    "cos": Operation((NUMBER,), NUMBER, "cos", "functions"),
    "arccos": Operation((NUMBER,), NUMBER, "arccos", "functions"),
}
"""The operations that only the formulas with roots need. No standard says how these round, so programs with them have
no error bounds and are not printed as kernels: they are proved, evaluated in floats and counted."""

KNOWN = {**OPERATIONS, **FUNCTIONS}
"""All operations of steps, by name."""


@dataclass(frozen=True, slots=True)
class Step:
    """`name` becomes the result of `operation` on `arguments`, rounded once."""

    name: str
    operation: str
    arguments: tuple[Argument, ...]

    @property
    def reads(self) -> tuple[str, ...]:
        """The names among the arguments."""
        return tuple(argument for argument in self.arguments if isinstance(argument, str))


@dataclass(frozen=True)
class Program:
    """Steps that turn named inputs into named values. All inputs are numbers.

    Raises ValueError on construction where a name is not an identifier, is defined twice or is used before it is
    defined, and where an operation is unknown or is given the wrong number or kind of arguments.
    """

    name: str
    inputs: tuple[str, ...]
    steps: tuple[Step, ...]

    def __post_init__(self) -> None:
        kinds: dict[str, str] = {}
        for name in self.inputs:
            self._require_new(name, kinds)
            kinds[name] = NUMBER
        for step in self.steps:
            self._require_new(step.name, kinds)
            try:
                kinds[step.name] = kind_of(step, kinds)
            except ValueError as error:
                raise ValueError(f"program {self.name}: step {step.name}: {error}") from None

    def _require_new(self, name: str, kinds: dict[str, str]) -> None:
        if not (name.isascii() and name.isidentifier()):
            raise ValueError(f"program {self.name}: {name!r} is not a name")
        if name in kinds:
            raise ValueError(f"program {self.name}: {name} is defined twice")

    def step(self, name: str) -> Step:
        """Return the step of that name. Raises KeyError where there is none."""
        for step in self.steps:
            if step.name == name:
                return step
        raise KeyError(name)


_OF_BOOLEANS = {
    ("select", (BOOLEAN, BOOLEAN, BOOLEAN)),
    ("eq", (BOOLEAN, BOOLEAN)),
    ("ne", (BOOLEAN, BOOLEAN)),
}
"""Operations that also take truth values in the place of numbers, with the kinds of their arguments."""


def kind_of(step: Step, kinds: dict[str, str]) -> str:
    """Return the kind of the step's result, NUMBER or BOOLEAN, given the kinds of the names before it.

    Raises ValueError where the step is not well formed.
    """
    operation = KNOWN.get(step.operation)
    if operation is None:
        raise ValueError(f"there is no operation {step.operation!r}")
    if len(step.arguments) != len(operation.takes):
        raise ValueError(f"{step.operation} takes {len(operation.takes)} arguments, not {len(step.arguments)}")
    kinds_of_arguments = tuple(_kind_of_argument(argument, kinds) for argument in step.arguments)
    if (step.operation, kinds_of_arguments) in _OF_BOOLEANS:
        return BOOLEAN
    if kinds_of_arguments != operation.takes:
        raise ValueError(
            f"{step.operation} takes ({', '.join(operation.takes)}), not ({', '.join(kinds_of_arguments)})"
        )
    return operation.gives


def _kind_of_argument(argument: Argument, kinds: dict[str, str]) -> str:
    if isinstance(argument, str):
        if argument not in kinds:
            raise ValueError(f"{argument} is not defined before it is used")
        return kinds[argument]
    if isinstance(argument, bool) or not isinstance(argument, int) or abs(argument) > LARGEST_CONSTANT:
        raise ValueError(f"{argument!r} is neither a name nor an integer up to {LARGEST_CONSTANT}")
    return NUMBER


def needed(program: Program, wanted: tuple[str, ...]) -> tuple[Step, ...]:
    """Return the steps that the wanted names depend on, in order. Raises KeyError if a wanted name does not exist."""
    known = {*program.inputs, *(step.name for step in program.steps)}
    for name in wanted:
        if name not in known:
            raise KeyError(f"program {program.name} has no {name}")
    alive = set(wanted)
    steps = []
    for step in reversed(program.steps):
        if step.name in alive:
            alive.update(step.reads)
            steps.append(step)
    return tuple(reversed(steps))


def cut(program: Program, known: Iterable[str], wanted: Iterable[str]) -> Program:
    """Return the part of the program that leads from the `known` names to the `wanted` ones.

    The known names, inputs or steps, become the first inputs, in the order given; original inputs that are still
    needed follow. Raises KeyError where a name does not exist.
    """
    first_inputs = tuple(dict.fromkeys(known))
    for name in first_inputs:
        if name not in program.inputs:
            program.step(name)
    others = tuple(name for name in program.inputs if name not in first_inputs)
    remaining = Program(
        program.name, (*first_inputs, *others), tuple(step for step in program.steps if step.name not in first_inputs)
    )
    steps = needed(remaining, tuple(dict.fromkeys(wanted)))
    read = {name for step in steps for name in step.reads}
    return Program(program.name, (*first_inputs, *(name for name in others if name in read)), steps)


@dataclass(frozen=True, slots=True)
class Hoisting:
    """A program's steps in two parts: those that depend only on fixed inputs, and the others."""

    outside: tuple[Step, ...]
    inside: tuple[Step, ...]


def hoist(program: Program, fixed: Collection[str]) -> Hoisting:
    """Divide the program's steps: those that depend only on the `fixed` inputs and on constants, and the others.

    Raises ValueError where a fixed input is not one of the program.
    """
    unknown = sorted(set(fixed) - set(program.inputs))
    if unknown:
        raise ValueError(f"program {program.name} has no input {', '.join(unknown)}")
    known = set(fixed)
    outside, inside = [], []
    for step in program.steps:
        if known.issuperset(step.reads):
            known.add(step.name)
            outside.append(step)
        else:
            inside.append(step)
    return Hoisting(tuple(outside), tuple(inside))


def split(program: Program, wanted: tuple[str, ...], fixed: tuple[str, ...]) -> tuple[Program, Program]:
    """Divide a program into two: the steps that depend only on fixed inputs, and those from there to the wanted names.

    Inputs of a program are numbers, so a comparison of fixed numbers stays in the second part: it costs one operation.
    Raises KeyError where a wanted name does not exist.
    """
    kinds = dict.fromkeys(program.inputs, NUMBER)
    for step in program.steps:
        kinds[step.name] = kind_of(step, kinds)
    numbers = [step.name for step in hoist(program, fixed).outside if kinds[step.name] == NUMBER]
    left = cut(program, numbers, wanted)
    read = {name for step in left.steps for name in step.reads} | set(wanted)
    known = [name for name in numbers if name in read]
    return cut(program, fixed, known), cut(program, known, wanted)


_INFIX = {operation.sign: name for name, operation in KNOWN.items() if len(operation.takes) == 2}
_PREFIX = {operation.sign: name for name, operation in KNOWN.items() if len(operation.takes) == 1}


def steps_of(text: str) -> tuple[Step, ...]:
    """Return the steps of a listing. Raises ValueError naming a line that is not a step, a remark or blank."""
    lines = (line.partition("#")[0].strip() for line in text.splitlines())
    return tuple(_step_of(line) for line in lines if line)


def program_of(name: str, inputs: tuple[str, ...], *listings: str) -> Program:
    """Make the program with the steps of these listings, one listing after the other."""
    return Program(name, inputs, tuple(step for text in listings for step in steps_of(text)))


def line_of(step: Step) -> str:
    """Return one step in the written form; `steps_of` reads it back."""
    sign = KNOWN[step.operation].sign
    if step.operation == "select":
        condition, left, right = step.arguments
        return f"{step.name} = {condition} ? {left} : {right}"
    if len(step.arguments) == 1:
        return f"{step.name} = {sign} {step.arguments[0]}"
    left, right = step.arguments
    return f"{step.name} = {left} {sign} {right}"


def _step_of(line: str) -> Step:
    name, equals, formula = (part.strip() for part in line.partition("="))
    words = formula.split()
    if equals and len(words) == 3 and words[1] in _INFIX:
        return Step(name, _INFIX[words[1]], (_argument(words[0]), _argument(words[2])))
    if equals and len(words) == 2 and words[0] in _PREFIX:
        return Step(name, _PREFIX[words[0]], (_argument(words[1]),))
    if equals and len(words) == 5 and (words[1], words[3]) == ("?", ":"):
        return Step(name, "select", (_argument(words[0]), _argument(words[2]), _argument(words[4])))
    raise ValueError(f"this line of a listing is not a step: {line!r}")


def _argument(word: str) -> Argument:
    return int(word) if word.lstrip("-").isdigit() else word


@dataclass(frozen=True, slots=True)
class Operations:
    """Numbers of operations by kind; a subtraction counts as an addition, a sign change is not counted.

    `functions` are cosines and their inverses.
    """

    additions: int = 0
    multiplications: int = 0
    divisions: int = 0
    square_roots: int = 0
    functions: int = 0
    comparisons: int = 0
    logical: int = 0
    selections: int = 0

    @property
    def rounded(self) -> int:
        """The number of operations that round: + − × ÷ √, cos, arccos."""
        return self.additions + self.multiplications + self.divisions + self.square_roots + self.functions


def count(steps: Iterable[Step]) -> Operations:
    """Count the operations in `steps`."""
    counts = Counter(KNOWN[step.operation].counted for step in steps)
    return Operations(**{kind: number for kind, number in counts.items() if kind is not None})
