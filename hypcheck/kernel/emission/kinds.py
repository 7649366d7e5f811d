"""Kinds of code for one pair: the question, the routine that answers, and the text of the file about both.

A new kind is an entry of KINDS: its columns, its routine (specialise/sweeping.py), how the routine's number becomes an
answer, and the numbers that the file also gives. Only PHRASES depends on the language.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from sys import float_info

from hypcheck.derivation.program import Program, Step
from hypcheck.derivation.routines import Routine
from hypcheck.geometry.pair import AXIS, COLUMNS, SIZES, TILTED_COLUMNS
from hypcheck.kernel.emission.dialects import Dialect
from hypcheck.kernel.emission.routines import routines_text
from hypcheck.kernel.specialise import sweeping
from hypcheck.kernel.specialise.scene_routines import position_routine, sweep_routine
from hypcheck.scene.model import SceneModel


@dataclass(frozen=True)
class Number:
    """A second result beside the answer: the routine that computes it, and its value if nothing is proved."""

    routine: Routine
    nothing: float


@dataclass(frozen=True)
class Kind:
    """A kind of emitted file: the answer that it gives about a row with these `columns`.

    `routine` makes a number, which is the answer where it is below `decided`; of a `passage` it is a time, and one up
    to 1 is the answer 1. Without a routine the statements are a program's, which makes exterior, interior and decided.
    `one` and `many` are the functions for one row and for many, `python` what the latter is called there, `numbers`
    those that the file has besides, and
    `head` is what its first lines say.
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
        """The domain in which the code decides; outside of it the answer is 2."""
        if self.routine is None:
            return {"ratio": [0, float_info.max], "magnitude": [0, float_info.max]}
        return {"ratio": [2.0**-26, 2.0**26], "magnitude": [2.0**-250, 2.0**250]}


_PAIR = "The answer about a spheroid of semi-axes b, b, d{place} and a hyperboloid of semi-axes alpha, alpha, gamma."
_TILTED = "A spheroid of semi-axes b, b, d at (x, y, z), of revolution about axis (any length), against the hyperboloid"
_BODY = "(x² + y²)/alpha² − z²/gamma² = 1."
_PROOF = (
    "Every other answer is right: a multiplier is found by halving, and what it proves is decided beyond a counted",
    "bound of all roundings; a bad one makes the answer 2.",
)

POSITION = Kind(COLUMNS, "position", "classify", _PAIR, python="classify")
"""Of upright spheroids, by a program."""

KINDS = {
    "tilted": Kind(
        TILTED_COLUMNS,
        "position",
        "classify_tilted",
        _PAIR,
        sweeping.POSITION,
        python="classify",
        head=(
            _TILTED,
            f"{_BODY} +1 exterior, 0 contact, −1 interior; 2 where float64 cannot say, 127 for an invalid row.",
            *_PROOF,
        ),
    ),
    "clearance": Kind(
        TILTED_COLUMNS,
        "position",
        "classify_tilted",
        _PAIR,
        sweeping.POSITION,
        python="classify",
        numbers={
            "clearance_lower": Number(sweeping.LOWER, -1.0),
            "clearance_upper": Number(sweeping.UPPER, float_info.max),
        },
        head=(
            _TILTED,
            f"{_BODY} +1 exterior, 0 contact, −1 interior; 2 where float64 cannot say, 127 for an invalid row.",
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
            "2 where float64 cannot say, 127 for an invalid row. first_contact is a time from 0 to 1 up to which a",
            f"sweep with contact is proved clear; {sweeping.NEVER} without contact, {sweeping.UNKNOWN} unknown.",
            *_PROOF,
        ),
    ),
}
"""By name: what `emit --method` takes beside the methods of pair.py."""


def kind_of_scene(scene: SceneModel, *, sweep: bool) -> Kind:
    """Code for a whole scene, for a mover and hyperboloids of any axis: positions, or sweeps. Raises InputError."""
    parts = (
        ("Where the mover itself has contact, its parts are for the caller: the answer is 2.",)
        if scene.mover.parts
        else ()
    )
    many = f"{len(scene.hyperboloids)} hyperboloid{'s' * (len(scene.hyperboloids) != 1)}"
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
            head=(
                f"The mover of a scene of {many} on a straight sweep: 1 contact, 0 clear all along;",
                "2 where float64 cannot say, 127 for an invalid row. first_contact is a time from 0 to 1 up to which a",
                f"sweep with contact is proved clear; {sweeping.NEVER} without contact, {sweeping.UNKNOWN} unknown.",
                *parts,
                *_PROOF,
            ),
        )
    routine = position_routine(scene)
    return Kind(
        routine.inputs,
        "whole",
        "whole_rows",
        "The answer about the mover in the scene.",
        routine,
        head=(
            f"The mover of a scene of {many}, in the scene's coordinates, asked for {scene.question}:",
            "+1 exterior, 0 contact, −1 interior; of one side 1 is yes and 0 no. 2 where float64 cannot say, 127 for",
            "an invalid row.",
            *parts,
            *_PROOF,
        ),
    )


@dataclass(frozen=True)
class _Phrases:
    """The phrases of a language for the parameters and results of a kind's functions."""

    answer: str
    told: str
    hit: str
    undecided: str
    number: str
    axis: str
    declaration: str
    times: str = ""
    keep: str = ""


_C_NUMBER = """
/* {meaning} */
double {prefix}_{name}({parameters})
{{
    return EVALUATION == 0 || EVALUATION == 1 || EVALUATION == 16 ? {routine}({given}) : {nothing!r};
}}
"""
_SIZE_CHECK = """static int is_size(double value)
{
    return bits_of(value) >> 63 == 0 && bits_of(value) != 0 && is_finite(value);
}"""
_RUST_NUMBER = """
/// {meaning}
pub fn {name}(row: &[f64; {width}]) -> f64 {{
    let [{columns}] = *row;
    if FLOATS_DECIDE {{
        {routine}({given})
    }} else {{
        {nothing!r}
    }}
}}

/// # Safety
/// `row` is {width} numbers.
#[no_mangle]
pub unsafe extern "C" fn {prefix}_{name}_of(row: *const f64) -> f64 {{
    {name}(&*row.cast::<[f64; {width}]>())
}}
"""
_JAVASCRIPT_NUMBER = """
/** {meaning} */
export function {name}({columns}) {{
    return {routine}({given});
}}
"""
_PYTHON_NUMBER = '''

def {name}({parameters}) -> float:
    """{meaning}"""
    try:
        return {routine}({given})
    except ZeroDivisionError:  # a square that underflows
        return {nothing!r}
'''

_C = _Phrases(
    "exterior ? 1 : interior ? -1 : 0",
    "(int)told",
    "told <= 1.0",
    "",
    _C_NUMBER,
    " && (bits_of({0}) << 1 || bits_of({1}) << 1 || bits_of({2}) << 1)",
    "double {name}",
    ", double *times",
    "\n        if (times) times[i] = positions[i] == 1 ? {prefix}_first_contact({row}) : NAN;",
)
PHRASES = {
    "c": _C,
    "cpp": _C,
    "rust": _Phrases(
        "i8::from(exterior) - i8::from(interior)",
        "told as i8",
        "i8::from(told <= 1.0)",
        "",
        _RUST_NUMBER,
        " && row[{start}..].iter().any(|part| bits_of(*part) << 1 != 0)",
        "{name}",
        ", times: *mut f64",
        """
        if !times.is_null() {{
            let hit = *positions.add(i) == 1;
            *times.add(i) = if hit {{ first_contact(&*rows.add({width} * i).cast()) }} else {{ f64::NAN }};
        }}""",
    ),
    "javascript": _Phrases(
        "exterior ? 1 : interior ? -1 : 0",
        "told",
        "told <= 1 ? 1 : 0",
        "",
        _JAVASCRIPT_NUMBER,
        " || !words.slice({start}).some((word) => word << 1n & 0xffffffffffffffffn)",
        "{name}",
    ),
    "python": _Phrases(
        "1 if exterior else -1 if interior else 0",
        "int(told)",
        "int(told <= 1)",
        "decided, told = False, 0.0",
        _PYTHON_NUMBER,
        " and any(bits_of(part) << 1 & 2**64 - 1 for part in ({0}, {1}, {2}))",
        "{name}: float",
    ),
}
PHRASES_UNDECIDED = "decided = exterior = interior = False"


def asked_of(kind: Kind) -> str:
    """The name of the function for one row in an emitted module of JavaScript or Rust."""
    if not kind.sizes:
        return kind.one
    return "passage" if kind.passage else "tilted" if kind.tilted else "predicate"


def columns_text(kind: Kind, dialect: Dialect, prefix: str) -> dict[str, str]:
    """The text of a template about rows: columns, check, functions."""
    phrases, names = PHRASES[dialect.name], kind.columns
    columns, width = ", ".join(names), str(len(names))
    parameters = ", ".join(phrases.declaration.format(name=name) for name in names)
    one = asked_of(kind) if dialect.name == "javascript" else kind.one
    place = "" if dialect.name == "python" or kind.passage else " at (x, y, z)"
    words = {
        "columns": columns, "width": width, "parameters": parameters, "prefix": prefix, "given": columns,
    }  # fmt: skip
    numbers = {name if dialect.name != "javascript" else _camel(name): number for name, number in kind.numbers.items()}
    texts = [
        phrases.number.format(
            name=name, meaning=number.routine.meaning, routine=number.routine.name, nothing=number.nothing, **words
        )
        for name, number in numbers.items()
    ]
    times = phrases.times if kind.passage else ""
    declared = [
        f"int {prefix}_{kind.one}({parameters});",
        f"void {prefix}_{kind.many}(size_t n, const double *rows, int8_t *positions{times});",
        *(f"double {prefix}_{name}({parameters});" for name in kind.numbers),
    ]
    return {
        **words,
        "row": _row(width),
        "one": one,
        "many": (kind.python or kind.many) if dialect.name == "python" else kind.many,
        "meaning": kind.meaning.format(place=place),
        "outputs": times,
        "keep": phrases.keep.format(row=_row(width), **words) if kind.passage else "",
        "declared": "\n".join(declared),
        "valid": _valid(kind, phrases, dialect.name),
        "has_axis": phrases.axis.format(*AXIS, start=len(names) - 3) if kind.tilted else "",
        "sizes": str(len(kind.sizes)),
        "size_check": _SIZE_CHECK if kind.sizes else "",
        "numbers": "".join(texts),
        "answer": phrases.answer if kind.routine is None else phrases.hit if kind.passage else phrases.told,
        "undecided": PHRASES_UNDECIDED if kind.routine is None else phrases.undecided,
    }  # fmt: skip


def _row(width: str) -> str:
    return ", ".join(f"row[{place}]" for place in range(int(width)))


def _camel(name: str) -> str:
    first, *others = name.split("_")
    return first + "".join(map(str.capitalize, others))


def _valid(kind: Kind, phrases: _Phrases, language: str) -> str:
    """The condition under which a row is valid, in C, C++ and Python."""
    axis = phrases.axis.format(*AXIS, start=0) if kind.tilted else ""
    others = kind.columns[len(kind.sizes) :]
    if language == "python":
        sizes = f"all(map(is_size, ({', '.join(kind.sizes)}))) and " if kind.sizes else ""
        return f"{sizes}all(map(is_finite, ({', '.join(others)}))){axis}"
    checks = [*(f"is_size({name})" for name in kind.sizes), *(f"is_finite({name})" for name in others)]
    return " && ".join(checks) + axis


def routine_text(kind: Kind, routine: Routine, dialect: Dialect) -> dict[str, str]:
    """The routines of a kind, and the statements that call the one that answers."""
    routines = dict.fromkeys([routine.name, *(number.routine.name for number in kind.numbers.values())])
    named = {function.name: function for function in (routine, *(number.routine for number in kind.numbers.values()))}
    text = routines_text([named[name] for name in routines], dialect, "float64")
    decided = Program("told", ("told",), (Step("decided", "lt", ("told", kind.decided)),))
    call = f"{routine.name}({', '.join(kind.columns)})"
    statement = dialect.say("told", value=call)
    return {
        "constants": "",
        "integers": f"\n{text}\n",
        "steps": "\n".join([statement, *dialect.statements(decided, ("decided",), "float64")]),
        "imports": "import math\n",
    }
