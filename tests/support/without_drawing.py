"""Runs that write only text reports: drawing takes most of a small run, and the tests of reports cover it."""

from __future__ import annotations

import sys


def draw_nothing(patch):
    """From here on, until `patch` is undone, matplotlib and jinja2 are not there."""
    for name in ("matplotlib", "jinja2"):
        patch.setitem(sys.modules, name, None)


COMMAND = (
    sys.executable,
    "-c",
    "import sys; sys.modules.update(matplotlib=None, jinja2=None)\nfrom hypcheck.cli.main import process\nprocess()",
)
"""The command line in a process of its own that writes its reports in text alone."""
