"""A plugin of pytest: a worker that is about to be killed is first let end, so that it keeps what it covered.

hypcheck kills the worker of an implementation as soon as nothing more is wanted of it, with a signal that no process
notices. Here its input is closed before, at whose end it ends by itself; one that is busy gets SIGTERM, at which
coverage writes its data (`sigterm` in `pyproject.toml`). Isolated workers do not count: they see no variables of
coverage and write nowhere outside their scratch folder. It is the same worker in the tests without isolation.
"""

from __future__ import annotations

import subprocess
from contextlib import suppress

import pytest

from hypcheck.implementations.process import Process

PATIENCE_S = 0.5
"""A worker that is busy in C or stopped hears neither."""


@pytest.hookimpl
def pytest_configure() -> None:
    """Put the question before each kill."""
    kill = Process.kill

    def asked_and_killed(self: Process) -> None:
        running = self._launched
        if not self._closed and not running.isolated and "hypcheck.implementations.worker" in str(running.process.args):
            self._pipes[0].close()
            for _ in range(2):
                with suppress(subprocess.TimeoutExpired):
                    running.process.wait(PATIENCE_S)
                    break
                running.process.terminate()
        kill(self)

    Process.kill = asked_and_killed  # type: ignore[method-assign]
