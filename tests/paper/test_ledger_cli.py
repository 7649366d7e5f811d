"""`hypcheck derive`: options in, pages and an exit code out."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace

import pytest

from hypcheck.cli.main import main
from hypcheck.derivation.chain_book import chains
from hypcheck.errors import Exit
from hypcheck.paper.derive import content
from hypcheck.paper.ledger.book import entries, entries_of
from hypcheck.paper.ledger.entry import Evidence
from hypcheck.report.document import Emphasis, prose


def told(capsys, *arguments):
    code = main(["derive", *arguments])
    output, errors = capsys.readouterr()
    return code, output, errors


def test_derive_without_options_shows_all_parts_and_all_hold(capsys):
    code, output, errors = told(capsys)
    assert code == Exit.HELD
    assert errors == ""
    for title in ("Derivation:", "Propositions:", "Ledger:", "Costs:"):
        assert f"\n{title}" in output


def test_parts_are_shown_in_their_order_whatever_the_order_of_the_options(capsys):
    _, output, _ = told(capsys, "--only", "costs", "--only", "derivation")
    assert output.index("Derivation:") < output.index("Costs:")
    assert "Ledger:" not in output


@pytest.mark.parametrize(
    ("claim", "numbers"),
    [
        ("12", ["(12)"]),
        ("(12)", ["(12)"]),
        ("eq. 12", ["(12)"]),
        ("Equation 1", ["(1)"]),
        ("A.2b", ["A.2b"]),
        ("appendix A.2b", ["A.2b"]),
        ("theorem 1", ["Theorem 1", "Theorem 1, proof"]),
        ("Proposition 5", ["Proposition 5.1", "Proposition 5.2", "Proposition 5, regime"]),
        ("prop 5.1", ["Proposition 5.1"]),
        ("Table 1", ["Table 1", "Table 1, caption"]),
        ("Table 4, caption", ["Table 4, caption"]),
        ("Section 5", ["Section 5"]),
        ("Table 2", ["Table 2, lines", "Table 2"]),
    ],
)
def test_a_claim_is_found_by_each_of_its_usual_names(claim, numbers):
    assert [entry.number for entry in entries_of(claim)] == numbers


def test_ledger_entry_is_found_by_its_number():
    for entry in entries():
        assert entry in entries_of(entry.number)


def test_derive_output_appears_only_as_a_complete_file(capsys, tmp_path):
    target = tmp_path / "derivation.json"
    code, output, _ = told(capsys, "--only", "costs", "--format", "json", "--output", str(target))
    assert (code, output) == (Exit.HELD, "")
    assert json.loads(target.read_text(encoding="utf-8"))["agrees"]
    code, _, errors = told(capsys, "--only", "costs", "--output", str(tmp_path / "no" / "where"))
    assert code == Exit.USAGE
    assert errors.startswith("hypcheck: error: cannot write")


def test_derive_leaves_no_file_if_the_claim_does_not_exist(capsys, tmp_path):
    target = tmp_path / "claim.txt"
    target.write_text("before")
    code, _, _ = told(capsys, "--claim", "Lemma 9", "--output", str(target))
    assert code == Exit.USAGE
    assert target.read_text() == "before"
    assert list(tmp_path.iterdir()) == [target]


def test_a_misspelled_claim_is_refused_with_a_suggestion_of_the_right_one(capsys):
    code, _, errors = told(capsys, "--claim", "Propositon 3.1")
    assert code == Exit.USAGE
    assert "did you mean 'Proposition 3.1'?" in errors


@pytest.mark.parametrize("form", ["text", "json", "latex", "markdown"])
def test_failing_step_of_a_proof_is_shown_and_derive_ends_with_6(capsys, monkeypatch, form):
    chain = chains()["Proposition 3, repaired"]
    link = chain.links[0]
    wrong = replace(link.parts[0], relation="<")
    broken = replace(chain, links=(replace(link, parts=(wrong, *link.parts[1:])), *chain.links[1:]))
    monkeypatch.setattr(content, "chains", lambda: {**chains(), chain.name: broken})
    code, output, errors = told(capsys, "--only", "propositions", "--format", form)
    assert code == Exit.ORACLES_DISAGREE
    assert errors == ("hypcheck: the derivation disagrees with results that it should show: Proposition 3, repaired\n")
    assert ("FAILS" in output) == (form != "json")
    if form == "json":
        document = json.loads(output)
        assert document["agrees"] is False
        assert document["failing"] == ["Proposition 3, repaired"]


def test_evidence_that_is_not_found_is_shown_as_failing():
    (table,) = (entry for entry in entries() if entry.number == "Table 2")
    without = replace(table, grounds=lambda: (Evidence("search", "nothing found among 7 hulls", holds=False),))
    assert (Emphasis(content.FAILS), prose("nothing found among 7 hulls")) in list(content.details(without))


def test_derive_shows_a_verdict_without_its_evidence_as_failing():
    (table,) = (entry for entry in entries() if entry.number == "Table 2")
    assert table.confirmed
    assert content.verdict(table) == "false"
    groundless = replace(table, verdict="proved", grounds=tuple)
    assert not groundless.confirmed
    assert content.verdict(groundless) == "FAILS: proved"


HEAVY = ("sympy", "numpy", "mpmath", "fcl", "matplotlib")


def loaded(code):
    """Which of HEAVY a fresh interpreter holds after running `code`."""
    report = f"import sys; {code}; print(*(name for name in {HEAVY!r} if name in sys.modules), file=sys.stderr)"
    done = subprocess.run([sys.executable, "-c", report], capture_output=True, check=True, text=True)
    return set(done.stderr.split())


STUDIES = ("hypcheck.paper", "hypcheck.engines", "hypcheck.proofs")


@pytest.mark.parametrize(
    "command",
    [
        "classify --alpha 2 --gamma 3 --b 1 --d 1 --center 5 0 0",
        "verify --help",
        "replay --help",
    ],
)
def test_commands_for_users_load_no_module_of_the_paper_the_engines_or_the_proofs(command):
    """Studies are the paper's derivation and simulations, the collision engines, and the proofs in Coq."""
    code = (
        "import sys; from hypcheck.cli.main import main\n"
        f"try: main({command.split()!r})\nexcept SystemExit: pass\n"
        f"print(*(name for name in sys.modules if name.startswith({STUDIES!r})), file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, text=True)
    assert done.stdout
    assert not done.stderr.split()


def test_derive_help_loads_no_heavy_library():
    assert loaded("from hypcheck.cli.main import main; main(['derive', '--help'])") == set()


def test_the_ledger_needs_neither_fcl_nor_matplotlib():
    assert loaded("import hypcheck.paper.ledger, hypcheck.paper.derive.formats") <= {"sympy", "numpy", "mpmath"}
