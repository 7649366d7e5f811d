"""The exact truth that tests compare with, in one place: where it stands in the tree is known here alone."""

from __future__ import annotations

from hypcheck.truth.exact import Decision, decide, kind_of, position
from hypcheck.truth.float_filter import positions

__all__ = ["Decision", "decide", "kind_of", "position", "positions"]
