"""Runs that write only text reports: drawing takes most of a small run, and the tests of reports cover it."""

from __future__ import annotations

import sys


def draw_nothing(patch):
    """From here on, until `patch` is undone, matplotlib and jinja2 are not there, nor what jinja2 brings."""
    for name in ("matplotlib", "jinja2", "markupsafe"):
        patch.setitem(sys.modules, name, None)


MISSING = "matplotlib=None, jinja2=None, markupsafe=None"

COMMAND = (
    sys.executable,
    "-c",
    f"import sys; sys.modules.update({MISSING})\nfrom hypcheck.cli.main import process\nprocess()",
)
"""The command line in a process of its own that writes its reports in text alone."""
