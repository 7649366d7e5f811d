"""What each format says of recorded runs is what is committed beside their records: see tests/tools/goldens.py."""

from __future__ import annotations

import difflib
from functools import cache

import pytest

from tests.tools import goldens

made = cache(goldens.made)


def lines(text):
    """Lines with their ends; a format that is not written has none."""
    return (text or "").splitlines(keepends=True)


@pytest.mark.parametrize(("run", "name"), [(run, name) for run in goldens.RUNS for name in goldens.names_of(run)])
def test_report_of_a_recorded_run_is_the_golden_beside_its_record(run, name):
    path = goldens.FOLDER / run / name
    golden = path.read_bytes().decode("utf-8") if path.exists() else None
    if made(run).get(name) != golden:
        changed = difflib.unified_diff(lines(golden), lines(made(run).get(name)), "golden", "now", n=0)
        pytest.fail(f"make goldens, if this is meant: {run}/{name}\n{''.join([*changed][:40])}", pytrace=False)


def test_goldens_are_no_more_files_than_the_formats_write():
    for run in goldens.RUNS:
        files = {str(path.relative_to(goldens.FOLDER / run).as_posix()) for path in (goldens.FOLDER / run).rglob("*.*")}
        kept = {name for name in files if not name.endswith((".py", ".toml", "jsonl", ".pyc"))}
        assert kept == set(made(run))
