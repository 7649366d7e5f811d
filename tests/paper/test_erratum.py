"""The erratum agrees with the ledger, compiles to three pages at most, and takes no claim and no part."""

from __future__ import annotations

import re
import shutil

import pytest
import sympy
from sympy.parsing.sympy_parser import (
    convert_xor,
    implicit_multiplication,
    parse_expr,
    split_symbols,
    standard_transformations,
)

from hypcheck.cli.main import main
from hypcheck.errors import Exit
from hypcheck.paper.derive import erratum
from hypcheck.paper.derive.content import Selection


@pytest.fixture(scope="module")
def note():
    return "\n".join(erratum.lines(Selection(())))


def test_the_erratum_has_every_value_filled_in_and_is_well_formed_latex(note):
    assert note.isascii()
    assert "<<" not in note
    assert not re.search(r"<\s*[a-z][a-z0-9\s-]*>", note)  # a name of a value, broken over a line or not
    assert note.count("$") % 2 == 0
    assert note.count("{") - note.count(r"\{") == note.count("}") - note.count(r"\}")
    assert note.count(r"\proofof{") == note.count(r"\qed") - 1 == 6  # and the command is defined
    assert note.count(r"\newcommand{\proofof}") == 1


def test_no_inline_formula_of_the_erratum_contains_the_punctuation_of_its_sentence(note):
    text = re.sub(r"\\begin\{gather\*\}.*?\\end\{gather\*\}|\\\[.*?\\\]", "", note, flags=re.DOTALL)
    formulas = re.findall(r"\$(.*?)\$", text, flags=re.DOTALL)
    assert len(formulas) > 150
    for formula in formulas:
        assert formula[-1] not in ",;:.", formula
        assert r",\ " not in formula, formula
        assert not re.search(r"=[^,()\[\]]*,[^()\[\]]*=", formula), formula  # two equations are two formulas


def test_the_erratum_states_the_row_of_table_5_as_a_question_and_counts_no_operations(note):
    _, item = note.split("9. Table 5, second row: a question.")
    assert "inference" in item.split(r"\head{Proofs}")[0]
    assert "division" not in note
    assert "similar" not in note


def test_a_name_without_a_value_in_the_erratum_is_an_error():
    assert erratum.filled("of <<one>> and <<two-parts>>", {"one": "1", "two-parts": "2"}) == "of 1 and 2"
    with pytest.raises(KeyError):
        erratum.filled("of <<one>>", {})


def test_the_erratum_has_the_corrections_and_counterexamples_of_the_ledger(note):
    words = " ".join(note.split())
    assert "centre $(5/2,0,0)$: exterior, with $\\Delta=0$, $c_2=-33/4$ and $c_1=18$" in words
    assert "centre $(0,0,2)$ is interior" in words
    assert r"12.4708\,\% and 11.7990\,\%" in words
    assert "$r>a+1$" in words
    assert "thin shell" in words


def test_the_displayed_corrections_of_the_erratum_are_what_the_derivation_gives(note):
    display = re.search(r"\\begin\{gather\*\}(.*?)\\end\{gather\*\}", note, re.DOTALL)[1]
    eleven, twelve, appendix = display.split("\\\\\n")
    assert "".join(eleven.split()) == r"f(\lambda)=\frac{(a^2+\lambda)\,g(\lambda)}{a^4c^2},"
    plain = twelve.replace(r"\lambda", "L").replace(r"\,", "").replace("_c", "").strip().rstrip(",").partition("=")[2]
    transformations = (*standard_transformations, split_symbols, implicit_multiplication, convert_xor)
    right = parse_expr(" ".join(plain.split()), transformations=transformations)
    a, c, x, y, z, at = sympy.symbols("a c x y z L")
    g = (a**2 + at) * (c**2 - at) * (x**2 + y**2 + z**2 - 1 - at) - a**2 * (x**2 + y**2) * (c**2 - at)
    assert sympy.expand(right - g + c**2 * z**2 * (a**2 + at)) == 0
    assert "l^2+l" not in appendix.split(r"\text{for}")[0]


@pytest.mark.skipif(shutil.which(erratum.COMPILER) is None, reason="LaTeX is not installed here: nothing compiles")
def test_the_erratum_compiles_to_three_pages_at_most(note, tmp_path):
    target = tmp_path / "note.tex"
    target.write_text(note)
    assert erratum.compile_note(target) == f"wrote {target.with_suffix('.pdf')}"
    assert {path.name for path in tmp_path.iterdir()} == {"note.tex", "note.pdf"}
    pages = len(re.findall(rb"/Type\s*/Page\b", (tmp_path / "note.pdf").read_bytes()))
    assert pages <= 3


def test_derive_without_pdflatex_writes_the_latex_source_and_says_that_it_is_not_compiled(
    capsys, monkeypatch, tmp_path
):
    monkeypatch.setenv("PATH", str(tmp_path))
    target = tmp_path / "note.tex"
    assert main(["derive", "--format", "erratum", "--output", str(target)]) == Exit.HELD
    assert capsys.readouterr().err == "not compiled: there is no pdflatex on this machine\n"
    assert [path.name for path in tmp_path.iterdir()] == ["note.tex"]


def latex(monkeypatch, tmp_path, script):
    """A program in the place of pdflatex."""
    program = tmp_path / erratum.COMPILER
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    target = tmp_path / "out" / "erratum.tex"
    target.parent.mkdir()
    target.write_text("the source")
    return target


def test_compile_note_writes_the_pdf_beside_its_source(monkeypatch, tmp_path):
    target = latex(monkeypatch, tmp_path, "for last; do :; done; cp $last note.pdf; touch note.aux")
    assert erratum.compile_note(target) == f"wrote {target.with_suffix('.pdf')}"
    assert target.with_suffix(".pdf").read_text() == "the source"
    assert {path.name for path in target.parent.iterdir()} == {"erratum.tex", "erratum.pdf"}


def test_compile_note_reports_the_failure_and_writes_nothing_if_latex_fails_or_hangs(monkeypatch, tmp_path):
    target = latex(monkeypatch, tmp_path, "exit 3")
    assert erratum.compile_note(target) == (
        f"not compiled: {erratum.COMPILER} ended with 3; run it on {target} to see why"
    )

    (tmp_path / erratum.COMPILER).write_text("#!/bin/sh\nexec sleep 60\n")
    assert erratum.compile_note(target, 0.2) == f"not compiled: {erratum.COMPILER} took longer than 0.2 s"
    assert not target.with_suffix(".pdf").exists()
