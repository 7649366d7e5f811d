"""`hypcheck classify` about one pair: the answer, its proof checked from the printed numbers, and bad options."""

from __future__ import annotations

import json
import re
from fractions import Fraction

import pytest
from hypothesis import given, settings

from hypcheck.answer import answer, answer_as_json, answer_as_text
from hypcheck.cli.main import main
from hypcheck.geometry.pair import Pair
from hypcheck.tables.numbers import exact_text, readable_text
from hypcheck.truth.exact import Decision
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
        assert lines[1].startswith(f"clearance  {shown} spheroid radi")


def test_classify_reads_negative_centers_in_every_notation(capsys):
    for center in (("-2.5", "-0", "-0.0"), ("-.25e1", "0", "-1e-400"), ("0", "-25e-1", "+0")):
        assert main([*options(1, 2, 1, 1, *center), "--json"]) == 0
        assert json.loads(capsys.readouterr().out)["clearance"] == 0.5


def test_classify_prints_a_valid_proof_for_the_example_of_the_readme(capsys):
    assert main(options(1, 2, 1, 1, 2.5, 0, 0)) == 0
    text = " ".join(capsys.readouterr().out.split())
    at, value = re.search(r"λ = (\S+) lies in \(0, B\) and g\(λ\) = (\S+) is above 0", text).groups()
    assert "A = (α/b)² = 1, B = (γ/d)² = 4, P = (x₀²+y₀²)/b² = 25/4, Q = (z₀/d)² = 0" in text
    t = Fraction(at)
    assert 0 < t < 4
    assert Fraction(value) == (1 + t) * (4 - t) * (Fraction(25, 4) - 1 - t) - Fraction(25, 4) * (4 - t) > 0


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


@pytest.mark.parametrize("left_out", ["--alpha", "--gamma", "--b", "--d", "--center"])
def test_classify_names_the_missing_option_of_one_pair(left_out, capsys):
    words = options(1, 2, 1, 1, 2.5, 0, 0)
    place = words.index(left_out)
    del words[place : place + (4 if left_out == "--center" else 2)]
    assert main(words) == 2
    assert capsys.readouterr().err.startswith(f"hypcheck: error: {left_out} is missing; ")


@pytest.mark.parametrize(
    ("row", "sentence"),
    [
        ((0, 2, 1, 1, 2, 0, 0), "--alpha is 0; a semi-axis must be greater than 0"),
        ((1, -2, 1, 1, 2, 0, 0), "--gamma is -2; a semi-axis must be greater than 0"),
        ((1, 2, "1e-999", 1, 2, 0, 0), "--b is 1e-999, which is too small for float64; it must be greater than 0"),
        ((1, 2, 1, "inf", 2, 0, 0), "--d is 'inf'; it must be finite"),
        ((1, 2, 1, 1, "nan", 0, 0), "--center: x is 'nan'; it must be finite"),
        (("0e-9", 2, 1, 1, 0, 0, 0), "--alpha is 0e-9; a semi-axis must be greater than 0"),
        ((1, 2, 1, 1, 0, "-1e999", 0), "--center: y is -1e999, which is too large for float64"),
        ((1, 2, 1, 1, 0, 0, "1_0"), "--center: z is '1_0'; it must be a decimal number such as 2.5 or -1e-3"),
        (("٣", 2, 1, 1, 0, 0, 0), "--alpha is '٣'; it must be a decimal number such as 2.5 or -1e-3"),
        (("", 2, 1, 1, 0, 0, 0), "--alpha is empty; it must be a number"),
    ],
)
def test_classify_refuses_an_invalid_number_and_says_what_its_option_takes(row, sentence, capsys):
    assert main(options(*row)) == 2
    assert capsys.readouterr().err == f"hypcheck: error: {sentence}\n"


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["classify"], "nothing to classify"),
        (["classify", "--input", "a.csv"], "--output is missing"),
        (["classify", "--output", "a.csv"], "--output is for tables"),
        ([*options(1, 2, 1, 1, 0, 0, 0), "--format", "csv"], "--format is for tables"),
        ([*options(1, 2, 1, 1, 0, 0, 0), "--on-invalid", "flag"], "--on-invalid is for tables"),
        ([*options(1, 2, 1, 1, 0, 0, 0), "--input", "a.csv", "--output", "-"], "--alpha is for one pair"),
        (["classify", "--input", "a.csv", "--output", "b.csv", "--json"], "--json is for one pair"),
        (["classify", "--input", "a.csv", "--output", "b.csv", "--center", "1", "2", "3"], "--center is for one pair"),
    ],
)
def test_classify_refuses_options_that_exclude_each_other(words, sentence, capsys):
    assert main(words) == 2
    assert sentence in capsys.readouterr().err


def test_classify_ends_with_6_if_the_oracles_disagree(monkeypatch, capsys):
    from hypcheck.truth import exact as oracle

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
    from hypcheck.truth.certificate import Certificate

    def wrong(pair, decision):
        return Certificate(decision.position, multiplier=Fraction(4))

    monkeypatch.setattr(module, "prove", wrong)
    assert main(options(1, 2, 1, 1, 2.5, 0, 0)) == 6
    assert "does not hold" in capsys.readouterr().err
