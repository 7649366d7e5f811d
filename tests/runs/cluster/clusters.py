"""A scheduler and workers of dask.distributed in processes of their own, on free ports."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

ALLOWED_FAILURES = 1
SETTINGS = {
    "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": str(ALLOWED_FAILURES),
    "DASK_DISTRIBUTED__WORKER__MULTIPROCESSING_METHOD": "forkserver",
}
"""Workers that begin again are forked from a process that has loaded dask, which takes longer than all that they do."""

HOME = Path(__file__).parents[3]


@pytest.fixture(autouse=True, scope="module")
def patience():
    """On a machine that is busy, workers may need longer to start than a user is left waiting."""
    from hypcheck.runs import cluster

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cluster, "CONNECT", 60)
        yield


class Cluster:
    """A scheduler, and workers once they are started; `environment` is theirs besides ours."""

    def __init__(self, folder: Path, environment: dict[str, str]) -> None:
        self._folder = folder
        self._file = folder / "scheduler.json"
        self._environment = {**os.environ, **SETTINGS, **environment}
        self.processes: list[subprocess.Popen[bytes]] = []
        self._start(HOME, {}, "dask_scheduler", "--host", "127.0.0.1", "--port", "0")
        until = time.monotonic() + 60
        while not self._file.exists() or not self._file.read_text():
            assert time.monotonic() < until
            time.sleep(0.05)
        self.address = json.loads(self._file.read_text())["address"]

    def start_workers(self, count: int, environment: dict[str, str] | None = None, home: Path = HOME) -> None:
        """Workers, with the hypcheck in the folder `home`; where there are several, one that ends is started again."""
        place = ["--local-directory", str(self._folder)]
        each = ["--nworkers", str(count), "--nthreads", "1", "--memory-limit", "0"]
        each += ["--no-nanny"] if count == 1 else []
        self._start(home, environment or {}, "dask_worker", *each, *place)

    def _start(self, home: Path, environment: dict[str, str], program: str, *options: str) -> None:
        words = [sys.executable, "-m", f"distributed.cli.{program}", "--scheduler-file", str(self._file)]
        self.processes.append(
            subprocess.Popen(
                [*words, "--no-dashboard", *options],
                env={**self._environment, **environment},
                cwd=home,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                start_new_session=True,
            )
        )

    def kill_workers(self, number: int) -> None:
        """Those that were started by the call of that number, counted from 1, with who would start them again."""
        os.killpg(self.processes[number].pid, signal.SIGKILL)

    def kill_scheduler(self) -> None:
        """As the system does when memory runs out."""
        os.killpg(self.processes[0].pid, signal.SIGKILL)

    def stop_scheduler(self) -> None:
        """As a machine does that has no memory left to work with."""
        os.killpg(self.processes[0].pid, signal.SIGSTOP)

    def end(self) -> None:
        """All of it, now."""
        for process in reversed(self.processes):
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
