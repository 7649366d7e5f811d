"""`hypcheck classify --axis`: the answer about a spheroid that leans, its proof checked from the printed numbers."""

from __future__ import annotations

import json
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hypcheck import classify
from hypcheck.answer import answer, answer_as_json, answer_as_text, measured_clearance
from hypcheck.answers import answers
from hypcheck.cli.main import main
from hypcheck.geometry.pair import Pair
from hypcheck.tables.numbers import exact_text
from tests.cli.test_classify import number
from tests.kernel.test_tilted_integers import RINGS, small_rows, wide_rows
from tests.support.inside import decide
from tests.support.pairs import extreme_tilted_rows, nearly_touching_tilted_rows
from tests.support.tilted_fractions import combined, derivative, exact_position, interpolated, matrices, value


def options(row):
    alpha, gamma, b, d, *others = map(str, row)
    return [
        "classify",
        "--alpha",
        alpha,
        "--gamma",
        gamma,
        "--b",
        b,
        "--d",
        d,
        "--center",
        *others[:3],
        "--axis",
        *others[3:],
    ]


def check_printed_proof(row, printed):
    """Everything that is claimed, from the definitions and the printed strings alone."""
    S, H = matrices(row)
    proof = printed["proof"]
    if proof["by"] == "points":
        sides = set()
        for point in proof["points"]:
            x, y, z, h, s = (number(point[name]) for name in "xyzhs")
            at = [x, y, z, Fraction(1)]
            spheroid, hyperboloid = (
                sum(form[i][j] * at[i] * at[j] for i in range(4) for j in range(4)) for form in (S, H)
            )
            assert s == spheroid + 1 <= 1
            assert h == hyperboloid
            sides.add((h > 0) - (h < 0))
        assert 0 in sides or sides == {-1, 1}
        assert (printed["position"], printed["tangent"]) == (0, False)
        return
    at = number(proof["lambda"] if proof["by"] == "multiplier" else proof["m"])
    rows = [line[: len(proof["pivots"])] for line in combined(S, H, at)]
    for i, pivot in enumerate(map(number, proof["pivots"])):
        assert pivot == rows[i][i]
        assert pivot > 0 or not any(rows[i][i:])
        for k in range(i + 1, len(proof["pivots"]) if pivot else i):
            factor = rows[k][i] / pivot
            rows[k] = [a - factor * b for a, b in zip(rows[k], rows[i], strict=True)]
    if proof["by"] == "multiplier":
        assert len(proof["pivots"]) == 4
        assert "0" not in proof["pivots"]
        assert at * printed["position"] > 0
    else:
        f, expected = list(map(number, proof["f"])), interpolated(S, H)
        assert f == [each / -expected[0] for each in expected]
        assert value(f, at) == value(derivative(f), at) == 0 != at
        assert (printed["position"], printed["tangent"]) == (0, True)


TOUCHING = [[4.0, 1.0, 2.0, 1.0, 3.0, 0.0, 0.0, 1.0, 0.0, 0.0], [1.0, 2.0, 1.0, 0.5, 1.5, 0.0, 0.0, 1.0, 0.0, 0.0]]


WIDE = wide_rows(32, 4)


@pytest.mark.parametrize(
    "row",
    [
        *(list(row) for row, _ in RINGS),
        *TOUCHING,
        *small_rows(31, 30),
        *WIDE[:3:2],
        *(pytest.param(row, marks=pytest.mark.thorough) for row in WIDE[1::2]),
    ],
)
def test_every_proof_that_classify_prints_for_a_tilted_pair_can_be_checked_from_its_text(row):
    found = answer(Pair.from_row(row))
    printed = json.loads(answer_as_json(found))
    if max(map(abs, row)) < 1e9:
        assert printed["position"] == exact_position(row)
    check_printed_proof(row, printed)
    assert printed["kind"] is None
    text = answer_as_text(found)
    assert text.startswith(printed["label"])
    assert "kind" not in text
    assert max(map(len, text.splitlines())) < 400


@pytest.mark.parametrize("row", [TOUCHING[0], [1.0, 2.0, 1.0, 0.5, 2.5, 0.0, 0.0, 1.0, 1.0, 0.0]])
def test_a_proof_for_a_tilted_pair_fails_its_check_if_one_number_is_changed(row):
    proof = json.loads(answer_as_json(answer(Pair.from_row(row))))
    check_printed_proof(row, proof)
    for name in ("pivots", "f"):
        for index in range(len(proof["proof"].get(name, ()))):
            changed = list(proof["proof"][name])
            changed[index] = exact_text(number(changed[index]) + 1)
            with pytest.raises(AssertionError):
                check_printed_proof(row, proof | {"proof": proof["proof"] | {name: changed}})


@pytest.mark.parametrize("y", ["1e-165", "1e-170", "-1e-200", "5e-324"])
def test_classify_answers_a_clearance_below_the_least_float64_with_the_least_that_has_its_sign(y, capsys):
    assert main([*options([1, 2, 1, 1.5, 2, y, 0, 0, 1, 0]), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["position"], found["tangent"], found["clearance"]) == (1, False, 5e-324)


HUGE, FLAT = float.fromhex("0x1.fffffffffffe9p+1023"), float.fromhex("0x0.07602de4963fep-1022")
GAMMA, HEIGHT = float.fromhex("0x1.f26de949a5ee1p-300"), float.fromhex("-0x1.362e3227d0290p-300")
WIDEST = [HUGE, GAMMA, HUGE, FLAT, 0, 0, HEIGHT, 3, 0, -1]


def test_the_clearance_of_an_interior_pair_of_the_widest_range_of_lengths_is_the_least_float():
    pair = Pair.from_row(WIDEST)
    decision = decide(pair.lengths)
    assert (decision.position, decision.tangent, measured_clearance(pair, decision)) == (-1, False, 5e-324)
    found = answers(np.array([WIDEST]))
    assert (found.positions[0], found.tangent[0], found.clearance[0]) == (-1, False, 5e-324)


@pytest.mark.thorough  # its proof has thousands of bits
def test_classify_answers_an_interior_pair_of_the_widest_range_of_lengths(capsys):
    assert main([*options(WIDEST), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["position"], found["tangent"], found["clearance"]) == (-1, False, 5e-324)


@settings(max_examples=25)
@given(st.lists(st.one_of(nearly_touching_tilted_rows, extreme_tilted_rows), min_size=1, max_size=4))
def test_clearance_is_0_exactly_for_tangencies_and_has_the_sign_of_the_position_at_any_exponents(rows):
    found = answers(np.array(rows, dtype=np.float64))
    assert found.positions.tolist() == classify(rows).tolist()
    assert ((found.clearance == 0) == found.tangent).all()
    assert ((found.clearance > 0) == (found.positions != 0)).all()
    assert (found.clearance >= -1).all()
