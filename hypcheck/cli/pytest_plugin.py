"""The pytest plugin: a test that is marked with a SPEC fails where `hypcheck verify SPEC` would.

    @pytest.mark.hypcheck("library:./libcollide.so", tolerance=16)
    def test_the_collision_test_is_right(): ...

Options of the marker are those of `hypcheck verify`, with underscores. It gates tests of every kind: functions, methods
of unittest.TestCase, coroutines. A marker that would gate nothing is refused when tests are collected. The run is a
process of its own in pytest's root folder, where hypcheck.toml is read as on the command line, so that both gates are
the same. pytest loads this module in every run of an environment that has hypcheck: it imports nothing heavy until a
marked test is run.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from hypcheck.record import Record
    from hypcheck.report.facts import Failure

MARKER = "hypcheck(SPEC, ..., **options): fail where `hypcheck verify SPEC` with these options does; then run the test."


def pytest_configure(config: pytest.Config) -> None:
    """Register the marker."""
    config.addinivalue_line("markers", MARKER)


GATES_NOTHING: Mapping[str, str] = MappingProxyType(
    {
        "help": "prints help",
        "update": "rewrites the list of known failures",
        "resume": "reports the results of another run",
    }
)
"""Options of `hypcheck verify` with which a test would pass although nothing was tested."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Refuse markers that would gate nothing. Raises pytest.UsageError, which ends the run of pytest."""
    for item in items:
        for mark in item.iter_markers("hypcheck"):
            if trouble := _refused(mark.args, mark.kwargs):
                raise pytest.UsageError(f"{item.nodeid}: the marker hypcheck {trouble}")


def _refused(specs: Iterable[object], options: Mapping[str, Any]) -> str | None:
    """Return why a marker gates nothing, as the end of a sentence; None if it gates."""
    for spec in specs:
        if not isinstance(spec, str | os.PathLike):
            return f"has {spec!r} as SPEC; it must be a text such as 'python:mine.py:position'"
        if str(spec).startswith("-"):
            return f"has {str(spec)!r} as SPEC; an option is written as a keyword: tolerance=16"
    option = next((name for name in GATES_NOTHING if options.get(name)), None)
    return f"has {option}={options[option]!r}, which {GATES_NOTHING[option]} and gates nothing" if option else None


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_call(item: pytest.Item) -> None:
    """Gate the implementations that the markers of a test name, before the test runs."""
    for mark in item.iter_markers("hypcheck"):
        trouble = gate(mark.args, mark.kwargs, item.config.rootpath)
        if trouble:
            pytest.fail(trouble, pytrace=False)


def gate(specs: Iterable[object], options: Mapping[str, Any], root: Path) -> str | None:
    """Run `hypcheck verify` in the folder `root`; return why it fails, with the worst case and its replay, or None."""
    with TemporaryDirectory(prefix="hypcheck-") as temporary:
        out = root / options.get("out", temporary)
        fresh = () if "CI" in os.environ or "fresh" in options else ("--fresh=off",)
        words = [*_words({**options, "out": out}), *fresh, "--", *map(str, specs)]
        command = [sys.executable, "-m", "hypcheck", "verify", *words]
        # With CI set, verify refuses to run without an implementation instead of checking hypcheck itself.
        # Fresh rows, which it asks then too, are for a CI that is one: at a desk a test repeats what it did before.
        environment = {**os.environ, "CI": "true"}
        ended = subprocess.run(command, cwd=root, env=environment, capture_output=True, check=False)  # noqa: S603
        if ended.returncode == 0:
            return None
        errors = ended.stderr.decode("utf-8", "replace").strip()
        return _told(out) or f"hypcheck verify ended with {ended.returncode}: {errors}"


def _words(options: Mapping[str, Any]) -> Iterator[str]:
    """Yield the options as words of a command line.

    True becomes a flag, and a list is joined by commas; None and False are left out.
    """
    for name, value in options.items():
        if value is None or value is False:
            continue
        text = ",".join(map(str, value)) if isinstance(value, (list, tuple)) else str(value)
        yield f"--{name.replace('_', '-')}{'' if value is True else f'={text}'}"


def _told(out: Path) -> str | None:
    """Return the text about the failures in the record of a run; None without a record, because the run was refused."""
    from hypcheck.messages import counted, sentence
    from hypcheck.record import read
    from hypcheck.record.reader import FILE
    from hypcheck.report.verdict import failures, verdict

    if not (out / FILE).is_file():
        return None
    record = read(out)
    failed = failures(record)
    lines = [f"hypcheck: {verdict(record).sentence}"]
    if failed:
        worst = _worst(record, failed)
        if worst.message not in lines[0]:
            lines.append(worst.message)
        if worst.replay:
            lines.append(f"replay: {worst.replay}")
        if len(failed) > 1:
            lines.append(f"and {counted(len(failed) - 1, 'more failure')}")
    return "\n".join(map(sentence, lines))


def _worst(record: Record, failed: list[Failure]) -> Failure:
    """Return the failure with the greatest backward error; the first one where no answer was wrong."""
    from hypcheck.record.lines import GroupLine
    from hypcheck.report.model import worst_u

    errors = {group.family: worst_u(group) for group in record.of(GroupLine)}
    return max(failed, key=lambda failure: errors.get(failure.group, 0.0) if failure.kind == "wrong" else 0.0)
