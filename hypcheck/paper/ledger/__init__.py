"""The ledger of the paper's claims: each proved, a misprint, false with a witness, or not checkable."""

from __future__ import annotations

from hypcheck.paper.ledger.book import entries

__all__ = ["entries"]
