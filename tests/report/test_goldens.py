"""What each format says of recorded runs is what is committed beside their records: see tests/tools/goldens.py.

Their pages are files that load nothing and run nothing but their own.
"""

from __future__ import annotations

import difflib

import pytest

from tests.report.page_structure import faults
from tests.tools import goldens


def changes(name, golden, now):
    """The first lines of the difference; none if there is none. A format that is not written has no lines."""
    before, after = ((text or "").splitlines(keepends=True) for text in (golden, now))
    return [*difflib.unified_diff(before, after, f"the golden {name}", f"{name} as it is now", n=0)][:20]


LARGE = ("self", "bench")
"""Runs with many plots, of which the run of all samples has every kind."""


def require_goldens(run, now, kept):
    changed = [line for name in sorted({*now, *kept}) for line in changes(name, kept.get(name), now.get(name))]
    if changed:
        pytest.fail(f"{run}: if this is meant, make goldens\n{''.join(changed)}", pytrace=False)


@pytest.mark.parametrize(
    "run", [pytest.param(run, marks=pytest.mark.thorough if run in LARGE else ()) for run in goldens.RUNS]
)
def test_reports_of_a_recorded_run_equal_its_goldens_and_its_page_is_valid(run):
    """In one test for all formats, since to draw the plots takes most of the time."""
    now, page = goldens.made(run)
    require_goldens(run, now, goldens.kept(run))
    assert faults(page) == []


@pytest.mark.parametrize("run", LARGE)
def test_reports_without_plots_of_a_large_run_equal_its_goldens(run):
    now, kept = goldens.undrawn(run), goldens.kept(run)
    assert len(now) >= 6
    require_goldens(run, now, {name: text for name, text in kept.items() if name in now})
