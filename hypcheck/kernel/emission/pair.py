"""Code to take for one pair of any sizes: one file without dependencies, right for every float64 row.

The method "exact" has two stages, both printed from the programs that the fast path runs. CERTIFIED decides in float64
where a proved bound excludes that rounding changes a sign (kernel/programs/certified.py); INTEGERS decides the rest in
whole numbers, which are read from the bits of the row. No stage depends on the rounding mode, or on whether the program
flushes subnormal numbers to zero. C and C++ refuse -ffast-math and its parts, which change the order of operations
(templates/arithmetic.c.tmpl). The method "certified" is the first stage alone, and says 2, "cannot say", where it does
not decide. So do "dual" and "local-maximum", whose proof is another (kernel/programs/dual.py).

Python and JavaScript have integers of any size. C, C++ and Rust get some forty lines of them: each number of the
straight-line program has room for the bits that are counted for it (`bits_counted`), so nothing is allocated in C.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any

from hypcheck.derivation.program import Program, needed
from hypcheck.errors import InputError
from hypcheck.kernel.emission.dialects import DIALECTS, Dialect
from hypcheck.kernel.emission.kernel import PREFIX, asked_of_compiler, in_rust, require_prefix
from hypcheck.kernel.emission.kinds import KINDS, POSITION, Kind, asked_of, columns_text, kind_of_scene, routine_text
from hypcheck.kernel.programs import dual
from hypcheck.kernel.programs.certified import CERTIFIED, CONSTANTS
from hypcheck.kernel.programs.integers import INTEGERS, bits_counted
from hypcheck.kernel.specialise.settings import axis_of
from hypcheck.scene.model import SceneModel, is_tilted
from hypcheck.version import VERSION

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
"""The program in float64 of a method, and its constants."""

_SIGNS = ("n2", "n1", "delta", "slope_at_B", "slope_at_A", "offset_at_B", "offset_at_A", "ring_excess")
"""The values whose signs the last stage needs."""

_ANSWER = ("exterior", "interior", "decided")

_LIMB = 32

_INPUT_BITS = 2098
"""Bits of the largest float64 in units of the smallest, 2⁻¹⁰⁷⁴."""


_GIVEN = {"rust": "row", "javascript": "...words"}
"""What the last stage is given, where it is not the columns."""


def require_method(method: str) -> None:
    """Raise InputError unless there is code for a pair by this method."""
    if method not in METHODS:
        raise InputError(f"--method is {method!r}; it must be {', '.join(METHODS[:-1])} or {METHODS[-1]}")


def emitted_pair(method: str, language: str, command: Sequence[str], prefix: str = PREFIX) -> str:
    """The text of the file. Raises InputError for another method, or a prefix that the language has no use for."""
    require_method(method)
    require_prefix(prefix, language)
    kind = KINDS.get(method, POSITION)
    head = kind.head if kind.routine else tuple(_head(method))
    return _printed(kind, method, head, language, command, prefix)


def needs_routine(scene: SceneModel) -> bool:
    """Whether something in the scene is tilted, so that a plan of pairs cannot be made of the whole."""
    return axis_of(scene.mover) is not None or any(is_tilted(body.axis) for body in scene.hyperboloids)


def emitted_scene(
    scene: SceneModel, language: str, command: Sequence[str], prefix: str = PREFIX, *, sweep: bool
) -> str:
    """The text of a file for a whole scene, whose mover and hyperboloids may be tilted. Raises InputError."""
    require_prefix(prefix, language)
    kind = kind_of_scene(scene, sweep=sweep)
    return _printed(kind, "scene", kind.head, language, command, prefix)


def _printed(kind: Kind, method: str, head: Sequence[str], language: str, command: Sequence[str], prefix: str) -> str:
    dialect = DIALECTS[language]
    parts = {
        "header": "\n".join(
            f"{dialect.comment}{line}".rstrip() for line in (*_made(command), *head, *_notes(language))
        ),
        "prefix": prefix,
        "arithmetic": asked_of_compiler(dialect),
        "description": _described(method, kind, language, prefix),
        "can": "" if method == EXACT else "const CANNOT_SAY: i8 = 2;\n",
        "last": _last(method, language),
        **columns_text(kind, dialect, prefix),
        **(routine_text(kind, kind.routine, dialect) if kind.routine else _by_program(method, dialect)),
    }
    if method == EXACT:
        parts["integers"] = dialect.filled("integers", {"steps": "\n".join(_whole(INTEGERS, language))})
    return dialect.filled("pair", parts)


def _by_program(method: str, dialect: Dialect) -> dict[str, str]:
    """The statements of a program of one pair, in the function itself."""
    program, values = _FLOATS[method]
    number, steps = dialect.number_of("float64"), dialect.statements(program, _ANSWER, "float64")
    constants = [dialect.say("constant", number=number, name=name, value=repr(value)) for name, value in values.items()]
    return {
        "constants": "\n".join(constants),
        "steps": "\n".join(steps),
        "integers": "",
        "imports": "import math\n" if any("math." in step for step in steps) else "",
    }


def _last(method: str, language: str) -> str:
    if method != EXACT:
        return "CANNOT_SAY"
    return f"exactly({_GIVEN.get(language, 'alpha, gamma, b, d, x, y, z')})"


def _made(command: Sequence[str]) -> Iterator[str]:
    yield f"Made by `{' '.join(command)}`, hypcheck {VERSION}."
    yield ""


def _head(method: str) -> Iterator[str]:
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
    if language == "javascript":
        yield "Where the engine flushes subnormal numbers to zero, 2 is also the answer to a 0 that may have been one."
    else:
        yield "Keep the order of the operations (no -ffast-math); FMA, every rounding mode and flushing subnormal"
        yield "numbers to zero are allowed."


def _described(method: str, kind: Kind, language: str, prefix: str) -> str:
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
    if language == "python":
        return repr(description)
    text = json.dumps(description)
    if language == "javascript":
        return text
    return (
        in_rust([json.dumps(text)], prefix, asked_of(kind), len(kind.columns))
        if language == "rust"
        else json.dumps(text)
    )


def _whole(program: Program, language: str) -> Iterator[str]:
    """The steps in whole numbers: infix where the language has integers of any size, else a call for each."""
    bits, operators = bits_counted(program, _INPUT_BITS), {"add": "+", "sub": "-", "mul": "*"}
    calls = {"add": "add", "sub": "subtract", "mul": "multiply"}
    for step in needed(program, _SIGNS):
        first, second = step.arguments
        if language == "python":
            yield f"{step.name} = {first} {operators[step.operation]} {second}"
        elif language == "javascript":
            left, right = (f"{operand}n" if isinstance(operand, int) else operand for operand in (first, second))
            yield f"const {step.name} = {left} {operators[step.operation]} {right};"
        elif language == "rust":
            left, right = (
                f"&small({operand})" if isinstance(operand, int) else f"&{operand}" for operand in (first, second)
            )
            yield f"let {step.name} = {calls[step.operation]}({left}, {right});"
        else:
            left, right = (
                f"&whole_{operand}" if isinstance(operand, int) else f"&{operand}" for operand in (first, second)
            )
            limbs = -(-bits[step.name] // _LIMB) + 2
            yield f"uint32_t {step.name}_limbs[{limbs}]; whole {step.name} = {{0, 0, {step.name}_limbs}};"
            yield f"{calls[step.operation]}(&{step.name}, {left}, {right});"
