"""A right implementation, which claims less than every row; it needs hypcheck, and so runs with --isolate off."""

from __future__ import annotations

from hypcheck import classify

hypcheck = {"version": "2.0", "tilt": True, "domain": {"ratio": [1e-4, 1e4], "magnitude": [1e-5, 1e5]}}


def position(rows):
    """Decide every row exactly."""
    return classify(rows)
