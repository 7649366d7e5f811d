"""The executor of a cluster: tasks go to a dask scheduler, and a plugin holds the implementation on each worker.

If a worker dies, dask reassigns its tasks. dask blames every task that the worker had, and gives up a task that it has
blamed too often; such a task raises WorkerLost here.

The files that a SPEC names by their paths are sent to workers that lack them. A program on the PATH is not sent: each
worker uses its own. A Python module is not sent either, but must have the same content everywhere.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import hashlib
import json
import os
import shutil
import tempfile
import threading
import time
import uuid
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, InvalidStateError
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

from distributed import KilledWorker, Worker, WorkerPlugin, get_worker

from hypcheck.errors import InputError, system_reason
from hypcheck.implementations.implementation import Implementation
from hypcheck.implementations.session import Allowance
from hypcheck.implementations.spec import is_file, parse_spec
from hypcheck.runs.cluster import CLOSE, CONNECT, OTHER_FILES, START_TRIES, call_with_timeout
from hypcheck.runs.executors import keep_freed_memory
from hypcheck.runs.fingerprint import code_fingerprint, files_of, sha256
from hypcheck.runs.results import JudgingRules
from hypcheck.runs.schedule import ImplementationOpener, Step, TaskExecution, TaskResult, WorkerLost, perform_task

if TYPE_CHECKING:
    from distributed import Client
    from distributed import Future as DaskFuture

TICK = 1.0
MAX_CHECKS_WITHOUT_WORKER = 60
"""Seconds without a result between two checks of the cluster, and how many checks in a row may find no worker."""

SILENCES = 6
"""The number of checks in a row that may get no answer from the scheduler within CONNECT seconds."""

IDLE = 60.0
"""Seconds after which an idle implementation is closed; the next task opens it again."""

_CANCELLED = (asyncio.CancelledError, concurrent.futures.CancelledError)

Result = TypeVar("Result")
Arguments = ParamSpec("Arguments")


@contextmanager
def execution_on_cluster(
    client: Client, opener: ImplementationOpener, rules: JudgingRules, implementation: Implementation
) -> Iterator[TaskExecution]:
    """Enter a block in which the workers of a cluster perform tasks.

    A task raises the error of a worker that cannot start. Raises InputError if the cluster is lost; so do tasks.
    """
    name = f"hypcheck-{uuid.uuid4().hex}"
    files, module = files_to_ship(opener.spec), module_sha256(opener.spec)
    opener = replace(opener, declared=implementation.declared)
    plugin = ImplementationPlugin(name, opener, rules, files, module, code_fingerprint())
    workers = max(1, sum(client.nthreads().values()))
    with DaskExecutor(client) as executor:
        _register(client, plugin, executor)
        function = partial(_perform_opened, name)
        try:
            yield TaskExecution(executor, function, workers, implementation.allowance, implementation.max_rows, rules)
        finally:
            executor.shutdown()
            if client.status == "running":
                with suppress(Exception):  # if the cluster is lost, workers close idle implementations themselves
                    call_with_timeout(CLOSE, lambda: client.unregister_worker_plugin(name))


def _register(client: Client, plugin: ImplementationPlugin, executor: DaskExecutor) -> None:
    """Give the plugin to all workers; try again if one ended meanwhile: its replacement has it from the start."""
    for _ in range(START_TRIES):
        with suppress(ConnectionError):  # to a worker; see _registered
            return _registered(client, plugin, executor)
    raise executor.lost(f"workers died at start, {START_TRIES} times")


def _registered(client: Client, plugin: ImplementationPlugin, executor: DaskExecutor) -> None:
    """Give the plugin to all workers. Raises ConnectionError if a worker is gone, InputError if there is no answer."""
    try:
        call_with_timeout(CONNECT, lambda: client.register_plugin(plugin))
    except TimeoutError:
        raise executor.lost(f"it did not answer within {CONNECT} s") from None
    except OSError as error:  # dask's error for a closed connection
        raise ConnectionError(str(error)) from None


class DaskExecutor(Executor):
    """A dask client as an executor of the standard library.

    A future raises WorkerLost if dask gave its call up, and InputError if the cluster is lost: the scheduler is gone or
    does not answer, or has had no worker for too long.
    """

    def __init__(self, client: Client) -> None:
        self._client = client
        self._address = client.scheduler.address if client.scheduler else "?"
        self._running: dict[Future[Any], DaskFuture] = {}
        self._news = threading.Event()
        self._over = threading.Event()
        threading.Thread(target=self._watch, name="hypcheck-cluster", daemon=True).start()

    def submit(
        self, function: Callable[Arguments, Result], /, *args: Arguments.args, **kwargs: Arguments.kwargs
    ) -> Future[Result]:
        """Send a call to the scheduler."""
        future: Future[Result] = Future()
        try:
            there = self._client.submit(function, *args, **kwargs, key=f"hypcheck-{uuid.uuid4().hex}", pure=False)
        except Exception:  # noqa: BLE001 - dask raises whatever its broken connection leads to
            future.set_exception(self.lost("its scheduler is gone"))
            return future
        self._running[future] = there
        future.add_done_callback(self._forget)
        there.add_done_callback(partial(self._settle, future))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:  # noqa: ARG002
        """Cancel the calls that are left, without waiting for them."""
        self._over.set()
        for future in list(self._running):
            future.cancel()
        self._running.clear()

    def lost(self, why: str) -> InputError:
        """Return the error that the cluster is lost."""
        remark = "the record holds the finished part"
        return InputError(f"--cluster {self._address}: the cluster was lost: {why}; {remark}")

    def _forget(self, future: Future[Any]) -> None:
        """Tell the scheduler that the result of this future is not needed any more."""
        there = self._running.pop(future, None)
        if there is not None:
            there.release()  # unlike cancel(), this does not wait for the scheduler

    def _settle(self, future: Future[Any], there: DaskFuture) -> None:
        """Set the result or the error of a future."""
        if future.done():
            return
        try:
            result = there.result(timeout=TICK)
        except KilledWorker as killed:
            self._fail(future, WorkerLost("workers of the cluster", deaths=killed.allowed_failures + 1))
        except (*_CANCELLED, asyncio.TimeoutError, OSError) as error:
            if there.status == "error":  # the call itself raised the error
                self._fail(future, error)
            elif not isinstance(error, asyncio.TimeoutError):
                self._fail(future, self.lost("its scheduler is gone"))
            else:  # it was computed, but its worker is gone: dask computes it again
                there.add_done_callback(partial(self._settle, future))
        except Exception as error:  # noqa: BLE001 - future.result() raises it
            self._fail(future, error)
        else:
            self._news.set()
            with suppress(InvalidStateError):  # if it was cancelled meanwhile
                future.set_result(result)

    def _fail(self, future: Future[Any], error: BaseException) -> None:
        """Let a future raise this error, unless it was cancelled."""
        with suppress(InvalidStateError):  # if it was cancelled meanwhile
            future.set_exception(error)

    def _watch(self) -> None:
        """Let all calls fail if the cluster is lost; this is checked while no results arrive."""
        without_worker = silent = 0
        while not self._over.wait(TICK):
            if self._news.is_set() or not self._running:
                self._news.clear()
                without_worker = silent = 0
                continue
            trouble = ""
            try:
                workers = call_with_timeout(CONNECT, self._client.nthreads)
                silent, without_worker = 0, 0 if workers else without_worker + 1
            except TimeoutError:
                silent += 1
            except Exception:  # noqa: BLE001 - dask raises whatever its broken connection leads to
                trouble = "its scheduler is gone"
            if silent == SILENCES:
                trouble = f"its scheduler has not answered for {SILENCES * CONNECT} s"
            if without_worker > MAX_CHECKS_WITHOUT_WORKER:
                trouble = f"it has had no worker for {MAX_CHECKS_WITHOUT_WORKER} s"
            if trouble:
                for future in list(self._running):
                    self._fail(future, self.lost(trouble))


@dataclass(frozen=True, slots=True)
class ShippedFile:
    """A file that word `word` of a SPEC names: its absolute path where the run began, its content, its permissions."""

    word: int
    path: str
    content: bytes
    mode: int

    @property
    def sha256(self) -> str:
        """The sha256 of the content, in hexadecimal."""
        return hashlib.sha256(self.content).hexdigest()


def files_to_ship(text: str) -> tuple[ShippedFile, ...]:
    """Return the files that a SPEC names by their paths. Raises InputError if one cannot be read."""
    files = []
    for named in files_of(text):
        if named.searched:
            continue
        path = named.path.absolute()
        try:
            files.append(ShippedFile(named.word, str(path), path.read_bytes(), path.stat().st_mode & 0o777))
        except OSError as error:
            raise InputError(f"{path} cannot be sent to a cluster: {system_reason(error)}") from None
    return tuple(files)


def spec_on_worker(text: str, files: tuple[ShippedFile, ...], worker: str, folder: Path) -> str:
    """Return the SPEC as a worker can open it: files that the worker lacks are written into the folder.

    Raises InputError if a file on the worker has different content.
    """
    spec = parse_spec(text)
    words = list(spec.words)
    for file in files:
        words[file.word] = _path_on_worker(file, worker, folder)
    if spec.kind == "command":
        return f"command:{json.dumps(words)}"
    return f"{spec.kind}:{':'.join(words)}" if files else text


def _path_on_worker(file: ShippedFile, worker: str, folder: Path) -> str:
    """Return the path of a file on this worker: its own file, or a copy in `folder` if it has none.

    Raises InputError if the worker has a file with other content there.
    """
    path = Path(file.path)
    if not path.is_file():
        place = folder / str(file.word) / os.path.basename(file.path)
        place.parent.mkdir()
        place.write_bytes(file.content)
        place.chmod(file.mode)
        return str(place)
    require_same_sha256(file.path, file.sha256, sha256(path), worker)
    return file.path


def require_same_sha256(what: str, here: str, there: str, worker: str) -> None:
    """Raise InputError naming the worker if the two hashes differ."""
    if here != there:
        raise InputError(f"{what} is another file on worker {worker}: sha256 {there} there, and {here} here")


def module_sha256(text: str) -> str:
    """Return the sha256 of the file of a SPEC's Python module on this machine; "" if the SPEC names no module."""
    spec = parse_spec(text)
    if spec.kind != "python" or is_file(spec.words[0]):
        return ""
    return next((sha256(file.path) for file in files_of(text)), "(not found)")


@dataclass(eq=False)
class ImplementationPlugin(WorkerPlugin):  # type: ignore[misc]  # of a package that is not checked
    """The plugin that dask gives to all workers, present and later ones: it holds the implementations of one run.

    Each worker has as many implementations as it performs tasks at the same time. `name` is the name of the run.
    `files` are the files that the SPEC names, `module` is the sha256 of its Python module, `fingerprint` that of
    hypcheck's own files.
    """

    name: str
    opener: ImplementationOpener
    rules: JudgingRules
    files: tuple[ShippedFile, ...]
    module: str
    fingerprint: str

    def setup(self, worker: Worker) -> None:
        """Prepare the worker. The first task opens the implementation."""
        keep_freed_memory()
        self._worker, self._home = worker.address, Path(worker.local_directory)
        self._folder: Path | None = None
        self._opener: ImplementationOpener | None = None
        self._idle: list[tuple[float, Implementation]] = []
        self._lock, self._over = threading.Lock(), threading.Event()
        threading.Thread(target=self._close_idle, name="hypcheck-idle", daemon=True).start()

    def perform(self, task: Step, allowance: Allowance) -> TaskResult:
        """Perform a task with an idle implementation, or a new one."""
        with self._lock:
            implementation = self._idle.pop()[1] if self._idle else None
            opener = self._opener = self._opener or self._opener_here()
        if implementation is None:
            implementation = opener.open()
        try:
            result = perform_task(task, implementation, self.rules, allowance)
        except BaseException:
            implementation.kill()
            raise
        with self._lock:
            self._idle.append((time.monotonic(), implementation))
        if self._over.is_set():
            self._close()
        return result

    def _opener_here(self) -> ImplementationOpener:
        """Return the opener for this worker. Raises InputError if its files differ from those where the run began."""
        spec = self.opener.spec
        if code_fingerprint() != self.fingerprint:
            raise InputError(f"worker {self._worker} {OTHER_FILES}")
        if self.module:
            require_same_sha256(f"the module of {spec}", self.module, module_sha256(spec), self._worker)
        try:
            self._folder = Path(tempfile.mkdtemp(prefix="hypcheck-", dir=self._home))
            return replace(self.opener, spec=spec_on_worker(spec, self.files, self._worker, self._folder))
        except OSError as error:
            reason = system_reason(error)
            raise InputError(f"worker {self._worker} cannot write into its folder {self._home}: {reason}") from None

    def _close_idle(self) -> None:
        """Close implementations that have been idle for IDLE seconds, until the plugin is removed."""
        while not self._over.wait(IDLE / 4):
            with self._lock:
                old = [idle for idle in self._idle if time.monotonic() > idle[0] + IDLE]
                self._idle = [idle for idle in self._idle if idle not in old]
            for _, implementation in old:
                implementation.close()

    def teardown(self, worker: Worker) -> None:  # noqa: ARG002 - dask's signature
        """End all implementations of the worker now, and remove the files that were sent there."""
        self._close()

    def _close(self) -> None:
        """Kill the idle implementations, and remove the folder of files that were sent here."""
        self._over.set()
        with self._lock:
            idle, self._idle = self._idle, []
        for _, implementation in idle:
            implementation.kill()
        if self._folder is not None:
            shutil.rmtree(self._folder, ignore_errors=True)


def _perform_opened(name: str, task: Step, allowance: Allowance) -> TaskResult:
    """Perform a task of the run with that name on this worker.

    Raises InputError if the worker has other files of hypcheck than the machine where the run began.
    """
    worker = get_worker()
    plugin: ImplementationPlugin | None = worker.plugins.get(name)
    if plugin is None:  # the worker could not load it
        raise InputError(f"worker {worker.address} {OTHER_FILES}")
    return plugin.perform(task, allowance)
