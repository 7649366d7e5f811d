"""A plugin of pytest: coverage keeps with each line the tests, with their fixtures, that ran it.

Beside coverage's data stands `seconds.json`: what each test took, by its name.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterator
from pathlib import Path

import coverage
import pytest

_SECONDS: dict[str, float] = {}


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """Name the test while it runs, and time it."""
    running = coverage.Coverage.current()
    if running is not None:
        running.switch_context(item.nodeid)
    since = time.process_time()
    yield
    _SECONDS[item.nodeid] = round(time.process_time() - since, 3)
    if running is not None:
        running.switch_context("")


def pytest_sessionfinish() -> None:
    """Write what the tests took."""
    if place := os.environ.get("HYPCHECK_COVERAGE"):
        Path(place).with_name("seconds.json").write_text(json.dumps(_SECONDS), encoding="utf-8")
