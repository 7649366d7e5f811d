"""Whether the labels of a file are true: each is proved, or computed anew by an oracle that did not make it.

Position and tangency follow from the certificate alone (truth/certificate.py and shows_crossing, rational arithmetic);
the kind is asked of the roots, the clearance of the nearest point. Labels are made by the exact decision, which shares
nothing with these. Flip distances rest on exact decisions and are computed anew, and so are the flags.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from hypcheck.casebook.frozen.flags import flags_of
from hypcheck.casebook.frozen.labels import flips, shows_crossing
from hypcheck.casebook.frozen.model import Vector, VectorFile
from hypcheck.casebook.frozen.refusals import RefusalFile, columns_at_fault
from hypcheck.casebook.frozen.texts import decimal_of
from hypcheck.pairs import Pair, Position
from hypcheck.truth import exact
from hypcheck.truth.certificate import check_certificate
from hypcheck.truth.exact import Decision
from hypcheck.truth.nearest import nearest
from hypcheck.truth.roots import classify_by_roots


@dataclass(frozen=True, slots=True)
class Fault:
    """A label that is wrong: the line of its case (0 where it was not read from a file), its id, and what is wrong."""

    line: int
    case: str
    sentence: str


def faults_of_vectors(file: VectorFile, advance: Callable[[int], object] = lambda _: None) -> list[Fault]:
    """Every wrong label of a file of cases, in order; `advance` is told of each case that is done."""
    lines = file.lines or (0,) * len(file.cases)
    decisions = [exact.decide(case.pair.lengths) for case in file.cases]
    flags = flags_of([case.row for case in file.cases], decisions) if file.cases else []
    faults = []
    for line, case, truth, computed in zip(lines, file.cases, decisions, flags, strict=True):
        faults += [Fault(line, case.id, sentence) for sentence in _sentences(case, truth, computed)]
        advance(1)
    return faults


def faults_of_refusals(file: RefusalFile) -> list[Fault]:
    """Every row that is valid, or refused for other columns than the file says."""
    faults = []
    for line, case in zip(file.lines or (0,) * len(file.cases), file.cases, strict=True):
        found = columns_at_fault(case.row)
        if found != case.columns:
            said = f"columns {', '.join(case.columns)} are said to be at fault"
            faults.append(Fault(line, case.id, f"{said}, but {', '.join(found) or 'none'} is"))
    return faults


def _sentences(case: Vector, truth: Decision, flags: Sequence[str]) -> Iterator[str]:
    pair = case.pair
    yield from _unproved(case, pair)
    kind = classify_by_roots(pair).kind
    if kind is not case.kind:
        yield f"kind is {case.kind.value}; the roots say {kind.value}"
    measured = nearest(pair)
    if measured.clearance != case.clearance:
        yield f"clearance is {decimal_of(case.clearance)}; the nearest point says {decimal_of(measured.clearance)}"
    if (truth.position, truth.tangent) != (case.position, case.tangent):
        return  # its flips are to other positions
    for position, distance in flips(pair.lengths, truth).items():
        if distance != case.flips[position]:
            yield f"the flip to {position.label} is {decimal_of(case.flips[position])}; it is {decimal_of(distance)}"
    if set(flags) != set(case.flags):
        yield f"flags are {_names(case.flags)}; they are {_names(flags)}"


def _unproved(case: Vector, pair: Pair) -> Iterator[str]:
    """What the certificate does not prove of position and tangency."""
    claim = f"{case.position.label}, tangent" if case.tangent else case.position.label
    if not check_certificate(pair, case.witness.certificate(pair, case.position)):
        yield f"the certificate does not prove {claim}"
    elif case.tangent != (case.position is Position.CONTACT and case.witness.double_root is not None):
        yield f"the certificate is not one of a pair that is {claim}"
    elif case.position is Position.CONTACT and not case.tangent and not shows_crossing(pair, case.witness.offsets):
        yield "the certificate proves contact, but does not rule tangency out"


def _names(flags: Sequence[str]) -> str:
    return ", ".join(flags) or "none"
