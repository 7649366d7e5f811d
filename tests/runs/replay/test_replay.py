"""`hypcheck replay`: its output and its exit codes."""

from __future__ import annotations

import json

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.implementations.builtin import builtin
from hypcheck.record import read
from hypcheck.record.reader import recorded_cases
from hypcheck.runs.replay import case_of
from hypcheck.vectors import frozen as vectors
from hypcheck.vectors.families import FAMILIES
from tests.report import record_samples
from tests.runs.replay import faulty
from tests.support.records import resealed

FREE = "1,99,1,1,5,0,0"
"""Exterior, far off, beside what is nearly a cylinder."""

HIT = "1,2,1,1,2,-0.0,0"
"""A tangency at (1, 0, 0)."""


def subject(name):
    return f"python:tests.runs.replay.faulty:{name}"


def replayed(capsys, *words, code=0):
    assert main(["replay", *words, "--json"]) == code
    return json.loads(capsys.readouterr().out)


def test_replay_of_a_right_answer_says_right(capsys):
    found = replayed(capsys, FREE, subject("exact"))
    assert found["status"] == "right"
    assert (found["answer"], found["truth"]["label"], found["mistake"]) == (1, "exterior", None)
    assert found["values"]["formula"] == "table-2"
    assert (found["values"]["answer"], found["values"]["exact_answer"]) == (1, 1)


def test_replay_shows_the_backward_error_of_a_wrong_answer(capsys, built_in):
    """With α 1, γ 99 and a unit ball, x = 5: contact begins where x (1 − ε) = (α + b)(1 + ε), at ε = 3/7."""
    found = replayed(capsys, FREE, built_in(faulty.contact), code=1)
    assert (found["status"], found["mistake"], found["answer"]) == ("wrong", "false-contact", 0)
    assert found["backward_error"] == pytest.approx(3 / 7, rel=1e-3)
    assert found["backward_error_u"] == pytest.approx(3 / 7 * 2**53, rel=1e-3)
    assert found["truth"]["flips"]["contact"] == found["backward_error"]
    assert found["truth"]["flips"]["interior"] > found["backward_error"]


def test_replay_of_a_yes_no_question_shows_its_answer_in_words(capsys, built_in):
    spec = built_in(faulty.never_interior)
    assert replayed(capsys, FREE, spec, "--question", "exterior")["answer"] == 1
    assert replayed(capsys, "4,4,1,1,0,0,0", spec, "--question", "exterior")["status"] == "right"
    found = replayed(capsys, "4,4,1,1,0,0,0", spec, "--question", "interior", code=1)
    assert (found["status"], found["used"]["question"], found["declared"]["question"]) == (
        "wrong",
        "interior",
        "position",
    )
    assert FORMULAS[found["values"]["formula"]].question in ("interior", "position")


def test_replay_of_a_built_in_formula_shows_the_values_of_that_formula(capsys):
    found = replayed(capsys, "ring-0003", "builtin:hessian-float32")
    assert found["values"]["formula"] == "hessian"
    assert found["values"]["format"] == "float32"
    assert "evaluates" in found["values"]["why"]
    other = replayed(capsys, "ring-0003", "builtin:hessian-float32", "--formula", "shared", "--precision", "float16")
    assert (other["values"]["formula"], other["values"]["format"]) == ("shared", "float32")


def test_foreign_implementation_is_compared_with_a_formula_that_errs_alike(capsys):
    """On the ring Table 2 sees a contact where there is none; far off no formula does."""
    found = replayed(capsys, ring_where_table_2_errs(), subject("contact"), code=1)
    assert found["values"]["formula"] == "table-2"
    assert "answers as" in found["values"]["why"]
    far = replayed(capsys, FREE, subject("contact"), code=1)
    assert far["values"]["formula"] == "table-2"
    assert "though no formula" in far["values"]["why"]


def ring_where_table_2_errs():
    frozen = vectors.load("ring")
    answers = builtin("table-2-float64").answer(frozen.rows)
    return next(name for name, answer in zip(frozen.ids, answers.tolist(), strict=True) if answer == 0)


@pytest.mark.parametrize(
    ("precision", "shown"),
    [("float16", "float16"), ("bfloat16", "float32"), ("exact", "float64"), ("binary128", "longdouble")],
)
def test_replay_shows_values_in_a_format_for_every_precision(capsys, precision, shown):
    found = replayed(capsys, FREE, "builtin:fast", "--precision", precision)
    assert found["values"]["format"] == shown
    assert (" is used" in found["values"]["why"]) is (precision != "float16")


@pytest.mark.skipif(np.finfo(np.longdouble).nmant != 63, reason="long double has another format than that of the x87")
def test_replay_shows_values_in_the_format_of_the_x87_as_they_are(capsys):
    found = replayed(capsys, FREE, "builtin:fast", "--precision", "x87")
    assert (found["values"]["format"], " is used" in found["values"]["why"]) == ("longdouble", False)


def test_replay_has_no_values_of_a_formula_that_finds_no_multiplier(capsys):
    """In float16, whose greatest number is 65504, the sizes 1e5 are infinite."""
    found = replayed(capsys, "1e5,1e5,1,1,1e5,1,1", "builtin:fast", "--formula", "dual", "--precision", "float16")
    assert found["values"] == {"why": "the search of dual finds no finite λ in float16", "own": False}
    assert main(["replay", "1e5,1e5,1,1,1e5,1,1", "builtin:fast", "--formula", "dual", "--precision", "float16"]) == 0
    assert "none: the search of dual finds no finite λ in float16\n" in capsys.readouterr().out


def test_range_of_a_format_that_has_enough_is_no_cause_of_a_wrong_answer(capsys, built_in):
    """9999² is beyond float16."""
    wrong = ("1,9999,1,1,5,0,0", built_in(faulty.contact), "--precision")
    assert [found["cause"] for found in replayed(capsys, *wrong, "float16", code=1)["causes"]] == ["out-of-range"]
    assert replayed(capsys, *wrong, "binary128", code=1)["causes"] == []


def test_replay_finds_an_answer_that_depends_on_other_rows(capsys):
    found = replayed(capsys, FREE, subject("forgets_the_tail"), code=1)
    assert found["status"] == "nondeterministic"
    assert "at place 33: it answers -1" in found["reason"]


def test_replay_keeps_the_sign_of_a_zero(capsys, built_in):
    assert replayed(capsys, HIT, subject("minds_the_sign_of_zero"), code=1)["answer"] == -1
    spec = built_in(faulty.minds_the_sign_of_zero)
    assert replayed(capsys, HIT.replace("-0.0", "0"), spec)["answer"] == 0
    assert replayed(capsys, HIT.replace("-0.0", "-0x0p+0"), spec, code=1)["answer"] == -1


def test_replay_judges_answers_to_invalid_rows(capsys):
    assert replayed(capsys, "invalid-0003", "python:tests.runs.refusing:keeps_its_word")["status"] == "refused"
    found = replayed(capsys, "invalid-0003", "python:tests.runs.refusing:does_not", code=1)
    assert (found["status"], found["truth"], found["values"]) == ("wrong", None, None)
    assert main(["replay", "invalid-0003", "builtin:fast"]) == 2
    assert "does not declare" in capsys.readouterr().err


def test_replay_of_an_invalid_row_shows_the_fault_of_an_implementation_that_promised_to_refuse_it(capsys, tmp_path):
    (tmp_path / "dies.py").write_text(
        "hypcheck = {'refuses': True}\ndef f(rows):\n    raise ValueError('no such row')\n"
    )
    found = replayed(capsys, "invalid-0003", f"python:{tmp_path / 'dies.py'}:f", code=1)
    assert (found["status"], found["answer"]) == ("error", None)
    assert found["reason"].startswith("it raised ValueError: no such row")


def test_case_ids_name_the_same_rows_in_replay_as_elsewhere():
    frozen = vectors.load("ring").cases[4]
    assert case_of(frozen.id).row == frozen.row
    family = FAMILIES["ring"]
    for index in (0, 1023, 1024):
        assert case_of(f"ring/{family.version}/42/{index}").row == tuple(family.rows(42, 1025)[index].tolist())
    assert family.row(42, 3) == case_of(f"ring/{family.version}/42/3").row
    assert case_of("0x1.8p+1,2, 1,1,-0x1p-3,0,0").row == (3.0, 2.0, 1.0, 1.0, -0.125, 0.0, 0.0)


def test_replay_finds_the_cases_of_a_record_by_their_number(tmp_path, capsys, built_in, text_reports):
    out, contact = tmp_path / "out", built_in(faulty.contact)
    assert main(["verify", contact, "--families", "ring,tangent", "--count", "5", "--out", str(out)]) == 1
    capsys.readouterr()
    record = read(out / "record.jsonl")
    kept = recorded_cases(record)
    assert [each.number for each in kept] == list(range(1, len(kept) + 1))
    for each in kept[::4]:
        case = case_of(f"{out / 'record.jsonl'}:{each.number}")
        assert case.name == each.case.case
        assert case.row == case_of(case.name).row
        assert case == case_of(f"{out}:{each.number}")
        found = replayed(capsys, f"{out / 'record.jsonl'}:{each.number}", contact, code=1)
        assert found["backward_error"] == each.case.backward_error
    assert main(["replay", f"{out / 'record.jsonl'}:{len(kept) + 1}", contact]) == 2
    assert f"they are 1 to {len(kept)}" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "about", "own"),
    [
        (["builtin:table-2-float64"], "table-2", True),
        (["builtin:table-2-float64", "--formula", "shared"], "shared", False),
        (["builtin:fast"], "procedure-2a-spheroid", False),
        ([subject("contact")], "table-2", False),
    ],
)
def test_error_of_another_formula_is_not_reported_about_the_implementation(capsys, words, about, own):
    main(["replay", "ring-0007", *words, "--values"])
    text = capsys.readouterr().out
    found = text[text.index("\nfinding ") :].splitlines()[1:]
    assert any(f"the answer of {about} in float64" in line for line in found)
    assert (" not about " not in found[0]) is own
    assert ("these are not the values of " not in text) is own
    main(["replay", "ring-0007", *words, "--json"])
    assert json.loads(capsys.readouterr().out)["values"]["own"] is own


def test_replay_beside_a_hyperboloid_that_ends_is_refused_where_the_implementation_takes_no_heights(capsys):
    assert main(["replay", "ended-rim-0000", "builtin:table-2-float64"]) == 2
    refusal = (
        "hypcheck: error: ended-rim-0000 has heights at which the hyperboloid ends, and table-2-float64 takes none; "
    )
    assert capsys.readouterr().err == f'{refusal}its description must have "takes": ["heights"]\n'


def test_replay_prints_the_text_of_every_formula(capsys):
    for name in ("shared", "local-maximum", "dual", "procedure-2a-spheroid"):
        assert main(["replay", "tangent/1/1/5", "builtin:fast", "--formula", name, "--precision", "float32"]) == 0
        assert f"of {name}, as --formula asks" in capsys.readouterr().out


def test_record_with_an_invalid_row_is_refused(tmp_path, capsys):
    path = tmp_path / "record.jsonl"
    for row, said in (
        (["0x1p+0"] * 6, "worst[0].row is "),
        (["x"] * 7, 'worst[0].row[0] is "x"; it must be a text matching'),
        (3, "worst[0].row is 3; it must be a list"),
        (["0x1p+9999"] * 7, "case 1 has a number that is too large for float64"),
    ):
        worst = {**record_samples.worst("a", "wrong", 3.0), "row": row}
        text, _ = record_samples.text_and_record([record_samples.group("m", "float64", "ring", {"wrong": 1})])
        header, group, footer = map(json.loads, text.splitlines())
        path.write_bytes(resealed([header, {**group, "worst": [worst]}, footer]))
        assert main(["replay", f"{path}:1", "builtin:fast"]) == 2
        assert said in capsys.readouterr().err
