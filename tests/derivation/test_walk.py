"""The derivation shows every displayed formula of the paper, put right where it is misprinted."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import sympy

from hypcheck.derivation import pencil, walk
from hypcheck.derivation.links import matrix_identity
from hypcheck.derivation.pencil import difference
from hypcheck.derivation.printed_equations import check_equations, printed_claims


@cache
def shown():
    return [part for section in walk.walk() for link in section.links for part in link.parts]


def test_the_derivation_shows_each_correct_formula_as_the_paper_prints_it():
    texts = {part.text for part in shown()}
    misprinted = {equation.number for equation in check_equations() if not equation.holds}
    for claim in printed_claims():
        assert (claim.statement in texts) == (claim.number not in misprinted), claim.number


def test_the_derivation_shows_a_misprinted_formula_corrected():
    for number, name in (("11", "f(λ)"), ("12", "g(λ)"), ("A.2b", "c1(g_i)")):
        ((_, derived),) = next(claim.pairs for claim in printed_claims() if claim.number == number)
        right = [part.right for part in shown() if part.text.startswith(f"{name} = ")]
        assert any(difference(shown, derived) == 0 for shown in right if not isinstance(shown, sympy.MatrixBase))


def test_matrix_identity_reads_a_matrix_in_plain_text_and_checks_each_entry():
    hyperboloid, sphere = pencil.scaled_matrices()
    text = "S = [1, 0, 0, −x_c; 0, 1, 0, −y_c; 0, 0, 1, −z_c; −x_c, −y_c, −z_c, x_c² + y_c² + z_c² − 1]"
    assert matrix_identity(text, sphere).holds
    assert not matrix_identity(text, hyperboloid).holds
    assert not matrix_identity(text.replace("−y_c; 0, 0", "y_c; 0, 0"), sphere).holds
    assert not matrix_identity("S = [1, 0; 0, 1]", sphere).holds


def test_a_wrong_cubic_makes_its_section_of_the_derivation_fail(monkeypatch):
    right = pencil.scaled_cubic()
    monkeypatch.setattr(pencil, "scaled_cubic", lambda: replace(right, c2=right.c2 + pencil.ZC**2))
    assert [section.name for section in walk.walk() if not section.holds] == ["The pencil and its cubic"]
