"""The rounding mode of this thread, which a call must leave as it found it.

libm tells of one unit (on x86 the old one), so the arithmetic in use is asked too, by sums that only rounding decides.
"""

from __future__ import annotations

import ctypes

from hypcheck.methods.subject import ContractError

_ONE, _TINY = 1.0, 2.0**-60


def _libm() -> ctypes.CDLL | None:
    try:
        libm = ctypes.CDLL(None)
        libm.fegetround, libm.fesetround  # noqa: B018 - raises where it has them not
    except (OSError, TypeError, AttributeError):
        return None
    return libm


class RoundingMode:
    """Remembers the rounding mode; restore() puts it back, and complains where it had been changed."""

    def __init__(self) -> None:
        self._libm = _libm()
        self._mode = self._by_libm()

    def _by_libm(self) -> int:
        return int(self._libm.fegetround()) if self._libm else 0

    def restore(self) -> None:
        """Raise ContractError where the mode is no longer to nearest, or no longer what libm says it was."""
        found = mode_in_use()
        if found == "to nearest" and self._by_libm() == self._mode:
            return
        if self._libm:
            self._libm.fesetround(self._mode)
        where = found if found != "to nearest" else "outside of the unit that computes float64"
        raise ContractError(f"it left the rounding mode changed: {where}; a call must leave it as it was")


def mode_in_use() -> str:
    """How float64 sums are rounded here and now."""
    if _ONE + _TINY > _ONE:
        return "upward"
    if -_ONE - _TINY < -_ONE:
        return "downward"
    return "towards zero" if _ONE - _TINY < _ONE else "to nearest"
