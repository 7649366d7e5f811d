"""The build of the proofs with a stand-in for Coq and OCaml: what is asked of them, and what each answer leads to."""

from __future__ import annotations

import shutil
from pathlib import Path
from subprocess import CompletedProcess

import pytest
from click.testing import CliRunner

from hypcheck.errors import Exit, InputError
from hypcheck.proofs import build
from hypcheck.proofs.__main__ import main
from hypcheck.proofs.build import CONTROL, Weakened
from tests.proofs.state import up_to_date

REAL_NUMBERS = """\
Axioms:
ClassicalDedekindReals.sig_not_dec : forall P : Prop,
                                     {~ ~ P} + {~ P}
FunctionalExtensionality.functional_extensionality_dep
  : forall (A : Type) (B : A -> Type)
"""
"""How Coq prints axioms: the type may begin on the next line."""


class Tools:
    """Answers in place of Coq and OCaml: by the first file or word of a command that `says` knows; else success."""

    def __init__(self, monkeypatch, folder):
        self.says, self.asked = {}, []
        monkeypatch.setattr(build, "_run", self.run)
        monkeypatch.setattr(build, "BUILT", folder / "built")
        monkeypatch.setattr(build, "CHECKER", folder / "built" / "check_cases")
        monkeypatch.setattr(shutil, "which", lambda program: f"/usr/bin/{program}")

    def run(self, command, folder):
        """Keep the command, with the files of its folder, and answer."""
        self.asked.append((command, {path.name for path in folder.iterdir()} if folder != Path() else set()))
        code, out, err = next((self.says[word] for word in command if word in self.says), (0, "", ""))
        return CompletedProcess(command, code, out, err)


@pytest.fixture
def tools(monkeypatch, tmp_path):
    return Tools(monkeypatch, tmp_path)


def test_missing_libraries_of_ocaml_and_coq_are_named_where_the_programs_are_there(tools, tmp_path):
    tools.says = {"query": (1, "", ""), "-where": (0, f"{tmp_path}\n", "")}
    assert build.missing() == ["libzarith-ocaml-dev", "libcoq-flocq"]
    (tmp_path / "user-contrib" / "Flocq").mkdir(parents=True)
    assert build.missing() == ["libzarith-ocaml-dev"]
    tools.says["query"] = (0, "", "")
    assert build.missing() == []
    build.demand_tools()


def test_coq_build_is_up_to_date_only_if_it_holds_the_current_sources_and_the_checker(tools, monkeypatch):
    assert not up_to_date()
    build.BUILT.mkdir()
    for name in build.FILES:
        (build.BUILT / f"{name}.v").write_text(build.source(name), encoding="utf-8")
    assert not up_to_date()
    build.CHECKER.touch()
    assert up_to_date()
    monkeypatch.setattr(shutil, "which", lambda program: None)
    assert not up_to_date()
    monkeypatch.undo()


def test_coq_build_is_not_up_to_date_after_a_source_has_changed(tools):
    build.BUILT.mkdir()
    for name in build.FILES:
        (build.BUILT / f"{name}.v").write_text(build.source(name), encoding="utf-8")
    build.CHECKER.touch()
    (build.BUILT / "Rule.v").write_text("older", encoding="utf-8")
    assert not up_to_date()


def test_a_file_is_compiled_in_the_build_folder_and_its_statements_and_lines_are_counted(tools, monkeypatch):
    text = "Lemma one : True.\nProof. exact I. Qed.\n(* Lemma none : False. *)\nTheorem two : True.\n"
    monkeypatch.setattr(build, "source", lambda name: text)
    found = build.compile_file("Any")
    assert (found.name, found.statements, found.lines) == ("Any", 2, 4)
    assert found.seconds >= 0
    assert (build.BUILT / "Any.v").read_text(encoding="utf-8") == text
    assert [command for command, _ in tools.asked] == [["coqc", "-q", "-R", ".", "Hypcheck", "Any.v"]]


@pytest.mark.parametrize(("said", "message"), [(" Error: no.\n", "Error: no."), ("", "coqc failed without a message")])
def test_a_file_that_coq_refuses_is_an_error_with_what_coq_said(tools, said, message):
    tools.says = {"Rule.v": (1, "", said)}
    with pytest.raises(build.ProofError) as raised:
        build.compile_file("Rule")
    assert str(raised.value) == f"Coq refuses Rule.v: {message}"
    assert raised.value.exit_code == Exit.WRONG


def test_assumptions_of_a_proof_are_read_from_coq_and_empty_for_a_closed_proof(tools):
    build.BUILT.mkdir()
    tools.says = {"Assumptions.v": (0, REAL_NUMBERS, "")}
    assert build.assumptions(("Geometry",)) == {
        "ClassicalDedekindReals.sig_not_dec",
        "FunctionalExtensionality.functional_extensionality_dep",
    }
    asked = (build.BUILT / "Assumptions.v").read_text(encoding="utf-8")
    assert all(f"@Geometry.{each}" in asked for each in build.statements("Geometry"))
    tools.says = {"Assumptions.v": (0, "Closed under the global context\n", "")}
    assert build.assumptions(("Geometry",)) == set()


@pytest.mark.parametrize("answer", [(1, "", "Error: no such file"), (0, "Error: no such file", "")])
def test_coq_that_does_not_print_assumptions_is_an_error(tools, answer):
    build.BUILT.mkdir()
    tools.says = {"Assumptions.v": answer}
    with pytest.raises(build.ProofError, match="Coq does not say what the proofs assume: Error: no such file"):
        build.assumptions(("Geometry",))


def test_the_excluded_middle_is_allowed_in_floats_alone_and_another_axiom_nowhere(monkeypatch):
    known = set(build.AXIOMS)
    found = {True: known | {build.OF_FLOCQ}, False: known}
    monkeypatch.setattr(build, "assumptions", lambda names: set(found["Floats" in names]))
    assert build.demand_known_axioms(("Geometry", "Floats")) == known | {build.OF_FLOCQ}
    assert build.demand_known_axioms(("Geometry",)) == known
    found[False] = known | {build.OF_FLOCQ}
    with pytest.raises(build.ProofError, match=r"assume Classical_Prop\.classic; that is not allowed"):
        build.demand_known_axioms(("Geometry",))
    found.update({False: known, True: {"False_is_true"}})
    with pytest.raises(build.ProofError, match="assume False_is_true; that is not allowed"):
        build.demand_known_axioms(("Geometry", "Floats"))


def test_an_emitted_proof_is_checked_beside_the_compiled_proofs(tools, tmp_path):
    proof = tmp_path / "kernel.v"
    with pytest.raises(InputError, match="the proofs are not compiled"):
        build.check_kernel(proof)
    build.BUILT.mkdir()
    (build.BUILT / "Region.vo").touch()
    with pytest.raises(InputError, match=r"kernel\.v cannot be read: .*No such file"):
        build.check_kernel(proof)
    proof.write_text("Theorem sign : True.", encoding="utf-8")
    assert build.check_kernel(proof) >= 0
    assert tools.asked[-1] == (["coqc", "-q", "-R", ".", "Hypcheck", "Emitted.v"], {"Region.vo", "Emitted.v"})
    tools.says = {"Emitted.v": (1, "", "it is false")}
    with pytest.raises(build.ProofError, match=r"Coq refuses .*kernel\.v: it is false"):
        build.check_kernel(proof)


def test_checker_is_built_from_the_extracted_code_and_a_failure_quotes_ocaml(tools):
    build.BUILT.mkdir()
    build.build_checker()
    assert (build.BUILT / "check_cases.ml").read_bytes() == (build.SOURCES / "check_cases.ml").read_bytes()
    assert tools.asked[-1][0][-2:] == ["-o", "check_cases"]
    tools.says = {"ocamlopt": (2, "", "Unbound module Checker\n")}
    with pytest.raises(build.ProofError, match="OCaml refuses the checker: Unbound module Checker"):
        build.build_checker()


def checker(script):
    build.CHECKER.parent.mkdir()
    build.CHECKER.write_text(f"#!/bin/sh\n{script}\n")
    build.CHECKER.chmod(0o755)


@pytest.mark.parametrize("code", [0, 1])
def test_the_checkers_exit_code_says_whether_a_label_is_wrong(tools, code, capfd):
    checker(f'echo "$1"; exit {code}')
    assert build.run_checker(["file.json"]) == code
    assert capfd.readouterr().out == "file.json\n"


@pytest.mark.parametrize(
    ("script", "message"),
    [("echo 'check_cases: a.json: no list' >&2; exit 2", "a.json: no list"), ("exit 3", "check_cases ended with 3")],
)
def test_a_checker_that_cannot_read_a_file_is_an_error(tools, script, message):
    checker(script)
    with pytest.raises(InputError, match=f"{message}$"):
        build.run_checker(["a.json"])


def test_a_weakened_file_is_compiled_without_what_was_compiled_of_it_before(tools):
    build.BUILT.mkdir()
    for name in ("Checker", "Geometry"):
        (build.BUILT / f"{name}.vo").touch()
    assert build.accepted(CONTROL)
    assert tools.asked[-1][1] == {"Checker.v", "Geometry.vo"}
    tools.says = {"Checker.v": (1, "", "In environment: unable to unify")}
    assert not build.accepted(CONTROL)


def test_weakened_statement_that_matches_no_place_or_is_not_valid_coq_raises_an_error(tools):
    with pytest.raises(ValueError, match=r"Checker\.v has 0 places with 'not there'; one is needed"):
        build.accepted(Weakened("Checker", "not there", "", "anything"))
    tools.says = {"Checker.v": (1, "", "Syntax error: '.' expected")}
    build.BUILT.mkdir()
    with pytest.raises(ValueError, match=r"the change of Checker\.v is no Coq: Syntax error"):
        build.accepted(CONTROL)


@pytest.fixture
def proved(tools, monkeypatch):
    """All proofs hold, and Coq refuses the first weakened statement; `main` is run."""
    monkeypatch.setattr(build, "missing", list)
    monkeypatch.setattr("hypcheck.proofs.__main__.accepted", lambda change: change is CONTROL)
    monkeypatch.setattr(build, "run_checker", lambda files: 0)
    monkeypatch.setattr(
        build, "assumptions", lambda names: {*build.AXIOMS[:1], *({build.OF_FLOCQ} if "Floats" in names else ())}
    )
    return tools


def test_prove_names_each_file_its_axioms_and_the_refused_statements(proved):
    done = CliRunner().invoke(main, ["--weakened", "2"])
    lines = done.output.splitlines()
    assert done.exit_code == 0
    assert [line.split()[0] for line in lines[: len(build.FILES)]] == [f"{name}.v" for name in build.FILES]
    total = sum(len(build.statements(name)) for name in build.FILES)
    assert lines[len(build.FILES)].startswith(f"{total} statements in ")
    assert lines[-3:] == [
        f"    {build.AXIOMS[0]}",
        f"    {build.OF_FLOCQ} (Flocq alone)",
        "2 weakened statements are refused",
    ]


def test_prove_with_soundness_compiles_what_the_checker_rests_on_alone(proved):
    done = CliRunner().invoke(main, ["--soundness"])
    names = (*build.SOUNDNESS, "ExtractedChecker")
    weakened = sum(change.file in names for change in build.weakened())
    assert done.exit_code == 0
    assert f"{weakened} weakened statements are refused" in done.output
    assert {command[-1] for command, _ in proved.asked if command[0] == "coqc"} == {f"{name}.v" for name in names}


def test_prove_ends_with_1_where_coq_accepts_a_weakened_statement_or_refuses_the_control(proved, monkeypatch):
    monkeypatch.setattr("hypcheck.proofs.__main__.accepted", lambda change: True)
    done = CliRunner().invoke(main, ["--soundness"])
    assert done.exit_code == 1
    assert "error: Coq accepts Checker.v, weakened to allow a λ beyond the pole B" in done.output
    monkeypatch.setattr("hypcheck.proofs.__main__.accepted", lambda change: False)
    done = CliRunner().invoke(main, ["--soundness"])
    assert done.exit_code == 1
    assert "error: Coq refuses Checker.v in the folder in which it must refuse" in done.output


def test_prove_with_kernel_files_checks_only_these_files(proved, monkeypatch):
    monkeypatch.setattr(build, "check_kernel", lambda path: 1.25)
    done = CliRunner().invoke(main, ["one.v", "two.v"])
    assert (done.exit_code, proved.asked) == (0, [])
    assert done.output == "one.v: the bound is proved, 1.2 s\ntwo.v: the bound is proved, 1.2 s\n"
