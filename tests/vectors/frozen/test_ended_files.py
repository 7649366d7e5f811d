"""The frozen files about hyperboloids that end: enough of them, fresh, proved, read strictly, and shown."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import pytest

from hypcheck.cli.main import main
from hypcheck.errors import InputError
from hypcheck.geometry.pair import HEIGHTS, TILTED_COLUMNS, Position
from hypcheck.vectors import freezing, frozen
from hypcheck.vectors.cases import StoredCertificate, cases_text, read_cases
from hypcheck.vectors.checking import faults_of
from hypcheck.vectors.families import ENDED_FAMILIES, ENDED_SWEEP_FAMILIES
from hypcheck.vectors.format import ENDED_SCHEMA, ENDED_SWEEP_SCHEMA
from tests.support.records import violations
from tests.vectors.frozen.test_files import bits, schema, text_of


def fits(name, content, version):
    """Whether the file of that name fits its published schema, of which every 6th case is looked at."""
    document = json.loads(text_of(name))
    return not violations({**document, "cases": document["cases"][::6]}, schema(content, version))


every_file = pytest.mark.parametrize("name", frozen.ENDED_NAMES)


@every_file
def test_a_frozen_file_of_pairs_with_ends_fits_its_schema_equals_what_freezing_makes_and_has_right_labels(name):
    file = frozen.load(name)
    assert fits(name, "ended-vectors", ENDED_SCHEMA)
    assert {*bits(ENDED_FAMILIES[name].rows(1, len(file.cases)))} == {*bits(file.rows)}
    assert cases_text(replace(file, lines=())) == text_of(name)
    assert faults_of(replace(file, cases=file.cases[::12], lines=())) == []


def test_cases_with_ends_have_every_position_for_open_and_solid_bodies_and_some_are_tangent():
    cases = [case for name in frozen.ENDED_NAMES for case in frozen.load(name).cases]
    assert {(case.position, case.row[-1]) for case in cases} == {(position, s) for position in Position for s in (0, 1)}
    assert sum(case.tangent for case in cases) > 40
    by_rule = [case for case in cases if case.witness == StoredCertificate()]
    assert all(case.position is Position.CONTACT for case in by_rule)
    assert len(by_rule) < len(cases) / 8


@pytest.mark.parametrize(
    ("name", "content", "version"),
    [
        ("ended-invalid", "ended-refusals", ENDED_SCHEMA),
        ("ended-way-invalid", "ended-way-refusals", ENDED_SWEEP_SCHEMA),
    ],
)
def test_frozen_invalid_rows_with_heights_fit_their_schema_and_equal_those_that_freezing_makes(name, content, version):
    text = text_of(name)
    assert list(violations(json.loads(text), schema(content, version))) == []
    made = freezing.frozen_invalid_rows(name)
    assert made.cases == frozen.load(name).cases
    at_fault = {columns for case in made.cases for columns in [case.columns]}
    assert {("z_min", "z_max"), ("z_min",), ("z_max",), ("solid",), TILTED_COLUMNS[-3:]} <= at_fault
    assert set(HEIGHTS) <= {name for columns in at_fault for name in columns}


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda case: case.update(position=-case["position"] or 1), "does not prove|the exact decision is"),
        (lambda case: case.update(tangent=True), "the exact decision is"),
        (lambda case: case.update(certificate={"pieces": [["-inf", "inf", "0", "0"]]}), "does not prove"),
    ],
)
def test_a_wrong_label_of_a_case_that_ends_is_found(tmp_path, change, sentence, capsys):
    document = json.loads(text_of("ended-rim"))
    case = next(case for case in document["cases"] if "pieces" in case["certificate"])
    change(case)
    document["cases"], document["count"] = [case], 1
    path = tmp_path / "ended.json"
    path.write_text(json.dumps(document))
    assert main(["cases", "check", str(path)]) == 1
    assert re.search(sentence, capsys.readouterr().out)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda case: case["row"].__setitem__(10, "-Infinity"), 'z_min is "-Infinity"; it must be a number'),
        (lambda case: case["hex"].__setitem__(11, "0x1p+0"), "the hex of z_max"),
        (lambda case: case["row"].__setitem__(12, 2.0) or case["hex"].__setitem__(12, "0x1p+1"), "solid is 2.0"),
        (lambda case: case.update(certificate={"rule": "width"}), "certificate"),
        (lambda case: case.update(certificate={"pieces": [["0", "1", "1"]]}), "a list of 4"),
        (
            lambda case: case.update(certificate={"pieces": [["-inf", "-inf", "1", "1"]]}),
            r'pieces\[0\]\[1\] is "-inf"; it must be an integer or p/q, such as -3/4, or "inf"',
        ),
    ],
)
def test_a_malformed_case_that_ends_is_refused(tmp_path, change, sentence):
    document = json.loads(text_of("ended-rim"))
    document["cases"], document["count"] = document["cases"][:1], 1
    change(document["cases"][0])
    path = tmp_path / "ended.json"
    path.write_text(json.dumps(document))
    with pytest.raises(InputError, match=sentence):
        read_cases(str(path))


def test_cases_show_prints_the_heights_and_the_proof_of_a_case_with_ends(capsys):
    assert main(["cases", "show", "ended-rim-0000"]) == 0
    shown = capsys.readouterr().out
    assert "z_max" in shown
    assert "proof" in shown
    assert main(["cases", "show", "ended-rim/1/3/7", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["certificate"]


@pytest.mark.parametrize(
    ("proved", "sentence"),
    [
        (lambda witness: witness.multiplier is not None, r"makes S \+ λH positive definite.*, with or without ends"),
        (lambda witness: witness.pieces, r"cut into \d+ pieces?, each .* S \+ λH \+ μZ is positive"),
        (lambda witness: witness.offsets, "two points of the spheroid .*, so that they meet:"),
        (lambda witness: witness == StoredCertificate(), "rule in the height decides it"),
    ],
)
def test_a_shown_case_that_ends_has_a_sentence_for_each_kind_of_its_proof(proved, sentence, capsys):
    cases = [case for name in frozen.ENDED_NAMES for case in frozen.load(name).cases]
    case = next(case for case in cases if proved(case.witness))
    assert main(["cases", "show", case.id]) == 0
    assert re.search(sentence, " ".join(capsys.readouterr().out.split()))


@pytest.mark.parametrize("name", frozen.ENDED_SWEEP_NAMES)
def test_a_frozen_file_of_sweeps_with_ends_fits_its_schema_equals_what_freezing_makes_and_is_right(name):
    file = frozen.load(name)
    assert fits(name, "ended-ways", ENDED_SWEEP_SCHEMA)
    assert {*bits(ENDED_SWEEP_FAMILIES[name].rows(1, len(file.cases)))} == {*bits(file.rows)}
    assert cases_text(replace(file, lines=())) == text_of(name)
    assert faults_of(replace(file, cases=file.cases[::6], lines=())) == []
    hits = [case.hit for case in file.cases]
    assert sum(hits) > 0.3 * len(hits)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda case: case.update(hit=False, first=None, first_hex=None), "the exact decision|the least value"),
        (lambda case: case.update(first=[0.0, 0.0], first_hex=["0x0p+0"] * 2), "there is no contact at t 0.0"),
    ],
)
def test_a_wrong_label_of_a_sweep_beside_an_end_is_found_by_both_decisions(tmp_path, change, sentence, capsys):
    document = json.loads(text_of("ended-way-opening"))
    case = next(case for case in document["cases"] if case["hit"] and case["first"][0] > 0.1)
    change(case)
    document["cases"], document["count"] = [case], 1
    path = tmp_path / "ways.json"
    path.write_text(json.dumps(document))
    assert main(["cases", "check", str(path)]) == 1
    assert re.search(sentence, capsys.readouterr().out)


def test_a_sweep_beside_an_end_is_shown_with_its_first_contact(capsys):
    case = next(case for case in frozen.load("ended-way-over").cases if case.hit)
    assert main(["cases", "show", case.id]) == 0
    text = capsys.readouterr().out
    assert "contact on the sweep" in text
    assert repr(case.first[0]) in text
    assert "z_max" in text
