"""`hypcheck bench --kernel`: the targets of the fast path's speed, each a line "kernel" of the record."""

from __future__ import annotations

from hypcheck.bench.kernel.targets import run, steps

__all__ = ["run", "steps"]
