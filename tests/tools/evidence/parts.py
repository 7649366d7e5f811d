"""The parts of the evidence, what each must offer, and the figures that were measured last.

A part is a module of this folder with

- `TITLE`: the heading of its section,
- `measure() -> Figures`: measures anew, as long as it takes; raises `Unavailable` where a tool is missing,
- `section(figures) -> str`: Markdown below the heading, made from the figures alone.
"""

from __future__ import annotations

import importlib
import json
from pathlib import Path
from typing import Any, Protocol

ROOT = Path(__file__).resolve().parents[3]
KEPT = Path(__file__).with_name("figures.json")
PAGE = ROOT / "docs" / "evidence.md"
TABLES = ROOT / "docs" / "evidence"
"""The folder of the long lists of the page."""

PARTS: dict[str, str] = {
    "fuzz": "fuzz",
    "faults": "faults",
    "python-coverage": "python_coverage",
    "python-mutants": "python_mutants",
    "coverage": "coverage",
    "emitted": "emitted",
    "kernel-mutants": "kernel_mutants",
    "constants": "program_mutants",
}
"""The module of each part, by its name on the command line; the page has them in this order."""

Figures = dict[str, Any]
"""What one part measured: numbers, strings, lists and objects, as JSON has them."""


class Unavailable(Exception):  # noqa: N818 - a condition of this machine, no fault
    """A part cannot be measured here; the sentence says which tool is missing."""


class Part(Protocol):
    """A module that measures something and describes it."""

    TITLE: str

    def measure(self) -> Figures:
        """The figures of this part, measured now."""

    def section(self, figures: Figures) -> str:
        """Its text on the page."""


def part(name: str) -> Part:
    """The module of the part `name`."""
    return importlib.import_module(f"tests.tools.evidence.{PARTS[name]}")


def kept() -> dict[str, Figures]:
    """The figures of every part as they were measured last."""
    return json.loads(KEPT.read_text(encoding="utf-8"))


def text_of(figures: dict[str, Figures]) -> str:
    """The text of the file that keeps the figures."""
    return json.dumps({name: figures[name] for name in PARTS if name in figures}, indent=1, ensure_ascii=False) + "\n"
