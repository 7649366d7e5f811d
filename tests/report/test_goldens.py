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


@pytest.mark.parametrize("run", goldens.RUNS)
def test_reports_of_a_recorded_run_are_the_goldens_beside_its_record_and_its_page_is_sound(run):
    """In one test for all formats, since to draw the plots takes most of the time."""
    (now, page), kept = goldens.made(run), goldens.kept(run)
    changed = [line for name in sorted({*now, *kept}) for line in changes(name, kept.get(name), now.get(name))]
    if changed:
        pytest.fail(f"{run}: if this is meant, make goldens\n{''.join(changed)}", pytrace=False)
    assert faults(page) == []
