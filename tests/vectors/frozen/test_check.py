"""`hypcheck cases check` finds every wrong label: each is broken in turn, and the check names the case."""

from __future__ import annotations

import io
import json
import math
from dataclasses import replace
from fractions import Fraction

import pytest

from hypcheck.cli.main import main
from hypcheck.errors import InputError
from hypcheck.geometry.pair import Position
from hypcheck.tables.strict_json import read_document
from hypcheck.truth.backward_error import Bracket
from hypcheck.vectors import frozen
from hypcheck.vectors.cases import StoredCertificate, cases_text
from hypcheck.vectors.checking import faults_of
from tests.support.inside import Kind

STEP = 61
"""Every STEP-th frozen case is checked here; `make check-cases` checks all."""


def case_of(name, wanted):
    """The first frozen case of a family of which `wanted` holds."""
    return next(case for case in frozen.load(name).cases if wanted(case))


CLEAR = case_of("tower-body", lambda case: case.position is Position.EXTERIOR)
INSIDE = case_of("tower-body", lambda case: case.position is Position.INTERIOR)
CROSSING = case_of("uniform", lambda case: case.position is Position.CONTACT)
TOUCHING = case_of("tangent", lambda case: case.tangent and case.kind.limit_of is Position.EXTERIOR)
TOUCHING_INSIDE = case_of("tangent", lambda case: case.tangent and case.kind.limit_of is Position.INTERIOR)
RING = frozen.load("ring").cases[0]
ON_SURFACE = case_of("on-surface", lambda case: len(case.witness.offsets) == 1)
SAMPLES = (CLEAR, INSIDE, CROSSING, TOUCHING, TOUCHING_INSIDE, RING, ON_SURFACE)

every_sample = pytest.mark.parametrize("case", SAMPLES, ids=lambda case: case.id)


def sentences(case, **changes):
    """What the check says of a case with these labels in place of its own."""
    changed = replace(case, **changes)
    faults = faults_of(replace(frozen.load("ring"), cases=(changed,), lines=()))
    assert {fault.case for fault in faults} <= {case.id}
    return [fault.sentence for fault in faults]


@every_sample
def test_check_finds_no_fault_in_a_right_case(case):
    assert sentences(case) == []


@every_sample
@pytest.mark.parametrize("position", Position, ids=lambda position: position.label)
def test_a_wrong_position_label_is_found_by_the_certificate_of_the_case(case, position):
    if position is case.position:
        return
    flips = {other: 0.5 for other in Position if other is not position}
    assert any("the certificate" in sentence for sentence in sentences(case, answer=int(position), flips=flips))


@every_sample
def test_a_wrong_tangency_label_is_found_by_the_certificate_of_the_case(case):
    assert any("the certificate" in sentence for sentence in sentences(case, tangent=not case.tangent))


@pytest.mark.parametrize("other", SAMPLES, ids=lambda case: case.id)
@every_sample
def test_check_refuses_the_certificate_of_another_case(case, other):
    """Unless it proves this one too, which is looked at in rationals here."""
    if other is case or _proves(case, other.witness):
        return
    assert any("the certificate" in sentence for sentence in sentences(case, witness=other.witness))


def _proves(case, witness):
    """Whether a multiplier proves a clear case: φ(λ) > 0, a form of the claim that the checker does not use.

    The centre, which is one of all points of a crossing, proves that a case with its centre on the surface is one.
    """
    if case is ON_SURFACE and witness.offsets:
        return True
    at = witness.multiplier
    if at is None or case.position is Position.CONTACT:
        return False
    alpha, gamma, b, d, x, y, z = map(Fraction, case.row)
    A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / b**2, (z / d) ** 2
    if not (0 < at < B if case.position is Position.EXTERIOR else -A < at < 0):
        return False
    return P * at / (A + at) - Q * at / (B - at) - 1 - at > 0


def test_clear_case_labelled_tangent_is_a_fault_even_with_a_double_root_in_its_certificate():
    for case in (CLEAR, INSIDE):
        both = replace(case.witness, double_root=Fraction(1))
        assert any("the certificate" in sentence for sentence in sentences(case, tangent=True, witness=both))


@pytest.mark.parametrize(
    "offsets",
    [
        ((0, 0, 0),),
        ((0, 0, 0), (0, 0, 0)),
        ((0, 0, 0), (2, 0, 0)),  # not in the spheroid
        ((5, 0, 0), (-5, 0, 0)),
    ],
)
def test_certificate_whose_points_do_not_prove_contact_is_refused(offsets):
    witness = StoredCertificate(offsets=tuple(tuple(map(Fraction, point)) for point in offsets))
    for case in (CLEAR, INSIDE, CROSSING, TOUCHING):
        assert any("the certificate" in sentence for sentence in sentences(case, witness=witness))


def test_certificate_with_a_touching_point_does_not_prove_a_crossing():
    """(α, γ, b, d) = (1, 2, 1, 1) at (2, 0, 0) touches at (1, 0, 0): that point proves contact, but no crossing."""
    touching = case_of("small-integers", lambda case: case.tangent)
    row = (1.0, 2.0, 1.0, 1.0, 2.0, 0.0, 0.0)
    witness = StoredCertificate(offsets=((Fraction(-1), Fraction(0), Fraction(0)),))
    said = sentences(
        replace(touching, row=row, tangent=False, kind=Kind.CROSSING_ONE_CURVE, clearance=-0.5, flags=()),
        witness=witness,
    )
    assert "the certificate proves contact, but does not rule tangency out" in said
    inner = StoredCertificate(offsets=((Fraction(0), Fraction(0), Fraction(0)),))
    row = (1.0, 2.0, 1.0, 1.0, 1.0, 0.0, 0.0)
    said = sentences(
        replace(touching, row=row, tangent=False, kind=Kind.CROSSING_ONE_CURVE, clearance=-1.0), witness=inner
    )
    assert not any("the certificate" in sentence for sentence in said)


@every_sample
def test_wrong_kind_of_a_case_is_found_by_the_roots(case):
    for kind in [kind for kind in Kind if kind is not case.kind][::5]:
        assert f"kind is {kind.value}; the roots say {case.kind.value}" in sentences(case, kind=kind)


@every_sample
def test_case_with_a_clearance_one_ulp_off_is_a_fault(case):
    for direction in (-math.inf, math.inf):
        changed = math.nextafter(case.clearance, direction)
        assert any(sentence.startswith("clearance is") for sentence in sentences(case, clearance=changed))
    assert any(sentence.startswith("clearance is") for sentence in sentences(case, clearance=math.inf))


@every_sample
def test_case_with_a_flip_distance_one_ulp_off_is_a_fault(case):
    for position, flip in case.flips.items():
        changed = {**case.flips, position: Bracket(flip.lower, math.nextafter(flip.upper, math.inf))}
        assert [f"the flip to {position.label} is" in sentence for sentence in sentences(case, flips=changed)] == [True]


@every_sample
def test_case_with_a_missing_or_superfluous_flag_is_a_fault(case):
    for flag in case.flags:
        fewer = tuple(other for other in case.flags if other != flag)
        assert any(sentence.startswith("flags are") for sentence in sentences(case, flags=fewer))
    for flag in ("subnormal-float64", "c1=0", "table-2-float64"):
        if flag not in case.flags:
            assert any(sentence.startswith("flags are") for sentence in sentences(case, flags=(*case.flags, flag)))


@every_sample
@pytest.mark.parametrize("place", range(7))
def test_case_with_one_changed_number_in_its_row_is_a_fault(case, place):
    """One part in 10⁶ of one number: flips move, if nothing else does. A zero becomes a hair."""
    row = list(case.row)
    row[place] = row[place] * (1 + 1e-6) if row[place] else 1e-9
    assert sentences(case, row=tuple(row))


@pytest.mark.slow
def test_labels_of_frozen_files_are_right():
    """A sample of every file, the first case and the last among it, by certificate, roots, nearest point and flips."""
    for name in frozen.NAMES:
        file = frozen.load(name)
        chosen = sorted({*range(0, len(file.cases), STEP), len(file.cases) - 1})
        sample = replace(file, cases=tuple(file.cases[place] for place in chosen), lines=())
        assert faults_of(sample) == []
    assert faults_of(frozen.load("invalid")) == []


def test_valid_row_in_a_file_of_invalid_rows_is_a_fault():
    file = frozen.load("invalid")
    bits = tuple(int(word, 16) for word in ["3ff0000000000000"] * 7)
    valid = replace(file.cases[5], bits=bits)
    other = replace(file.cases[6], columns=("x",))
    faults = faults_of(replace(file, cases=(*file.cases[:5], valid, other, *file.cases[7:])))
    assert [(fault.case, fault.line) for fault in faults] == [
        (file.cases[place].id, file.lines[place]) for place in (5, 6)
    ]
    assert "but none is" in faults[0].sentence


def written(tmp_path, change):
    """A small vector file, changed as text."""
    file = frozen.load("tangent")
    path = tmp_path / "mine.json"
    text = cases_text(replace(file, cases=file.cases[:6]))
    changed = change(text)
    assert changed != text or change is same
    path.write_text(changed, encoding="utf-8")
    return str(path)


def same(text):
    return text


def test_cases_check_ends_with_0_if_all_labels_hold(tmp_path, capsys):
    path = written(tmp_path, same)
    assert main(["cases", "check", path, path]) == 0
    assert capsys.readouterr().out == "12 cases checked, none with a wrong label\n"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"tangent":true', '"tangent":false'),
        ('"double_root":"', '"double_root":"1'),
        ('"flips":{"exterior":0.0', '"flips":{"exterior":0.1'),
        (',"waist"', ""),
    ],
)
def test_cases_check_ends_with_1_and_names_the_case_if_a_label_is_wrong(tmp_path, capsys, old, new):
    path = written(tmp_path, lambda text: text.replace(old, new, 1) if old[0] == '"' else _last(text, old, new))
    assert main(["cases", "check", path]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert all(line.startswith(f"{path}, line ") and ", case tangent-0" in line for line in lines[:-1])
    assert len(lines) >= 2
    assert lines[-1] == "6 cases checked, 1 with a wrong label"


def _last(text, old, new):
    """The last occurrence replaced: the first one is in the head."""
    head, _, tail = text.rpartition(old)
    return head + new + tail


def test_cases_check_continues_after_a_wrong_label_and_stops_at_a_malformed_file(tmp_path, capsys):
    wrong = written(tmp_path, lambda text: text.replace('"tangent":true', '"tangent":false', 1))
    bad = tmp_path / "bad.json"
    bad.write_text("[]", encoding="utf-8")
    assert main(["cases", "check", wrong, str(bad)]) == 2
    found = capsys.readouterr()
    assert "case tangent-0000" in found.out
    assert found.err.startswith(f"hypcheck: error: {bad}, line 1: ")


@pytest.mark.parametrize("name", ["tangent", "invalid"])
def test_cases_check_refuses_a_file_without_cases(tmp_path, capsys, name):
    document = json.loads(frozen.path_of(name).read_text(encoding="utf-8"))
    path = tmp_path / "empty.json"
    path.write_text(json.dumps({**document, "count": 0, "cases": []}), encoding="utf-8")
    assert main(["cases", "check", str(path)]) == 2
    assert capsys.readouterr().err == f"hypcheck: error: {path} has no cases; nothing was checked\n"


def test_cases_check_checks_invalid_rows_too(tmp_path, capsys):
    path = tmp_path / "invalid.json"
    text = frozen.path_of("invalid").read_text(encoding="utf-8")
    document = json.loads(text)
    document["cases"][0]["columns"] = ["x"]
    path.write_text(text, encoding="utf-8")
    assert main(["cases", "check", str(path)]) == 0
    path.write_text(json.dumps(document), encoding="utf-8")
    assert main(["cases", "check", str(path)]) == 1
    assert "case invalid-0000: columns x are said to be at fault, but alpha is" in capsys.readouterr().out


def test_an_endless_pipe_is_refused_after_a_limited_number_of_bytes(monkeypatch):
    class Endless(io.RawIOBase):
        def readinto(self, buffer):
            buffer[:] = b"\n" * len(buffer)
            return len(buffer)

        def readable(self):
            return True

    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BufferedReader(Endless())))
    with pytest.raises(InputError, match="standard input has more than 2 MiB; it must be divided"):
        read_document("-", largest=2 << 20)


def test_counting_the_cases_of_an_unknown_name_is_refused_with_a_suggestion():
    with pytest.raises(InputError, match="no frozen vectors 'rings'; did you mean ring"):
        frozen.count_of("rings")


def test_cases_check_ends_with_2_and_names_a_missing_frozen_file(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(frozen, "folder", lambda: tmp_path)
    assert main(["cases", "check"]) == 2
    assert "forest-type-1.json" in capsys.readouterr().err
