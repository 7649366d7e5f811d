"""What can be asked of a position, and the answers to it."""

from __future__ import annotations

from typing import Literal

from hypcheck.errors import InputError
from hypcheck.scene.model import QUESTIONS

Question = Literal["position", "exterior", "interior", "contact"]
"""`position` is answered by +1, 0 or −1, the others by 1 (yes) or 0 (no)."""

NUMBER_OF = {question: number for number, question in enumerate(QUESTIONS)}
"""As in core/hypcheck.h."""

POSITION_OF = {"exterior": 1, "interior": -1, "contact": 0}
"""The position to which a question is answered yes."""


def require_known(question: str) -> None:
    """Raise InputError for a question that is none."""
    if question not in QUESTIONS:
        raise InputError(f"question is {question!r}; it must be one of {', '.join(QUESTIONS)}")
