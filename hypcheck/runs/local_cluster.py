"""`--cluster local:N`: a scheduler and N workers of dask.distributed on this machine, for one run and nobody else.

Whoever reaches a dask scheduler or worker can let it execute anything. So all of them listen on the loopback interface
alone and speak TLS with a certificate that is made for this run and never leaves the memory of its processes: to
connect takes the key, which no other user of the machine has. None has an HTTP server. Their files are in a folder that
only this user can enter.
"""

from __future__ import annotations

import logging
import os
import shutil
import sys
import tempfile
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from multiprocessing import active_children
from pathlib import Path
from typing import Any

import dask
import distributed
from distributed.security import Security

from hypcheck.errors import UnavailableError
from hypcheck.processes import interrupts_held, require_semaphores

CLOSE = 1
"""Seconds that the workers have to close: they hold nothing that could be lost."""

ALLOWED_FAILURES = 1
"""A task may cost this many workers and one more, and then is tried alone."""

LOOPBACK = "127.0.0.1"

SCRATCH = "hypcheck-cluster-"
"""What the names of the folders for the files of workers begin with."""


class _WithoutHttp:
    """A node of dask that starts no HTTP server; every one does otherwise, with the page of a dashboard or without."""

    def start_http_server(self, *_: Any, **__: Any) -> None:  # noqa: ANN401 - dask's signature
        """Do nothing."""


class Scheduler(_WithoutHttp, distributed.Scheduler):  # type: ignore[misc]  # of a package that is not checked
    """dask's scheduler; its class's name is what it calls itself to a client."""


class Worker(_WithoutHttp, distributed.Worker):  # type: ignore[misc]  # as above
    """dask's worker."""


@contextmanager
def local_cluster(workers: int) -> Iterator[tuple[str, Security]]:
    """The address of a scheduler that runs here with so many workers, and what a client needs to connect.

    All of them end with the block, willing or not. Raises UnavailableError where no certificate can be made.
    """
    security = _temporary_security()
    require_semaphores()
    others = active_children()
    with _scratch_folder() as scratch:
        try:
            # The threads that start workers, again and again, hold interrupts as long as they live.
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
                with suppress(Exception):  # of workers that take their time
                    cluster.close(timeout=CLOSE)
        finally:
            for process in set(active_children()) - set(others):
                process.kill()
                process.join()


def _started(workers: int, security: Security) -> distributed.SpecCluster:
    here = {"host": LOOPBACK, "protocol": "tls://", "security": security}
    scheduler = {**here, "port": 0, "dashboard": False, "allowed_failures": ALLOWED_FAILURES}
    worker = {
        **here,
        "worker_class": Worker,
        "nthreads": 1,
        "memory_limit": 0,
        "dashboard": False,
        "silence_logs": logging.CRITICAL,
    }
    return distributed.SpecCluster(
        scheduler={"cls": Scheduler, "options": scheduler},
        workers={number: {"cls": distributed.Nanny, "options": worker} for number in range(workers)},
        security=security,
        silence_logs=logging.CRITICAL,
    )


def _temporary_security() -> Security:
    try:
        return Security.temporary()
    except ImportError:
        raise UnavailableError(
            "--cluster local:N needs cryptography, for the certificate of its connections: "
            "pip install 'hypcheck[cluster]'"
        ) from None


@contextmanager
def _scratch_folder() -> Iterator[Path]:
    """A folder for the files of workers, which is removed with the block; those of killed runs are removed before it.

    A run holds the lock of its folder, which the system gives back however the run ends.
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
    while True:
        folder = Path(tempfile.mkdtemp(prefix=SCRATCH))
        if sys.platform == "win32":
            return folder, None
        with suppress(OSError):  # another run that began took it for one that was left, and removes it
            lock = os.open(folder, os.O_RDONLY)
            if _try_lock(lock) and folder.exists():
                return folder, lock
            os.close(lock)


def _remove_unless_in_use(folder: Path) -> None:
    if sys.platform == "win32":
        return
    with suppress(OSError):  # removed meanwhile, or a link that somebody planted
        lock = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
        try:
            if os.fstat(lock).st_uid == os.getuid() and _try_lock(lock):
                shutil.rmtree(folder, ignore_errors=True)
        finally:
            os.close(lock)


def _try_lock(lock: int) -> bool:
    """Whether the lock of an open folder could be had."""
    import fcntl  # noqa: PLC0415 - there is none on Windows

    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True
