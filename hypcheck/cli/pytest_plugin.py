"""The pytest plugin: a test that is marked with a SPEC fails where `hypcheck verify SPEC` would.

    @pytest.mark.hypcheck("library:./libcollide.so", tolerance=16)
    def test_the_collision_test_is_right(): ...

Options of the marker are those of `hypcheck verify`, with underscores. The run is a process of its own in pytest's root
folder, where hypcheck.toml is read as on the command line, so that both gates are the same. pytest loads this module in
every run of an environment that has hypcheck: it imports nothing heavy until a marked test is run.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from hypcheck.record import Record
    from hypcheck.report.verdict import Failure

MARKER = "hypcheck(SPEC, ..., **options): fail where `hypcheck verify SPEC` with these options does; then run the test."


def pytest_configure(config: pytest.Config) -> None:
    """Register the marker."""
    config.addinivalue_line("markers", MARKER)


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> None:
    """Gate what the markers of a test name, before its own body runs."""
    for mark in pyfuncitem.iter_markers("hypcheck"):
        trouble = gate(mark.args, mark.kwargs, pyfuncitem.config.rootpath)
        if trouble:
            pytest.fail(trouble, pytrace=False)


def gate(specs: Iterable[object], options: Mapping[str, Any], root: Path) -> str | None:
    """Why `hypcheck verify` fails in the folder `root`, with the worst case and its replay; None if it does not."""
    with TemporaryDirectory(prefix="hypcheck-") as temporary:
        out = root / options.get("out", temporary)
        words = [*map(str, specs), *_words({**options, "out": out})]
        fresh = () if "CI" in os.environ or "fresh" in options else ("--fresh", "off")
        command = [sys.executable, "-m", "hypcheck", "verify", *words, *fresh]
        # With CI set, verify refuses to run without an implementation instead of checking hypcheck itself.
        # Fresh rows, which it asks then too, are for a CI that is one: at a desk a test repeats what it did before.
        environment = {**os.environ, "CI": "true"}
        ended = subprocess.run(command, cwd=root, env=environment, capture_output=True, check=False)  # noqa: S603
        if ended.returncode == 0:
            return None
        said = ended.stderr.decode("utf-8", "replace").strip()
        return _told(out) or f"hypcheck verify ended with {ended.returncode}: {said}"


def _words(options: Mapping[str, Any]) -> Iterator[str]:
    """The options as on a command line: True is a flag, a list is joined by commas, None and False are left out."""
    for name, value in options.items():
        if value is None or value is False:
            continue
        yield f"--{name.replace('_', '-')}"
        if value is not True:
            yield ",".join(map(str, value)) if isinstance(value, (list, tuple)) else str(value)


def _told(out: Path) -> str | None:
    """What failed, from the record of the run; None if there is none, since the run was refused."""
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
        lines.append(worst.message)
        if worst.replay:
            lines.append(f"replay: {worst.replay}")
        if len(failed) > 1:
            lines.append(f"and {counted(len(failed) - 1, 'more failure')}")
    return "\n".join(map(sentence, lines))


def _worst(record: Record, failed: list[Failure]) -> Failure:
    """The failure with the greatest backward error; the first one where no answer was wrong."""
    from hypcheck.record.lines import GroupLine
    from hypcheck.report.model import worst_u

    errors = {group.family: worst_u(group) for group in record.of(GroupLine)}
    return max(failed, key=lambda each: errors.get(each.group, 0.0) if each.kind == "wrong" else 0.0)
