"""`--cluster` refuses addresses without a scheduler, and clusters that differ from this machine, in one sentence."""

from __future__ import annotations

import contextlib
import copy
import os
import shutil
import signal
import socket
import sys
import threading

import pytest

from hypcheck.cli.main import main
from hypcheck.errors import InputError
from hypcheck.implementations.session import Limits
from hypcheck.runs.cases import Pace
from hypcheck.runs.fingerprint import code_fingerprint
from hypcheck.runs.plan import check_cluster_address
from hypcheck.runs.schedule import ImplementationOpener, RunState, perform_steps
from tests.runs.cluster.clusters import Cluster, patience  # noqa: F401
from tests.runs.crashing import rules_of, steps_of

pytest.importorskip("distributed")

from distributed.comm.core import CommClosedError

from hypcheck.runs import cluster as connection
from hypcheck.runs.cluster import call_with_timeout, cluster_client
from hypcheck.runs.dask_executor import execution_on_cluster


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """A scheduler and one worker."""
    found = Cluster(tmp_path_factory.mktemp("cluster"), {})
    found.start_workers(1)
    yield found
    found.end()


@contextlib.contextmanager
def server(says):
    """The address of a server that sends these bytes to each client and nothing else."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        held = []

        def serve():
            with contextlib.suppress(OSError):
                while True:
                    held.append(listening.accept()[0])
                    held[-1].sendall(says)

        threading.Thread(target=serve, daemon=True).start()
        yield f"tcp://127.0.0.1:{listening.getsockname()[1]}"
        listening.shutdown(socket.SHUT_RDWR)
        for each in held:
            each.close()


def refusal(address, monkeypatch):
    """The error for an address that must answer within a second."""
    monkeypatch.setattr(connection, "CONNECT", 1)
    with pytest.raises(InputError) as said, cluster_client(address):
        pass
    return str(said.value)


@pytest.mark.parametrize(
    "address",
    ["nonsense", "host", "host:", "host:65536", "local:0", "local:x", "http://host:8786", "tcp://host/a:1", ""],
)
def test_option_cluster_refuses_text_that_is_no_scheduler_address(address):
    with pytest.raises(InputError, match=r"it must be that of a dask\.distributed scheduler, such as"):
        check_cluster_address(address)


@pytest.mark.parametrize("address", ["host:8786", "tcp://10.0.0.1:8786", "tls://[::1]:65535", "local:1", "local:9999"])
def test_option_cluster_accepts_scheduler_addresses(address):
    check_cluster_address(address)


def test_call_with_timeout_returns_raises_or_times_out():
    assert call_with_timeout(9, lambda: 3) == 3
    with pytest.raises(ZeroDivisionError):
        call_with_timeout(9, lambda: 1 // 0)
    with pytest.raises(TimeoutError, match="it took longer than 1 s"):
        call_with_timeout(1, threading.Event().wait)


def test_closed_port_is_refused_with_the_reason_of_the_system(monkeypatch):
    with socket.create_server(("127.0.0.1", 0)) as listening:
        port = listening.getsockname()[1]
    said = refusal(f"tcp://127.0.0.1:{port}", monkeypatch)
    assert said == f"--cluster tcp://127.0.0.1:{port}: no dask scheduler answers there: connection refused"


@pytest.mark.parametrize(
    ("says", "reason"),
    [
        (b"", "there was no answer within 1 s"),
        (b"HTTP/1.1 400 Bad Request\r\n\r\n" * 9, "the answer is not one of dask"),
    ],
)
def test_server_that_is_not_dask_is_refused_with_a_reason(monkeypatch, says, reason):
    with server(says) as address:
        assert reason in refusal(address, monkeypatch)


def test_refused_tls_address_names_the_settings_for_certificates(monkeypatch):
    settings = "dask's settings distributed.comm.tls name the certificates"
    assert settings in refusal("tls://127.0.0.1:9", monkeypatch)


def test_address_of_a_worker_is_refused(cluster, monkeypatch):
    with cluster_client(cluster.address) as client:
        (worker,) = client.scheduler_info()["workers"]
    assert "is the address of a dask worker; it must be that of its scheduler" in refusal(worker, monkeypatch)


def test_worker_that_cannot_write_into_its_folder_ends_the_run_with_an_error(cluster):
    opening = ImplementationOpener("builtin:fast", Limits())
    with (
        cluster_client(cluster.address) as client,
        opening.open() as it,
        execution_on_cluster(client, opening, rules_of(it), it) as performing,
    ):
        client.run(lambda dask_worker: shutil.rmtree(dask_worker.local_directory))
        with pytest.raises(InputError, match=r"worker tcp://\S+ cannot write into its folder \S+: no such file"):
            list(perform_steps(steps_of(["ring"], 100, Pace()), performing, RunState(it.allowance)))


def test_scheduler_without_workers_and_one_whose_worker_is_stopped_are_refused(tmp_path, monkeypatch):
    """The stopped worker does not answer, though its connection is open."""
    found = Cluster(tmp_path, {})
    try:
        assert "the scheduler has no workers; `dask worker tcp://" in refusal(found.address, monkeypatch)
        monkeypatch.undo()
        found.start_workers(1)
        with cluster_client(found.address) as client:
            (worker,) = client.run(os.getpid).values()
        os.kill(worker, signal.SIGSTOP)
        assert "not all of its workers answered within 1 s" in refusal(found.address, monkeypatch)
    finally:
        found.end()


@pytest.mark.parametrize(
    ("package", "version", "said"), [("hypcheck", "0.0.1", "has hypcheck 0.0.1"), ("dask", None, "has no dask")]
)
def test_node_with_another_version_is_refused(cluster, package, version, said):
    with cluster_client(cluster.address) as client:
        found = client.get_versions(packages=["hypcheck"])
    connection._require_versions(found, cluster.address)
    for node in ("scheduler", "worker"):
        other = copy.deepcopy(found)
        machine = other[node] if node == "scheduler" else next(iter(other["workers"].values()))
        machine["packages"][package] = version
        with pytest.raises(
            InputError, match=rf"{node} (tcp\S+ )?{said}, this machine has .*; both must have the same version"
        ):
            connection._require_versions(other, cluster.address)


def test_cluster_without_dask_installed_is_refused_with_the_command_that_installs_it(monkeypatch, tmp_path, capsys):
    monkeypatch.setitem(sys.modules, "distributed", None)
    monkeypatch.delitem(sys.modules, "hypcheck.runs.cluster")
    words = ["verify", "builtin:fast", "--families", "ring", "--count", "3", "--out", str(tmp_path)]
    assert main([*words, "--cluster", "local:2"]) == 2
    assert capsys.readouterr().err.splitlines()[-1] == (
        "hypcheck: error: --cluster needs dask.distributed (distributed is not installed): "
        "pip install 'hypcheck[cluster]'"
    )
    assert not list(tmp_path.iterdir())


def test_worker_that_is_lost_before_it_sends_its_fingerprint_is_not_refused():
    """The worker that replaces it is checked later."""
    ours = code_fingerprint()
    connection._require_same_files({"tcp://a:1": ours, "tcp://b:2": CommClosedError("in rpc")}, "tcp://c:3")
    for there in ("another", ImportError("no module named hypcheck.runs.fingerprint")):
        with pytest.raises(InputError, match="worker tcp://b:2 has other files of hypcheck"):
            connection._require_same_files({"tcp://a:1": ours, "tcp://b:2": there}, "tcp://c:3")
