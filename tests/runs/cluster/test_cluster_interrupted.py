"""If the cluster is lost or the run interrupted, the finished part is kept and the run can be resumed."""

from __future__ import annotations

import signal

import pytest

from hypcheck.record import read
from hypcheck.record.progress import ProgressLine
from hypcheck.record.reader import FILE
from tests.runs.cluster.clusters import Cluster
from tests.runs.interruption import CODE, came_to, ended, started, wait_for
from tests.runs.resume.test_interrupted import all_gone, needs_proc, token  # noqa: F401

pytest.importorskip("distributed")
pytestmark = needs_proc


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """What a run comes to that never had to do with a cluster."""
    out = tmp_path_factory.mktemp("whole")
    assert ended(out)[0] == CODE
    return came_to(out)


def lost(tmp_path, out, strike):
    """What a run says that loses its cluster, whose scheduler is struck once progress is kept."""
    cluster = Cluster(tmp_path, {})
    try:
        cluster.start_workers(1)
        process = started(out, "--cluster", cluster.address)
        wait_for(process, out, b"progress")
        strike(cluster)
        said = "".join(process.communicate(timeout=60))
    finally:
        cluster.end()
    assert process.returncode == 2
    assert read(out / FILE).of(ProgressLine)
    return said


def test_record_of_a_run_whose_scheduler_died_can_be_resumed(tmp_path, whole):
    out = tmp_path / "out"
    said = lost(tmp_path, out, Cluster.kill_scheduler)
    assert "the cluster was lost: its scheduler is gone; the record holds the finished part" in said
    assert f"the same command with --resume {out} continues" in said
    assert "Traceback" not in said
    assert ended(out, "--resume", str(out))[0] == CODE
    assert came_to(out) == whole


def test_stopped_scheduler_ends_the_run_after_a_timeout(tmp_path):
    """Its system goes on to say that it is there."""
    said = lost(tmp_path, tmp_path / "out", Cluster.stop_scheduler)
    assert "the cluster was lost: its scheduler has not answered for 2 s; the record holds the finished part" in said


def test_interrupted_run_on_a_local_cluster_ends_its_workers_and_can_be_resumed(tmp_path, whole, token):  # noqa: F811
    process = started(tmp_path, "--cluster", "local:2", start_new_session=True)
    wait_for(process, tmp_path, b"progress")
    process.send_signal(signal.SIGINT)
    said = "".join(process.communicate())
    assert process.returncode == 130, said
    assert "Traceback" not in said
    assert all_gone(token) == []
    assert ended(tmp_path, "--cluster", "local:1", "--resume", str(tmp_path))[0] == CODE
    assert came_to(tmp_path) == whole
