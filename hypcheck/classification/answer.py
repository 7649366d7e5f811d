"""The whole answer about one pair: position, kind, clearance and a checked proof. Loads no numpy."""

from __future__ import annotations

from dataclasses import dataclass

from hypcheck.classification.agreement import DisagreementError, require_agreement
from hypcheck.pairs import Pair
from hypcheck.truth import exact
from hypcheck.truth.certificate import Certificate, check_certificate
from hypcheck.truth.exact import Decision
from hypcheck.truth.prove import prove


@dataclass(frozen=True, slots=True)
class Answer:
    """What is known of a pair: the exact decision, its clearance in spheroid radii, and what proves the decision."""

    pair: Pair
    decision: Decision
    clearance: float
    certificate: Certificate


def answer(pair: Pair) -> Answer:
    """Decide, measure and prove. Raises DisagreementError where two oracles, or a proof and its claim, contradict."""
    from hypcheck.truth.nearest import nearest  # noqa: PLC0415 - loads mpmath

    decision = exact.decide(pair.lengths)
    measured = nearest(pair)
    require_agreement(pair.row, (decision.position, decision.tangent), (measured.position, measured.clearance))
    certificate = prove(pair, decision)
    if certificate.position is not decision.position or not check_certificate(pair, certificate):
        raise DisagreementError(
            f"the proof found for {pair} does not hold; please report this, it is a fault of hypcheck"
        )
    return Answer(pair, decision, measured.clearance, certificate)
