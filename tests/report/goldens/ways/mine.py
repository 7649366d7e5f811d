"""A wrong implementation of the question about ways: it looks at 16 moments of each, and takes no axis into account."""

from __future__ import annotations

from hypcheck.implementations.sweeps import sampled

hypcheck = {"question": "passage", "times": True, "tilt": True}


def passage(rows):
    """Contact at one of the moments, and the first of them."""
    return sampled(rows[:, :10], 16)
