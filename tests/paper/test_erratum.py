"""The erratum agrees with the ledger, compiles to three pages at most, and takes no claim and no part."""

from __future__ import annotations

import re
import shutil
import subprocess

import pytest

from hypcheck.cli.main import main
from hypcheck.errors import Exit
from hypcheck.paper.derive import erratum
from hypcheck.paper.derive.selection import Selection


@pytest.fixture(scope="module")
def note():
    return "\n".join(erratum.lines(Selection(())))


def test_the_erratum_has_every_value_filled_in_and_is_well_formed_latex(note):
    assert note.isascii()
    assert not re.search(r"<[\w ]+>", note)
    assert note.count("$") % 2 == 0
    assert note.count("{") - note.count(r"\{") == note.count("}") - note.count(r"\}")
    assert note.count(r"\proof") == note.count(r"\qed") >= 8


def test_the_erratum_has_the_corrections_and_counterexamples_of_the_ledger(note):
    assert r"f(\lambda) = g\,(a^{2} + \lambda)/(a^{4}\,c^{2})" in note
    assert "centre $(5/2,0,0)$: exterior, $\\Delta=0,\\ c_2=-33/4,\\ c_1=18$" in note
    assert "centre $(0,0,2)$: interior" in note
    assert "11.7990, 10.9387, 10.3449, 9.6364, 8.9626, 8.5885" in note


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
    monkeypatch.setattr(erratum.shutil, "which", lambda _: None)
    target = tmp_path / "note.tex"
    assert main(["derive", "--format", "erratum", "--output", str(target)]) == Exit.HELD
    assert capsys.readouterr().err == "not compiled: there is no pdflatex on this machine\n"
    assert [path.name for path in tmp_path.iterdir()] == ["note.tex"]


@pytest.mark.parametrize("more", [("--claim", "12"), ("--only", "costs")])
def test_derive_erratum_refuses_claim_and_only(capsys, more):
    assert main(["derive", "--format", "erratum", *more]) == Exit.USAGE
    assert "takes neither --claim nor --only" in capsys.readouterr().err


def latex(monkeypatch, tmp_path, script):
    """A program in the place of pdflatex."""
    program = tmp_path / "latex"
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)
    monkeypatch.setattr(erratum, "COMPILER", str(program))
    target = tmp_path / "out" / "erratum.tex"
    target.parent.mkdir()
    target.write_text("the source")
    return target


def test_compile_note_writes_the_pdf_beside_its_source(monkeypatch, tmp_path):
    target = latex(monkeypatch, tmp_path, "for last; do :; done; cp $last note.pdf; touch note.aux")
    assert erratum.compile_note(target) == f"wrote {target.with_suffix('.pdf')}"
    assert target.with_suffix(".pdf").read_text() == "the source"
    assert {path.name for path in target.parent.iterdir()} == {"erratum.tex", "erratum.pdf"}


def test_compile_note_says_so_and_writes_nothing_if_latex_fails_or_hangs(monkeypatch, tmp_path):
    target = latex(monkeypatch, tmp_path, "exit 3")
    assert erratum.compile_note(target) == (
        f"not compiled: {erratum.COMPILER} ended with 3; run it on {target} to see why"
    )

    def hangs(*words, timeout, **others):
        raise subprocess.TimeoutExpired(words, timeout)

    monkeypatch.setattr(erratum.subprocess, "run", hangs)
    assert erratum.compile_note(target) == f"not compiled: {erratum.COMPILER} took longer than 120 s"
    assert not target.with_suffix(".pdf").exists()
