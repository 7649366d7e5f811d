"""Runs tests against mutants: one pytest process loads all tests, and forks for each mutant.

`python -m tests.tools.evidence.mutant_runs TASKS RESULTS`: TASKS is a JSON file with the test files to load and, for
each mutant, its tests in their order, and the one that killed it before, if any. RESULTS gets a JSON line for each:
killed or timeout (by which test), survived, or not-made where no function that lives has the code.
"""

from __future__ import annotations

import importlib
import json
import os
import resource
import signal
import sys
import time
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from types import FunctionType
from typing import Any

import pytest
from hypothesis import Phase, settings

from tests.tools.evidence.mutations import Mutation, apply, functions_of

LEAST_S = 0.7
"""Seconds of a processor that any mutant may take; beyond that, twice what its tests take under coverage."""

USUAL_S = 0.15
"""What a test takes of which nothing is known."""

WALL = 12
"""A mutant may take so many times as long by the clock, on a busy machine."""

SURVIVED, KILLED, NOT_MADE = 0, 11, 12


class Runner:
    """The plugin of pytest that runs the mutants in place of the tests."""

    def __init__(self, tasks: dict[str, Any], results: Path) -> None:
        self._tasks, self._results = tasks, results
        self._kills: Counter[tuple[str, str]] = Counter()
        self._living: dict[str, list[FunctionType]] = {}
        self._failed = False

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Notice that a test failed."""
        self._failed = self._failed or report.failed

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Run every mutant, and then each test that killed one without a change, where it must pass."""
        settings.register_profile("mutants", settings.default, phases=(Phase.explicit, Phase.generate))
        settings.load_profile("mutants")  # a test that fails has told all: no example is made smaller
        items = {item.nodeid: item for item in session.items}
        sound: dict[str, bool] = {}
        with self._results.open("a", encoding="utf-8") as file:
            for task in self._tasks["mutants"]:
                found = self._found(task, items, sound)
                file.write(json.dumps({"mutation": task["mutation"], **found}) + "\n")
                file.flush()
        return True

    def _found(self, task: dict[str, Any], items: dict[str, pytest.Item], sound: dict[str, bool]) -> dict[str, Any]:
        mutation, first = Mutation(**task["mutation"]), task["first"]
        if first in items and sound.get(first, True):
            found = self._judged(mutation, [first], items)
            if found["outcome"] in ("killed", "timeout") and self._is_sound(first, items, sound):
                return found
        names = [name for name in task["tests"] if sound.get(name, True) and name in items]
        found = self._judged(mutation, names, items)
        while found["outcome"] == "killed" and not self._is_sound(found["by"], items, sound):
            names.remove(found["by"])
            found = self._judged(mutation, names, items)
        return found

    def _is_sound(self, name: str, items: dict[str, pytest.Item], sound: dict[str, bool]) -> bool:
        """Whether a test passes in a fork without a change."""
        if name not in sound:
            sound[name] = _forked(lambda tell: self._tested([items[name]], tell), 30.0)[0] == SURVIVED
        return sound[name]

    def _judged(self, mutation: Mutation, names: Sequence[str], items: dict[str, pytest.Item]) -> dict[str, Any]:
        ordered = sorted(names, key=lambda name: -self._kills[mutation.module, name])
        limit = LEAST_S + 2 * sum(self._tasks["seconds"].get(name, USUAL_S) for name in names)
        file = str(Path(mutation.module).resolve())
        if file not in self._living:
            importlib.import_module(mutation.module.removesuffix(".py").replace("/", "."))  # some are loaded when asked
            self._living[file] = functions_of(file)

        def work(tell: Tell) -> int:
            source = Path(file).read_text(encoding="utf-8")
            made = apply(mutation, file, source, self._living[file])
            return self._tested([items[name] for name in ordered], tell) if made else NOT_MADE

        done, seconds, by = _forked(work, limit)
        outcome = {SURVIVED: "survived", NOT_MADE: "not-made", KILLED: "killed"}.get(done, "timeout")
        self._kills[mutation.module, by] += outcome == "killed"
        by = by if outcome in ("killed", "timeout") else ""
        return {"outcome": outcome, "tests": len(ordered), "seconds": round(seconds, 3), "by": by}

    def _tested(self, tests: Sequence[pytest.Item], tell: Tell) -> int:
        for item, following in pairwise([*tests, None]):
            tell(item.nodeid)
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            if self._failed:
                return KILLED
        return SURVIVED


Tell = Callable[[str], None]
"""Tells the process before a fork which test begins."""


def _forked(work: Callable[[Tell], int], limit: float) -> tuple[int, float, str]:
    """The code of the work, done in a fork, its seconds of a processor, and what it told last; -1: it took too long."""
    told, tell = os.pipe()
    process = os.fork()
    if process == 0:
        _be_the_fork(work, limit, tell)
    os.close(tell)
    until, code = time.monotonic() + WALL * limit, None
    while code is None and time.monotonic() < until:
        ended, status, used = os.wait4(process, os.WNOHANG)
        if ended:
            code = os.waitstatus_to_exitcode(status)
        else:
            time.sleep(0.005)
    with suppress(ProcessLookupError):
        os.killpg(process, signal.SIGKILL)
    if code is None:
        _, _, used = os.wait4(process, 0)
    with os.fdopen(told, encoding="utf-8") as file:
        word = file.read().rpartition("\0")[0].rpartition("\0")[2]
    return -1 if code is None else code, used.ru_utime + used.ru_stime, word


def _be_the_fork(work: Callable[[Tell], int], limit: float, tell: int) -> None:
    os.setsid()
    null = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(null, stream)
    resource.setrlimit(resource.RLIMIT_CPU, (int(limit) + 1, int(limit) + 2))
    resource.setrlimit(resource.RLIMIT_AS, (6 << 30, 6 << 30))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    code = NOT_MADE
    try:
        code = work(lambda word: os.write(tell, f"{word}\0".encode()))
    finally:
        os._exit(code)


def main(tasks_file: str, results: str) -> int:
    """Load the tests, run the mutants."""
    os.environ["CI"] = "1"  # hypothesis gives the same examples each time
    tasks = json.loads(Path(tasks_file).read_text(encoding="utf-8"))
    options = ["-q", "-s", "-p", "no:cacheprovider", "-p", "no:xdist", "-p", "no:hypcheck"]
    options += ["-W", "ignore::pytest.PytestAssertRewriteWarning"]
    return int(pytest.main([*options, *tasks["files"]], plugins=[Runner(tasks, Path(results))]))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
