"""Every counterexample of the ledger and of the erratum, recomputed from the printed rule alone, in its regime."""

from __future__ import annotations

import re
from fractions import Fraction
from functools import cache

import pytest

from hypcheck.geometry.pair import Pair
from hypcheck.paper.derive import erratum
from hypcheck.paper.derive.content import Selection
from hypcheck.paper.ledger import statements
from hypcheck.paper.ledger.book import entries, faults, faults_with_entries
from hypcheck.paper.ledger.entry import FALSE
from hypcheck.paper.ledger.points import facts_in_order
from tests.paper import printed_rules as printed
from tests.support.fractions_truth import exact_position
from tests.support.inside import least_position
from tests.support.tilted_fractions import exact_position as tilted_position

EXTERIOR, CONTACT, INTERIOR = 1, 0, -1


@cache
def ledger():
    return {entry.number: entry for entry in entries()}


def witnesses(number):
    return [
        (point.a, point.c, point.r, Fraction(0), point.z)
        for evidence in ledger()[number].evidence
        for point in (witness.facts.point for witness in evidence.witnesses)
    ]


def position(row):
    a, c, x, y, z = row
    return exact_position((a, c, Fraction(1), Fraction(1), x, y, z))


def told(number):
    """The sizes of rotors and the lengths of arms that the evidence names."""
    text = "; ".join(evidence.text for evidence in ledger()[number].evidence)
    size, arm = re.search(r"rotors of ([\d/]+) its size on arms of ([\d/]+)", text).groups()
    return Fraction(size), Fraction(arm)


def fails_3_1(row):
    assert printed.in_regime_3(*row[:2])
    return (position(row) == EXTERIOR) != printed.proposition_3_1(printed.by_14(*row))


def fails_3_2(row):
    assert printed.in_regime_3(*row[:2])
    return printed.says_contact(printed.by_14(*row)) and position(row) != CONTACT


def fails_5_1(row):
    assert printed.in_regime_5(row[0])
    return (position(row) == INTERIOR) != printed.proposition_5_1(printed.by_14(*row))


def fails_5_2(row):
    assert printed.in_regime_5(row[0])
    return printed.says_contact(printed.by_14(*row)) and position(row) != CONTACT


def fails_table_2(row):
    a, c, x, y, z = row
    assert printed.in_regime_3(a, c)
    return (position(row) == EXTERIOR) != printed.table_2(a, c, Fraction(1), Fraction(1), x, y, z)


SIMPLE = {
    "Proposition 3.1": fails_3_1,
    "Proposition 3.2": fails_3_2,
    "Proposition 5.1": fails_5_1,
    "Proposition 5.2": fails_5_2,
    "Table 1": fails_table_2,
    "Table 1, caption": fails_table_2,
    "Table 2": fails_table_2,
}


@pytest.mark.parametrize("number", SIMPLE)
def test_the_printed_rule_is_wrong_at_each_of_its_witnesses_within_its_regime(number):
    assert witnesses(number)
    for row in witnesses(number):
        assert SIMPLE[number](row), row


def test_12_as_printed_makes_proposition_3_call_a_pair_in_contact_exterior_and_proposition_5_one_interior():
    first, second = witnesses("(12)")
    assert position(first) == position(second) == CONTACT
    assert printed.in_regime_3(*first[:2])
    assert printed.proposition_3_1(printed.by_12(*first))
    assert printed.in_regime_5(second[0])
    assert printed.proposition_5_1(printed.by_12(*second))
    for row in (first, second):  # by (14) both are contact: only (12) misleads
        assert printed.says_contact(printed.by_14(*row))


@pytest.mark.parametrize(
    ("row", "numbers", "says"),
    [
        (("3/2", "1", "1", "0", "1"), ("12357/256", "5/4", "-9/4"), printed.proposition_5_1),
        (("2", "2", "4", "0", "2"), ("14656", "-15", "32"), printed.proposition_3_1),
    ],
)
def test_12_as_printed_misleads_at_two_more_pairs_that_were_computed_by_hand(row, numbers, says):
    row = tuple(map(Fraction, row))
    assert printed.by_12(*row).numbers == tuple(map(Fraction, numbers))
    assert says(printed.by_12(*row))
    assert position(row) == CONTACT


def test_12_as_printed_is_right_about_a_certain_interior_pair_on_the_axis():
    row = tuple(map(Fraction, (1, 1, 0, 0, 1)))
    assert position(row) == INTERIOR
    assert printed.by_12(*row).numbers == (49, 1, -2)
    assert printed.proposition_5_1(printed.by_12(*row))


def test_all_roots_of_the_witness_against_the_proof_of_proposition_3_are_positive_and_its_coefficients_are_0():
    (row,) = witnesses("Proposition 3, proof: signs")
    g = printed.by_14(*row)
    assert printed.in_regime_3(*row[:2])
    assert (g.c2, g.c1, g.c0) == (0, 0, -1)  # λ³ − 1 has the one real root 1


def test_on_the_ring_g_has_a_double_and_a_simple_positive_root_and_the_sphere_is_exterior():
    (row,) = witnesses("Proposition 3, proof: roots")
    a, c, r, _, z = row
    assert (z, r**2) == (0, (c**2 + 1) * (a**2 + c**2) / c**2)
    assert position(row) == EXTERIOR
    assert printed.by_14(*row).delta == 0


def test_procedure_2a_as_printed_refuses_four_disjoint_interior_rotors():
    (row,) = witnesses("Table 3")
    a, c, r, _, z = row
    rotors = [(a, c, x, y, z) for x, y in ((r, 0), (0, r), (-r, 0), (0, -r))]
    assert a >= 1
    assert 2 * r**2 >= 4  # neighbours are √2 r apart
    assert {position(each) for each in rotors} == {INTERIOR}
    assert not printed.procedure_2a([printed.by_14(*each) for each in rotors])


@pytest.mark.parametrize(
    ("number", "body_position", "tall"), [("Table 4", INTERIOR, True), ("Table 4, caption", CONTACT, False)]
)
def test_procedure_2b_as_printed_refuses_a_body_with_four_interior_rotors(number, body_position, tall):
    body, _ = witnesses(number)
    a, c, r, _, z = body
    rotors = printed.rotors_of(a, c, r, z, *told(number))
    assert a >= 1
    assert printed.in_regime_3(a, c) is tall
    assert position(body) == body_position
    assert {position(each) for each in rotors} == {INTERIOR}
    assert not printed.procedure_2b(printed.by_14(*body), [printed.by_14(*each) for each in rotors])


def test_procedure_2b_as_printed_calls_a_movement_valid_that_takes_a_part_of_the_body_through_the_wall():
    body, _ = witnesses("Table 4, purpose")
    a, c, r, _, z = body
    rotors = printed.rotors_of(a, c, r, z, *told("Table 4, purpose"))
    assert a >= 1
    assert printed.in_regime_3(a, c)
    assert position(body) == CONTACT
    assert printed.procedure_2b(printed.by_14(*body), [printed.by_14(*each) for each in rotors])
    text = "; ".join(evidence.text for evidence in ledger()["Table 4, purpose"].evidence)
    x, y, w = map(Fraction, re.search(r"its point \(([^)]*)\)", text)[1].replace("−", "-").split(", "))
    assert (x - r) ** 2 + y**2 + (w - z) ** 2 <= 1  # in the body's spheroid
    assert (x**2 + y**2) / a**2 - w**2 / c**2 > 1  # beyond the wall


@pytest.mark.parametrize(("number", "place"), [("Section 4, contact", 1), ("Section 4, discriminant", 0)])
def test_there_is_contact_with_a_positive_discriminant_in_a_low_hyperboloid(number, place):
    row = witnesses(number)[place]
    assert row[0] >= 1
    assert not printed.in_regime_3(*row[:2])
    assert position(row) == CONTACT
    assert printed.by_14(*row).delta > 0


@pytest.mark.parametrize("number", ["Section 4, contact", "Section 4, discriminant"])
def test_harmless_demands_a_wide_waist_because_contact_at_a_narrow_one_has_a_positive_discriminant(number):
    row = tuple(map(Fraction, ("1/2", "1", "0", "0", "0")))
    assert printed.in_regime_3(*row[:2])
    assert position(row) == CONTACT
    assert printed.by_14(*row).delta > 0
    assert "(γ/d)² ≥ α/b ≥ 1" in ledger()[number].harmless


def test_in_floats_table_2_refuses_a_thin_shell_about_the_ring_though_z0_is_not_0():
    centre = 2.5, 0.0, 1e-12
    assert position(tuple(map(Fraction, (1.0, 2.0, *centre)))) == EXTERIOR
    assert printed.table_2(*map(Fraction, (1, 2, 1, 1, *centre)))
    assert not printed.table_2(1.0, 2.0, 1.0, 1.0, *centre)


def test_every_false_statement_names_its_faults_and_every_fault_has_a_statement():
    for entry in entries():
        assert bool(entry.faults) == (entry.verdict == FALSE), entry.number
        assert set(entry.faults) <= set(faults()), entry.number
    assert all(numbers for _, _, numbers in faults_with_entries())
    assert len(faults()) == 7
    assert sum(entry.verdict == FALSE for entry in entries()) == 17


AWAY_FROM = {
    "the ring": statements.ring,
    "a coefficient that is 0": lambda facts: 0 in (facts.c1, facts.c2),
    "contact with Δ > 0": lambda facts: not statements.tall(facts),
    "signs without Δ": lambda facts: facts.delta <= 0,
}
STATEMENTS = {
    "Proposition 3.1": statements.PROPOSITION_3_1,
    "Proposition 3.2": statements.PROPOSITION_3_2,
    "Proposition 3, proof: roots": statements.THREE_POSITIVE_ROOTS,
    "Proposition 3, proof: signs": statements.ALL_POSITIVE,
    "Proposition 5.1": statements.PROPOSITION_5_1,
    "Proposition 5.2": statements.PROPOSITION_5_2,
    "Section 4, contact": statements.CONTACT_MEANS_NOT_POSITIVE,
    "Section 4, discriminant": statements.CLEAR_IS_POSITIVE,
}


@pytest.mark.parametrize("number", STATEMENTS)
def test_a_false_statement_holds_wherever_none_of_its_faults_is(number):
    """So a statement is false for these faults alone; and each of the faults contradicts it somewhere."""
    statement, named = STATEMENTS[number], ledger()[number].faults
    wrong = [each for each in facts_in_order() if statement.where(each) and not statement.says(each)]
    assert all(any(AWAY_FROM[name](each) for name in named) for each in wrong)
    if number != "Section 4, contact":  # "i.e." says both ways; this statement is one of them, the other is 5.2
        assert all(any(AWAY_FROM[name](each) for each in wrong) for name in named)


@pytest.fixture(scope="module")
def note():
    return " ".join("\n".join(erratum.lines(Selection(()))).split())


PAIR = r"\$a=([\d/]+)\$, \$c=([\d/]+)\$, centre \$\(([-\d/,]+)\)\$"
NUMBERS = r"\$\\Delta=([-\d/]+)\$, \$c_2=([-\d/]+)\$ and \$c_1=([-\d/]+)\$"


def rows(groups):
    a, c, centre = groups[:3]
    return tuple(map(Fraction, (a, c, *centre.split(","))))


def test_every_pair_of_the_erratum_has_the_position_and_the_numbers_that_it_states(note):
    by_14 = re.findall(
        rf"{PAIR}(?:,? which)?(?::| is|,)? ?(?:is )?(interior|exterior|in contact|contact),? with {NUMBERS}", note
    )
    assert len(by_14) == 8
    labels = {"interior": INTERIOR, "exterior": EXTERIOR, "contact": CONTACT, "in contact": CONTACT}
    for found in by_14:
        row, numbers = rows(found), tuple(map(Fraction, found[4:]))
        assert position(row) == labels[found[3]], found
        assert printed.by_14(*row).numbers == numbers, found
    by_12 = re.findall(rf"says (exterior|interior) of {PAIR}, which is in contact, since \(12\) gives {NUMBERS}", note)
    assert len(by_12) == 2
    for label, *found in by_12:
        row, numbers = rows(found), tuple(map(Fraction, found[3:]))
        assert position(row) == CONTACT
        assert printed.by_12(*row).numbers == numbers
        rule = {"exterior": printed.proposition_3_1, "interior": printed.proposition_5_1}[label]
        assert rule(printed.by_12(*row))
    assert (
        len(re.findall(PAIR, note)) == len(by_14) + len(by_12) + 2
    )  # the ring once more, and c2 < 0, c1 > 0 without Δ


def test_the_erratum_has_a_counterexample_to_each_proposition_and_table_that_it_corrects(note):
    for number in ("Proposition 3.1", "Proposition 5.1", "Proposition 5.2", "Table 3", "Table 4", "Table 4, caption"):
        for a, c, r, _, z in witnesses(number)[: 2 if number == "Proposition 5.1" else 1]:
            assert f"$a={a}$, $c={c}$, centre $({r},0,{z})$" in note, number
    assert "$a=7$, $c=7$, centre $(10,0,0)$: exterior" in note


def test_the_tilted_pair_of_the_erratum_is_in_contact_and_would_be_interior_if_upright(note):
    found = re.search(
        r"\$\\alpha=(\d+)\$, \$\\gamma=(\d+)\$, \$b=(\d+)\$, \$d=(\d+)\$ and the centre \$\(([\d,]+)\)\$, the upright "
        r"spheroid is interior and the one with its axis along \$\(([\d,]+)\)\$ is in contact",
        note,
    )
    *sizes, centre, axis = found.groups()
    row = [float(each) for each in (*sizes, *centre.split(","))]
    assert exact_position(tuple(map(Fraction, row))) == INTERIOR
    assert tilted_position((*row, *(float(each) for each in axis.split(",")))) == CONTACT


def test_pairs_on_which_a_test_of_the_centres_height_errs_are_confirmed_by_the_least_value():
    """The least value knows neither the pencil nor the rule in the height."""
    (evidence,) = ledger()["Section 3.2, maximum height"].evidence
    found = re.findall(r"α = [^:]*", evidence.text.replace("−", "-"))
    first, second = (
        Pair(*numbers[:7], z_max=numbers[7])
        for numbers in ([float(number) for number in re.findall(r"-?\d+", text)] for text in found)
    )
    assert first.z > first.z_max
    assert least_position(first) == CONTACT
    assert second.z <= second.z_max
    assert least_position(second) == INTERIOR
    assert position_of_whole(second) == CONTACT


def position_of_whole(pair):
    return exact_position([Fraction(number) for number in pair.row[:7]])
