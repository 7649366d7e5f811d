"""A run on a cluster gives the result of a run on this machine, even if workers end during the run."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

from hypcheck.errors import InputError
from hypcheck.implementations.session import Limits
from hypcheck.runs import cases
from hypcheck.runs.resume import saved_state
from hypcheck.runs.schedule import ImplementationOpener, RunState, perform_steps
from tests.runs.cluster.clusters import Cluster, patience  # noqa: F401
from tests.runs.crashing import ENVIRONMENT, KILLS, here, require_one_crash, rules_of, steps_of, without_culprit

pytest.importorskip("distributed")

from hypcheck.runs.cluster import cluster_client
from hypcheck.runs.dask_executor import execution_on_cluster


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """Two workers, whom the unlucky row kills."""
    started = Cluster(tmp_path_factory.mktemp("cluster"), ENVIRONMENT)
    started.start_workers(2)
    yield started
    started.end()


@pytest.fixture(scope="module")
def client(cluster):
    with cluster_client(cluster.address) as found:
        yield found


PACE = cases.Pace(chunk_rows=1024, retest_after=3000, single_rows=60)
"""Chunks and rounds small enough that a test has many."""


def there(client, opening, some, after=lambda number: None):
    """The last state; `after` is called behind each step."""
    with opening.open() as it, execution_on_cluster(client, opening, rules_of(it), it) as performing:
        it.close()
        passed = []
        for _, state in perform_steps(some, performing, RunState(it.allowance)):
            after(len(passed))
            passed.append(state)
        return passed[-1]


def pids(client):
    return client.run(os.getpid)


def test_tasks_of_killed_workers_are_reassigned_and_results_stay_the_same(client):
    some = steps_of(["tower-body", "ring"], 4500, PACE)

    def kill(number):
        if number in {1, 7}:
            os.kill(next(iter(pids(client).values())), signal.SIGKILL)

    assert saved_state(there(client, KILLS, some, kill)) == saved_state(here(KILLS, some))


def test_only_cases_that_kill_their_worker_end_as_crashes(client):
    some = steps_of(["uniform", "tower-body"], 2600, PACE)
    culprit, others = without_culprit(some)
    found = there(client, KILLS, some).total
    reason = "4 workers of the cluster ended while they asked these cases"
    require_one_crash(found, here(KILLS, others).total, culprit, reason)


def _subject(folder: Path) -> tuple[Path, ImplementationOpener]:
    file = folder / "subject.py"
    file.write_text("import numpy as np\n\n\ndef f(rows):\n    return np.zeros(len(rows), dtype=np.int8)\n")
    return file, ImplementationOpener(f"python:{file}:f", Limits())


def test_file_that_a_worker_lacks_is_sent_to_it(client, tmp_path):
    file, opening = _subject(tmp_path)
    some = steps_of(["ring"], 2000, PACE)
    expected = here(opening, some)
    with opening.open() as it, execution_on_cluster(client, opening, rules_of(it), it) as performing:
        file.rename(tmp_path / "elsewhere.py")
        *_, (_, state) = perform_steps(some, performing, RunState(it.allowance))
    assert saved_state(state) == saved_state(expected)


def test_worker_with_another_file_under_test_is_refused(client, tmp_path):
    file, opening = _subject(tmp_path)
    with opening.open() as it, execution_on_cluster(client, opening, rules_of(it), it) as performing:
        file.write_text(file.read_text() + "\n")
        with pytest.raises(
            InputError, match=r"subject.py is another file on worker tcp://127.0.0.1:\d+: sha256 \w{64} "
        ):
            list(perform_steps(steps_of(["ring"], 100, PACE), performing, RunState(it.allowance)))


def test_workers_keep_no_files_or_processes_after_a_run(client, cluster):
    """Neither an implementation nor a copy of its file: all of the tests above are over."""
    held = client.run(lambda dask_worker: sum(name.startswith("hypcheck-") for name in dask_worker.plugins))
    assert set(held.values()) == {0}
