"""The frozen files about ways: enough of them, fresh, proved, read strictly, and confirmed by dense exact sampling."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.errors import InputError
from hypcheck.geometry.rows import SWEEPS, invalid
from hypcheck.vectors import freezing, frozen
from hypcheck.vectors.cases import cases_text, read_cases
from hypcheck.vectors.checking import faults_of
from hypcheck.vectors.families import SWEEP_FAMILIES
from hypcheck.vectors.format import SWEEP_SCHEMA, described, flag_facts
from tests.support.records import violations
from tests.vectors.frozen.test_files import bits, schema, text_of

every_file = pytest.mark.parametrize("name", frozen.SWEEP_NAMES)
STEP = 12
OUTDATED = {"way-ring": (14, 43, 55)}
"""Numbers of ways that their generator makes no more: they begin in contact. Those in their places are at the end."""


def sample(name, step=STEP):
    return frozen.load(name).cases[::step]


def test_there_are_at_least_2000_sweeps_in_at_least_14_families():
    files = [frozen.load(name) for name in frozen.SWEEP_NAMES]
    assert len(files) >= 14
    cases = [case for file in files for case in file.cases]
    assert len({struct for file in files for struct in bits(file.rows)}) == len(cases) >= 2000
    answers = Counter(case.hit for case in cases)
    assert min(answers.values()) >= 0.2 * len(cases)
    assert {flag for case in cases for flag in case.flags} == set(flag_facts("sweeps"))
    assert sum("tunnelling" in case.flags for case in cases) >= 200


@every_file
def test_rows_of_a_file_of_sweeps_are_the_first_rows_of_its_family_without_duplicates(name):
    file = frozen.load(name)
    wanted = list(dict.fromkeys(bits(freezing.planned(name))))
    assert [case.id for case in file.cases] == [f"{name}-{number:04d}" for number in range(len(file.cases))]
    found, outdated = bits(file.rows), OUTDATED.get(name, ())
    for place in outdated:
        assert found[place] not in wanted
        found[place] = found[len(wanted) + outdated.index(place)]
    assert found == wanted + [wanted[place] for place in outdated]
    assert file.head == described(name, f"hypcheck cases freeze {name}", SWEEP_FAMILIES[name])
    assert cases_text(file) == text_of(name)
    assert file.positions.tolist() == [int(case.hit) for case in file.cases]
    assert not invalid(file.rows, SWEEPS).any()


@every_file
def test_labels_of_a_file_of_sweeps_are_right(name):
    assert faults_of(replace(frozen.load(name), cases=sample(name), lines=())) == []


@every_file
def test_a_file_of_sweeps_fits_its_published_schema(name):
    document = json.loads(text_of(name))
    document["cases"] = document["cases"][::9]
    wanted = schema("tilted-ways" if name.startswith("tilted") else "ways", SWEEP_SCHEMA)
    assert list(violations(document, wanted)) == []


@pytest.mark.parametrize(("name", "columns"), [("way-invalid", SWEEPS.upright), ("tilted-way-invalid", SWEEPS.tilted)])
def test_frozen_invalid_sweeps_fit_their_schema_and_equal_those_that_freezing_makes(name, columns):
    text = text_of(name)
    assert list(violations(json.loads(text), schema(name.replace("invalid", "refusals"), SWEEP_SCHEMA))) == []
    assert cases_text(freezing.frozen_invalid_rows(name)) == text
    file = frozen.load(name)
    assert file.rows.shape == (len(file.cases), len(columns))
    assert invalid(file.rows, SWEEPS).all()
    assert faults_of(file) == []
    assert {case.columns[0] for case in file.cases if len(case.columns) == 1} == set(columns)
    with np.errstate(invalid="ignore"):
        steps = file.rows[:, 7:10] - file.rows[:, 4:7]
    assert np.isnan(steps).any(axis=1).sum() >= 15
    if name == "tilted-way-invalid":
        assert sum(case.columns == SWEEPS.tilted[10:] and not any(case.row[10:]) for case in file.cases) == 12


def test_frozen_sweeps_have_the_flags_that_their_family_promises():
    def flagged(name, flag):
        cases = frozen.load(name).cases
        return sum(flag in case.flags for case in cases) / len(cases)

    assert flagged("way-grazing", "tangent") == flagged("way-grazing", "tunnelling") == 1
    assert flagged("way-end", "tangent") == 1
    assert flagged("way-begun-in-contact", "contact-at-start") == 1
    assert flagged("way-still", "still") == 1
    assert flagged("way-vertical", "vertical-way") > 0.9
    assert flagged("way-horizontal", "horizontal-way") > 0.9
    assert flagged("way-across", "tunnelling") > 0.5
    assert np.flatnonzero(frozen.load("way-ring").positions).tolist() == list(OUTDATED["way-ring"])
    assert not frozen.load("tilted-way-ring").positions.any()
    for name in ("way-near-graze", "way-uniform", "way-tower", "way-short", "way-long", "tilted-way-uniform"):
        assert 0.05 < frozen.load(name).positions.mean() < 0.99, name


def changed(name, place, **changes):
    file = frozen.load(name)
    return [
        fault.sentence for fault in faults_of(replace(file, cases=(replace(file.cases[place], **changes),), lines=()))
    ]


def test_wrong_labels_of_a_sweep_are_found():
    case = frozen.load("way-grazing").cases[0]
    assert changed("way-grazing", 0) == []
    assert changed("way-grazing", 0, first=None)[0] == "the certificate does not prove that the sweep is clear"
    later = replace(case.witness, time=case.witness.time + Fraction(1, 64))
    assert changed("way-grazing", 0, witness=later)[0] == "the certificate does not prove contact at its time"
    early = (case.first[0] / 2, case.first[0])
    assert changed("way-grazing", 0, first=early)[0].startswith("the certificate does not prove that the first contact")
    short = replace(case.witness, steps=case.witness.steps[:-1])
    assert changed("way-grazing", 0, witness=short)[0].startswith("the certificate does not prove that the first")
    assert changed("way-grazing", 0, flags=())[0].startswith("flags are none; they are ")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"hit":true', '"hit":false', "hit is false; it must be true, which follows from the field first"),
        (
            '"schema": "1.2.0"',
            '"schema": "1.5.0"',
            "schema is \"1.5.0\"; it must be one that this program reads: '1.0.0'",
        ),
        ('"content": "ways"', '"content": "tilted-ways"', "row is .* it must be a list of 13"),
        ('"time":"', '"time":"x', 'time is "x'),
        ('"double_root":"', '"double_root":null,"other":"', "other"),
    ],
)
def test_a_damaged_file_of_sweeps_is_refused(tmp_path, old, new, message):
    text = text_of("way-grazing")
    assert old in text
    path = tmp_path / "ways.json"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(InputError, match=message):
        read_cases(str(path))


def test_cases_commands_accept_sweeps(tmp_path, capsys):
    assert main(["cases", "show", "way-ring"]) == 0
    assert "answers     108 clear, 3 contact" in capsys.readouterr().out
    assert main(["cases", "show", "way-grazing-0001"]) == 0
    shown = capsys.readouterr().out
    assert "contact on the sweep" in shown
    assert "is a double root." in shown
    assert main(["cases", "show", next(case.id for case in frozen.load("way-uniform").cases if not case.hit)]) == 0
    shown = capsys.readouterr().out
    assert "clear all along" in shown
    assert "first" not in shown
    assert main(["cases", "show", "way-uniform/1/1/0", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["id"] == "way-uniform/1/1/0"
    assert main(["cases", "show", "tilted-way-invalid-0000"]) == 0
    assert capsys.readouterr().out.count("at fault") == 3
    target = tmp_path / "made.json"
    assert main(["cases", "generate", "tilted-way-ring", "--count", "3", "--output", str(target)]) == 0
    assert main(["cases", "check", str(target)]) == 0
    assert "3 cases checked, none with a wrong label" in capsys.readouterr().out


POINT = ["0", "0", "0"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda case: case.update(first=[0.25, "0.5"]), r'first\[1\] is "0.5"; it must be a number'),
        (
            lambda case: case.update(hit=False, first=None),
            "first_hex is .*; it must be null, which follows from the field first",
        ),
        (
            lambda case: case.update(first=[0.5, 0.25], first_hex=["0x1p-1", "0x1p-2"]),
            r"first is \[0.5, 0.25\]; it must be null, or two times from 0 to 1, the lower first",
        ),
        (
            lambda case: case["certificate"].update(points=[POINT] * 3),
            "certificate.points is .*; it must be a list of two points at most",
        ),
        (lambda case: case["certificate"].update(points=[POINT]), "a certificate has a time with points or with a"),
        (lambda case: case["certificate"].update(time=None), "a certificate has a time with points or with a"),
    ],
)
def test_a_malformed_case_of_a_sweep_is_refused(tmp_path, change, message):
    """It is of a way that grazes, whose certificate has a time and a double root."""
    document = json.loads(text_of("way-grazing"))
    document["cases"], document["count"] = document["cases"][:1], 1
    assert document["cases"][0]["certificate"]["double_root"]
    change(document["cases"][0])
    path = tmp_path / "ways.json"
    path.write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(InputError, match=message):
        read_cases(str(path))
