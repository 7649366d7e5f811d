"""Settings of hypothesis for tests that draw another number of examples than usual."""

from __future__ import annotations

from hypothesis import settings


def examples(count: int) -> settings:
    """So many examples where the profile draws 100, and fewer in the same measure where it draws fewer."""
    return settings(max_examples=max(1, count * settings.default.max_examples // 100))
