"""The site of the pages in a browser: no table of the record of engines is cut off in a window of 1280 px."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys

import pytest

from tests.report import browser
from tests.support.pages import ROOT

CUT_OFF = """[...document.querySelectorAll('.md-typeset__scrollwrap')]
    .filter((table) => table.scrollWidth > table.clientWidth)
    .map((table) => table.innerText.slice(0, 60))"""
"""What the tables begin with whose last columns only scrolling shows."""


@pytest.mark.thorough
@pytest.mark.skipif(importlib.util.find_spec("mkdocs") is None, reason="mkdocs is not installed; make .venv/ready-docs")
def test_no_table_of_the_engines_page_is_cut_off_at_1280_pixels(tmp_path):
    words = [sys.executable, "-m", "mkdocs", "build", "--quiet", "--site-dir", str(tmp_path)]
    subprocess.run(words, cwd=ROOT, env={**os.environ, "NO_MKDOCS_2_WARNING": "1"}, check=True, timeout=300)
    with browser.opened() as window:
        page = window.visit(tmp_path / "reports" / "engines" / "index.html").page
        page.set_viewport_size({"width": 1280, "height": 900})
        assert page.evaluate("document.querySelectorAll('.md-typeset__scrollwrap').length") >= 8
        assert page.evaluate(CUT_OFF) == []
        page.add_style_tag(content=".md-typeset table:not([class]) th { min-width: 5rem !important }")
        assert page.evaluate(CUT_OFF) != []
