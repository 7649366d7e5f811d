"""The connection to a dask scheduler: to one that is running, or to one started here with `--cluster local:N`.

dask sends Python's pickle, which a scheduler and its workers execute, so they belong in a trusted network.

Therefore the processes of `local:N` listen on the loopback interface alone and speak TLS. The certificate is made for
this run and never leaves the memory of its processes: no other user of the machine can connect. No process has an HTTP
server, and their files are in a folder that only this user can enter.
"""

from __future__ import annotations

import asyncio
import logging
import os
import shutil
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator, Mapping
from concurrent import futures
from contextlib import contextmanager, suppress
from multiprocessing import active_children
from pathlib import Path
from threading import Thread
from typing import Any, TypeVar

import dask
import distributed
from distributed import Client
from distributed.core import rpc
from distributed.security import Security
from distributed.versions import get_versions

from hypcheck.errors import InputError, UnavailableError
from hypcheck.processes import interrupts_held, require_semaphores
from hypcheck.runs.fingerprint import code_fingerprint
from hypcheck.runs.plan import LOCAL_CLUSTER
from hypcheck.version import VERSION

if sys.platform != "win32":
    import fcntl

Result = TypeVar("Result")

CONNECT = 10
"""Seconds until a scheduler must answer, and until it must have a worker."""

START_TRIES = 3
"""The number of attempts to start the workers. An attempt fails if one of them ends while it starts."""

CLOSE, CLOSE_LOCAL = 5, 1
"""Seconds that a client has to close, and the workers of a local cluster: they hold nothing that could be lost."""

SAME = ("hypcheck", "python", "dask", "distributed", "numpy")
"""Packages that must have the same version everywhere; of Python the first two numbers count."""

OTHER_FILES = f"has other files of hypcheck {VERSION} than this machine; install the same files there"

ALLOWED_FAILURES = 1
"""A local cluster gives a task up after one more death of a worker than this number; then the task is tried alone."""

LOOPBACK = "127.0.0.1"

SCRATCH = "hypcheck-cluster-"
"""The beginning of the names of the folders for the files of workers."""


def call_with_timeout(seconds: int, call: Callable[[], Result]) -> Result:
    """Perform a call, and return its value. Raises what the call raises, and TimeoutError after `seconds`.

    After a timeout the call keeps running.

    The time limit is needed because a call may never return if the scheduler's process exists but no longer works.
    Seconds in which this process was suspended do not count.
    """
    future: futures.Future[Result] = futures.Future()

    def perform() -> None:
        try:
            future.set_result(call())
        except BaseException as error:  # noqa: BLE001 - future.result() raises it
            future.set_exception(error)

    Thread(target=perform, name="hypcheck-call", daemon=True).start()
    for _ in range(seconds):
        futures.wait([future], timeout=1)
        if future.done():
            return future.result()
    raise TimeoutError(f"it took longer than {seconds} s")


@contextmanager
def cluster_client(address: str) -> Iterator[Client]:
    """Enter a block with a client of the scheduler at that address, which has a worker.

    Processes that were started for the client end with the block.

    Raises UnavailableError if no certificate can be made for `local:N`, and InputError if the scheduler cannot be
    reached, has no workers, or has other versions than this machine.
    """
    _silence_logs()
    local = LOCAL_CLUSTER.fullmatch(address)
    if local is None:
        with _client(address, Security()) as client:  # connects according to dask's settings
            yield client
    else:
        with local_cluster(int(local[1])) as (cluster, security), _client(cluster, security) as client:
            yield client


@contextmanager
def _client(address: str, security: Security) -> Iterator[Client]:
    """Connect to the scheduler at this address; check its workers, versions and files; close the client at the end."""
    _require_scheduler(address, security)
    try:
        with warnings.catch_warnings(), interrupts_held():
            warnings.simplefilter("ignore")  # warnings about versions, which are compared below
            client = Client(address, timeout=CONNECT, security=security, set_as_default=False, name="hypcheck")
    except Exception as error:  # noqa: BLE001 - a foreign server may cause any error
        raise _no_scheduler(address, error) from None
    try:
        _require_workers(client, address)
        try:
            _require_versions(call_with_timeout(CONNECT, lambda: client.get_versions(packages=["hypcheck"])), address)
            _require_same_files(
                call_with_timeout(CONNECT, lambda: client.run(code_fingerprint, on_error="return")), address
            )
        except TimeoutError:
            raise InputError(f"--cluster {address}: not all of its workers answered within {CONNECT} s") from None
        yield client
    finally:
        with suppress(Exception):
            client.close(timeout=CLOSE)


def _require_scheduler(address: str, security: Security) -> None:
    """Raise InputError if no dask scheduler of this version answers.

    A Client would raise other errors, and print tracebacks of some when it is freed.
    """

    async def identity() -> tuple[str, Any]:
        async with rpc(address, CONNECT, connection_args=security.get_connection_args("client")) as node:
            kind = str((await node.identity())["type"])
            return kind, await node.versions(packages=["hypcheck"]) if kind == "Scheduler" else None

    try:
        kind, versions = asyncio.run(asyncio.wait_for(identity(), CONNECT + 3))  # dask waits longer if nobody answers
    except Exception as error:  # noqa: BLE001 - a foreign server may cause any error, a MemoryError too
        raise _no_scheduler(address, error) from None
    if kind != "Scheduler":
        raise InputError(
            f"--cluster {address} is the address of a dask {kind.lower()}; it must be that of its scheduler"
        )
    _require_same_versions("the scheduler", versions, get_versions(packages=["hypcheck"]), address)


def _no_scheduler(address: str, error: BaseException) -> InputError:
    """Return the error that no dask scheduler answers at this address, with the reason that `error` gives."""
    chain = [error]  # dask wraps connection errors in others, and retries until its timeout
    while (before := chain[-1].__cause__ or chain[-1].__context__) is not None:
        chain.append(before)
    reasons = [error.strerror for error in chain if isinstance(error, OSError) and error.strerror]
    if reasons:
        reason = reasons[-1].lower()
    elif isinstance(error, (TimeoutError, asyncio.TimeoutError)):
        reason = f"there was no answer within {CONNECT} s"
    elif isinstance(error, MemoryError):
        reason = "the answer is not one of dask"
    else:
        reason = str(error) or type(error).__name__
    tls = "; dask's settings distributed.comm.tls name the certificates" if address.startswith("tls:") else ""
    return InputError(f"--cluster {address}: no dask scheduler answers there: {reason}{tls}")


def _require_workers(client: Client, address: str) -> None:
    """Wait for a worker. Raise InputError if the scheduler has none within CONNECT seconds."""
    try:
        client.wait_for_workers(1, timeout=CONNECT)
    except OSError:  # TimeoutError is an OSError
        raise InputError(
            f"--cluster {address}: the scheduler has no workers; `dask worker {address}` starts one"
        ) from None


def _require_versions(report: Mapping[str, Any], address: str) -> None:
    """Raise InputError naming the first difference between this machine and the scheduler or a worker."""
    nodes = {
        "the scheduler": report["scheduler"],
        **{f"worker {name}": versions for name, versions in report["workers"].items()},
    }
    for node, versions in nodes.items():
        _require_same_versions(node, versions, report["client"], address)


def _require_same_versions(node: str, there: Mapping[str, Any], here: Mapping[str, Any], address: str) -> None:
    """Raise InputError if a package of SAME has another version on the machine `node` than on this one."""
    ours, theirs = _versions(here), _versions(there)
    for package in SAME:
        if theirs[package] != ours[package]:
            had = f"has {package} {theirs[package]}" if theirs[package] else f"has no {package}"
            raise InputError(
                f"--cluster {address}: {node} {had}, this machine has {ours[package]}; both must have the same version"
            )


def _require_same_files(files: Mapping[str, Any], address: str) -> None:
    """Raise InputError if a worker's files of hypcheck differ, though its version is the same.

    `files` are the fingerprints by worker, with an OSError for a worker that was lost before it answered. A worker that
    replaces a lost one is checked when it performs its first task.
    """
    here = code_fingerprint()
    for worker, there in files.items():
        if there != here and not isinstance(there, OSError):
            raise InputError(f"--cluster {address}: worker {worker} {OTHER_FILES}")


def _versions(machine: Mapping[str, Any]) -> dict[str, str | None]:
    """Return the versions of the packages of SAME on a machine; None for a package that it lacks."""
    packages = machine["packages"]
    return {name: packages.get(name) for name in SAME} | {"python": ".".join(packages["python"].split(".")[:2])}


_LOUD = ("distributed", "tornado", "asyncio")


def _silence_logs() -> None:
    """Silence the logs of dask: this process reports problems of the cluster in its own messages."""
    for name in (*_LOUD, *logging.root.manager.loggerDict):
        if name.split(".")[0] in _LOUD:
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)


class _WithoutHttp:
    """A node of dask that starts no HTTP server; otherwise each node has one, even without a dashboard."""

    def start_http_server(self, *_: Any, **__: Any) -> None:  # noqa: ANN401 - dask's signature
        """Do nothing."""


class Scheduler(_WithoutHttp, distributed.Scheduler):  # type: ignore[misc]  # of a package that is not checked
    """dask's scheduler; it tells clients the name of its class."""


class Worker(_WithoutHttp, distributed.Worker):  # type: ignore[misc]  # as above
    """dask's worker."""


@contextmanager
def local_cluster(workers: int) -> Iterator[tuple[str, Security]]:
    """Start a scheduler with `workers` workers here; the block gets its address and the security settings for a client.

    All processes end with the block. Raises UnavailableError if no certificate can be made.
    """
    security = _temporary_security()
    require_semaphores()
    others = active_children()
    with _scratch_folder() as scratch:
        try:
            # The threads that start workers inherit the blocked interrupts for their whole life.
            with (
                dask.config.set({"temporary-directory": str(scratch)}),
                warnings.catch_warnings(),
                interrupts_held(),
            ):
                warnings.simplefilter("ignore")
                cluster = _started(workers, security)
            try:
                yield cluster.scheduler_address, security
            finally:
                with suppress(Exception):  # closing the workers may take longer
                    cluster.close(timeout=CLOSE_LOCAL)
        finally:
            for process in set(active_children()) - set(others):
                process.kill()
                process.join()


def _started(workers: int, security: Security) -> distributed.SpecCluster:
    """Start the scheduler and its workers, and return them as a cluster.

    If a worker's process ends at its start, all are started again, up to START_TRIES times in all.
    """
    for _ in range(START_TRIES):
        with suppress(RuntimeError, OSError):  # dask raises this if a process ended
            return _start_once(workers, security)
    raise UnavailableError(f"--cluster local:{workers}: workers died at start, {START_TRIES} times")


def _start_once(workers: int, security: Security) -> distributed.SpecCluster:
    """Try once to start the scheduler and its workers. Raises RuntimeError or OSError if a process ends meanwhile."""
    here = {"host": LOOPBACK, "protocol": "tls://", "security": security, "dashboard": False}
    scheduler = {**here, "port": 0, "allowed_failures": ALLOWED_FAILURES}
    worker = {**here, "worker_class": Worker, "nthreads": 1, "memory_limit": 0, "silence_logs": logging.CRITICAL}
    return distributed.SpecCluster(
        scheduler={"cls": Scheduler, "options": scheduler},
        workers={number: {"cls": distributed.Nanny, "options": worker} for number in range(workers)},
        security=security,
        silence_logs=logging.CRITICAL,
    )


def _temporary_security() -> Security:
    """Return TLS settings with a new certificate. Raises UnavailableError if the package that makes one is missing."""
    try:
        return Security.temporary()
    except ImportError:
        raise UnavailableError(
            "--cluster local:N needs cryptography, for the certificate of its connections: "
            "pip install 'hypcheck[cluster]'"
        ) from None


@contextmanager
def _scratch_folder() -> Iterator[Path]:
    """Make a folder for the files of workers; remove it after the block. Remove folders that killed runs left before.

    A run holds a lock on its folder. The system releases the lock however the run ends.
    """
    for left in Path(tempfile.gettempdir()).glob(f"{SCRATCH}*"):
        _remove_unless_in_use(left)
    folder, lock = _locked_folder()
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        if lock is not None:
            os.close(lock)


def _locked_folder() -> tuple[Path, int | None]:
    """Make a folder and lock it. Return it with the descriptor of the lock; None on Windows, which has no lock."""
    while True:
        folder = Path(tempfile.mkdtemp(prefix=SCRATCH))
        if sys.platform == "win32":
            return folder, None
        with suppress(OSError):  # another run removed it because it was not locked yet
            lock = os.open(folder, os.O_RDONLY)
            if _try_lock(lock) and folder.exists():
                return folder, lock
            os.close(lock)


def _remove_unless_in_use(folder: Path) -> None:
    """Remove the folder of an earlier run of this user, unless that run still holds the lock."""
    if sys.platform == "win32":
        return
    with suppress(OSError):  # another run removed it, or somebody put a link there
        lock = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
        try:
            if os.fstat(lock).st_uid == os.getuid() and _try_lock(lock):
                shutil.rmtree(folder, ignore_errors=True)
        finally:
            os.close(lock)


def _try_lock(lock: int) -> bool:
    """Lock an open folder; False if another process holds the lock."""
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True
