"""From a record's worst rows to findings: an engine with a planted error, reduced to one triangle and proved."""

import sys
from math import isnan, nan

import numpy as np
import pytest
from msgspec.structs import replace

from hypcheck.cli.main import main
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


SAYS = {
    "false contact": "apart",
    "missed contact": "clear",
    "too near": "mm apart",
    "too far": "mm apart",
    "contradiction": "mm apart",
}
"""How the engine's answer ends, and how what is proved of it begins or ends."""

PROVED = {
    "false contact": "clear by ",
    "missed contact": "in contact: ",
    "too near": "mm apart at least",
    "too far": "mm apart at most",
    "contradiction": "clear by ",
}


def measured(mesh, row, **changes):
    reported = Reported(1, 0, 10.0, 10.0, row, None, 1, row)
    found = Measured(
        BALL.name, len(mesh.triangles), 1.0, 1, 0, 0, 0.0, None, 0, 0.0, 1, 1, 5.0, row, {}, [],
        Reported(0, 0, None, None, None, None), reported, None,
    )  # fmt: skip
    return replace(found, **changes)


def record(name, *found):
    return EngineRecord("2.0.0", "0", "here", name, "0", list(found), [], {})


def engine_with(contact=0.0, reported=0.0):
    """An engine that says contact up to this distance, and reports this much more than the distance."""

    def said(asker, corners):
        apart = float(np.sqrt(to_triangles(corners).min())) - asker.b
        return Said(apart <= contact, apart + reported)

    return said


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
    tmp_path, mesh, rows, kind, row, planted, least_mm, most_mm
):
    of_row = record("python-fcl", measured(mesh, rows[row]))
    found = {each.kind: each for each in findings_of(of_row, tmp_path, engine_with(**planted))}
    one = found[kind]
    assert proved(one)
    assert least_mm <= one.error_mm <= most_mm
    assert one.said.endswith(SAYS[kind])
    assert one.proved.startswith(PROVED[kind]) or one.proved.endswith(PROVED[kind])
    assert (one.b, one.d, one.millimetres) == (0.25, 0.25, 1000.0)
    assert all((np.array(one.corners) * 2.0**20 % 1 == 0).flat)


def test_an_engine_without_an_error_gives_no_finding(tmp_path, mesh, rows):
    both = [measured(mesh, rows[each]) for each in ("clear", "contact")]
    assert list(findings_of(record("python-fcl", *both), tmp_path, engine_with())) == []


@pytest.mark.parametrize(
    "answer",
    [lambda asker, corners: None, lambda asker, corners: Said(len(corners) > 1, nan)],
    ids=["never answers", "is wrong about many triangles only"],
)
def test_an_engine_without_an_error_about_one_triangle_gives_no_finding(tmp_path, mesh, rows, answer):
    assert list(findings_of(record("python-fcl", measured(mesh, rows["clear"])), tmp_path, answer)) == []


def test_an_engine_error_on_a_triangle_that_is_not_the_nearest_is_found_by_halving(tmp_path, mesh, rows):
    """The engine is wrong about one of the triangles behind the nearest: the finding is of that one."""
    right, wrong = engine_with(), []

    def planted(asker, corners):
        if len(corners) > 1 and not wrong:
            wrong.append(corners[5])
        return Said(False, right(asker, corners).reported - any((each == wrong[0]).all() for each in corners if wrong))

    (one,) = findings_of(record("python-fcl", measured(mesh, rows["clear"])), tmp_path, planted)
    assert one.kind == "too near"
    assert one.corners == wrong[0].tolist()


def test_rows_that_cannot_show_an_error_of_the_engine_itself_are_not_reduced(tmp_path, mesh, rows):
    row = rows["clear"]
    small = Reported(1, 0, 1.4, 1.4, row, None)
    others = [measured(mesh, row, family=name) for name in ("leaning", "inside")]
    explained = measured(mesh, row, own_worst_row=None, distance=small, penetration=small)
    assert list(findings_of(record("python-fcl", *others, explained), tmp_path, engine_with(PLANTED, -PLANTED))) == []


def test_no_missed_contact_or_too_far_error_counts_for_an_engine_whose_body_is_a_convex_hull(tmp_path):
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


def test_asker_returns_the_answer_of_an_adapter_or_none_if_the_adapter_ends_early(monkeypatch, tmp_path):
    """The adapter is one for node, in the place of which another program stands on PATH."""
    node = tmp_path / "bin" / "node"
    node.parent.mkdir()
    (node.parent / "npm").write_text("#!/bin/sh\n")
    monkeypatch.setenv("PATH", f"{node.parent}:/bin:/usr/bin")

    def program(text):
        node.write_text(f"#!{sys.executable}\n{text}")
        for path in node.parent.iterdir():
            path.chmod(0o755)

    program("")
    assert main(["engines", "install", "cannon-es", "--cache", str(tmp_path)]) == 0
    asker = Asker(ENGINES["cannon-es"], tmp_path, 1.0, 0.25)
    program(
        "import sys; from pathlib import Path\n"
        "first = sys.stdin.readline(), sys.stdin.readline()\n"
        "assert first == ('classify 1 1 tilted-text\\n', '1 1 1.0 0.25 0 0 0 0 0 1\\n'), first\n"
        "corners = Path(sys.argv[2], 'surface.off').read_text().splitlines()[2:5]\n"
        "print('{}', '1 1', '1', '2 1', corners[0].split()[2], sep='\\n')\n"
    )
    assert asker(ABOVE[np.newaxis]) == Said(True, 0.5)
    program("print('{}', '1 1', '0', sep='\\n')\n")
    said = asker(ABOVE[np.newaxis])
    assert not said.contact
    assert isnan(said.reported)
    program("raise SystemExit(3)\n")
    assert asker(ABOVE[np.newaxis]) is None


def test_the_depth_of_a_triangle_through_the_middle_of_a_ball_is_the_radius():
    """The direction is drawn, for no nearest point gives one: that of the triangle's plane."""
    corners = ABOVE - [0, 0, 0.5]
    way = best_direction(corners, 0.5, 0.5)
    assert lower_bounds(corners, 0.5, 0.5, way[np.newaxis])[0] == pytest.approx(-0.5, abs=1e-9)


def test_the_nearest_point_of_a_triangle_without_area_is_on_its_longest_side():
    line = np.array([[-1.0, 1.0, 0.0], [3.0, 1.0, 0.0], [0.5, 1.0, 0.0]])
    shares = nearest_shares(line)
    assert shares @ line == pytest.approx([0, 1, 0])
    assert (shares.sum(), shares.min() >= 0) == (1, True)


def test_best_direction_proves_the_signed_distance_of_a_triangle_from_a_ball():
    rng = np.random.default_rng(5)
    for corners in rng.normal((0.0, 0.0, 2.0), size=(20, 3, 3)):
        way = best_direction(corners, 0.5, 0.5)
        point = nearest_shares(corners) @ corners
        found = lower_bounds(corners, 0.5, 0.5, way[np.newaxis])[0]
        assert found == pytest.approx(np.linalg.norm(point) - 0.5, abs=1e-9)
