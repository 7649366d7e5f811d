"""From a record's worst rows to findings: an engine with a planted error, reduced to one triangle and proved."""

import sys
from math import isnan, nan

import numpy as np
import pytest
from msgspec.structs import replace

from hypcheck.engines import reduce
from hypcheck.engines.engine import ENGINES
from hypcheck.engines.findings import proved
from hypcheck.engines.measure import EngineRecord, Measured, Reported
from hypcheck.engines.placing import FAMILIES, drawn
from hypcheck.engines.reduce import Asker, Said, best_direction, findings_of, lower_bounds, nearest_shares
from hypcheck.engines.scene import rows_near, surface_mesh, to_triangles

BALL = FAMILIES["ball"]
PLANTED = 0.01
"""What is wrong with an engine here, in metres."""

ABOVE = np.array([[-1.0, -1.0, 0.5], [1.0, -1.0, 0.5], [0.0, 1.0, 0.5]])
"""A triangle half a unit above the origin."""


@pytest.fixture(scope="module")
def mesh():
    return surface_mesh(BALL.sizes, 500)


@pytest.fixture(scope="module")
def rows(mesh):
    """Rows of the ball about half of PLANTED from contact with the mesh: a clear one and one in contact."""
    spot, gap = drawn(BALL, 2)
    found, apart = rows_near(spot, gap, mesh)
    clear = (apart - 1) * BALL.b
    nearest = [int(np.abs(clear - wanted).argmin()) for wanted in (PLANTED / 2, -PLANTED / 2)]
    assert clear[nearest] == pytest.approx([PLANTED / 2, -PLANTED / 2], abs=PLANTED / 4)
    return {"clear": found[nearest[0]].tolist(), "contact": found[nearest[1]].tolist()}


def measured(mesh, row, **changes):
    reported = Reported(1, 0, 10.0, 10.0, row, None, 1, row)
    found = Measured(
        BALL.name, len(mesh.triangles), 1.0, 1, 0, 0, 0.0, None, 0, 0.0, 1, 1, 5.0, row, {}, [],
        Reported(0, 0, None, None, None, None), reported, None,
    )  # fmt: skip
    return replace(found, **changes)


def record(name, *found):
    return EngineRecord("2.0.0", "0", "here", name, "0", list(found), [], {})


def engine_with(monkeypatch, contact=0.0, reported=0.0):
    """An engine that says contact up to this distance, and reports this much more than the distance."""

    def said(asker, corners):
        apart = float(np.sqrt(to_triangles(corners).min())) - asker.b
        return Said(apart <= contact, apart + reported)

    monkeypatch.setattr(Asker, "__call__", said)


@pytest.mark.parametrize(
    ("kind", "row", "planted", "least_mm", "most_mm"),
    [
        ("false contact", "clear", {"contact": PLANTED}, 1.2, 7.5),
        ("missed contact", "contact", {"contact": -PLANTED}, 1.2, 7.5),
        ("too near", "clear", {"reported": -PLANTED}, 5.0, 10.001),
        ("too far", "clear", {"reported": PLANTED}, 5.0, 10.001),
        ("contradiction", "clear", {"contact": PLANTED}, 1.2, 7.5),
    ],
)
def test_a_planted_engine_error_is_reduced_to_one_triangle_of_round_numbers_and_proved(
    monkeypatch, tmp_path, mesh, rows, kind, row, planted, least_mm, most_mm
):
    engine_with(monkeypatch, **planted)
    found = {each.kind: each for each in findings_of(record("python-fcl", measured(mesh, rows[row])), tmp_path)}
    one = found[kind]
    assert proved(one)
    assert least_mm <= one.error_mm <= most_mm
    assert (one.b, one.d, one.millimetres) == (0.25, 0.25, 1000.0)
    assert all((np.array(one.corners) * 2.0**20 % 1 == 0).flat)


def test_an_engine_without_an_error_gives_no_finding(monkeypatch, tmp_path, mesh, rows):
    engine_with(monkeypatch)
    both = [measured(mesh, rows[each]) for each in ("clear", "contact")]
    assert list(findings_of(record("python-fcl", *both), tmp_path)) == []


def test_an_engine_that_never_answers_gives_no_finding(monkeypatch, tmp_path, mesh, rows):
    monkeypatch.setattr(Asker, "__call__", lambda asker, corners: None)
    assert list(findings_of(record("python-fcl", measured(mesh, rows["clear"])), tmp_path)) == []


def test_an_engine_error_that_no_single_triangle_shows_gives_no_finding(monkeypatch, tmp_path, mesh, rows):
    def said(asker, corners):
        return Said(len(corners) > 1, nan)

    monkeypatch.setattr(Asker, "__call__", said)
    assert list(findings_of(record("python-fcl", measured(mesh, rows["clear"])), tmp_path)) == []


def test_an_engine_error_on_a_triangle_that_is_not_the_nearest_is_found_by_halving(monkeypatch, tmp_path, mesh, rows):
    engine_with(monkeypatch)
    right = Asker.__call__
    nearest = reduce._near(measured(mesh, rows["clear"]), np.array(rows["clear"]))
    wrong = nearest[5]

    def said(asker, corners):
        planted = any((each == wrong).all() for each in corners)
        return Said(False, right(asker, corners).reported - planted)

    monkeypatch.setattr(Asker, "__call__", said)
    asker = Asker(ENGINES["python-fcl"], tmp_path, BALL.b, BALL.d)
    assert asker.error("too near", asker(nearest[:1]), nearest[0]) == pytest.approx(0.0, abs=1e-9)
    assert reduce._alone(asker, "too near", nearest).tolist() == wrong.tolist()


def test_rows_that_cannot_show_an_error_of_the_engine_itself_are_not_reduced(monkeypatch, tmp_path, mesh, rows):
    engine_with(monkeypatch, contact=PLANTED, reported=-PLANTED)
    row = rows["clear"]
    small = Reported(1, 0, 1.4, 1.4, row, None)
    others = [measured(mesh, row, family=name) for name in ("leaning", "inside")]
    explained = measured(mesh, row, own_worst_row=None, distance=small, penetration=small)
    assert list(findings_of(record("python-fcl", *others, explained), tmp_path)) == []


def test_an_engine_whose_body_is_a_hull_has_no_missed_contact_or_too_far_error(tmp_path):
    hull = Asker(ENGINES["pybullet"], tmp_path, 1.0, 0.25)
    exact = Asker(ENGINES["python-fcl"], tmp_path, 1.0, 0.25)
    assert hull.error("too far", Said(False, 1.0), ABOVE) == 0
    assert exact.error("too far", Said(False, 1.0), ABOVE) == pytest.approx(0.75)
    deep = ABOVE * [1, 1, 0]
    assert hull.error("missed contact", Said(False, nan), deep) == 0
    assert exact.error("missed contact", Said(False, nan), deep) == pytest.approx(0.25)


@pytest.mark.parametrize(
    ("kind", "said", "error"),
    [
        ("false contact", Said(True, nan), 0.25),
        ("false contact", Said(False, nan), 0.0),
        ("too near", Said(False, 0.2), 0.05),
        ("too near", Said(False, 0.3), 0.0),
        ("too near", Said(False, nan), 0.0),
        ("too far", Said(False, 0.3), 0.05),
        ("too far", None, 0.0),
        ("contradiction", Said(True, 0.2), 0.25),
        ("contradiction", Said(True, -0.2), 0.0),
        ("contradiction", Said(False, 0.2), 0.0),
    ],
)
def test_error_of_an_engine_is_the_difference_of_its_answer_from_the_true_distance(tmp_path, kind, said, error):
    asker = Asker(ENGINES["python-fcl"], tmp_path, 1.0, 0.25)
    assert asker.error(kind, said, ABOVE) == pytest.approx(error, abs=1e-9)


def test_asker_reads_the_answer_of_an_adapter_or_gives_none_if_it_ends_early(monkeypatch, tmp_path):
    script = tmp_path / "adapter.py"
    monkeypatch.setattr(reduce, "command", lambda engine, cache, scene, tightest: (sys.executable, script, scene))
    asker = Asker(ENGINES["python-fcl"], tmp_path, 1.0, 0.25)
    script.write_text(
        "import sys; from pathlib import Path\n"
        "first = sys.stdin.readline(), sys.stdin.readline()\n"
        "assert first == ('classify 1 1 tilted-text\\n', '1 1 1.0 0.25 0 0 0 0 0 1\\n'), first\n"
        "corners = Path(sys.argv[1], 'surface.off').read_text().splitlines()[2:5]\n"
        "print('{}', '1 1', '1', '2 1', corners[0].split()[2], sep='\\n')\n"
    )
    assert asker(ABOVE[np.newaxis]) == Said(True, 0.5)
    script.write_text("print('{}', '1 1', '0', sep='\\n')\n")
    said = asker(ABOVE[np.newaxis])
    assert not said.contact
    assert isnan(said.reported)
    script.write_text("raise SystemExit(3)\n")
    assert asker(ABOVE[np.newaxis]) is None


def test_distances_in_a_finding_are_worded_as_apart_or_deep():
    assert reduce._words("too near", Said(False, 0.002), 0.001, 1000.0) == ("2 mm apart", "3 mm apart at least")
    assert reduce._words("too far", Said(False, 0.002), 0.001, 1000.0) == ("2 mm apart", "1 mm apart at most")
    assert reduce._words("too near", Said(True, -0.002), 0.001, 1000.0) == ("2 mm deep", "1 mm deep at most")


def test_best_direction_proves_the_signed_distance_of_a_triangle_from_a_ball():
    rng = np.random.default_rng(5)
    for corners in rng.normal((0.0, 0.0, 2.0), size=(20, 3, 3)):
        way = best_direction(corners, 0.5, 0.5)
        point = nearest_shares(corners) @ corners
        found = lower_bounds(corners, 0.5, 0.5, way[np.newaxis])[0]
        assert found == pytest.approx(np.linalg.norm(point) - 0.5, abs=1e-9)
