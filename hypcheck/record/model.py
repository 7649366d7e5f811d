"""A record as a value."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

Line = dict[str, Any]


@dataclass(frozen=True)
class Record:
    """A record as read: its header, its lines between header and footer, and its footer (None: truncated)."""

    header: Line
    lines: tuple[Line, ...]
    footer: Line | None

    def of(self, kind: str) -> list[Line]:
        """The lines of one kind, in order."""
        return [line for line in self.lines if line["type"] == kind]
