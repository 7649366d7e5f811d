"""Every test here asserts that no process that it started outlives it."""

from tests.tools.miniatures import token

__all__ = ["token"]
