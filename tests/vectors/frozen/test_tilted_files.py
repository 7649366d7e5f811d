"""The frozen files about tilted spheroids: enough of them, fresh, proved, read strictly, and shown."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.errors import InputError
from hypcheck.geometry.pair import TILTED_COLUMNS, Position
from hypcheck.geometry.rows import invalid
from hypcheck.vectors import freezing, frozen
from hypcheck.vectors.cases import case_fields, cases_text, read_cases
from hypcheck.vectors.checking import faults_of
from hypcheck.vectors.families import FAMILIES, TILTED_FAMILIES
from hypcheck.vectors.format import TILTED_SCHEMA, content_with, described, flag_facts
from hypcheck.vectors.labels import shows_crossing
from tests.support.inside import Bracket
from tests.support.records import violations
from tests.vectors.frozen.test_files import bits, schema, text_of

STEP = 40
every_file = pytest.mark.parametrize("name", frozen.TILTED_NAMES)
FEW = ("tilted-tangent", "tilted-ring", "tilted-upright", "tilted-near-contact")


def sample(name, step=STEP):
    file = frozen.load(name)
    chosen = sorted({*range(0, len(file.cases), step), len(file.cases) - 1})
    return replace(file, cases=tuple(file.cases[place] for place in chosen), lines=())


def test_there_are_at_least_2000_tilted_cases_in_at_least_12_families():
    assert len(frozen.TILTED_NAMES) >= 12
    assert sum(len(frozen.load(name).cases) for name in frozen.TILTED_NAMES) >= 2000
    cases = [case for name in frozen.TILTED_NAMES for case in frozen.load(name).cases]
    assert {flag for case in cases for flag in case.flags} == set(flag_facts("tilted"))


@every_file
def test_rows_of_a_tilted_file_are_the_first_rows_of_its_family_without_duplicates(name):
    file = frozen.load(name)
    wanted = list(dict.fromkeys(bits(freezing.planned(name))))
    assert bits(file.rows) == wanted
    assert [case.id for case in file.cases] == [f"{name}-{number:04d}" for number in range(len(wanted))]
    assert file.head == described(name, f"hypcheck cases freeze {name}", TILTED_FAMILIES[name])
    assert cases_text(file) == text_of(name)
    assert frozen.load(name).rows.shape == (len(wanted), 10)


@pytest.mark.slow
@every_file
def test_labels_of_a_tilted_file_are_right(name):
    assert faults_of(sample(name)) == []


@every_file
def test_a_tilted_file_fits_its_published_schema(name):
    document = json.loads(text_of(name))
    document["cases"] = document["cases"][::7]
    assert list(violations(document, schema("tilted-vectors", TILTED_SCHEMA))) == []


def test_frozen_invalid_tilted_rows_fit_their_schema_and_equal_those_that_freezing_makes():
    text = text_of("tilted-invalid")
    assert list(violations(json.loads(text), schema("tilted-refusals", TILTED_SCHEMA))) == []
    assert cases_text(freezing.frozen_invalid_rows("tilted-invalid")) == text
    file = frozen.load("tilted-invalid")
    assert file.rows.shape == (len(file.cases), 10)
    assert invalid(file.rows).all()
    assert faults_of(file) == []
    assert {columns[0] for case in file.cases if len(columns := case.columns) == 1} == set(TILTED_COLUMNS)
    without = [case for case in file.cases if case.columns == TILTED_COLUMNS[7:]]
    assert any(not np.any(case.row[7:]) for case in without)


def test_tilted_ring_cases_are_clear_with_a_vanishing_discriminant():
    cases = frozen.load("tilted-ring").cases
    exactly = [case for case in cases if "quartic-delta=0" in case.flags]
    assert len(exactly) >= len(cases) / 4
    assert all("quartic-ring" in case.flags and case.position is not Position.CONTACT for case in exactly)


def test_tilted_tangent_cases_are_tangent_and_tilted_crossing_cases_have_a_double_root_without_tangency():
    assert all(case.tangent for case in frozen.load("tilted-tangent").cases)
    for case in frozen.load("tilted-crossing").cases:
        assert not case.tangent
        assert {"quartic-delta=0", "sphere"} & set(case.flags)


def test_vertical_axes_and_spheres_have_the_position_of_the_upright_pair():
    for name in ("tilted-upright", "tilted-sphere"):
        assert not any("tilt-matters" in case.flags for case in frozen.load(name).cases)
    tower = frozen.load("tilted-tower").cases
    assert 0.01 < np.mean(["tilt-matters" in case.flags for case in tower]) < 0.5


def changed(case, **changes):
    file = replace(frozen.load("tilted-near-contact"), cases=(replace(case, **changes),), lines=())
    return [fault.sentence for fault in faults_of(file)]


def test_wrong_labels_of_a_tilted_case_are_found():
    case = next(each for each in frozen.load("tilted-near-contact").cases if each.position is Position.EXTERIOR)
    assert changed(case) == []
    assert "does not prove contact" in changed(case, answer=0)[0]
    assert "clearance" in changed(case, clearance=case.clearance * 1.1)[0]
    assert "flags" in changed(case, flags=("sphere",))[0]
    wide = case.flips[Position.CONTACT]
    for ends in (Bracket(0.0, wide.lower / 2), Bracket(wide.upper * 2, wide.upper * 3), Bracket(0.0, 0.0)):
        flips = {**case.flips, Position.CONTACT: ends}
        assert "the flip to contact is" in changed(case, flips=flips)[0]
    row = (*case.row[:7], *(-2 * each for each in case.row[7:]))
    assert changed(case, row=row) == []
    witness = replace(case.witness, multiplier=-case.witness.multiplier)
    assert "does not prove exterior" in changed(case, witness=witness)[0]


def test_points_of_a_crossing_lie_in_the_spheroid_on_strictly_opposite_sides():
    case = next(each for each in frozen.load("tilted-near-contact").cases if len(each.witness.offsets) == 2)
    centre, other = case.witness.offsets
    assert shows_crossing(case.row, (centre, other))
    assert not shows_crossing(case.row, (centre,))
    assert not shows_crossing(case.row, (other,))
    assert not shows_crossing(case.row, (centre, tuple(2 * Fraction(each) for each in other)))


NO_AXIS, NO_HEX = [0.0] * 3, ["0x0p+0"] * 3
SOUND = text_of("tilted-ring").splitlines()
FIRST = SOUND.index('"cases": [') + 1


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda case: case.update(row=case["row"][:7]), "a list of 10"),
        (lambda case: case["row"].__setitem__(slice(7, 10), [0.0] * 3), "hex of axis_"),
        (lambda case: case.update(row=[*case["row"][:7], *NO_AXIS], hex=[*case["hex"][:7], *NO_HEX]), "direction"),
        (lambda case: case.update(tangent=0), "true or false"),
        (lambda case: case.update(kind="exterior"), "kind"),
        (lambda case: case["flips"].update(contact=0.5), "a list of 2"),
        (lambda case: case["flips"].update(contact=[0.5, 0.25]), "the lower first"),
        (lambda case: case["flips"].update(contact=[0.5, 1.5]), "from 0 to 1"),
        (
            lambda case: case["flips"].update(contact=[0.5, "1"]),
            r'flips.contact\[1\] is "1"; it must be a number, or "inf"',
        ),
        (lambda case: case["flips"].pop("contact") and None, "flips has no contact"),
        (lambda case: case.update(flags=["ring"]), "not among those"),
    ],
)
def test_a_tilted_case_that_is_wrongly_written_is_refused(tmp_path, change, message):
    lines = list(SOUND)
    case = json.loads(lines[FIRST].removesuffix(","))
    assert tuple(case) == case_fields(content_with(frozenset({"axis"})))
    change(case)
    lines[FIRST] = json.dumps(case) + ","
    path = tmp_path / "mine.json"
    path.write_text("\n".join(lines), encoding="utf-8")
    with pytest.raises(InputError, match=f"line {FIRST + 1}, case tilted-ring-0000: .*{message}"):
        read_cases(str(path))


def test_read_cases_refuses_a_file_whose_content_is_not_the_requested_one(tmp_path):
    with pytest.raises(InputError, match="here it must be 'positions'"):
        read_cases(str(frozen.path_of("tilted-ring")), content_with())
    with pytest.raises(InputError, match="here it must be 'tilted-positions'"):
        read_cases(str(frozen.path_of("ring")), content_with(frozenset({"axis"})))
    with pytest.raises(InputError, match="here it must be 'refusals'"):
        read_cases(str(frozen.path_of("tilted-ring")), content_with(refused=True))
    path = tmp_path / "mine.json"
    path.write_text(text_of("tilted-ring").replace("1.1.0", "1.0.0", 1), encoding="utf-8")
    with pytest.raises(InputError, match="it must be one of positions, refusals"):
        read_cases(str(path))


def printed(capsys, *arguments):
    assert main(["cases", *arguments]) == 0
    return capsys.readouterr().out


def test_cases_show_prints_tilted_families_and_cases(capsys):
    assert "positions" in printed(capsys, "show", "tilted-ring")
    assert "all to be refused" in printed(capsys, "show", "tilted-invalid")
    text = " ".join(printed(capsys, "show", "tilted-ring-0000").split())
    for part in (
        "axis_x",
        "axis_z",
        "is above 0, and S + λH is positive definite",
        "flip contact if each number may change",
        " … ",
    ):
        assert part in text
    assert json.loads(printed(capsys, "show", "--json", "tilted-ring-0000"))["id"] == "tilted-ring-0000"
    assert "axis_x" in printed(capsys, "show", "tilted-invalid-0000")
    assert "position" in printed(capsys, "show", "tilted-uniform/1/5/3")


def test_cases_generate_writes_tilted_rows_in_every_format(capsys, tmp_path):
    table = printed(capsys, "generate", "tilted-uniform", "--count", "3", "--format", "csv").splitlines()
    assert table[0] == ",".join(("id", *TILTED_COLUMNS))
    assert table[1].startswith("tilted-uniform/1/1/0,")
    path = tmp_path / "mine.json"
    printed(capsys, "generate", "tilted-upright", "--count", "2", "--seed", "7", "--output", str(path))
    assert len(read_cases(str(path)).cases) == 2
    assert printed(capsys, "check", str(path)) == "2 cases checked, none with a wrong label\n"


def test_tilted_and_upright_families_have_different_names():
    assert not set(FAMILIES) & set(TILTED_FAMILIES)
    assert set(frozen.NAMES).isdisjoint(frozen.TILTED_NAMES)
