"""The parts and formats of `hypcheck derive`, by name. Nothing here loads sympy; the modules beside it do."""

from __future__ import annotations

PARTS = {
    "derivation": "from the two surfaces to the coefficients, step by step",
    "propositions": "the proofs of the paper's propositions as they hold, link by link",
    "ledger": "every statement of the paper, and what became of it",
    "costs": "operations of each way to the answer, counted from its program",
}
"""The parts by name, in their order, with what they are."""

FORMATS = ("text", "latex", "json", "markdown", "erratum")
"""The formats by name; formats.py has their writers."""
