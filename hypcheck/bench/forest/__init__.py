"""`hypcheck bench --forest`: a walker's step among 10 to a million trees, beside FCL's broad phase."""

from __future__ import annotations

from hypcheck.bench.forest.stepping import run, sizes

__all__ = ["run", "sizes"]
