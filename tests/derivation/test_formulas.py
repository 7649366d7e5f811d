"""Answers of the formulas, in exact arithmetic, to pairs whose position is known by geometry."""

from __future__ import annotations

import subprocess
import sys
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hypcheck.derivation.evaluation import EXACT, evaluate
from hypcheck.derivation.formulas import FORMULAS, REGIMES, answers
from hypcheck.geometry.pair import COLUMNS, Position

HALF, QUARTER = Fraction(1, 2), Fraction(1, 4)
EXTERIOR, CONTACT, INTERIOR = Position.EXTERIOR, Position.CONTACT, Position.INTERIOR
RIGHT_EVERYWHERE = [f.name for f in FORMULAS.values() if f.question == "position" and f.classifies_pairs]
OF_ONE_SPHEROID = ("procedure-2a-spheroid", "procedure-2b-spheroid")
PROCEDURE_1 = ("table-2", "procedure-1")


def answer(name, a, c, center, **more):
    """The formula's answer to the unit sphere about `center` and the hyperboloid of semi-axes a and c."""
    row = dict(zip(COLUMNS, (a, c, 1, 1, *center), strict=True))
    return answers(FORMULAS[name], EXACT, {**row, **more})


# Distances: on the axis dist² = A + AQ/(A+B); at the waist |r − a|, or from r = a + B/a on (two nearest points, off the
# waist plane) dist² = B(P − A − B)/(A + B).
WITNESSES = [
    (1, 2, (Fraction(5, 2), 0, 0), EXTERIOR),  # the ring: r − a = 3/2
    (7, 7, (10, 0, 0), EXTERIOR),  # the ring: r − a = 3
    (7, 7, (6, 8, 0), EXTERIOR),
    (3, 3, (1, 0, 0), INTERIOR),  # a − r = 2; c2 = 0
    (4, 1, (1, 0, 0), INTERIOR),  # a − r = 3; c1 = 0
    (1, 1, (1, 0, 0), CONTACT),  # its centre lies on the waist; g = λ³ − 1
    (HALF, 1, (0, 0, 2), INTERIOR),  # dist² = 21/20
    (QUARTER, 1, (HALF, 0, 0), CONTACT),  # r − a = 1/4
    (2, 1, (4, 0, 0), EXTERIOR),  # dist² = 11/5
    (2, HALF, (4, 0, 0), CONTACT),  # dist² = 47/68
    (1, QUARTER, (2, 0, HALF), CONTACT),  # the point (√5, 0, 1/2) is at distance √5 − 2 < 1
    (1, 2, (2, 0, 0), CONTACT),  # touches (1, 0, 0)
    (3, 3, (2, 0, 0), CONTACT),  # touches (3, 0, 0) from inside
    (1, 1, (0, 0, 0), CONTACT),  # fits the waist
    (4, 2, (5, 0, 0), CONTACT),  # touches (4, 0, 0), g = (λ − 4)³
    (1, HALF, (Fraction(5, 2), 0, 0), CONTACT),  # touches at two points: dist² = 1/4·(25/4 − 5/4)/(5/4) = 1
    (3, 3, (0, 0, 0), INTERIOR),
    (1, 2, (3, 0, 0), EXTERIOR),
]


@pytest.mark.parametrize("name", RIGHT_EVERYWHERE)
def test_formulas_for_all_sizes_are_right_on_pairs_with_a_known_position(name):
    assert [answer(name, *pair) for *pair, _ in WITNESSES] == [position for *_, position in WITNESSES]


@pytest.mark.parametrize(
    ("a", "c", "center", "multiplier", "position"),
    [
        (1, 2, (Fraction(5, 2), 0, 0), 1, EXTERIOR),  # φ = 25/8 − 2
        (7, 7, (10, 0, 0), 7, EXTERIOR),  # φ = 700/56 − 8
        (3, 3, (1, 0, 0), -2, INTERIOR),  # φ = −2/7 + 1
        (3, 3, (1, 0, 0), -1, CONTACT),  # φ = −1/8: this λ proves nothing
        (4, 1, (1, 0, 0), -3, INTERIOR),  # φ = −3/13 + 2
        (2, HALF, (4, 0, 0), Fraction(1, 5), CONTACT),
        (1, 2, (Fraction(5, 2), 0, 0), 4, CONTACT),  # λ = B is no proof, nor is any λ outside (−A, B)
        (1, 2, (Fraction(5, 2), 0, 0), -2, CONTACT),
        (3, 3, (1, 0, 0), 0, CONTACT),
    ],
)
def test_the_dual_form_decides_with_the_given_multiplier(a, c, center, multiplier, position):
    assert answer("dual", a, c, center, lambda_=multiplier) == position


def test_the_dual_form_near_a_tangency_proves_exterior_only_with_the_exact_multiplier():
    row = {"alpha": 1, "gamma": 1, "b": 3, "d": 1, "x": 4, "y": 1e-160, "z": 0}
    for name in RIGHT_EVERYWHERE:
        assert answers(FORMULAS[name], EXACT, row) == EXTERIOR
    assert answers(FORMULAS["dual"], EXACT, {**row, "lambda_": Fraction(1, 3)}) == EXTERIOR
    assert answers(FORMULAS["dual"], EXACT, {**row, "lambda_": 1 / 3}) == CONTACT


@pytest.mark.parametrize(("a", "c", "center"), [(1, 2, (Fraction(5, 2), 0, 0)), (7, 7, (10, 0, 0))])
@pytest.mark.parametrize("name", PROCEDURE_1)
def test_procedure_1_as_printed_answers_contact_on_the_ring_where_the_pair_is_exterior(name, a, c, center):
    assert c**2 > a  # the regime it is printed for
    assert answer(name, a, c, center) == 0
    values = evaluate(FORMULAS[name].program, EXACT, dict(zip(COLUMNS, (a, c, 1, 1, *center), strict=True)))
    assert values["delta"] == 0


@pytest.mark.parametrize("name", OF_ONE_SPHEROID)
@pytest.mark.parametrize(("a", "c", "coefficient"), [(3, 3, "c2"), (4, 1, "c1")])
def test_procedures_2_as_printed_refuse_interior_positions_with_a_zero_coefficient(name, a, c, coefficient):
    assert answer(name, a, c, (1, 0, 0)) == 0
    values = evaluate(FORMULAS[name].program, EXACT, dict(zip(COLUMNS, (a, c, 1, 1, 1, 0, 0), strict=True)))
    assert values[coefficient] == 0
    assert values["delta"] > 0


@pytest.mark.parametrize("name", PROCEDURE_1)
def test_procedure_1_outside_its_regime_answers_exterior_for_a_pair_in_contact(name):
    assert answer(name, 2, HALF, (4, 0, 0)) == 1


def test_table_2_has_a_positive_discriminant_for_a_pair_in_contact_if_c_is_small():
    row = dict(zip(COLUMNS, (1, QUARTER, 1, 1, 2, 0, HALF), strict=True))
    assert evaluate(FORMULAS["table-2"].program, EXACT, row)["delta"] == Fraction(2023, 4096)
    # All four rotors, b/40 wide on arms of b/20·√2, are interior: at height 1/2 ± d/40 the radius exceeds 2.1.
    rotors = {"b_s": Fraction(1, 40), "d_s": Fraction(1, 40), "l": Fraction(1, 20), "cosine": 1, "sine": 0}
    for rotor in ((2, Fraction(1, 20)), (2, -Fraction(1, 20)), (2 + Fraction(1, 20), 0), (2 - Fraction(1, 20), 0)):
        pair = dict(zip(COLUMNS, (1, QUARTER, rotors["b_s"], rotors["d_s"], *rotor, HALF), strict=True))
        assert answers(FORMULAS["coefficients"], EXACT, pair) == INTERIOR
    assert answers(FORMULAS["procedure-2a"], EXACT, {**row, **rotors}) == 1
    assert answers(FORMULAS["procedure-2b"], EXACT, {**row, **rotors}) == 0


@st.composite
def rotor_scenes(draw):
    """A hyperboloid wide enough for its regime, a quadcopter, and an angle with rational cosine and sine."""
    t = draw(st.fractions(-2, 2, max_denominator=9))
    size, place = st.fractions(HALF, 2, max_denominator=9), st.fractions(-3, 3, max_denominator=9)
    b, b_s = draw(size), draw(size) / 4
    return {
        "alpha": max(b, 2 * b_s) + draw(st.fractions(0, 4, max_denominator=9)),
        "gamma": draw(size) * 4,
        "b": b,
        "d": draw(size),
        "b_s": b_s,
        "d_s": draw(size) / 4,
        "x": draw(place),
        "y": draw(place),
        "z": draw(place),
        "l": draw(size),
        "cosine": (1 - t**2) / (1 + t**2),
        "sine": 2 * t / (1 + t**2),
    }


@settings(max_examples=10)
@given(rotor_scenes())
def test_procedures_2_test_each_rotor_as_their_formula_for_one_spheroid(scene):
    rotors = evaluate(FORMULAS["procedure-2a"].program, EXACT, scene)
    # Rotor i stands at l/√2·(T1, T2) from the centre, and the next one a quarter of a turn on.
    cosine, sine = scene["cosine"], scene["sine"]
    corner = (cosine - sine, cosine + sine)
    arm = EXACT.operations["sqrt"](Fraction(2)) * (scene["l"] / 2)
    verdicts = []
    for rotor in (1, 2, 3, 4):
        here = {**scene, "b": scene["b_s"], "d": scene["d_s"]}
        here["x"], here["y"] = scene["x"] + arm * corner[0], scene["y"] + arm * corner[1]
        alone = values_with_surds(FORMULAS["procedure-2a-spheroid"].program, here)
        for name in ("c1", "c2", "delta", "touching", "inside"):
            assert rotors[f"{name}_g{rotor}"] == alone[name]
        verdicts.append(alone["valid"])
        corner = (-corner[1], corner[0])
    all_four = int(all(verdicts))
    assert answers(FORMULAS["procedure-2a"], EXACT, scene) == all_four
    hull = evaluate(FORMULAS["procedure-2b-spheroid"].program, EXACT, scene)
    assert answers(FORMULAS["procedure-2b"], EXACT, scene) == (all_four if hull["touching"] else hull["valid"])


def values_with_surds(program, inputs):
    """The program's values where inputs may be irrational already, and so are not converted."""
    values = dict(inputs)
    for step in program.steps:
        operands = (values[a] if isinstance(a, str) else Fraction(a) for a in step.arguments)
        values[step.name] = EXACT.operations[step.operation](*operands)
    return values


@st.composite
def known_positions(draw):
    """A pair made from a point of the hyperboloid and a step along its normal there, hence of known position.

    With (C, S) on the unit circle and u v = 1/k², a = (u+v)/(2C) and c = (v−u)/(2S), the point (a² k C, c² k S) of the
    meridian is on the hyperboloid and (C, −S) is its unit normal. A centre s outward from the point (inward for s < 0)
    has t = s/k in F(t) = 0; as long as −A < t < B the point is the nearest one and the distance is |s|. For |s| ≤ 1 the
    closed ball has the point in it, whatever t is.
    """
    slope = draw(st.fractions(Fraction(1, 9), Fraction(8, 9), max_denominator=9))
    cosine, sine = (1 - slope**2) / (1 + slope**2), 2 * slope / (1 + slope**2)
    k = draw(st.fractions(Fraction(1, 4), 4, max_denominator=8))
    v = draw(st.fractions(Fraction(1, 4), 8, max_denominator=8).filter(lambda v: v * k > 1))
    u = 1 / (k**2 * v)
    a, c = (u + v) / (2 * cosine), (v - u) / (2 * sine)
    step = draw(st.sampled_from([-1, 1])) * draw(
        st.one_of(st.just(Fraction(1)), st.fractions(0, 3, max_denominator=16), st.just(1 + Fraction(1, 10**30)))
    )
    near = -(a**2) < step / k < c**2
    r, z = a**2 * k * cosine + step * cosine, c**2 * k * sine - step * sine
    turn = draw(st.fractions(-1, 1, max_denominator=5))
    x, y = r * (1 - turn**2) / (1 + turn**2), r * 2 * turn / (1 + turn**2)
    b, d = draw(st.sampled_from([1, HALF, 3])), draw(st.sampled_from([1, QUARTER, 5]))
    row = dict(zip(COLUMNS, (a * b, c * d, b, d, x * b, y * b, z * d), strict=True))
    if abs(step) <= 1:
        return row, CONTACT
    return row, (EXTERIOR if step > 0 else INTERIOR) if near else None


@given(known_positions())
def test_formulas_for_all_sizes_agree_next_to_pairs_with_a_known_position(case):
    row, position = case
    found = {answers(FORMULAS[name], EXACT, row) for name in RIGHT_EVERYWHERE}
    assert len(found) == 1
    assert position is None or found == {position}


SMALL = st.fractions(-4, 4, max_denominator=4)
SMALL_SIZE = st.fractions(QUARTER, 4, max_denominator=4)


@given(SMALL_SIZE, SMALL_SIZE, SMALL, SMALL, st.fractions(-1, 1, max_denominator=64))
def test_a_position_that_the_dual_form_proves_is_that_of_all_other_formulas(a, c, r, z, share):
    """Wherever φ proves something, every formula agrees; in contact it proves nothing."""
    multiplier = share * (c**2 if share > 0 else a**2)
    proved = answer("dual", a, c, (r, 0, z), lambda_=multiplier)
    for name in RIGHT_EVERYWHERE:
        position = answer(name, a, c, (r, 0, z))
        assert proved in (CONTACT, position)


@given(SMALL_SIZE, SMALL_SIZE, SMALL, SMALL)
def test_printed_procedures_are_right_in_their_regime_except_for_the_known_exceptions(a, c, r, z):
    position = answer("local-maximum", a, c, (r, 0, z))
    ring = z == 0 and r**2 == (c**2 + 1) * (a**2 + c**2) / c**2 and c**2 > a
    values = evaluate(FORMULAS["table-2"].program, EXACT, dict(zip(COLUMNS, (a, c, 1, 1, r, 0, z), strict=True)))
    if c**2 >= a:
        for name in PROCEDURE_1:
            assert answer(name, a, c, (r, 0, z)) == (position == EXTERIOR and not ring)
    if a >= 1:
        dropped = 0 in (values["c1"], values["c2"])
        for name in OF_ONE_SPHEROID:
            assert answer(name, a, c, (r, 0, z)) == (position == INTERIOR and not dropped)


def test_each_formula_has_a_name_a_known_question_and_known_regimes():
    for name, formula in FORMULAS.items():
        assert formula.name == formula.program.name == name
        assert formula.question in {"position", "exterior", "interior"}
        assert set(formula.regimes) <= set(REGIMES)
        assert formula.title
        assert formula.source
    others = {name for name, formula in FORMULAS.items() if not formula.classifies_pairs}
    assert others == {"procedure-2a", "procedure-2b", "dual"}
    assert FORMULAS["dual"].program.inputs == (*COLUMNS, "lambda_")


def test_importing_the_formulas_loads_neither_sympy_nor_numpy():
    modules = ("formulas", "evaluation", "rounding", "program")
    imports = "; ".join(f"import hypcheck.derivation.{module}" for module in modules)
    code = f"{imports}; import sys; sys.exit(bool({{'sympy', 'numpy', 'mpmath', 'fcl'}} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], check=False, timeout=60).returncode == 0


def test_importing_float_arithmetic_does_not_load_sympy():
    code = "import hypcheck.derivation.float_arithmetic, sys; sys.exit('sympy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False, timeout=60).returncode == 0
