"""Writes a file of code for rows of any sizes, without dependencies: for pairs, or for a scene with tilted bodies.

A kind of file (Kind) is the question, the routine or program that answers, and the text of the file about both. A new
kind is an entry of KINDS: its columns, its routine (specialise/sweeping.py), how the routine's number becomes an
answer, and the numbers that the file gives in addition. Only the phrases of a language (templates/NAME.toml) depend on
it.

The method "exact" has two stages, both printed from the programs that the fast path runs. CERTIFIED decides in float64
where a proved bound excludes that rounding changes a sign (kernel/programs/certified.py); INTEGERS decides the rest in
whole numbers, which are read from the bits of the row. No stage depends on the rounding mode, or on whether the program
flushes subnormal numbers to zero. C and C++ refuse -ffast-math and its parts, which change the order of operations
(templates/arithmetic.c.tmpl). The method "certified" is the first stage alone, and says 2, "cannot say", where it does
not decide. "dual" and "local-maximum" also answer 2 there; they prove their answers in another way
(kernel/programs/dual.py).

Python and JavaScript have integers of any size. For C, C++ and Rust the file contains some forty lines of integer
arithmetic. Each number of the straight-line program has room for the bits that are counted for it
(programs/integers.py), so C allocates no memory.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from sys import float_info
from typing import Any

from hypcheck.derivation.program import Program, Step
from hypcheck.derivation.routines import Routine
from hypcheck.errors import InputError
from hypcheck.geometry.pair import AXIS, COLUMNS, SIZES, TILTED_COLUMNS
from hypcheck.kernel.emission.dialects import (
    PREFIX,
    Dialect,
    description_in_language,
    dialect_of,
    require_prefix,
    routines_text,
)
from hypcheck.kernel.programs import dual
from hypcheck.kernel.programs.certified import CERTIFIED, CONSTANTS
from hypcheck.kernel.programs.integers import INTEGERS, integer_statements
from hypcheck.kernel.specialise import sweeping
from hypcheck.kernel.specialise.scene_routines import position_routine, sweep_routine
from hypcheck.kernel.specialise.settings import axis_of
from hypcheck.scene.model import SceneModel, is_tilted
from hypcheck.version import VERSION


@dataclass(frozen=True)
class Number:
    """A number that a file gives beside the answer: the routine for it, and its value if nothing is proved."""

    routine: Routine
    nothing: float


@dataclass(frozen=True)
class Kind:
    """A kind of emitted file: the answer that it gives about a row with these `columns`.

    `routine` computes a number. If that is below `decided` it is the answer; for a `passage` it is a time, and the
    answer is 1 if the time is at most 1, else 0. Without a routine a program computes exterior, interior and decided.
    `one` and `many` name the functions for one row and for many rows, `python` names the latter in Python. `meaning`
    says in a sentence what they answer, `numbers` has the numbers that the file also gives, by name, and `head` has
    the first lines of the file.
    """

    columns: tuple[str, ...]
    one: str
    many: str
    meaning: str
    routine: Routine | None = None
    decided: int = 2
    passage: bool = False
    numbers: Mapping[str, Number] = field(default_factory=dict)
    head: tuple[str, ...] = ()
    python: str = ""

    @property
    def tilted(self) -> bool:
        """Whether rows have an axis."""
        return set(AXIS) <= set(self.columns)

    @property
    def sizes(self) -> tuple[str, ...]:
        """The columns that are sizes: finite and > 0."""
        return tuple(name for name in self.columns if name in SIZES)

    @property
    def domain(self) -> dict[str, object]:
        """The domain in which the code decides: ratios and magnitudes of sizes; outside of it the answer is 2."""
        if self.routine is None:
            return {"ratio": [0, float_info.max], "magnitude": [0, float_info.max]}
        return {"ratio": [2.0**-26, 2.0**26], "magnitude": [2.0**-250, 2.0**250]}

    @property
    def asked(self) -> str:
        """The name of the function for one row in an emitted module of JavaScript or Rust."""
        if not self.sizes:
            return self.one
        return "passage" if self.passage else "tilted" if self.tilted else "predicate"


_PAIR = "The answer about a spheroid of semi-axes b, b, d{place} and a hyperboloid of semi-axes alpha, alpha, gamma."
_BODY = "(x² + y²)/alpha² − z²/gamma² = 1."
_TILTED = (
    "A spheroid of semi-axes b, b, d at (x, y, z), of revolution about axis (any length), against the hyperboloid",
    f"{_BODY} +1 exterior, 0 contact, −1 interior; 2 where float64 cannot say, 127 for an invalid row.",
)
_FIRST_CONTACT = (
    "2 where float64 cannot say, 127 for an invalid row. first_contact is a time from 0 to 1 up to which a",
    f"sweep with contact is proved clear; {sweeping.NEVER} without contact, {sweeping.UNKNOWN} unknown.",
)
_PROOF = (
    "Every other answer is right: a multiplier is found by halving, and what it proves is decided beyond a counted",
    "bound of all roundings; a bad one makes the answer 2.",
)

POSITION = Kind(COLUMNS, "position", "classify", _PAIR, python="classify")
"""The kind of file for upright spheroids, whose answer is computed by a program."""

_TILTED_POSITION = ("position", "classify_tilted", _PAIR, sweeping.POSITION)

KINDS = {
    "tilted": Kind(TILTED_COLUMNS, *_TILTED_POSITION, python="classify", head=(*_TILTED, *_PROOF)),
    "clearance": Kind(
        TILTED_COLUMNS,
        *_TILTED_POSITION,
        python="classify",
        numbers={
            "clearance_lower": Number(sweeping.LOWER, -1.0),
            "clearance_upper": Number(sweeping.UPPER, float_info.max),
        },
        head=(
            *_TILTED,
            "clearance_lower and clearance_upper bound the clearance: made 1 + clearance times as large about its",
            f"centre, the spheroid touches. −1 and {float_info.max!r} say nothing; below 0 it has contact.",
            *_PROOF,
        ),
    ),
    "passage": Kind(
        sweeping.SWEEP_COLUMNS,
        "way",
        "passage_tilted",
        "Whether a spheroid of semi-axes b, b, d has contact on its straight sweep.",
        sweeping.FIRST,
        sweeping.UNKNOWN,
        python="passage",
        passage=True,
        numbers={"first_contact": Number(sweeping.FIRST, float(sweeping.UNKNOWN))},
        head=(
            "Whether a spheroid of semi-axes b, b, d, of revolution about axis (any length), has contact on its",
            f"straight sweep with the hyperboloid {_BODY} 1 contact, 0 clear all along;",
            *_FIRST_CONTACT,
            *_PROOF,
        ),
    ),
}
"""The kinds of files whose answer is computed by a routine, by the name that `emit --method` takes."""


def kind_of_scene(scene: SceneModel, *, sweep: bool) -> Kind:
    """Return the kind of file for a whole scene with any axes: sweeps or, without `sweep`, positions.

    Raises InputError if the scene has no hyperboloid.
    """
    parts = ("Where the mover itself has contact, its parts are for the caller: the answer is 2.",)
    last = (*(parts if scene.mover.parts else ()), *_PROOF)
    mover = f"The mover of a scene of {len(scene.hyperboloids)} hyperboloid{'s' * (len(scene.hyperboloids) != 1)}"
    if sweep:
        routine = sweep_routine(scene)
        return Kind(
            routine.inputs,
            "sweep",
            "sweep_rows",
            "Whether the mover has contact on its straight sweep in the scene.",
            routine,
            sweeping.UNKNOWN,
            passage=True,
            numbers={"first_contact": Number(routine, float(sweeping.UNKNOWN))},
            head=(f"{mover} on a straight sweep: 1 contact, 0 clear all along;", *_FIRST_CONTACT, *last),
        )
    routine = position_routine(scene)
    return Kind(
        routine.inputs,
        "whole",
        "whole_rows",
        "The answer about the mover in the scene.",
        routine,
        head=(
            f"{mover}, in the scene's coordinates, asked for {scene.question}:",
            "+1 exterior, 0 contact, −1 interior; of one side 1 is yes and 0 no. 2 where float64 cannot say, 127 for",
            "an invalid row.",
            *last,
        ),
    )


EXACT, CERTIFIED_ONLY, DUAL, LOCAL_MAXIMUM = UPRIGHT = ("exact", "certified", "dual", "local-maximum")
"""The methods for upright spheroids."""

METHODS = (*UPRIGHT, *KINDS)
"""What `emit --method` takes."""

_FLOATS = {
    EXACT: (CERTIFIED, CONSTANTS),
    CERTIFIED_ONLY: (CERTIFIED, CONSTANTS),
    DUAL: (dual.DUAL, dual.CONSTANTS),
    LOCAL_MAXIMUM: (dual.LOCAL_MAXIMUM, dual.CONSTANTS),
}
"""By method: its program in float64, and the constants of the program."""

_SIGNS = ("n2", "n1", "delta", "slope_at_B", "slope_at_A", "offset_at_B", "offset_at_A", "ring_excess")
"""The values of INTEGERS whose signs the last stage needs."""

_ANSWER = ("exterior", "interior", "decided")


def emitted_pair(method: str, language: str, command: Sequence[str], prefix: str = PREFIX) -> str:
    """Return the text of the file. Raises InputError for another method, or a prefix that the language refuses."""
    if method not in METHODS:
        raise InputError(f"--method is {method!r}; it must be {', '.join(METHODS[:-1])} or {METHODS[-1]}")
    kind = KINDS.get(method, POSITION)
    return _printed(kind, method, kind.head or tuple(_head(method)), language, command, prefix)


def needs_routine(scene: SceneModel) -> bool:
    """Whether a body of the scene is tilted: the whole scene then needs a routine; a plan of pairs cannot hold it."""
    return axis_of(scene.mover) is not None or any(is_tilted(body.axis) for body in scene.hyperboloids)


def emitted_scene(
    scene: SceneModel, language: str, command: Sequence[str], prefix: str = PREFIX, *, sweep: bool
) -> str:
    """Return the text of a file for a whole scene, whose mover and hyperboloids may be tilted. Raises InputError."""
    kind = kind_of_scene(scene, sweep=sweep)
    return _printed(kind, "scene", kind.head, language, command, prefix)


def _printed(kind: Kind, method: str, head: Sequence[str], language: str, command: Sequence[str], prefix: str) -> str:
    """Return the text of a file of this kind: the template of the language, filled in."""
    require_prefix(prefix, language)
    dialect = dialect_of(language)
    made = (f"Made by `{' '.join(command)}`, hypcheck {VERSION}.", "")
    parts = {
        "header": "\n".join(f"{dialect.comment}{line}".rstrip() for line in (*made, *head, *_notes(language))),
        "prefix": prefix,
        "arithmetic": dialect.asked_of_compiler,
        "description": _described(method, kind, language, prefix),
        "can": "" if method == EXACT else "const CANNOT_SAY: i8 = 2;\n",
        "last": dialect.say("exactly") if method == EXACT else "CANNOT_SAY",
        **_columns_text(kind, dialect, prefix),
        **(_routine_text(kind, kind.routine, dialect) if kind.routine else _by_program(method, dialect)),
    }
    if method == EXACT:
        parts["integers"] = dialect.filled(
            "integers", {"steps": "\n".join(integer_statements(INTEGERS, _SIGNS, dialect.integers))}
        )
    return dialect.filled("pair", parts)


def _by_program(method: str, dialect: Dialect) -> dict[str, str]:
    """Return the parts of the template for a method that a program answers: its statements, and what they give."""
    program, values = _FLOATS[method]
    number, steps = dialect.number_of("float64"), dialect.statements(program, _ANSWER, "float64")
    constants = [dialect.say("constant", number=number, name=name, value=repr(value)) for name, value in values.items()]
    return {
        "constants": "\n".join(constants),
        "steps": "\n".join(steps),
        "integers": "",
        "imports": "import math\n" if any("math." in step for step in steps) else "",
        "answer": dialect.say("decided_position"),
        "undecided": "decided = exterior = interior = False",
    }


def _routine_text(kind: Kind, routine: Routine, dialect: Dialect) -> dict[str, str]:
    """Return the parts of the template for a kind with a routine: the routines, the call, and what it gives."""
    routines = {each.name: each for each in (routine, *(number.routine for number in kind.numbers.values()))}
    decided = Program("told", ("told",), (Step("decided", "lt", ("told", kind.decided)),))
    call = dialect.say("told", value=f"{routine.name}({', '.join(kind.columns)})")
    return {
        "constants": "",
        "integers": f"\n{routines_text(list(routines.values()), dialect, 'float64')}\n",
        "steps": "\n".join([call, *dialect.statements(decided, ("decided",), "float64")]),
        "imports": "import math\n",
        "answer": dialect.say("hit_answer" if kind.passage else "told_answer"),
        "undecided": dialect.say("undecided"),
    }


def _columns_text(kind: Kind, dialect: Dialect, prefix: str) -> dict[str, str]:
    """Return the parts of the template about rows: columns, checks of a row, functions."""
    names, scripted, in_python = kind.columns, dialect.name == "javascript", dialect.name == "python"
    parameters = ", ".join(dialect.say("parameter", name=name) for name in names)
    words = {
        "columns": ", ".join(names),
        "given": ", ".join(names),
        "width": str(len(names)),
        "parameters": parameters,
        "prefix": prefix,
        "row": ", ".join(f"row[{place}]" for place in range(len(names))),
    }
    numbers = [
        dialect.say(
            "number_function",
            name=_camel(name) if scripted else name,
            meaning=number.routine.meaning,
            routine=number.routine.name,
            nothing=repr(number.nothing),
            **words,
        )
        for name, number in kind.numbers.items()
    ]
    times = dialect.say("times") if kind.passage else ""
    declared = [
        f"int {prefix}_{kind.one}({parameters});",
        f"void {prefix}_{kind.many}(size_t n, const double *rows, int8_t *positions{times});",
        *(f"double {prefix}_{name}({parameters});" for name in kind.numbers),
    ]
    return {
        **words,
        "one": kind.asked if scripted else kind.one,
        "many": (kind.python or kind.many) if in_python else kind.many,
        "meaning": kind.meaning.format(place="" if in_python or kind.passage else " at (x, y, z)"),
        "outputs": times,
        "keep": dialect.say("keep_time", **words) if kind.passage else "",
        "declared": "\n".join(declared),
        "valid": _valid(kind, dialect),
        "has_axis": _checked_axis(kind, dialect),
        "sizes": str(len(kind.sizes)),
        "size_check": dialect.say("size_check") if kind.sizes else "",
        "numbers": "".join(numbers),
    }


def _camel(name: str) -> str:
    """Return a name with underscores in camel case, as JavaScript has it."""
    first, *others = name.split("_")
    return first + "".join(map(str.capitalize, others))


def _checked_axis(kind: Kind, dialect: Dialect) -> str:
    """Return the code, joined to the check of a row, that refuses the axis 0, 0, 0; empty without an axis."""
    return dialect.say("checked_axis", start=len(kind.columns) - 3) if kind.tilted else ""


def _valid(kind: Kind, dialect: Dialect) -> str:
    """Return the condition under which a row is valid, for C, C++ and Python."""
    axis, others = _checked_axis(kind, dialect), kind.columns[len(kind.sizes) :]
    if dialect.name == "python":
        sizes = f"all(map(is_size, ({', '.join(kind.sizes)}))) and " if kind.sizes else ""
        return f"{sizes}all(map(is_finite, ({', '.join(others)}))){axis}"
    checks = [*(f"is_size({name})" for name in kind.sizes), *(f"is_finite({name})" for name in others)]
    return " && ".join(checks) + axis


def _head(method: str) -> Iterator[str]:
    """Yield the lines at the head of a file for upright spheroids, by this method."""
    yield "A spheroid of semi-axes b, b, d at (x, y, z) against the hyperboloid (x² + y²)/alpha² − z²/gamma² = 1."
    yield "+1 exterior, 0 contact (tangency included), −1 interior; 127 where a size is not finite and > 0, or a"
    yield "coordinate is not finite."
    if method == EXACT:
        yield "Right for every float64 row: floats decide where a proved bound allows, whole numbers the rest."
    elif method == CERTIFIED_ONLY:
        yield "2 where float64 cannot say; every other answer is right. The bound of 3Δ is E below, those of c1 and c2"
        yield "are e1 and e2: an answer is given where |3Δ| > E and the signs that it asks for exceed their bounds."
    else:
        means = "Newton's steps" if method == DUAL else "the local maximum of the cubic, and Newton's steps"
        yield "2 where float64 cannot say; every other answer is right. phi(lambda) > e proves clear, e bounding the"
        yield "error. The tangent of phi, which is concave, proves contact, or a point of the hyperboloid at the"
        yield f"centre's height. lambda is found by {means}; a bad one makes the answer 2."


def _notes(language: str) -> Iterator[str]:
    """Yield the lines that say what must not change the arithmetic."""
    if language == "javascript":
        yield "Where the engine flushes subnormal numbers to zero, 2 is also the answer to a 0 that may have been one."
    else:
        yield "Keep the order of the operations (no -ffast-math); FMA, every rounding mode and flushing subnormal"
        yield "numbers to zero are allowed."


def _described(method: str, kind: Kind, language: str, prefix: str) -> str:
    """Return the description of the file by itself, as code of the language."""
    description: dict[str, Any] = {
        "protocol": 1,
        "name": f"{method} ({language})" if method == "scene" else f"pair, {method} ({language})",
        "version": VERSION,
        "language": language,
        "precision": "exact",
        "question": "passage" if kind.passage else "position",
        "refuses": True,
        **({"tilt": True} if kind.tilted and kind.sizes else {}),
        "domain": kind.domain,
    }
    return description_in_language(description, language, prefix, (kind.asked, len(kind.columns)))
