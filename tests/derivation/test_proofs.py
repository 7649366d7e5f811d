"""The proofs hold, and a program that differs in any one step is not proved."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest

from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.program import OPERATIONS, Program, Step, line_of, steps_of
from hypcheck.derivation.proofs import prove, prove_formulas

SAMPLED = {
    "table-2": 1,
    "procedure-1": 3,
    "procedure-2a-spheroid": 4,
    "procedure-2b-spheroid": 4,
    "procedure-2a": 151,
    "procedure-2b": 197,
    "coefficients": 29,
    "hessian": 31,
    "shared": 37,
    "local-maximum": 3,
    "dual": 2,
}
"""Of each formula every n-th change is tried: the proof of a larger program takes longer."""


def mutants(program: Program) -> Iterator[tuple[Step, Program]]:
    """The program with one step changed: another operation, operands or branches exchanged, a constant one off."""
    for index, step in enumerate(program.steps):
        for other in _changed(step):
            yield (
                other,
                Program(program.name, program.inputs, (*program.steps[:index], other, *program.steps[index + 1 :])),
            )


def _changed(step: Step) -> Iterator[Step]:
    here = OPERATIONS[step.operation]
    for name, operation in OPERATIONS.items():
        if name != step.operation and (operation.takes, operation.gives) == (here.takes, here.gives):
            yield replace(step, operation=name)
    if step.operation in {"sub", "div", "gt", "lt", "ge", "le"}:
        yield replace(step, arguments=step.arguments[::-1])
    if step.operation == "select":
        condition, yes, no = step.arguments
        yield replace(step, arguments=(condition, no, yes))
    for place, argument in enumerate(step.arguments):
        if isinstance(argument, int):
            for other in (argument - 1, argument + 1):
                yield replace(step, arguments=(*step.arguments[:place], other, *step.arguments[place + 1 :]))


def survivors(name: str, every: int = 1) -> list[str]:
    formula = FORMULAS[name]
    return [
        line_of(step)
        for index, (step, program) in enumerate(mutants(formula.program))
        if index % every == 0 and all(proof.holds for proof in prove(replace(formula, program=program)))
    ]


@pytest.mark.parametrize("name", ["derivation", *FORMULAS])
def test_every_proof_of_a_formula_holds(name):
    found = [proof for proof in prove_formulas() if proof.formula == name]
    assert found
    assert [proof.statement for proof in found if not proof.holds] == []


def test_every_formula_has_a_proof_of_its_coefficients_and_of_its_answer():
    proved = {(proof.formula, proof.quantity) for proof in prove_formulas()}
    for formula in FORMULAS.values():
        assert (formula.name, formula.answer) in proved
        number = {"dual": "phi", "procedure-2a": "c2_g4"}.get(formula.name, "c2")
        assert (formula.name, number) in proved


def test_table_2_with_a_single_step_changed_is_not_proved():
    assert sum(1 for _ in mutants(FORMULAS["table-2"].program)) > 150
    assert survivors("table-2", every=5) == []


@pytest.mark.thorough
@pytest.mark.parametrize(("name", "every"), SAMPLED.items())
def test_a_formula_with_one_of_its_sampled_steps_changed_is_not_proved(name, every):
    # In [c2 > 0; c1 ≠ 0] or [c2 < 0; c1 < 0] it is the same to write c2 ≠ 0 for c2 < 0.
    assert set(survivors(name, every)) <= {"c2_negative = c2 != 0", "c2_negative_g1 = c2_g1 != 0"}


def test_a_formula_whose_decision_reads_an_unproved_number_is_not_proved():
    formula = FORMULAS["table-2"]
    (peeking,) = steps_of("distinct = delta > Q")
    steps = tuple(peeking if step.name == "distinct" else step for step in formula.program.steps)
    mutant = replace(formula, program=replace(formula.program, steps=steps))
    assert [proof.quantity for proof in prove(mutant) if not proof.holds] == ["valid"]
