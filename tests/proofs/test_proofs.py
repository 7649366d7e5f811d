"""The Coq sources, the messages of the build without Coq, and the proved checker where it has been built."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import pytest

from hypcheck.cli.main import main
from hypcheck.cli.scene import asked_scene
from hypcheck.errors import InputError
from hypcheck.kernel.printing import coq
from hypcheck.kernel.printing.coq import proof_of
from hypcheck.paper.ledger import checks
from hypcheck.paper.ledger.book import claims
from hypcheck.proofs import build, weakenings
from hypcheck.proofs.build import CONTROL, accepted, weakened
from hypcheck.vectors import frozen
from tests.proofs import ended_agreement
from tests.proofs.agreement import disagreements
from tests.proofs.state import up_to_date
from tests.support.inside import CERTIFIED_CONSTANTS, PATTERNS, SLACK, Kind, U, certified, plan_of

ALWAYS_CLEAR = """
name = "far away"
[[hyperboloid]]
alpha = 1.0
gamma = 1.0
[mover]
b = 0.5
d = 0.5
[region]
x = [50.0, 60.0]
y = [0.0, 1.0]
z = [0.0, 1.0]
"""

compiled = pytest.mark.skipif(not up_to_date(), reason="`make prove` has not been run here since the last change")


def test_every_coq_file_is_compiled_and_has_neither_admitted_proofs_nor_axioms():
    assert {path.stem for path in build.SOURCES.rglob("*.v")} == set(build.FILES) - {build.HEADER_TEXT}
    for name in build.FILES:
        assert all(build.proves(name, each) for each in build.statements(name)), name


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("Lemma easy : True.\nProof. Admitted.\n(* Qed *)", "Admitted"),
        ("Axiom easy : True.", "Axiom"),
        ("Lemma easy : True.\nProof. exact I. Qed.\n(* Admitted *)", ""),
    ],
)
def test_unproved_finds_an_admitted_proof_and_an_axiom_in_a_coq_file(text, word):
    assert build.unproved(text) == word


def test_each_weakened_statement_changes_one_place_of_a_file_in_the_build():
    assert len({(change.file, change.old, change.new) for change in weakened()}) == len(weakened()) >= 20
    for change in (*weakened(), CONTROL):
        assert change.file in build.FILES
        assert build.source(change.file).count(change.old) == 1, change


@compiled
def test_coq_accepts_the_checker_and_refuses_it_if_the_ring_counts_as_a_tangency():
    (ring,) = (
        change for change in weakened() if change.allows == "the ring as a tangency" and change.file == "Checker"
    )
    assert accepted(CONTROL)
    assert not accepted(ring)


def test_weakened_statements_are_made_for_every_stage_and_reasons_are_given_only_for_existing_ones():
    made = weakenings.made(build.source)
    assert {change.stage for change in made} == {"1 to 5", "1", "2", "3", "4", "5", "ends", "checker"}
    assert len({(change.file, change.allows) for change in made}) == len(made) >= 400
    for change in made:
        assert change.old != change.new
        assert build.source(change.file).count(change.old) == 1
    assert set(weakenings.reasons()) <= {(change.file, change.allows) for change in made}


@compiled
@pytest.mark.parametrize(
    ("allows", "holds"),
    [("throat: without two_negative", False), ("waist_clear: 2 +1, place 2", False), ("groove: 3 +1", True)],
)
def test_coq_refuses_a_statement_without_a_guard_and_accepts_one_with_a_stronger_guard(allows, holds):
    (change,) = (each for each in weakenings.made(build.source) if each.file == "Stages" and each.allows == allows)
    assert accepted(change) is holds


def test_theorems_that_the_ledger_names_are_in_the_coq_sources():
    theorems = [line.removeprefix("coq: ") for each in claims().values() for line in each.evidence if "coq: " in line]
    assert len(theorems) >= 20
    for theorem in theorems:
        assert build.proves(*theorem.split(".")), theorem


def test_derive_fails_when_a_row_of_the_root_patterns_is_missing():
    for kind in Kind:
        fewer = {**PATTERNS, kind: PATTERNS[kind][1:]}
        patterns, coq = checks.listed_patterns(fewer), checks.patterns_in_coq(fewer)
        assert not patterns.holds
        assert not coq.holds
        assert PATTERNS[kind][0] in patterns.text


def test_derive_fails_when_two_kinds_exchange_their_root_patterns():
    moved = {**PATTERNS, Kind.EXTERIOR_RING: PATTERNS[Kind.EXTERIOR_TANGENT_TWO_POINTS]}
    moved[Kind.EXTERIOR_TANGENT_TWO_POINTS] = PATTERNS[Kind.EXTERIOR_RING]
    assert checks.listed_patterns(moved).holds
    assert not checks.patterns_in_coq(moved).holds


def test_prove_without_coq_names_the_packages_and_ends_2():
    command = [sys.executable, "-m", "hypcheck.proofs"]
    done = subprocess.run(command, env={**os.environ, "PATH": ""}, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr == (
        "proofs: error: the proofs need programs that are not here; on Debian: "
        "apt-get install coq ocaml-findlib ocaml-nox libzarith-ocaml-dev libcoq-flocq\n"
    )


def test_stage_two_in_coq_is_printed_from_the_program_of_the_kernel():
    assert build.source("StageTwo") == coq.stage_two()


def test_listings_in_coq_are_printed_from_the_programs_that_print_the_header():
    assert build.source("Programs") == coq.programs()


@compiled
def test_coq_refuses_a_changed_constant_operation_or_name_in_every_printed_part():
    assert build.refuse_changes(1, build.BUILT) >= 60


def test_constants_proved_in_coq_are_those_of_the_kernel():
    kernel = build.source("Kernel")
    for step, units, constant in (("c0", 8, "u_8"), ("c1", 12, "u_12"), ("c2", 8, "u_8"), ("delta_3", 1536, "u_1536")):
        assert re.search(rf"Theorem error_of_{step} .*?<= {units} \* u \*", kernel, re.DOTALL), step
        unit = Fraction(certified.SINGLE_CONSTANTS[constant]) / Fraction(SLACK)
        assert unit == units * Fraction(U) == units * Fraction(1, 2**52)
    bound = build.source("RunningBound")
    assert "Definition unit := / 2 ^ 52.\nDefinition slack := 1 + / 2 ^ 20.\n" in bound
    assert "4 * unit * slack; 8 * unit * slack; 12 * unit * slack; slack; 16 * unit * slack] 0." in bound
    assert Fraction(SLACK) == 1 + Fraction(1, 2**20)
    for units in (4, 8, 12, 16):
        assert Fraction(CERTIFIED_CONSTANTS[f"u_{units}"]) == units * Fraction(1, 2**52) * Fraction(SLACK)


def test_emit_writes_the_proof_of_each_discriminant_beside_the_kernel(tmp_path):
    kernel, proof = tmp_path / "kernel.c", tmp_path / "kernel.v"
    words = ["emit", "--scene", "tower", "--language", "c", "--output", str(kernel), "--proof", str(proof)]
    assert main(words) == 0
    text = proof.read_text(encoding="utf-8")
    assert kernel.read_text(encoding="utf-8").startswith("/*")
    assert text.count("Theorem sign ") == 2
    for stages in plan_of(asked_scene("tower", None), "float64").settings:
        assert f"Definition bound : Q := ({Fraction(stages.discriminant.bound).numerator} #" in text


def test_emit_with_proof_refuses_a_kernel_without_a_discriminant(tmp_path, capsys):
    scene = tmp_path / "far.toml"
    scene.write_text(ALWAYS_CLEAR, encoding="utf-8")
    words = ["emit", "--scene", str(scene), "--language", "c", "--output", str(tmp_path / "kernel.c")]
    assert main([*words, "--proof", str(tmp_path / "kernel.v")]) == 2
    assert "this kernel decides without a discriminant" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == [scene]


@compiled
def test_coq_proves_the_bound_of_an_emitted_kernel_and_refuses_a_smaller_one(tmp_path):
    text = proof_of(plan_of(asked_scene("tower-simplest", None), "float32"))
    proof, wrong = tmp_path / "kernel.v", tmp_path / "wrong.v"
    proof.write_text(text, encoding="utf-8")
    assert build.check_kernel(proof) > 0
    wrong.write_text(re.sub(r"(bound : Q := \(\d+ # \d+)\)", r"\g<1>0)", text), encoding="utf-8")
    with pytest.raises(build.ProofError, match="Coq refuses"):
        build.check_kernel(wrong)


@compiled
def test_the_proved_checker_proves_every_frozen_position_and_every_sweep_without_ends(capfd):
    files = build.frozen_files()
    names = {name for name in frozen.ALL_NAMES if "ended-way" not in name}
    assert {Path(file).stem for file in files} == names
    cases = sum(len(json.loads(Path(file).read_text(encoding="utf-8"))["cases"]) for file in files)
    assert build.run_checker(files) == 0
    assert capfd.readouterr().out == f"{cases} cases checked by the proved checker, none with a wrong label\n"


@compiled
def test_the_proved_checker_fails_if_it_finds_no_common_point_for_a_contact_without_a_certificate(capfd, tmp_path):
    file = json.loads((frozen.folder() / "ended-rim-tangent.json").read_text(encoding="utf-8"))
    (tmp_path / "found.json").write_text(json.dumps(file), encoding="utf-8")
    touch, other = (case for case in file["cases"][:2] if case["certificate"] == {"rule": "height"})
    for case, position in ((touch, 0), (other, 1)):
        case["row"][3], case["hex"][3], case["position"] = 2.0**-10, "0x1p-10", position
    (tmp_path / "missed.json").write_text(json.dumps({**file, "cases": [touch, other]}), encoding="utf-8")
    assert build.run_checker([str(tmp_path / "found.json")]) == 0
    assert "not checked" not in capfd.readouterr().out
    assert build.run_checker([str(tmp_path / "missed.json")]) == 1
    said = capfd.readouterr().out
    assert f"case {other['id']}: the certificate does not prove the label\n" in said
    assert said.endswith("1 contacts beside an end have no certificate and are not checked\n")


def _interior_called_exterior(case):
    case["position"] = 1


def _exterior_called_interior(case):
    case["position"] = -1


def _tangency_called_crossing(case):
    case["tangent"] = False


def _root_moved(case):
    case["certificate"]["double_root"] += "0"


def _axis_turned(case):
    case["row"][7], case["row"][8] = case["row"][8], case["row"][7]
    case["hex"][7], case["hex"][8] = case["hex"][8], case["hex"][7]


def _first_contact_later(case):
    case["first_hex"] = ["0x1.8p-1", "0x1.8p-1"]


def _piece_left_out(case):
    del case["certificate"]["pieces"][-1]


def _piece_to_the_other_side(case):
    piece = case["certificate"]["pieces"][0]
    piece[0] = piece[0].removeprefix("-") if piece[0].startswith("-") else f"-{piece[0]}"


def _point_left_out(case):
    del case["certificate"]["points"][0]


def _end_moved(case):
    case["row"][11], case["hex"][11] = "inf", "inf"


def _open_called_solid(case):
    case["row"][12], case["hex"][12] = 1.0, "0x1p+0"


def _valid_row(case):
    case["row"][10], case["row"][11] = -1.0, 2.0


@compiled
@pytest.mark.parametrize(
    ("name", "place", "damage"),
    [
        ("tangent", 7, _interior_called_exterior),
        ("tangent", 7, _tangency_called_crossing),
        ("tangent", 7, _root_moved),
        ("tilted-tangent", 7, _tangency_called_crossing),
        ("tilted-tangent", 7, _root_moved),
        ("tilted-tangent", 7, _axis_turned),
        ("tilted-uniform", 1, _interior_called_exterior),
        ("way-across", 0, _first_contact_later),
        ("way-across", 0, _piece_left_out),
        ("way-across", 0, _piece_to_the_other_side),
        ("way-across", 0, _point_left_out),
        ("ended-rim", 0, _exterior_called_interior),
        ("ended-rim", 0, _piece_left_out),
        ("ended-rim", 0, _open_called_solid),
        ("ended-rim", 1, _end_moved),
        ("ended-rim", 2, _point_left_out),
        ("tilted-ended-rim", 0, _axis_turned),
    ],
)
def test_the_proved_checker_refuses_a_wrong_label(name, place, damage, capfd, tmp_path):
    file = json.loads((frozen.folder() / f"{name}.json").read_text(encoding="utf-8"))
    damage(file["cases"][place])
    (tmp_path / "wrong.json").write_text(json.dumps(file), encoding="utf-8")
    assert build.run_checker([str(tmp_path / "wrong.json")]) == 1
    said = capfd.readouterr().out
    assert f"case {file['cases'][place]['id']}: the certificate does not prove the label" in said
    assert "checked by the proved checker, 1 with a wrong label\n" in said


@compiled
def test_the_proved_checker_finds_a_valid_row_in_a_file_of_invalid_rows_with_ends(capfd, tmp_path):
    file = json.loads((frozen.folder() / "ended-invalid.json").read_text(encoding="utf-8"))
    _valid_row(file["cases"][0])
    (tmp_path / "wrong.json").write_text(json.dumps(file), encoding="utf-8")
    assert build.run_checker([str(tmp_path / "wrong.json")]) == 1
    assert f"case {file['cases'][0]['id']}: is a valid row\n" in capfd.readouterr().out


@compiled
@pytest.mark.parametrize("name", ["ended-disc", "ended-small-integers", "tilted-ended-rim"])
def test_the_proved_checker_and_python_agree_on_certificates_beside_ends(name, tmp_path):
    proved, python = ended_agreement.verdicts(name, tmp_path, every=6)
    assert proved == python
    assert 20 < sum(proved) < len(proved) - 20


@compiled
@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{", "the file ends in the middle of a value"),
        ('{"content": "positions", "cases": [{"id": "a"}]}', 'case a: there is no "hex"'),
        ('{"content": "positions", "cases": 3}', "a list is expected"),
    ],
)
def test_the_proved_checker_names_a_file_that_it_cannot_read(text, said, tmp_path):
    (tmp_path / "bad.json").write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as raised:
        build.run_checker([str(tmp_path / "bad.json")])
    assert str(raised.value) == f"{tmp_path}/bad.json: {said}"


@compiled
def test_the_proved_checker_and_python_agree_on_right_and_wrong_certificates():
    number, proved, different = disagreements(2000, seed=2)
    assert different == []
    assert number >= 2000
    assert 200 < proved < number - 200
