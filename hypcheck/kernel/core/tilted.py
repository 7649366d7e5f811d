"""What generate.py prints for spheroids whose axis leans: their integers, and the memory that these need."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from hypcheck.derivation.program import Program, Step, needed
from hypcheck.geometry.pair import TILTED_COLUMNS
from hypcheck.kernel.programs.integers import bits_counted
from hypcheck.kernel.programs.tilted_integers import COEFFICIENTS, DISCRIMINANT, INVARIANTS, QUARTIC

KEPT = ("p", "q", "s", "t", "k0", "k1", "k2", *COEFFICIENTS)
"""What hc_quartic_of keeps, in the order of the program."""

CUT_BITS = 128


def pool_bits() -> tuple[int, int]:
    """The most bits that the integers of hc_exact_tilted_position have at any time, and the most numbers these are."""
    quartic = bits_counted(QUARTIC)
    kept = sum(quartic[name] for name in KEPT)
    invariants = _bits_of(INVARIANTS, {name: quartic[name] for name in COEFFICIENTS})
    discriminant = _bits_of(DISCRIMINANT, {name: invariants[name] for name in ("I", "J")})
    phases = (
        sum(quartic.values()),
        kept + 5 * (CUT_BITS + 64) + sum(invariants.values()),
        kept + 5 * (CUT_BITS + 64) + sum(discriminant.values()),
        kept + max(_bits_about_a_pole(quartic)),
    )
    return max(phases), len(QUARTIC.steps) + len(TILTED_COLUMNS)


def kilobytes() -> int:
    """What the stack holds at most for a row whose axis leans: the integers, and what calls them."""
    bits, numbers = pool_bits()
    return -(-(bits // 8 + 16 * numbers + 24 * 1024) // 1024)


def _bits_of(program: Program, inputs: Mapping[str, int]) -> dict[str, int]:
    bits = bits_counted(program, max(inputs.values()))
    return {**bits, **inputs}


def _bits_about_a_pole(k: Mapping[str, int]) -> list[int]:
    """The bits in use at each step of hc_coefficient_sign and hc_sign_with_root."""
    n, scale = k["k0"] + k["k2"], max(k["k2"], k["q"])
    u, v, power, found = scale + 3, 0, 1, []
    for name in ("f3", "f2", "f1", "minus_f0"):
        term = k[name] + power
        v_n, v_k1, u_p = v + n, v + k["k1"], u + k["p"]
        next_u, next_v, next_power = max(v_n, term + 3, u_p) + 1, max(u, v_k1) + 1, power + scale
        found.append(n + u + v + power + 2 * term + 3 + v_n + v_k1 + u_p + next_u + next_v + next_power)
        u, v, power = next_u, next_v, next_power
    U, D = max(u + 2, v + k["k1"]) + 1, max(2 * k["k1"], n + 3) + 1
    found.append(n + u + v + power + u + 2 + v + k["k1"] + U + 2 * U + 2 * v + 2 * k["k1"] + n + 3 + D + 2 * v + D)
    found[-1] += max(2 * U, 2 * v + D) + 1
    return found


def _statement(step: Step) -> str:
    left, right = step.arguments
    if isinstance(left, int):
        return f"const hc_integer {step.name} = hc_multiple(POOL, {left}, &{right});"
    if step.operation == "mul":
        return f"const hc_integer {step.name} = hc_product(POOL, &{left}, &{right});"
    sign = {"add": 1, "sub": -1}[step.operation]
    return f"const hc_integer {step.name} = hc_sum(POOL, &{left}, &{right}, {sign});"


def _statements(program: Program, wanted: tuple[str, ...], pool: str) -> list[str]:
    return [_statement(step).replace("POOL", pool) for step in needed(program, wanted)]


def _pool() -> list[str]:
    bits, numbers = pool_bits()
    return [
        f"#define HC_CUT_BITS {CUT_BITS}",
        f"#define HC_TILTED_LIMBS ({bits} / HC_LIMB_BITS + {2 * numbers}) /* counted from the programs */",
    ]


TEXTS: dict[str, Callable[[], Iterable[str]]] = {
    "TILTED_POOL": _pool,
    "TILTED_QUARTIC": lambda: _statements(QUARTIC, KEPT, "pool"),
    "TILTED_INVARIANTS": lambda: _statements(INVARIANTS, ("I", "J"), "&pool"),
    "TILTED_DISCRIMINANT": lambda: _statements(DISCRIMINANT, ("delta",), "&pool"),
}
