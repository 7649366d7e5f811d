"""The rule that each formula must follow, checked for every combination of signs.

A decision reads its numbers only through comparisons with 0 and with 3A, −3B, −A, B and B². The values tried meet every
combination of outcomes of these that can occur, so agreement on all of them is agreement everywhere.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import product

from hypcheck.derivation.paper_listings import ROTORS

SIGNS = (-1, 0, 1)


@dataclass(frozen=True)
class DecisionRule:
    """The step must be `rule` of the values of the steps or inputs named in `letters`, on every one of the `cases`.

    `statement` is the rule in words.
    """

    step: str
    letters: tuple[str, ...]
    cases: tuple[tuple[int, ...], ...]
    rule: Callable[..., int]
    statement: str


def decisions(formula_name: str) -> tuple[DecisionRule, ...]:
    """All that the answer of the formula by that name must be. Raises KeyError for a name that has none."""
    return _DECISIONS[formula_name]


def _proposition_3(delta: int, c1: int, c2: int) -> int:
    return int(delta > 0 and c2 < 0 and c1 > 0)


def _inside(c1: int, c2: int) -> bool:
    return (c2 > 0 and c1 != 0) or (c2 < 0 and c1 < 0)


def _one_spheroid(delta: int, c1: int, c2: int) -> int:
    return int(not delta <= 0 and _inside(c1, c2))


def _four_rotors(*signs: int, inside: Callable[[int, int], bool] = _inside) -> int:
    rotors = tuple(zip(signs[0::3], signs[1::3], signs[2::3], strict=True))
    if any(delta <= 0 for delta, _, _ in rotors):
        return 0
    return int(all(inside(c1, c2) for _, c1, c2 in rotors))


def _hull_then_rotors(delta: int, c1: int, c2: int, *rotors: int) -> int:
    return _four_rotors(*rotors) if delta <= 0 else int(_inside(c1, c2))


def _some_negative(c1: int, c2: int) -> bool:
    return not (c2 < 0 and c1 > 0)


def _four_rotors_repaired(*signs: int) -> int:
    return _four_rotors(*signs, inside=_some_negative)


def _hull_then_rotors_repaired(delta: int, c1: int, c2: int, *rotors: int) -> int:
    return int((delta > 0 and _some_negative(c1, c2)) or _four_rotors_repaired(*rotors))


def _procedure_1_repaired(delta: int, c1: int, c2: int, Q: int, E: int, EE: int, four_A: int) -> int:
    return int(E > 0 and EE > four_A) if Q == 0 else _proposition_3(delta, c1, c2)


def _all_regimes(delta: int, c1: int, c2: int, A: int, B: int, Q: int, slope_at_B: int, slope_at_minus_A: int) -> int:
    all_positive = c2 < 0 and c1 > 0
    ring = Q == 0 and slope_at_B == 0 and A < B**2
    if ring or (delta > 0 and all_positive and not (c2 < -3 * B and slope_at_B > 0)):
        return 1
    return -1 if delta > 0 and not all_positive and c2 < 3 * A and slope_at_minus_A > 0 else 0


def _at_local_maximum(h1: int, lambda_m: int, g_m: int, A: int, B: int) -> int:
    if h1 > 0 and g_m > 0 and -A < lambda_m < B:
        return (lambda_m > 0) - (lambda_m < 0)
    return 0


def _at_given_lambda(phi: int, lambda_: int, A: int, B: int) -> int:
    if phi > 0 and -A < lambda_ < B:
        return (lambda_ > 0) - (lambda_ < 0)
    return 0


def _chosen_maximum(c2: int, from_c1: int, from_c2: int) -> int:
    return from_c1 if c2 < 0 else from_c2


_ONE = ("delta", "c1", "c2")
_PATTERNS = tuple(product(SIGNS, repeat=3))
_ROTOR_LETTERS = tuple(f"{name}_g{rotor}" for rotor in ROTORS for name in _ONE)
_RIGHT, _TOUCHING, _OUTSIDE = (1, 1, 1), (0, 1, 1), (1, 1, -1)


def _rotor_cases() -> Iterable[tuple[int, ...]]:
    """Every pattern of each rotor beside three that are right, and all mixtures of right, touching and outside."""
    for rotor, pattern in product(range(len(ROTORS)), _PATTERNS):
        yield _RIGHT * rotor + pattern + _RIGHT * (len(ROTORS) - 1 - rotor)
    for mixture in product((_RIGHT, _TOUCHING, _OUTSIDE), repeat=len(ROTORS)):
        yield sum(mixture, ())


_PROPOSITION_3 = DecisionRule("valid", _ONE, _PATTERNS, _proposition_3, "valid ⟺ Δ > 0, c2 < 0 and c1 > 0")
_INTERIOR_RULE = "[c2 > 0; c1 ≠ 0] or [c2 < 0; c1 < 0]"
_ONE_SPHEROID = DecisionRule("valid", _ONE, _PATTERNS, _one_spheroid, f"valid ⟺ not Δ ≤ 0, and {_INTERIOR_RULE}")
_FOUR_ROTORS = DecisionRule(
    "valid",
    _ROTOR_LETTERS,
    tuple(_rotor_cases()),
    _four_rotors,
    f"non-valid if Δ(g_i) ≤ 0 for some i; else valid ⟺ {_INTERIOR_RULE} for all i",
)
_HULL_THEN_ROTORS = DecisionRule(
    "valid",
    (*_ONE, *_ROTOR_LETTERS),
    tuple(hull + rotors for hull, rotors in product(_PATTERNS, _rotor_cases())),
    _hull_then_rotors,
    f"as Procedure 2.a where Δ ≤ 0; else valid ⟺ {_INTERIOR_RULE}",
)
_REPAIRED_RULE = "Δ > 0 and not (c2 < 0 and c1 > 0)"
_FOUR_ROTORS_REPAIRED = DecisionRule(
    "valid", _ROTOR_LETTERS, _FOUR_ROTORS.cases, _four_rotors_repaired, f"valid ⟺ {_REPAIRED_RULE} for each rotor"
)
_HULL_THEN_ROTORS_REPAIRED = DecisionRule(
    "valid",
    _HULL_THEN_ROTORS.letters,
    _HULL_THEN_ROTORS.cases,
    _hull_then_rotors_repaired,
    f"valid ⟺ {_REPAIRED_RULE} for the bounding spheroid, or for each rotor",
)
_PROCEDURE_1_REPAIRED = DecisionRule(
    "answer",
    (*_ONE, "Q", "E", "EE", "four_A"),
    tuple(pattern + rest for pattern in _PATTERNS for rest in product(SIGNS, repeat=4)),
    _procedure_1_repaired,
    "valid ⟺ Q = 0, E > 0 and E² > 4A, or Q ≠ 0, Δ > 0, c2 < 0 and c1 > 0",
)
_SIZES_TRIED = ((1, 1), (1, 2), (2, 1))  # A = B², A < B² and A > B²


def _all_regimes_decision(discriminant: str) -> DecisionRule:
    # c2 below, at and above −3B, 0 and 3A, for A and B up to 2.
    cases = tuple(
        (delta, c1, c2, *sizes, Q, at_B, at_minus_A)
        for delta, c1, c2, sizes, Q, at_B, at_minus_A in product(
            SIGNS, SIGNS, (-7, -6, -4, -3, -1, 0, 1, 3, 4, 6, 7), _SIZES_TRIED, SIGNS, SIGNS, SIGNS
        )
    )
    letters = (discriminant, "c1", "c2", "A", "B", "Q", "slope_at_B", "slope_at_minus_A")
    return DecisionRule(
        "position",
        letters,
        cases,
        _all_regimes,
        "exterior ⟺ Δ > 0, c2 < 0, c1 > 0 and not (c2 < −3B and g'(B) > 0), or Q = 0, g'(B) = 0 and A < B²; "
        "interior ⟺ Δ > 0, not (c2 < 0 and c1 > 0), c2 < 3A and g'(−A) > 0",
    )


_AROUND = tuple(range(-3, 4))  # below, at, between and above −A, 0 and B, for A and B up to 2
_LOCAL_MAXIMUM = DecisionRule(
    "position",
    ("h1", "lambda_m", "g_m", "A", "B"),
    tuple((h1, at, g, *sizes) for h1, at, g, sizes in product(SIGNS, _AROUND, SIGNS, _SIZES_TRIED)),
    _at_local_maximum,
    "the sign of λm where h1 > 0, g(λm) > 0 and −A < λm < B, else contact",
)
_CHOICE = DecisionRule(
    "lambda_m",
    ("c2", "from_c1", "from_c2"),
    tuple((c2, 5, 7) for c2 in SIGNS),
    _chosen_maximum,
    "λm = c1/(−c2 + √h1) where c2 < 0, else (−c2 − √h1)/3",
)
_DUAL = DecisionRule(
    "position",
    ("phi", "lambda_", "A", "B"),
    tuple((phi, at, *sizes) for phi, at, sizes in product(SIGNS, _AROUND, _SIZES_TRIED)),
    _at_given_lambda,
    "the sign of λ where φ(λ) > 0 and −A < λ < B, else 0",
)

_ALL_POSITIVE = DecisionRule(
    "valid",
    ("delta_27", "r1", "r2", "r3"),
    tuple(product(SIGNS, repeat=4)),
    lambda *signs: int(min(signs) > 0),
    "valid ⟺ Δ > 0 and all three roots are positive",
)

_DECISIONS = {
    "table-2": (_PROPOSITION_3,),
    "procedure-1": (_PROPOSITION_3,),
    "procedure-2a": (_FOUR_ROTORS,),
    "procedure-2b": (_HULL_THEN_ROTORS,),
    "procedure-2a-spheroid": (_ONE_SPHEROID,),
    "procedure-2b-spheroid": (_ONE_SPHEROID,),
    "coefficients": (_all_regimes_decision("delta"),),
    "hessian": (_all_regimes_decision("delta_3"),),
    "shared": (_all_regimes_decision("delta_3"),),
    "local-maximum": (_LOCAL_MAXIMUM, _CHOICE),
    "dual": (_DUAL,),
    "roots-trigonometric": (_ALL_POSITIVE,),
    "procedure-1-repaired": (_PROCEDURE_1_REPAIRED,),
    "procedure-2a-repaired": (_FOUR_ROTORS_REPAIRED,),
    "procedure-2b-repaired": (_HULL_THEN_ROTORS_REPAIRED,),
}
