"""What can be asked of `hypcheck derive`: parts and formats, by name. Nothing here loads sympy."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib import import_module
from typing import Any

PARTS = {
    "derivation": "from the two surfaces to the coefficients, step by step",
    "propositions": "the proofs of the paper's propositions as they hold, link by link",
    "ledger": "every statement of the paper, and what became of it",
    "costs": "operations of each way to the answer, counted from its program",
}
"""The parts by name, in their order, with what they are."""

FORMATS = {
    "text": "hypcheck.paper.derive.text",
    "latex": "hypcheck.paper.derive.latex",
    "json": "hypcheck.paper.derive.as_json",
    "markdown": "hypcheck.paper.derive.markdown",
    "erratum": "hypcheck.paper.derive.erratum",
}
"""The formats by name, with the module whose `lines` writes what was chosen."""


def writer(name: str) -> Callable[[Any], Iterator[str]]:
    """The function from what was chosen (choosing.Chosen) to the lines of a format, without ends of line."""
    lines: Callable[[Any], Iterator[str]] = import_module(FORMATS[name]).lines
    return lines
