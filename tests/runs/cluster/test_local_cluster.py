"""A local cluster serves one run only: no other user, no network, and no longer than the run."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import socket
import ssl
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from hypcheck.cli.main import main
from tests.tools.miniatures import needs_proc

pytest.importorskip("distributed")

from distributed.core import rpc
from distributed.security import Security

from hypcheck.runs.cluster import SCRATCH, _scratch_folder, cluster_client

pytestmark = needs_proc

LISTENING = "0A"
WORKERS = 2


def descendants(process: int) -> set[int]:
    """The numbers of a process and of all that it and its children started."""
    found, todo = set(), [process]
    while todo:
        found.add(each := todo.pop())
        for file in Path(f"/proc/{each}/task").glob("*/children"):
            with contextlib.suppress(OSError):
                todo += map(int, file.read_text().split())
    return found


def listening(processes: set[int]) -> set[tuple[str, int]]:
    """Addresses, as the system writes them in hexadecimal, and ports on which these processes accept connections."""
    sockets = set()
    for process in processes:
        for file in Path(f"/proc/{process}/fd").iterdir():
            with contextlib.suppress(OSError):
                sockets.add(os.readlink(file))
    found = set()
    for table in ("/proc/net/tcp", "/proc/net/tcp6"):
        for line in Path(table).read_text().splitlines()[1:] if Path(table).exists() else ():
            _, local, _, state, *rest = line.split()
            if state == LISTENING and f"socket:[{rest[5]}]" in sockets:
                address, port = local.split(":")
                found.add((address, int(port, 16)))
    return found


def answer_without_certificate(port: int) -> bytes:
    """What a TLS server answers to one that has no certificate; raises where it lets nobody in without."""
    context = ssl.create_default_context()
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    with socket.create_connection(("127.0.0.1", port), timeout=5) as plain, context.wrap_socket(plain) as encrypted:
        encrypted.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
        return encrypted.recv(1)


async def identity(address: str, security: Security) -> str:
    """What a node of dask says that it is."""
    async with rpc(address, timeout=5, connection_args=security.get_connection_args("client")) as there:
        return str((await asyncio.wait_for(there.identity(), 5))["type"])


PRELOADED = """import os

def dask_setup(worker):
    marks = os.environ["MARKS"]
    deaths = len(os.listdir(marks))
    if deaths >= int(os.environ["DEATHS"]):
        return
    async def die(**_):
        open(f"{marks}/{deaths}", "w").close()
        os._exit(9)
    if os.environ["DIES"] == "at its start":
        open(f"{marks}/{deaths}", "w").close()
        os._exit(9)
    worker.handlers["plugin-add"] = die
"""
"""What a worker of dask loads first: it ends its process at its start, or when it is given the implementation."""


def run_with_workers_that_die(tmp_path, dies: str, deaths: int) -> subprocess.CompletedProcess[str]:
    """`hypcheck verify` on a local cluster, the first `deaths` of whose workers end."""
    (tmp_path / "preload.py").write_text(PRELOADED)
    (tmp_path / "marks").mkdir()
    names = {"MARKS": tmp_path / "marks", "DIES": dies, "DEATHS": deaths}
    preload = {"DASK_DISTRIBUTED__WORKER__PRELOAD": tmp_path / "preload.py", **names}
    words = ["verify", "builtin:fast", "--families", "ring", "--count", "50", "--out", "out", "--cluster", "local:1"]
    return subprocess.run(
        [sys.executable, "-m", "hypcheck", *words],
        cwd=tmp_path,
        env={**os.environ, **{name: str(value) for name, value in preload.items()}},
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )


@pytest.mark.parametrize("dies", ["at its start", "when it is given the implementation"])
def test_a_run_holds_if_a_worker_ends_while_it_starts(tmp_path, dies):
    run = run_with_workers_that_die(tmp_path, dies, 1)
    assert run.returncode == 0, run.stderr
    assert "HELD" in run.stdout
    assert len(list((tmp_path / "marks").iterdir())) == 1


def test_a_run_whose_workers_always_end_while_they_start_ends_2_with_a_sentence(tmp_path):
    run = run_with_workers_that_die(tmp_path, "at its start", 1000)
    assert run.returncode == 2, run.stderr
    assert "--cluster local:1: workers died at start, 3 times" in run.stderr
    assert "internal error" not in run.stderr


@pytest.fixture(scope="module")
def sockets():
    """All on which a local cluster listens; the scheduler's address, and what our own client shows it."""
    before = listening(descendants(os.getpid()))
    with cluster_client(f"local:{WORKERS}") as client:
        yield listening(descendants(os.getpid())) - before, client.scheduler.address, client.security


def test_local_cluster_listens_only_on_loopback_and_on_no_more_ports_than_dask_needs(sockets):
    """A socket for the scheduler, and two for each worker: its own and that of the process that begins it again."""
    found, _, _ = sockets
    assert {address for address, _ in found} == {"0100007F"}
    assert len(found) == 1 + 2 * WORKERS
    assert 8787 not in {port for _, port in found}


def test_every_socket_of_a_local_cluster_refuses_clients_without_a_certificate(sockets):
    found, _, _ = sockets
    for _, port in found:
        with pytest.raises((ssl.SSLError, ConnectionError)):
            answer_without_certificate(port)


def test_scheduler_of_a_local_cluster_answers_only_with_the_certificate_of_the_run(sockets):
    _, address, ours = sockets
    assert asyncio.run(identity(address, ours)) == "Scheduler"
    for strange, security in (
        (address.replace("tls://", "tcp://"), Security()),
        (address, Security.temporary()),
    ):
        with pytest.raises((OSError, asyncio.TimeoutError)):
            asyncio.run(identity(strange, security))


def test_local_cluster_says_that_cryptography_is_missing(monkeypatch, tmp_path, capsys):
    monkeypatch.setitem(sys.modules, "cryptography", None)
    words = ["verify", "builtin:fast", "--families", "ring", "--count", "3", "--out", str(tmp_path)]
    assert main([*words, "--cluster", "local:2"]) == 2
    assert capsys.readouterr().err.splitlines()[-1] == (
        "hypcheck: error: --cluster local:N needs cryptography, for the certificate of its connections: "
        "pip install 'hypcheck[cluster]'"
    )
    assert not list(tmp_path.iterdir())


KILLED = """
import os, signal
from pathlib import Path
from hypcheck.runs.cluster import local_cluster
if __name__ == "__main__":
    with local_cluster(0):
        os.kill(os.getpid(), signal.SIGKILL)
"""


def test_scratch_folder_of_a_killed_local_cluster_is_removed_when_the_next_one_starts(monkeypatch, tmp_path):
    """That of one that runs is left, as are what a link leads to and what somebody else made."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    file = tmp_path / "killed.py"
    file.write_text(KILLED)
    ended = subprocess.run([sys.executable, file], env={**os.environ, "TMPDIR": str(tmp_path)}, check=False)
    assert ended.returncode == -signal.SIGKILL
    (left,) = tmp_path.glob("hypcheck-cluster-*")
    other = tmp_path / "other"
    other.mkdir()
    (other / "file").write_text("")
    link = tmp_path / f"{SCRATCH}link"
    link.symlink_to(other)
    with _scratch_folder() as running:
        assert not left.exists()
        assert running.stat().st_mode & 0o077 == 0
        with _scratch_folder():
            assert running.exists()
    assert sorted(tmp_path.iterdir()) == [link, file, other]
    assert (other / "file").exists()
