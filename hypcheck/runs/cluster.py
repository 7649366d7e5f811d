"""The connection to a dask scheduler: one that is running, or one that is started on this machine.

What is sent is Python's pickle, which a scheduler and its workers execute: they belong in a network that is trusted.
"""

from __future__ import annotations

import asyncio
import logging
import re
import warnings
from collections.abc import Callable, Iterator, Mapping
from concurrent import futures
from contextlib import contextmanager, suppress
from threading import Thread
from typing import TYPE_CHECKING, Any, TypeVar

from hypcheck.errors import InputError, UnavailableError
from hypcheck.processes import interrupts_held
from hypcheck.runs.fingerprint import code_fingerprint
from hypcheck.version import VERSION

if TYPE_CHECKING:
    from distributed import Client
    from distributed.security import Security


Result = TypeVar("Result")

LOCAL = re.compile(r"local:([1-9]\d{0,3})")
"""`local:N`: a scheduler here, with N workers."""

CONNECT = 10
"""Seconds until a scheduler must answer, and until it must have a worker."""

CLOSE = 5
"""Seconds that a client has to close."""

SAME = ("hypcheck", "python", "dask", "distributed", "numpy")
"""What must be of one version everywhere, of Python its first two numbers."""


OTHER_FILES = f"has other files of hypcheck {VERSION} than there are here; install the same there"


def check_address(address: str) -> None:
    """Raise InputError where the text is no address at all."""
    named = re.fullmatch(r"(?!local:)((tcp|tls|ws|wss|ucx)://)?[^\s/:][^\s/]*:(?P<port>\d{1,5})", address)
    if not LOCAL.fullmatch(address) and not (named and int(named["port"]) < 1 << 16):
        right = "that of a dask.distributed scheduler, such as tcp://10.0.0.1:8786, or local:N for N workers here"
        raise InputError(f"--cluster is {address!r}; it must be {right}")


def call_with_timeout(seconds: int, call: Callable[[], Result]) -> Result:
    """What a call returns. Raises what it raises, or TimeoutError, and then leaves it to itself.

    A call may never return where the scheduler is there, as the system sees it, but does nothing any more. Seconds in
    which this process stood still do not count.
    """
    future: futures.Future[Result] = futures.Future()

    def perform() -> None:
        try:
            future.set_result(call())
        except BaseException as error:  # noqa: BLE001 - it is raised where it is waited for
            future.set_exception(error)

    Thread(target=perform, name="hypcheck-call", daemon=True).start()
    for _ in range(seconds):
        futures.wait([future], timeout=1)
        if future.done():
            return future.result()
    raise TimeoutError(f"it took longer than {seconds} s")


@contextmanager
def cluster_client(address: str) -> Iterator[Client]:
    """A client of the scheduler at that address, which has a worker; what was started here is ended with the block.

    Raises UnavailableError where dask.distributed is not installed, and InputError where the scheduler cannot be
    reached, has no workers, or has other versions than there are here.
    """
    try:
        import distributed  # noqa: F401, PLC0415 - an extra, and slow to load
    except ModuleNotFoundError as error:
        raise UnavailableError(
            f"--cluster needs dask.distributed ({error.name} is not installed): pip install 'hypcheck[cluster]'"
        ) from None
    _silence_logs()
    local = LOCAL.fullmatch(address)
    if local is None:
        with _client(address) as client:
            yield client
        return
    from hypcheck.runs.local_cluster import local_cluster  # noqa: PLC0415 - loads dask

    with local_cluster(int(local[1])) as (found, security), _client(found, security) as client:
        yield client


@contextmanager
def _client(address: str, security: Security | None = None) -> Iterator[Client]:
    """A client; without `security` it connects as dask's settings say."""
    from distributed import Client  # noqa: PLC0415
    from distributed.security import Security  # noqa: PLC0415

    security = security or Security()
    _require_scheduler(address, security)
    try:
        with warnings.catch_warnings(), interrupts_held():
            warnings.simplefilter("ignore")  # of versions, which are looked at below
            client = Client(address, timeout=CONNECT, security=security, set_as_default=False, name="hypcheck")
    except Exception as error:  # noqa: BLE001 - whatever it is that answers there may lead to any
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
    """Raise InputError where nobody answers as dask does, or dask of another version.

    A Client would find that out by errors of its own, some of them printed as tracebacks when it is freed.
    """
    from distributed.core import rpc  # noqa: PLC0415
    from distributed.versions import get_versions  # noqa: PLC0415

    async def who() -> tuple[str, Any]:
        async with rpc(address, CONNECT, connection_args=security.get_connection_args("client")) as there:
            kind = str((await there.identity())["type"])
            return kind, await there.versions(packages=["hypcheck"]) if kind == "Scheduler" else None

    try:
        kind, versions = asyncio.run(asyncio.wait_for(who(), CONNECT + 3))  # dask waits longer for one who is silent
    except Exception as error:  # noqa: BLE001 - a stranger's answer may lead to any, a MemoryError too
        raise _no_scheduler(address, error) from None
    if kind != "Scheduler":
        raise InputError(f"--cluster {address}: a dask {kind.lower()} is there, and no scheduler; name its scheduler")
    _require_same_versions("the scheduler", versions, get_versions(packages=["hypcheck"]), address)


def _no_scheduler(address: str, error: BaseException) -> InputError:
    chain = [error]
    while (before := chain[-1].__cause__ or chain[-1].__context__) is not None:  # dask wraps errors of connections, and
        chain.append(before)  # goes on trying until it is out of time
    told = [each.strerror for each in chain if isinstance(each, OSError) and each.strerror]
    if told:
        reason = told[-1].lower()
    elif isinstance(error, (TimeoutError, asyncio.TimeoutError)):
        reason = f"nothing was said within {CONNECT} s"
    elif isinstance(error, MemoryError):
        reason = "what is said there is not what dask says"
    else:
        reason = str(error) or type(error).__name__
    tls = "; certificates are told by dask's settings distributed.comm.tls" if address.startswith("tls:") else ""
    return InputError(f"--cluster {address}: no dask scheduler answers there: {reason}{tls}")


def _require_workers(client: Client, address: str) -> None:
    try:
        client.wait_for_workers(1, timeout=CONNECT)
    except OSError:  # a timeout is one
        raise InputError(
            f"--cluster {address}: the scheduler has no workers; `dask worker {address}` starts one"
        ) from None


def _require_versions(found: Mapping[str, Any], address: str) -> None:
    """Raise InputError naming the first difference between here and the scheduler or a worker."""
    there = {"the scheduler": found["scheduler"], **{f"worker {name}": each for name, each in found["workers"].items()}}
    for who, each in there.items():
        _require_same_versions(who, each, found["client"], address)


def _require_same_versions(who: str, there: Mapping[str, Any], here: Mapping[str, Any], address: str) -> None:
    ours, theirs = _versions(here), _versions(there)
    for package in SAME:
        if theirs[package] != ours[package]:
            had = f"has {package} {theirs[package]}" if theirs[package] else f"has no {package}"
            raise InputError(f"--cluster {address}: {who} {had}, and here it is {ours[package]}; both must be one")


def _require_same_files(found: Mapping[str, Any], address: str) -> None:
    """Raise InputError where a worker has other files of ours, though by its version they should be the same.

    One that was lost before it could tell is none of them; whoever comes in its place is looked at when it is asked.
    """
    here = code_fingerprint()
    for worker, there in found.items():
        if there != here and not isinstance(there, OSError):
            raise InputError(f"--cluster {address}: worker {worker} {OTHER_FILES}")


def _versions(machine: Mapping[str, Any]) -> dict[str, str | None]:
    packages = machine["packages"]
    return {name: packages.get(name) for name in SAME} | {"python": ".".join(packages["python"].split(".")[:2])}


_LOUD = ("distributed", "tornado", "asyncio")


def _silence_logs() -> None:
    """Whatever there is to say of the cluster, this process says itself, in a sentence."""
    for name in (*_LOUD, *logging.root.manager.loggerDict):
        if name.split(".")[0] in _LOUD:
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)
