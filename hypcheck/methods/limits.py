"""What a foreign implementation may use before it is stopped."""

from __future__ import annotations

import math
from dataclasses import dataclass

from hypcheck.errors import InputError


@dataclass(frozen=True, slots=True)
class Limits:
    """Seconds until it is ready, seconds without progress, restarts after faults, bytes its process group may hold.

    Raises InputError where one of them leaves no room at all.
    """

    startup_timeout: float = 30.0
    timeout: float = 10.0
    restarts: int = 20
    memory: int = 4 << 30

    def __post_init__(self) -> None:
        for name in ("startup_timeout", "timeout", "memory"):
            value = getattr(self, name)
            if not 0 < value < math.inf:
                raise InputError(f"the limit {name.replace('_', ' ')} is {value}; it must be more than 0")
        if self.restarts < 0:
            raise InputError(f"the limit restarts is {self.restarts}; it must be 0 or more")
