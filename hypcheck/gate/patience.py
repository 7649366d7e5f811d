"""Calls that may never return: of a client whose scheduler is there, as the system sees it, but does nothing more."""

from __future__ import annotations

from collections.abc import Callable
from concurrent import futures
from threading import Thread
from typing import TypeVar

Result = TypeVar("Result")


def within(seconds: int, call: Callable[[], Result]) -> Result:
    """What the call returns. Raises what it raises, or TimeoutError, and then leaves it to itself.

    Seconds in which this process stood still do not count.
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
