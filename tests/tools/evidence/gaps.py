"""Why some conditions of the C header are never seen with both values, by the gap as coverage.py names it."""

from __future__ import annotations

EXPLAINED: dict[str, str] = {}
