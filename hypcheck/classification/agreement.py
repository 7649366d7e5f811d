"""Two oracles are asked about every pair, and an answer is given only where they say the same."""

from __future__ import annotations

from hypcheck.errors import Exit, HypcheckError
from hypcheck.pairs import COLUMNS, Position


class DisagreementError(HypcheckError):
    """The exact decision and the nearest point contradict each other about a pair: one of them is wrong."""

    exit_code = Exit.ORACLES_DISAGREE


def require_agreement(row: tuple[float, ...], decided: tuple[int, bool], measured: tuple[int, float]) -> None:
    """Raise DisagreementError unless the decision (position, tangent) and the measure (position, clearance) agree.

    They do when the positions are the same and a clearance of 0 means tangency and nothing else.
    """
    position, tangent = decided
    if measured[0] == position and (measured[1] == 0) == tangent:
        return
    pair = ", ".join(f"{name} {value!r}" for name, value in zip(COLUMNS, row, strict=True))
    said = f"{Position(position).label}{' (tangent)' if tangent else ''}"
    raise DisagreementError(
        f"two oracles disagree about {pair}: by exact decision {said}, by the nearest point "
        f"{Position(measured[0]).label} with clearance {measured[1]!r}; please report this, it is a fault of hypcheck"
    )
