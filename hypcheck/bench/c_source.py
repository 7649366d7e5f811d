"""The methods in C: one source file, printed from the programs that numpy runs, and the quadcopter's procedures.

Each method is two functions, for rows and for the centres of one scene, in a table. A driver calls them through the
table the requested number of times, so that neither Python nor an optimiser affects the timing. The roots and the
search of the dual form are written here by hand, because they are not straight-line programs. A procedure answers one
position per call, as a craft does before each move. A second file has the programs compared with the compiled kernel.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from hypcheck.derivation.formulas import FORMULAS, Formula
from hypcheck.derivation.program import Program, cut
from hypcheck.geometry.pair import COLUMNS, SIZES
from hypcheck.implementations import procedures
from hypcheck.implementations.alternatives import DISTANCES
from hypcheck.implementations.method import parts
from hypcheck.kernel.printing.languages import C_SUFFIXES, c_statements


def procedures_source() -> str:
    """The functions and their driver; hypcheck.h and math.h must be included before."""
    return (
        _before("hull", procedures.hull_programs()[0])
        + _before("rotors", procedures.rotor_programs()[0])
        + "".join(_both())
        + _REST
    )


def _both() -> Iterator[str]:
    """The printed and the repaired procedures, which store the same numbers of a craft."""
    for repaired, prefix in ((procedures.PRINTED, ""), (procedures.PUT_RIGHT, "repaired_")):
        in_contact, inside = procedures.hull_steps(repaired)
        (hull_before, hull), (rotor_before, rotors) = (
            procedures.hull_programs(repaired),
            procedures.rotor_programs(repaired),
        )
        yield _asked(f"{prefix}rotors", rotor_before, rotors, ("valid",), "return valid;")
        yield _asked(f"{prefix}hull", hull_before, hull, (in_contact, inside), f"return {in_contact} ? 2 : {inside};")
        yield _PROCEDURES.replace("{prefix}", prefix)


def _before(name: str, program: Program) -> str:
    """The steps that depend only on the craft, stored in an array; a real program would store them in a structure."""
    names = [step.name for step in program.steps]
    stored = "\n".join(f"    k[{place}] = {name};" for place, name in enumerate(names))
    statements = "\n".join(f"    {line}" for line in c_statements(program, tuple(names)))
    return f"\nstatic void {name}_before(const double *craft, double *k)\n{{\n{_craft()}\n{statements}\n{stored}\n}}\n"


def _asked(name: str, before: Program, program: Program, wanted: tuple[str, ...], end: str) -> str:
    read = {name for step in program.steps for name in step.reads}
    constants = "\n".join(
        f"    const double {step.name} = k[{place}];" for place, step in enumerate(before.steps) if step.name in read
    )
    inputs = _craft(read)
    statements = "\n".join(f"    {line}" for line in c_statements(program, wanted))
    moving = ", ".join(f"double {name}" for name in procedures.MOVING)
    unused = "".join(f"    (void){name};\n" for name in procedures.MOVING if name not in read)
    return (
        f"\nstatic int {name}_asked(const double *craft, const double *k, {moving})\n"
        f"{{\n    (void)craft;\n{unused}{inputs}\n{constants}\n{statements}\n    {end}\n}}\n"
    )


def _craft(read: set[str] | None = None) -> str:
    named = [(place, name) for place, name in enumerate(procedures.CRAFT) if read is None or name in read]
    fields = "\n".join(f"    const double {name} = craft[{place}];" for place, name in named)
    return fields + "".join(f"\n    (void){name};" for _, name in named)


_PROCEDURES = """
static int {prefix}procedure_2a(const double *craft, const double *hull, const double *rotors, double x, double y,
                                double z, double cosine, double sine)
{
    (void)hull;
    return {prefix}rotors_asked(craft, rotors, x, y, z, cosine, sine);
}

static int {prefix}procedure_2b(const double *craft, const double *hull, const double *rotors, double x, double y,
                                double z, double cosine, double sine)
{
    const int answer = {prefix}hull_asked(craft, hull, x, y, z, cosine, sine);
    return answer == 2 ? {prefix}rotors_asked(craft, rotors, x, y, z, cosine, sine) : answer;
}
"""

_REST = """
typedef int body_function(const double *, const double *, const double *, double, double, double, double, double);

static int no_body(const double *craft, const double *hull, const double *rotors, double x, double y, double z,
                   double cosine, double sine)
{
    (void)craft, (void)hull, (void)rotors, (void)x, (void)y, (void)z, (void)cosine, (void)sine;
    return 0;
}

static int certified_body(const double *craft, const double *hull, const double *rotors, double x, double y, double z,
                          double cosine, double sine)
{
    const int body = hypcheck_position(craft[0], craft[1], craft[2], craft[3], x, y, z);
    const double half = craft[6] * sqrt(2.0) / 2.0, along = half * (cosine - sine), across = half * (cosine + sine);
    const double xs[4] = {along, -across, -along, across}, ys[4] = {across, along, -across, -along};
    (void)hull, (void)rotors;
    if (body != 0)
        return body < 0;
    for (int i = 0; i < 4; i++)
        if (hypcheck_position(craft[0], craft[1], craft[4], craft[5], x + xs[i], y + ys[i], z) >= 0)
            return 0;
    return 1;
}

static body_function *volatile of_bodies[] = {no_body, procedure_2a, procedure_2b, certified_body,
                                            repaired_procedure_2a, repaired_procedure_2b};

void bench_bodies(size_t which, size_t repeat, const double *craft, size_t n, const double *x, const double *y,
                  const double *z, const double *cosine, const double *sine, int8_t *out)
{
    double hull[64], rotors[64];
    hull_before(craft, hull);
    rotors_before(craft, rotors);
    for (size_t k = 0; k < repeat; k++)
        for (size_t i = 0; i < n; i++)
            out[i] = (int8_t)of_bodies[which](craft, hull, rotors, x[i], y[i], z[i], cosine[i], sine[i]);
}
"""


NUMBERS = {"float32": "float", "float64": "double", "longdouble": "long double"}
"""The C type of each format."""

DIGITS = {"float": "FLT_MANT_DIG", "double": "DBL_MANT_DIG", "long double": "LDBL_MANT_DIG"}
LEAST = {"float": "FLT_MIN", "double": "DBL_MIN", "long double": "LDBL_MIN"}


@dataclass(frozen=True)
class CMethod:
    """A method's name, and the code of its two functions: identifier(NAME) with _rows and _scene appended."""

    name: str
    code: str


def source(methods: Sequence[CMethod]) -> str:
    """The whole file; the table begins with a method that does nothing."""
    rows = ", ".join(f"{identifier(method.name)}_rows" for method in methods)
    scenes = ", ".join(f"{identifier(method.name)}_scene" for method in methods)
    functions = "\n".join(method.code for method in methods)
    return f"{_HEAD}\n{functions}\n{_DRIVER.format(rows=rows, scenes=scenes)}{procedures_source()}"


def identifier(name: str) -> str:
    """A method's name as an identifier of C."""
    return name.replace("-", "_").replace(".", "_")


def of_formula(formula: Formula, format_name: str) -> CMethod:
    """A formula's printed program; steps that depend only on sizes come before the loop."""
    number = NUMBERS[format_name]
    outside, inside = parts(formula)
    known = tuple(step.name for step in outside.steps)
    return _method(
        f"{formula.name}-{format_name}",
        number,
        c_statements(outside, known, number=number),
        c_statements(inside, (formula.answer,), number=number),
        formula.answer,
    )


def trigonometric(format_name: str) -> CMethod:
    """The roots of g by the trigonometric form, only if Δ > 0; decisions are as in implementations/alternatives.py."""
    number = NUMBERS[format_name]
    outside, inside = parts(_CUBIC)
    known = tuple(step.name for step in outside.steps)
    wanted = tuple(name for name in ("c0", "c1", "c2", "delta") if name not in known)
    end = C_SUFFIXES[number]
    return _method(
        f"trigonometric-{format_name}",
        number,
        c_statements(outside, known, number=number),
        (*c_statements(inside, wanted, number=number), *_TRIGONOMETRIC.format(N=number, f=end).strip().splitlines()),
        "side",
    )


def dual(format_name: str) -> CMethod:
    """The dual form: the search of implementations/alternatives.py, step by step, then the rest of the program."""
    number = NUMBERS[format_name]
    program = cut(FORMULAS["dual"].program, DISTANCES, ("phi",))
    search = _SEARCH.format(N=number, f=C_SUFFIXES[number], digits=DIGITS[number], least=LEAST[number])
    return _method(
        f"dual-{format_name}",
        number,
        (),
        (*search.strip().splitlines(), *c_statements(program, ("phi",), number=number)),
        "phi > 0 ? (lambda_ > 0) - (lambda_ < 0) : 0",
    )


FAST = CMethod(
    "fast",
    """
static void fast_rows(size_t n, const double *restrict rows, int8_t *restrict out)
{
    if (n == 1)
        *out = (int8_t)hypcheck_position(rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6]);
    else
        hypcheck_classify(n, rows, out);
}

static void fast_scene(const double *restrict sizes, size_t n, const double *restrict xs, const double *restrict ys,
                       const double *restrict zs, int8_t *restrict out)
{
    hypcheck_classify_scene(sizes, n, xs, ys, zs, out);
}
""",
)
"""The fast path as hypcheck.classify runs it if it was compiled."""

_TABLE_2 = FORMULAS["table-2"]
_CUBIC = Formula("cubic", "the cubic of Table 2", "position", _TABLE_2.program, "delta", "Table 2")


def _method(name: str, number: str, before: Sequence[str], inside: Sequence[str], answer: str) -> CMethod:
    """A method from its statements before the loop over centres and inside it, and the expression of the answer.

    `number` is the C type of its numbers.
    """
    called, within = identifier(name), _indented(inside, 8)
    taken = "\n".join(
        f"        const {number} {column} = ({number})row[{place}];" for place, column in enumerate(COLUMNS)
    )
    sizes = "\n".join(f"    const {number} {size} = ({number})sizes[{place}];" for place, size in enumerate(SIZES))
    centre = "\n".join(
        f"        const {number} {coordinate} = ({number}){coordinate}s[i];" for coordinate in ("x", "y", "z")
    )
    code = f"""
static void {called}_rows(size_t n, const double *restrict rows, int8_t *restrict out)
{{
    for (size_t i = 0; i < n; i++) {{
        const double *const row = rows + 7 * i;
{taken}
{_indented(before, 8)}
{within}
        out[i] = (int8_t)({answer});
    }}
}}

static void {called}_scene(const double *restrict sizes, size_t n, const double *restrict xs,
                         const double *restrict ys, const double *restrict zs, int8_t *restrict out)
{{
{sizes}
{_indented(before, 4)}
    for (size_t i = 0; i < n; i++) {{
{centre}
{within}
        out[i] = (int8_t)({answer});
    }}
}}
"""
    return CMethod(name, code)


def _indented(lines: Sequence[str], depth: int) -> str:
    return "\n".join(" " * depth + line for line in lines)


_HEAD = """\
/* Printed by hypcheck bench from derivation/formulas.py: what is compared is what was proved. */
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "hypcheck.h"

static void nothing_rows(size_t n, const double *restrict rows, int8_t *restrict out)
{
    (void)n, (void)rows, (void)out;
}
"""

_DRIVER = """
typedef void rows_function(size_t, const double *restrict, int8_t *restrict);
typedef void scene_function(const double *restrict, size_t, const double *restrict, const double *restrict,
                            const double *restrict, int8_t *restrict);

static rows_function *volatile of_rows[] = {{nothing_rows, {rows}}};
static scene_function *volatile of_scene[] = {{NULL, {scenes}}};

void bench_rows(size_t which, size_t repeat, size_t n, const double *rows, int8_t *out)
{{
    for (size_t k = 0; k < repeat; k++)
        of_rows[which](n, rows, out);
}}

void bench_scene(size_t which, size_t repeat, const double *sizes, size_t n, const double *x, const double *y,
                 const double *z, int8_t *out)
{{
    for (size_t k = 0; k < repeat; k++)
        of_scene[which](sizes, n, x, y, z, out);
}}

void bench_single(size_t which, size_t repeat, size_t n, const double *rows, int8_t *out)
{{
    for (size_t k = 0; k < repeat; k++)
        for (size_t i = 0; i < n; i++)
            of_rows[which](1, rows + 7 * i, out + i);
}}
"""

_TRIGONOMETRIC = """
int side = 0;
if (delta > 0) {{
    const {N} third = c2 / 3;
    const {N} square = third * third - c1 / 3;
    const {N} size = sqrt{f}(square);
    const {N} cosine = (third * (third * third - c1 / 2) + c0 / 2) / (square * size);
    const {N} angle = acos{f}(cosine < -1 ? -1 : cosine > 1 ? 1 : cosine);
    const {N} lowest = -2 * size * cos{f}(angle / 3) - third;
    const {N} middle = -2 * size * cos{f}((angle - ({N})6.283185307179586476925286766559L) / 3) - third;
    const {N} mean = (lowest + middle) / 2;
    side = (lowest > 0 && mean < B) - (middle < 0 && mean > -A);
}}
"""

_SEARCH = """
const {N} a = alpha / b, c = gamma / d, A = a * a, B = c * c;
const {N} ar = a * hypot{f}(x / b, y / b), cz = c * fabs{f}(z / d);
const {N} to_a_0 = ar / A, to_b_0 = cz / B;
const int within = to_a_0 * to_a_0 <= to_b_0 * to_b_0 + 1;
const {N} pole = within ? A : B, other = within ? B : A, half = pole / 2;
int near_zero = 1;
{N} low = half * {least}, high = half, mid = half;
for (int step = -1; step < {digits} + 13; step++) {{
    if (step >= 0)
        mid = step < 10 ? sqrt{f}(low) * sqrt{f}(high) : (low + high) / 2;
    const {N} to_pole = near_zero ? pole - mid : mid, to_other = other + (near_zero ? mid : pole - mid);
    const {N} left = ar / (within ? to_pole : to_other), right = cz / (within ? to_other : to_pole);
    const int past = (left * left <= right * right + 1) ^ within;
    if (step < 0) {{
        near_zero = past;
    }} else {{
        const int move_low = past ^ near_zero;
        low = move_low ? mid : low;
        high = move_low ? high : mid;
    }}
}}
const {N} size = near_zero ? high : pole - high, lambda_ = within ? -size : size;
const {N} to_pole = near_zero ? pole - high : high, to_other = other + (near_zero ? high : pole - high);
const {N} A_plus_lambda = within ? to_pole : to_other, B_minus_lambda = within ? to_other : to_pole;
"""


WORDS = 40
"""32-bit words of the integers whose product measures exact decisions. 1280 bits have room for the discriminant of a
row: it is of degree 24 in numbers of 53 bits that are alike in magnitude."""

_BASELINES = (
    f"""\
#define WORDS {WORDS}
"""
    """\
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

uint64_t read_only(size_t n, const uint64_t *restrict x, const uint64_t *restrict y, const uint64_t *restrict z)
{
    uint64_t mixed = 0;
    for (size_t i = 0; i < n; i++)
        mixed ^= x[i] ^ y[i] ^ z[i];
    return mixed;
}

void read_over_and_over(size_t times, size_t n, const uint64_t *x, const uint64_t *y, const uint64_t *z)
{
    static volatile uint64_t seen;
    while (times--)
        seen = read_only(n, x, y, z);
}

/* The lower half of what two integers of WORDS words multiply to, column by column, over and over. */
uint32_t products(size_t times, const uint32_t *left, const uint32_t *right)
{
    uint32_t result[WORDS], sum = 0;
    while (times--) {
        memset(result, 0, sizeof result);
        for (size_t i = 0; i < WORDS; i++) {
            uint64_t carry = 0;
            for (size_t k = 0; i + k < WORDS; k++) {
                carry += (uint64_t)(left[i] ^ (uint32_t)times) * right[k] + result[i + k];
                result[i + k] = (uint32_t)carry;
                carry >>= 32;
            }
        }
        sum ^= result[WORDS - 1];
    }
    return sum;
}

typedef size_t (*by_rows)(int, size_t, const double *, int8_t *);

void rows_over_and_over(by_rows ask, size_t times, size_t n, const double *rows, int8_t *out)
{
    while (times--)
        ask(0, n, rows, out);
}

typedef size_t (*kernel)(int, const double *, size_t, const double *, const double *, const double *, int8_t *);

void over_and_over(kernel ask, size_t times, const double *sizes, size_t n, const double *x, const double *y,
                   const double *z, int8_t *out)
{
    while (times--)
        ask(0, sizes, n, x, y, z, out);
}
"""
)

_PLAIN = """
void plain(const double *restrict sizes, size_t n, const double *restrict xs, const double *restrict ys,
           const double *restrict zs, int8_t *restrict out)
{
    table_2_float64_scene(sizes, n, xs, ys, zs, out);
}
"""


def baselines_source() -> str:
    """The programs compared with the compiled kernel: reading its rows, long products, and the uncertified Table 2.

    Other functions of the file call the kernel repeatedly.
    """
    return _BASELINES + of_formula(_TABLE_2, "float64").code + _PLAIN
