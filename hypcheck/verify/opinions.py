"""The four oracles behind one door: each turns rows into opinions, and says so where it cannot tell."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from hypcheck.pairs import Pair, Position
from hypcheck.rows import Rows


@dataclass(frozen=True, slots=True)
class Opinion:
    """What an oracle says of one pair; None where it does not say. `stage` names the part of it that decided."""

    position: Position | None
    tangent: bool | None = None
    kind: str | None = None
    stage: str = ""


@dataclass(frozen=True, slots=True)
class Oracle:
    """One way to the truth. `ask` maps rows (n, 7) to n opinions; `share` is the part of the cases it is asked."""

    name: str
    title: str
    ask: Callable[[Rows], Sequence[Opinion]]
    available: Callable[[], str | None] = lambda: None


def ask_exact(rows: Rows) -> list[Opinion]:
    """The exact decision, its certificate made and checked: an answer without a valid proof counts as undecided."""
    from hypcheck.truth import exact  # noqa: PLC0415  an oracle that is not asked is not loaded
    from hypcheck.truth.certificate import check_certificate  # noqa: PLC0415
    from hypcheck.truth.prove import prove  # noqa: PLC0415

    opinions = []
    for row in rows.tolist():
        pair = Pair.from_row(row)
        decision = exact.decide(pair.lengths)
        certificate = prove(pair, decision)
        proved = certificate.position is decision.position and check_certificate(pair, certificate)
        opinions.append(
            Opinion(decision.position, decision.tangent, decision.kind.value, "proved")
            if proved
            else Opinion(None, stage="certificate refused")
        )
    return opinions


def ask_nearest(rows: Rows) -> list[Opinion]:
    """The sign of the clearance to the nearest point, in floats with a bound, more digits where that cannot tell."""
    from hypcheck.truth.nearest import STAGES, positions  # noqa: PLC0415

    found = positions(np.ascontiguousarray(rows))
    return [
        Opinion(Position(position), tangent, None, STAGES[stage])
        for position, tangent, stage in zip(
            found.position.tolist(), found.tangent.tolist(), found.stage.tolist(), strict=True
        )
    ]


def ask_roots(rows: Rows) -> list[Opinion]:
    """The pattern of the roots of g, after [10]."""
    from hypcheck.truth.roots import classify_by_roots  # noqa: PLC0415

    reports = [classify_by_roots(Pair.from_row(row)) for row in rows.tolist()]
    return [
        Opinion(
            report.position,
            report.tangent,
            report.kind.value,
            "signs suffice" if report.literal is not None else "signs are ambiguous",
        )
        for report in reports
    ]


def ask_mesh(rows: Rows) -> list[Opinion]:
    """FCL's distance to two meshes with the hyperboloid between them; undecided inside its band."""
    from hypcheck.truth.mesh import verdict  # noqa: PLC0415
    from hypcheck.truth.mesh_refine import Outcome  # noqa: PLC0415

    def opinion(row: list[float]) -> Opinion:
        found = verdict(Pair.from_row(row))
        position = Position.CONTACT if found.outcome is Outcome.CONTACT else found.position
        return Opinion(position, stage=found.outcome.name.lower())

    return [opinion(row) for row in rows.tolist()]


def _mesh_trouble() -> str | None:
    from hypcheck.truth.mesh import availability  # noqa: PLC0415

    return availability()


ORACLES = {
    oracle.name: oracle
    for oracle in (
        Oracle("exact", "exact decision in integers, with a checked certificate", ask_exact),
        Oracle("nearest", "nearest point of the hyperboloid", ask_nearest),
        Oracle("roots", "root patterns after [10], re-derived; its text was not consulted", ask_roots),
        Oracle("mesh", "FCL on two one-sided meshes", ask_mesh, _mesh_trouble),
    )
}
