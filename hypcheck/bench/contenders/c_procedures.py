"""The quadcopter's procedures in C, one position a call: so a craft asks before it moves."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.derivation.program import Program
from hypcheck.kernel.printing.c import c_statements
from hypcheck.methods.procedures import (
    CRAFT,
    MOVING,
    PRINTED,
    PUT_RIGHT,
    hull_programs,
    hull_steps,
    rotor_programs,
)

NAMES = ("nothing", "procedure-2a", "procedure-2b", "certified", "procedure-2a-repaired", "procedure-2b-repaired")
"""By their places in the driver's table; the first does nothing."""


def procedures_source() -> str:
    """The functions and their driver; hypcheck.h and math.h are included before."""
    return _before("hull", hull_programs()[0]) + _before("rotors", rotor_programs()[0]) + "".join(_both()) + _REST


def _both() -> Iterator[str]:
    """The procedures as printed and put right, which keep the same numbers of a craft."""
    for repaired, prefix in ((PRINTED, ""), (PUT_RIGHT, "repaired_")):
        asked, inside = hull_steps(repaired)
        (hull_before, hull), (rotor_before, rotors) = hull_programs(repaired), rotor_programs(repaired)
        yield _asked(f"{prefix}rotors", rotor_before, rotors, ("valid",), "return valid;")
        yield _asked(f"{prefix}hull", hull_before, hull, (asked, inside), f"return {asked} ? 2 : {inside};")
        yield _PROCEDURES.replace("{prefix}", prefix)


def _before(name: str, program: Program) -> str:
    """What the craft alone decides, kept in an array: a program would hold it in a structure."""
    kept = [step.name for step in program.steps]
    stored = "\n".join(f"    k[{place}] = {each};" for place, each in enumerate(kept))
    statements = "\n".join(f"    {line}" for line in c_statements(program, tuple(kept)))
    return f"\nstatic void {name}_before(const double *craft, double *k)\n{{\n{_craft()}\n{statements}\n{stored}\n}}\n"


def _asked(name: str, before: Program, program: Program, wanted: tuple[str, ...], end: str) -> str:
    read = {each for step in program.steps for each in step.reads}
    kept = "\n".join(
        f"    const double {step.name} = k[{place}];" for place, step in enumerate(before.steps) if step.name in read
    )
    inputs = _craft(read)
    statements = "\n".join(f"    {line}" for line in c_statements(program, wanted))
    moving = ", ".join(f"double {each}" for each in MOVING)
    unused = "".join(f"    (void){each};\n" for each in MOVING if each not in read)
    return (
        f"\nstatic int {name}_asked(const double *craft, const double *k, {moving})\n"
        f"{{\n    (void)craft;\n{unused}{inputs}\n{kept}\n{statements}\n    {end}\n}}\n"
    )


def _craft(read: set[str] | None = None) -> str:
    named = [(place, each) for place, each in enumerate(CRAFT) if read is None or each in read]
    taken = "\n".join(f"    const double {each} = craft[{place}];" for place, each in named)
    return taken + "".join(f"\n    (void){each};" for _, each in named)


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
