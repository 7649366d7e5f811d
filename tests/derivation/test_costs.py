"""Operations counted from the programs are those counted by hand."""

from __future__ import annotations

import pytest

from hypcheck.derivation.formulas import FORMULAS, REPAIRED, cost_of, costs, discriminant_share, loop_as_printed
from hypcheck.derivation.program import Operations


def test_the_cost_of_table_2_is_the_count_of_its_operations():
    cost = cost_of(FORMULAS["table-2"])
    # Before the loop: α/b, A, γ/d, B, AB, c0 + A, C; and of what is printed inside it b², A − B, K, c0², 27 c0².
    assert cost.scene == Operations(additions=4, multiplications=6, divisions=2)
    # x², y², their sum, P; z/d, Q; B P, C + B P, A Q, c1; K − P, c2. Then Δ: c2², c2³, 4 c2³, term 1; c2 c1, term 2;
    # 18 c2, 18 c2 c1, term 3; c1², c1³, term 4; four sums. Three comparisons, two "and".
    assert cost.query == Operations(additions=9, multiplications=17, divisions=2, comparisons=3, logical=2)
    assert cost.by_fixed == 2
    assert loop_as_printed() == Operations(additions=11, multiplications=20, divisions=2, comparisons=3, logical=2)


def test_operation_counts_of_the_root_formulas_are_those_counted_by_hand():
    trigonometric, sweep = costs()[-2:]
    assert trigonometric.query.functions == 4  # one arccos, three cosines; the third of a turn is a constant
    assert trigonometric.query.square_roots == 1
    # For each root: g by Horner's scheme, the product of two differences, a complex quotient, the step.
    per_root = Operations(additions=4 + 1 + 1 + 1 + 6 + 3 + 2, multiplications=7 + 4 + 7, divisions=2)
    assert (sweep.query.additions, sweep.query.multiplications, sweep.query.divisions) == (
        3 * per_root.additions,
        3 * per_root.multiplications,
        3 * per_root.divisions,
    )
    assert sweep.scene == Operations()


def test_discriminant_share_of_the_four_rotors_equals_the_count_by_hand():
    # Per rotor 11 products and 4 sums: c0² and 27 c0² are the same for all, and depend on the sizes alone.
    assert discriminant_share() == (4 * 15, 100)


@pytest.mark.parametrize("cost", costs(), ids=lambda cost: cost.name)
def test_every_formula_has_a_cost_with_a_title_a_source_and_rounded_operations(cost):
    assert cost.query.rounded > 0
    assert cost.title
    assert cost.source
    assert 0 <= cost.by_fixed <= cost.query.divisions


def test_costs_are_named_after_the_formulas_and_the_two_root_formulas():
    assert [cost.name for cost in costs()] == [*FORMULAS, *REPAIRED, "roots-trigonometric", "roots-sweep"]
