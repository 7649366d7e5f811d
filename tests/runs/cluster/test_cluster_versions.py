"""A cluster with other versions, or with other files of hypcheck, is refused in one sentence."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

import hypcheck
from hypcheck.errors import InputError
from hypcheck.implementations.session import Limits
from hypcheck.runs.cases import Pace
from hypcheck.runs.schedule import ImplementationOpener, RunState, perform_steps
from hypcheck.version import VERSION
from tests.runs.cluster.clusters import HOME, Cluster, patience  # noqa: F401
from tests.runs.crashing import rules_of, steps_of

pytest.importorskip("distributed")

from hypcheck.runs.cluster import cluster_client
from hypcheck.runs.dask_executor import execution_on_cluster

OTHER_DASK = """
from importlib import metadata

ours = metadata.version
metadata.version = lambda name: "2020.1.0" if name == "distributed" else ours(name)
"""
OTHER_FILES = f"has other files of hypcheck {VERSION} than this machine; install the same files there"


@pytest.fixture(scope="module")
def scheduler(tmp_path_factory):
    """A scheduler with the versions of this machine."""
    found = Cluster(tmp_path_factory.mktemp("cluster"), {})
    yield found
    found.end()


@pytest.fixture
def cluster(scheduler):
    """The scheduler, without workers; those of a test end with it."""
    before = len(scheduler.processes)
    yield scheduler
    for number in range(before, len(scheduler.processes)):
        scheduler.kill_workers(number)  # their connections break long before another worker has started


@pytest.fixture(scope="module")
def another(tmp_path_factory):
    """A folder with a hypcheck that differs from ours by a comment."""
    home = tmp_path_factory.mktemp("another")
    shutil.copytree(Path(hypcheck.__file__).parent, home / "hypcheck", ignore=shutil.ignore_patterns("__pycache__"))
    (home / "cases").symlink_to(HOME / "cases")
    with (home / "hypcheck" / "runs" / "judge.py").open("a") as file:
        file.write("# one line more\n")
    return home


def refusal(address):
    with pytest.raises(InputError) as said, cluster_client(address):
        pass
    return str(said.value)


def test_scheduler_with_another_version_of_dask_is_refused_before_a_client_is_made(tmp_path, monkeypatch):
    """dask's own client may wait long for a scheduler of another version, and print errors."""
    monkeypatch.setattr("hypcheck.runs.cluster.Client", None)
    (tmp_path / "sitecustomize.py").write_text(OTHER_DASK)
    other = Cluster(tmp_path, {"PYTHONPATH": str(tmp_path)})
    try:
        said = refusal(other.address)
    finally:
        other.end()
    assert "the scheduler has distributed 2020.1.0, this machine has " in said


def test_worker_with_another_version_of_dask_is_refused(cluster, tmp_path):
    (tmp_path / "sitecustomize.py").write_text(OTHER_DASK)
    cluster.start_workers(1, {"PYTHONPATH": str(tmp_path)})
    said = refusal(cluster.address)
    assert "worker tcp://127.0.0.1:" in said
    assert " has distributed 2020.1.0, this machine has " in said


def test_worker_with_other_files_of_the_same_version_is_refused_before_the_run_and_ends_it_if_it_joins_later(
    cluster, another
):
    opening = ImplementationOpener("builtin:fast", Limits())
    ours = len(cluster.processes)
    cluster.start_workers(1)
    with (
        cluster_client(cluster.address) as client,
        opening.open() as it,
        execution_on_cluster(client, opening, rules_of(it), it) as performing,
    ):
        passed = perform_steps(steps_of(["ring"], 100, Pace()), performing, RunState(it.allowance))
        next(passed)
        cluster.start_workers(1, home=another)
        client.wait_for_workers(2, timeout=60)
        cluster.kill_workers(ours)
        with pytest.raises(InputError, match=rf"worker tcp://\S+ {OTHER_FILES}"):
            list(passed)
    assert refusal(cluster.address).endswith(OTHER_FILES)
