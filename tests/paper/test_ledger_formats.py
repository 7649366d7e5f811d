"""The output of `derive`: text of 100 columns, well-formed LaTeX, JSON by its schema, and a fresh docs/paper.md."""

from __future__ import annotations

import json
import re
import shutil
from importlib import resources
from pathlib import Path

import pytest
from click.testing import CliRunner
from matplotlib.mathtext import MathTextParser

from hypcheck.cli.paper import derive
from hypcheck.derivation.chain_book import chains
from hypcheck.derivation.program import Operations
from hypcheck.derivation.walk import walk
from hypcheck.paper.derive import FORMATS, PARTS, as_json, erratum
from hypcheck.paper.derive.content import Selection
from hypcheck.paper.derive.formats import WRITERS
from hypcheck.paper.derive.latex import UnknownCharacterError, formula, sentence
from hypcheck.paper.ledger.book import entries
from hypcheck.report.text import WIDTH, broken, columns, paragraph
from hypcheck.version import VERSION
from tests.support.records import violations

ALL = Selection(tuple(PARTS))
CLAIM = Selection((), "Proposition 3")
SCHEMA = json.loads(
    resources.files("hypcheck.paper").joinpath("schemas", f"derive-{as_json.SCHEMA}.json").read_text(encoding="utf-8")
)
PAGE = Path(__file__).resolve().parents[2] / "docs" / "paper.md"


def written(form, chosen):
    return "\n".join(WRITERS[form](chosen)).splitlines()


@pytest.mark.parametrize("chosen", [pytest.param(ALL, marks=pytest.mark.thorough), CLAIM], ids=["all", "claim"])
def test_derive_text_fits_into_100_columns_and_says_what_was_checked(chosen):
    lines = written("text", chosen)
    assert max(map(columns, lines)) <= WIDTH
    assert not any(line != line.rstrip() for line in lines)
    assert "FAILS" not in "\n".join(lines)
    parts = sum(len(link.parts) for chain in (*chosen.sections, *chosen.chains) for link in chain.links)
    assert sum(line.endswith("  checked") for line in lines) >= parts


def test_derive_text_has_every_part_and_every_ledger_entry():
    lines = written("text", ALL)
    for part in PARTS:
        assert any(line.startswith(f"{part.capitalize()}: ") for line in lines)
    for entry in entries():
        assert any(line.startswith(entry.number) for line in lines)


def test_a_claim_is_shown_with_its_witness_a_command_and_a_certificate():
    shown = "\n".join(written("text", CLAIM))
    assert "hypcheck classify --alpha 2.0 --gamma 2.0 --b 2.0 --d 1.0 --center 5.0 0.0 0.0" in shown
    assert "is above 0;" in shown
    assert "Proposition 3, repaired" in shown
    assert "\nRule\n" in shown
    assert "\nProposition 5, repaired" not in shown


def test_derive_text_shows_an_equation_as_the_paper_prints_it():
    shown = " ".join(" ".join(written("text", Selection((), "12"))).split())
    assert "printed g(λ) = λ³ + (a² − c² + 1 − x_c² − y_c²)·λ²" in shown
    assert "lacks − z_c²" in shown


@pytest.mark.parametrize("chosen", [ALL, CLAIM], ids=["all", "claim"])
def test_derive_latex_is_ascii_with_balanced_braces_and_environments(chosen):
    document = "\n".join(written("latex", chosen))
    assert document.isascii()
    bare = re.sub(r"\\[{}]", "", document)
    depth = 0
    for character in bare:
        depth += (character == "{") - (character == "}")
        assert depth >= 0
    assert depth == 0
    opened = []
    for kind, name in re.findall(r"\\(begin|end)\{(\w+\*?)\}", document):
        if kind == "begin":
            opened.append(name)
        else:
            assert opened.pop() == name
    assert opened == []
    assert document.count("$") % 2 == 0
    assert document.startswith(r"\documentclass")


@pytest.mark.skipif(shutil.which(erratum.COMPILER) is None, reason="LaTeX is not installed here: nothing compiles")
@pytest.mark.parametrize("chosen", [pytest.param(ALL, marks=pytest.mark.thorough), CLAIM], ids=["all", "claim"])
def test_derive_latex_compiles(chosen, tmp_path):
    target = tmp_path / "derivation.tex"
    target.write_text("\n".join(written("latex", chosen)), encoding="utf-8")
    assert erratum.compile_note(target) == f"wrote {target.with_suffix('.pdf')}"


def formulas():
    """Everything that is set in math mode, once."""
    shown = [(chain.statement, chain.links) for chain in (*walk(), *chains().values())]
    texts = [text for statement, links in shown for text in (statement, *(link.statement for link in links))]
    texts += [text for each in entries() for text in (each.statement, each.why, each.follows, each.correction)]
    inline = {match for each in texts for match in re.findall(r"\$(.*?)\$", sentence(each))}
    return inline | {formula(part.text) for _, links in shown for link in links for part in link.parts}


@pytest.mark.thorough
def test_matplotlib_can_typeset_every_ledger_formula():
    parser = MathTextParser("path")
    for each in sorted(formulas()):
        parser.parse(f"${each}$")


@pytest.mark.parametrize(
    ("plain", "tex"),
    [
        ("x_c² + y_c²", "x_{c}^{2} + y_{c}^{2}"),
        ("c0_s = −(α/b_s)²·(γ/d_s)²", r"c_{0,s} = -(\alpha/b_{s})^{2}\,(\gamma/d_{s})^{2}"),
        ("H = A⁻¹·H̄·A⁻¹", r"H = A^{-1}\,\bar{H}\,A^{-1}"),
        ("g''(λm) = −2√h1", r"g''(\lambda_{m}) = -2\sqrt{h_{1}}"),
        ("φ' without P = 0", r"\varphi'\text{ without }P = 0"),
        ("cosine − sine", r"\cos g_{i} - \sin g_{i}"),
    ],
)
def test_plain_formula_is_converted_to_latex(plain, tex):
    assert formula(plain) == tex


@pytest.mark.parametrize(
    ("plain", "tex"),
    [
        ("a rotor's axis", "a rotor's axis"),
        ("where a = 1 and c² > a", "where $a = 1$ and $c^{2} > a$"),
        ("“⟸” is 14 % of `hypcheck derive`", r"``$\Longleftarrow $'' is $14$ \% of \texttt{hypcheck derive}"),
        ("A cubic in A and B", "A cubic in $A$ and $B$"),
        ("Procedure 2.a, i.e. one", "Procedure 2.a, i.e. one"),
    ],
)
def test_plain_sentence_is_converted_to_latex(plain, tex):
    assert sentence(plain) == tex


def test_a_character_without_latex_raises_an_error():
    with pytest.raises(UnknownCharacterError):
        formula("☃ = 1")


@pytest.mark.parametrize(
    "chosen",
    [ALL, CLAIM, Selection(("costs",)), Selection(("ledger", "derivation"))],
    ids=["all", "claim", "costs", "two"],
)
def test_derive_json_fits_its_schema(chosen):
    document = json.loads("\n".join(written("json", chosen)))
    assert violations(document, SCHEMA, closed=True) == []
    assert document["agrees"] is True
    assert document["failing"] == []
    parts = ("propositions", "ledger") if chosen.claim else chosen.parts
    assert {part for part in PARTS if part in document} == set(parts)


def test_schema_of_derive_json_requires_every_count_of_operations():
    assert set(SCHEMA["$defs"]["operations"]["required"]) == {*Operations.__dataclass_fields__, "rounded"}


def test_paper_page_in_docs_equals_the_output_of_derive():
    """`make paper` writes it anew."""
    fresh = "\n".join(WRITERS["markdown"](Selection(("ledger", "costs")))) + "\n"
    assert PAGE.read_text(encoding="utf-8") == fresh


def test_derive_markdown_has_every_part():
    page = "\n".join(written("markdown", ALL))
    for part in PARTS:
        assert f"## {part.capitalize()}: " in page
    assert page.count("\n### ") > 40


@pytest.mark.parametrize("form", ["text", "latex", "markdown"])
def test_every_format_for_people_has_the_witnesses_and_certificates_of_a_claim(form):
    shown = "\n".join(written(form, CLAIM))
    assert "hypcheck classify --alpha 2.0 --gamma 2.0" in shown
    assert "is above 0;" in " ".join(shown.replace("$", "").split())


@pytest.mark.parametrize(("chosen", "brief"), [(Selection(("ledger",)), True), (Selection((), "13"), False)])
def test_derive_markdown_lists_formulas_that_hold_as_printed_unless_it_shows_one_claim(chosen, brief):
    assert ("Formulas that hold as printed, right − left = 0:" in written("markdown", chosen)) == brief


@pytest.mark.parametrize("form", FORMATS)
def test_derive_writes_each_format_as_the_function_written_returns_it(form):
    whole = form == "erratum"
    done = CliRunner().invoke(derive, ["--format", form, *([] if whole else ["--claim", "14"])])
    assert done.output.splitlines() == written(form, Selection(tuple(PARTS)) if whole else Selection((), "14"))


def test_line_breaks_never_separate_a_comparison_from_its_sides():
    lines = list(paragraph("word " * 18 + "c1 = 18 and (1, 0, 0) " * 5))
    assert not any(line.endswith((" =", "(1,", "0,")) or line.startswith(("=", "0")) for line in lines)


def test_long_formulas_are_broken_at_outer_plus_and_minus_signs_first():
    lines = broken("f = (a + b + c)·x + (d − e)·y − z", 20)
    assert lines == ["f = (a + b + c)·x", "+ (d − e)·y − z"]
    assert broken("f = (aaaa + bbbb + cccc)·x", 12) == ["f", "= (aaaa", "+ bbbb", "+ cccc)·x"]


def test_citation_and_readme_name_the_paper_as_the_ledger_does():
    root = PAGE.parents[1]
    title = "Algorithms for Determining Relative Position between Spheroids and Hyperboloids with One Sheet"
    for name in ("CITATION.cff", "README.md", "docs/paper.md", "docs/mathematics.md", "docs/simulate.md"):
        assert title in " ".join((root / name).read_text(encoding="utf-8").split()), name
    assert f"version: {VERSION}" in (root / "CITATION.cff").read_text(encoding="utf-8")
