"""Each adapter of an installed engine agrees with the truth far from contact, and shows an error that is planted."""

import sys
from pathlib import Path

import numpy as np
import pytest

from hypcheck.engines.engine import ENGINES, cache_folder, command, is_installed
from hypcheck.engines.measure import own_errors, reported_distances, spec_of
from hypcheck.engines.placing import FAMILIES, placed
from hypcheck.engines.scene import SurfaceMesh, distances, surface_mesh, write_scene
from hypcheck.implementations.implementation import open_implementation

BESIDE = Path(sys.prefix, "engines")  # where `make` installs what continuous integration tests
CACHE = BESIDE if BESIDE.is_dir() else cache_folder()
PLANTED = 0.05


@pytest.fixture(scope="module", params=ENGINES)
def engine(request):
    found = ENGINES[request.param]
    if not is_installed(found, CACHE):
        pytest.skip(f"{found.name} is not installed; hypcheck engines install {found.name}")
    return found


def asked(engine, folder, name, moved=0.0):
    """Placed rows of a family, the answers about a mesh that is moved, the distances from the right one, the words."""
    family, found = FAMILIES[name], placed(FAMILIES[name], 2)
    mesh = surface_mesh(family.sizes, 5000)
    lifted = SurfaceMesh(mesh.vertices * [1 + moved, 1 + moved, 1], mesh.triangles, mesh.deviation)
    write_scene(folder, family.sizes, lifted)
    words = command(engine, CACHE, folder, tightest=True)  # a margin by default is no error
    with open_implementation(spec_of(words)) as implementation:
        answered = implementation.classify(found.rows)
        timed = implementation.time(found.rows[:4], 2)
    assert answered.answered.all()
    assert timed > 0
    return found, answered.answers == 1, distances(found.rows, mesh), words


def test_an_engine_is_right_far_from_contact_and_a_planted_error_in_it_is_found(engine, tmp_path):
    found, said, _, _ = asked(engine, tmp_path / "right", "body")
    far = np.abs(found.gap) > (0.01 if engine.body == "hull" else 0.003)
    assert 6 <= far.sum() < len(far)
    assert (said == found.contact)[far].all()

    found, said, apart, _ = asked(engine, tmp_path / "planted", "body", moved=PLANTED / 2.0)
    own = own_errors(said, apart, hull=engine.body == "hull")
    assert (own.radii[own.wrong].max() * 0.15) > PLANTED / 10
    assert (own.wrong & ~found.contact).any()


def test_distances_that_an_engine_reports_for_a_clear_ball_are_right(engine, tmp_path):
    found, _, apart, words = asked(engine, tmp_path, "ball")
    reported = reported_distances(words, found.rows)
    assert np.isfinite(reported).sum() >= len(reported) / 4
    there = np.isfinite(reported) & (apart > 1)
    assert reported[there] == pytest.approx((apart[there] - 1) * 0.25, abs=1e-5)
