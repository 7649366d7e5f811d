"""What the gate must say of an implementation: declared where the implementation stands, by a decorator."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

Options = tuple[str, ...]
Function = Callable[[Any], Any]

NO_TOLERANCE = ("--tolerance", "0")
EXTREME = ("--families", "extreme")


@dataclass(frozen=True, slots=True)
class Expectation:
    """`right`: it must pass, else it must be rejected.

    `claim` are options of `hypcheck verify` that say what it claims (precision, question, domain); they are always
    given. `asked` are those that ask more of it than the default options do; a wrong one that has them passes without,
    unless it is a matter of `luck`, when nothing is expected there.
    """

    right: bool
    claim: Options = ()
    asked: Options = ()
    luck: bool = False


def wrong(*, claim: Options = (), asked: Options = (), luck: bool = False) -> Callable[[Function], Function]:
    """Declares that the gate must reject the function; where more must be asked for that, that it passes without."""
    return _declares(Expectation(right=False, claim=claim, asked=asked, luck=luck))


def right(*, claim: Options = (), asked: Options = ()) -> Callable[[Function], Function]:
    """Declares that the gate must pass the function."""
    return _declares(Expectation(right=True, claim=claim, asked=asked))


def expectation_of(function: Function) -> Expectation | None:
    """What was declared of the function, or None."""
    return getattr(function, "expectation", None)


def _declares(expectation: Expectation) -> Callable[[Function], Function]:
    def declare(function: Function) -> Function:
        function.expectation = expectation  # type: ignore[attr-defined]
        return function

    return declare
