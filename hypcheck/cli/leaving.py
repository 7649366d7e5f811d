"""A terminal that may be closed while somebody's work goes on in it."""

from __future__ import annotations

import io
import os
from contextlib import suppress
from typing import TextIO


class Leaving(io.TextIOBase):
    """Writes to a terminal while it is there, and then to nowhere: a bar that nobody can see is no reason to end."""

    def __init__(self, terminal: TextIO) -> None:
        super().__init__()
        self._terminal = terminal

    def isatty(self) -> bool:
        """As the terminal has it."""
        return self._terminal.isatty()

    def write(self, text: str) -> int:
        """Write it, if anybody can still see it."""
        try:
            return self._terminal.write(text)
        except OSError:
            self._leave()
            return len(text)

    def flush(self) -> None:
        """Let it be seen."""
        try:
            self._terminal.flush()
        except OSError:
            self._leave()

    def _leave(self) -> None:
        """Let what is held back, which Python would try to write once more as it ends, go to nowhere."""
        with suppress(OSError):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, self._terminal.fileno())
            os.close(nowhere)
