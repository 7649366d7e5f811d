"""If the cluster is lost or the run interrupted, the finished part is kept and the run can be resumed."""

from __future__ import annotations

import re
import signal

import pytest

from hypcheck.cli.main import main
from hypcheck.processes import require_semaphores
from hypcheck.record import read
from hypcheck.record.progress import ProgressLine
from hypcheck.record.reader import FILE
from tests.runs.cluster.clusters import Cluster
from tests.runs.interruption import CODE, came_to, in_small_steps, started, unbroken_run, wait_for, words
from tests.runs.resume.test_interrupted import all_gone, needs_proc, token  # noqa: F401

pytest.importorskip("distributed")
pytestmark = needs_proc


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """What a run comes to that never had to do with a cluster."""
    return unbroken_run(tmp_path_factory)[0]


@pytest.fixture(autouse=True, scope="module")
def resource_tracker():
    """Python's own process, which outlives each test, begins before the processes of a test are marked."""
    require_semaphores()


@pytest.fixture
def resumed(monkeypatch, text_reports):
    """Resumes a run in this process, and returns what it comes to."""
    in_small_steps(monkeypatch.setattr)

    def run(out, *more):
        assert main(words(out, "--resume", str(out), *more)) == CODE
        return came_to(out)

    return run


def lost(tmp_path, out, strike):
    """What a run says that loses its cluster, whose scheduler is struck once progress is kept."""
    cluster = Cluster(tmp_path, {})
    try:
        cluster.start_workers(1)
        process = started(out, "--cluster", cluster.address)
        try:
            wait_for(process, out, b"progress")
            strike(cluster)
            said = "".join(process.communicate(timeout=60))
        finally:
            process.kill()
            process.wait()
    finally:
        cluster.end()
    assert process.returncode == 2
    assert read(out / FILE).of(ProgressLine)
    return said


def test_record_of_a_run_whose_scheduler_died_can_be_resumed(tmp_path, whole, resumed):
    """The connection to a dead scheduler breaks at once, or is tried again until the run has waited too long."""
    out = tmp_path / "out"
    said = lost(tmp_path, out, Cluster.kill_scheduler)
    ways = "is gone|has not answered for 2 s"
    assert re.search(f"the cluster was lost: its scheduler ({ways}); the record holds the finished part", said)
    assert f"the same command with --resume {out} continues" in said
    assert "Traceback" not in said
    assert resumed(out) == whole


def test_stopped_scheduler_ends_the_run_after_a_timeout(tmp_path):
    """Its system goes on to say that it is there."""
    said = lost(tmp_path, tmp_path / "out", Cluster.stop_scheduler)
    assert "the cluster was lost: its scheduler has not answered for 2 s; the record holds the finished part" in said


def test_interrupted_run_on_a_local_cluster_ends_its_workers_and_can_be_resumed(
    tmp_path,
    whole,
    resumed,
    token,  # noqa: F811
):
    process = started(tmp_path, "--cluster", "local:2", start_new_session=True)
    wait_for(process, tmp_path, b"progress")
    process.send_signal(signal.SIGINT)
    said = "".join(process.communicate())
    assert process.returncode == 130, said
    assert "Traceback" not in said
    assert all_gone(token) == []
    assert resumed(tmp_path, "--cluster", "local:1") == whole
