"""`hypcheck classify` about one pair: the answer, its proof checked from the printed numbers, and bad options."""

from __future__ import annotations

import json
from fractions import Fraction

import pytest
from hypothesis import given, settings

from hypcheck.answer import answer, answer_as_json, answer_as_text
from hypcheck.cli.main import main
from hypcheck.geometry.pair import Pair, Position
from hypcheck.tables.numbers import exact_text, readable_text
from tests.support.inside import Certificate, Decision, kernel_classify, least
from tests.support.inside import exact as oracle
from tests.support.pairs import pairs


def options(*row: object) -> list[str]:
    alpha, gamma, b, d, *center = map(str, row)
    return ["classify", "--alpha", alpha, "--gamma", gamma, "--b", b, "--d", d, "--center", *center]


# By hand. The waist is a circle of radius 1 or 4, and the distance of a unit ball from it is seen at once.
KNOWN = {
    (1, 2, 1, 1, 2.5, 0, 0): ("exterior", 1, False, 0.5),
    (1, 2, 1, 1, 2, 0, 0): ("contact", 0, True, 0.0),
    (1, 2, 1, 1, 1.5, 0, 0): ("contact", 0, False, -0.5),
    (1, 2, 1, 1, 1, 0, 0): ("contact", 0, False, -1.0),
    (4, 4, 1, 1, 0, 0, 0): ("interior", -1, False, 3.0),
    (4, 4, 1, 1, 3, 0, 0): ("contact", 0, True, 0.0),
    (4, 4, 0.5, 1, 0, -3, 0): ("interior", -1, False, 1.0),
    (1, 1, 1, 1, 1, 0, "1e300"): ("interior", -1, False, None),
    ("1e300", "1e300", "1e-300", "5e-324", "1.1e300", 0, 0): ("exterior", 1, False, "inf"),
}

DISTANCES = {(1, 2, 1, 1, 2.5, 0, 0): 0.5, (4, 4, 1, 1, 0, 0, 0): 3.0, (4, 4, 0.5, 1, 0, -3, 0): 0.5}


@pytest.mark.parametrize(("row", "known"), KNOWN.items())
def test_classify_of_one_pair_gives_the_answer_computed_by_hand(row, known, capsys):
    label, position, tangent, clearance = known
    assert main([*options(*row), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["label"], found["position"], found["tangent"]) == (label, position, tangent)
    if clearance is not None:
        assert found["clearance"] == clearance
    assert main(options(*row)) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == (f"{label}, tangent" if tangent else label)
    if clearance is not None:
        shown = clearance if clearance == "inf" else f"{clearance:g}"
        assert lines[2].startswith(f"clearance  {shown} spheroid radi")
    distance = DISTANCES.get(row, 0.0 if position == 0 else None)
    if distance is not None:
        assert found["distance_lower"] <= distance <= found["distance_upper"]
        assert found["distance_upper"] - found["distance_lower"] < 1e-8
        shown = f"{distance:g}, in the unit of the lengths (proved: from " if distance else "0"
        assert lines[1].startswith(f"distance   {shown}")


def check_printed_proof(pair: Pair, printed: dict) -> None:
    """Check everything claimed, from the definitions and the printed strings alone."""
    alpha, gamma, b, d, x, y, z = map(Fraction, pair.row)
    proof = {name: number(value) for name, value in printed["proof"].items() if isinstance(value, str) and name != "by"}
    if printed["proof"]["by"] == "points":
        sides = set()
        for point in printed["proof"]["points"]:
            u, v, w, h, s = (number(point[name]) for name in "xyzhs")
            assert s == ((u - x) ** 2 + (v - y) ** 2) / b**2 + (w - z) ** 2 / d**2 <= 1
            assert h == (u * u + v * v) / alpha**2 - w * w / gamma**2 - 1
            sides.add((h > 0) - (h < 0))
        assert 0 in sides or sides == {-1, 1}
        assert (printed["position"], printed["tangent"]) == (0, False)
        return
    A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / b**2, (z / d) ** 2
    assert (proof["A"], proof["B"], proof["P"], proof["Q"]) == (A, B, P, Q)
    c2, c1, c0 = A - B + 1 - P - Q, -A * B + A - B + B * P - A * Q, -A * B
    if printed["proof"]["by"] == "multiplier":
        t = proof["lambda"]
        low, high = map(number, printed["proof"]["between"])
        assert (low, high) == ((0, B) if printed["position"] == 1 else (-A, 0))
        assert low < t < high
        assert proof["g"] == ((t + c2) * t + c1) * t + c0 > 0
    else:
        m, third = proof["m"], proof["third_root"]
        assert (c2, c1, c0) == (-2 * m - third, m * m + 2 * m * third, -m * m * third)
        assert -A <= m <= B
        assert m != 0
        assert m != B or third >= B
        assert (printed["position"], printed["tangent"]) == (0, True)


def number(text: str) -> Fraction:
    """A rational from its decimal digits, however many: Python's own reader stops at 4300."""
    top, _, bottom = text.partition("/")
    return Fraction(integer(top), integer(bottom or "1"))


def integer(digits: str) -> int:
    if digits.startswith("-"):
        return -integer(digits[1:])
    return int(digits) if len(digits) < 4000 else integer(digits[:-4000]) * 10**4000 + int(digits[-4000:])


@pytest.mark.slow
@settings(max_examples=60)
@given(pairs)
def test_every_proof_that_classify_prints_can_be_checked_from_its_text(pair):
    found = answer(pair)
    printed = json.loads(answer_as_json(found))
    check_printed_proof(pair, printed)
    assert printed["kind"] == found.decision.kind.value
    text = answer_as_text(found)
    assert text.startswith(printed["label"])
    assert max(map(len, text.splitlines())) < 400


@pytest.mark.parametrize("row", [(4, 10, 1, 1, 3, 4, 1e-160), (1, 1, 3, 1, 4, 1e-160, 0), (1, 2, 1, 1, 2, 0, 0)])
def test_a_proof_printed_by_classify_fails_its_check_if_one_number_is_changed(row):
    """The check above sees every number: change one, and it fails."""
    pair = Pair.from_row(map(float, row))
    proof = json.loads(answer_as_json(answer(pair)))
    for name, value in proof["proof"].items():
        if name == "by" or isinstance(value, list):
            continue
        changed = proof | {"proof": proof["proof"] | {name: exact_text(number(value) + 1)}}
        with pytest.raises(AssertionError):
            check_printed_proof(pair, changed)


@pytest.mark.parametrize("power", [10, 2999, 3000, 3001, 4301, 12_345])
def test_exact_text_writes_integers_and_fractions_of_any_length(power):
    for value in (10**power, 10**power - 1, -(7**power)):
        assert number(exact_text(Fraction(value))) == value
        assert number(exact_text(Fraction(value, 3**power))) == Fraction(value, 3**power)
        assert len(readable_text(Fraction(value, 3))) < 40


def test_readable_text_marks_a_rounded_number():
    assert readable_text(Fraction(25, 4)) == "25/4"
    assert readable_text(Fraction(1, 3) ** 80).startswith("≈ 6.765")


def test_classify_ends_with_6_if_the_oracles_disagree(monkeypatch, capsys):

    right = oracle.decide

    def wrong(lengths):
        decision = right(lengths)
        return Decision(type(decision.position)(-1), decision.tangent, decision.kind)

    monkeypatch.setattr(oracle, "decide", wrong)
    assert main(options(1, 2, 1, 1, 2.5, 0, 0)) == 6
    output, errors = capsys.readouterr()
    assert output == ""
    assert "two oracles disagree about alpha 1.0" in errors


def test_classify_ends_with_6_and_prints_no_proof_if_the_proof_does_not_hold(monkeypatch, capsys):
    from hypcheck import answer as module

    def wrong(pair, decision):
        return Certificate(decision.position, multiplier=Fraction(4))

    monkeypatch.setattr(module, "prove", wrong)
    assert main(options(1, 2, 1, 1, 2.5, 0, 0)) == 6
    assert "does not hold" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("module", "name", "more", "other"),
    [
        (least, "position", ["--z-max", "9"], "by the least value interior"),
        (kernel_classify, "classify", ["--margin", "0.1"], "with a margin interior"),
    ],
)
def test_classify_ends_with_6_if_the_least_value_or_the_position_with_a_margin_disagrees(
    module, name, more, other, monkeypatch, capsys
):
    monkeypatch.setattr(module, name, lambda *_, **__: Position.INTERIOR)
    assert main([*options(1, 2, 1, 1, 2.5, 0, 0), *more]) == 6
    output, errors = capsys.readouterr()
    assert output == ""
    assert "two oracles disagree about alpha 1.0" in errors
    assert f"by exact decision exterior, {other};" in errors


@pytest.mark.parametrize(("margin", "says"), [("0.25", "exterior: {} is proved"), ("1", "contact: {} is not proved")])
def test_text_about_a_margin_says_whether_a_distance_of_the_margin_is_proved(margin, says, capsys):
    assert main([*options(1, 2, 1, 1, 2.5, 0, 0), "--margin", margin]) == 0
    line = says.format(f"a distance of at least {margin}")
    assert f"margin     {line}" in capsys.readouterr().out.splitlines()


@pytest.mark.parametrize(
    ("center", "margin", "position"),
    [("2.5", "0.49", 1), ("2.5", "0.51", 0), ("0.5", "0.1", 0), ("2", "0", 0), ("2.5", "0", 1)],
)
def test_classify_with_a_margin_gives_contact_if_the_distance_is_less(center, margin, position, capsys):
    """A ball of radius 1 beside a waist of radius 1: the distance at 2.5 is 0.5; at 2 and at 0.5 the surfaces meet."""
    sizes = ["--alpha", "1", "--gamma", "2", "--b", "1", "--d", "1", "--center", center, "0", "0"]
    assert main(["classify", *sizes, "--json", "--margin", margin]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["margin"], found["position_with_margin"]) == (float(margin), position)
    assert main(["classify", *sizes, "--json"]) == 0
    plain = json.loads(capsys.readouterr().out)
    assert plain == {name: value for name, value in found.items() if "margin" not in name}
