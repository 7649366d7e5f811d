"""From a SPEC to an implementation that can be asked."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from hypcheck.methods.command import CommandSession
from hypcheck.methods.description import Description
from hypcheck.methods.domain import Domain
from hypcheck.methods.faults import StartError
from hypcheck.methods.implementation import Implementation
from hypcheck.methods.limits import Limits
from hypcheck.methods.session import Session
from hypcheck.methods.spec import Spec, parse_spec
from hypcheck.methods.worker_session import WorkerSession


def open_implementation(
    text: str,
    limits: Limits | None = None,
    *,
    precision: str | None = None,
    question: str | None = None,
    domain: Domain | None = None,
) -> Implementation:
    """The implementation that a SPEC names, running; `precision`, `question` and `domain` stand for what it declares.

    Raises InputError where the SPEC is none, and StartError where the implementation cannot be started.
    """
    spec = parse_spec(text)
    limits = limits or Limits()

    def start(run: int) -> Session:
        return STARTS[spec.kind](spec, limits, run)

    def instead(declared: Description) -> Description:
        return declared.overridden(precision, question, domain)

    try:
        return Implementation(spec, start, limits, instead)
    except StartError as error:
        raise StartError(f"{spec} could not be started: {error}") from None


def _start_builtin(spec: Spec, limits: Limits, run: int) -> Session:  # noqa: ARG001 - ours, so it is not limited
    from hypcheck.methods.builtin_session import BuiltinSession  # noqa: PLC0415 - loads every formula

    return BuiltinSession(spec.words[0])


def _start_command(spec: Spec, limits: Limits, run: int) -> Session:  # noqa: ARG001 - nothing varies between runs
    return CommandSession(spec.words, limits)


STARTS: Mapping[str, Callable[[Spec, Limits, int], Session]] = MappingProxyType(
    {"builtin": _start_builtin, "python": WorkerSession, "library": WorkerSession, "command": _start_command}
)
"""How each kind of SPEC is started; spec.py says how each is written."""
