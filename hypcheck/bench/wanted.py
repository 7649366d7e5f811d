"""What the kernels must reach: the targets and the forms of calls that targets.toml lists."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hypcheck import toml
from hypcheck.record.measurements import KernelLine
from hypcheck.runs.timing import estimate

Form = tuple[str, float]
"""A statement that calls, and how many times as long as the first of its table it may take."""


@dataclass(frozen=True, slots=True)
class KernelTarget:
    """A target: `wanted` is a least number, or a greatest one if `at_most`; `text` describes it.

    What is measured is a ratio to a ceiling, work that nothing here can do without, timed beside it in the same rounds:
    so it depends on the code, and as little as can be on the machine and on what else runs there.
    """

    name: str
    text: str
    wanted: float
    at_most: bool = False

    def line(self, measured: list[float], says: str) -> KernelLine:
        """The record's line: the median over rounds, with its 95 % interval. A miss is one of the whole interval."""
        ratio = estimate([measured])
        met = ratio.low <= self.wanted if self.at_most else ratio.high >= self.wanted
        return KernelLine(
            name=self.name,
            target=self.text,
            wanted=self.wanted,
            measured=ratio.median,
            ci95=(ratio.low, ratio.high),
            met=met,
            says=says,
        )


def _listed() -> dict[str, Any]:
    return toml.shipped("hypcheck.bench", "targets.toml")


def target(name: str) -> KernelTarget:
    """The target of that name, which must be listed."""
    entry = _listed()["targets"][name]
    at_most = "at_most" in entry
    return KernelTarget(name, entry["text"], entry["at_most" if at_most else "at_least"], at_most)


def forms(call: str) -> Mapping[str, Form]:
    """The forms in which a call may be written, by name; the first is the cheapest."""
    return {name: (text, times) for name, (text, times) in _listed()["forms"][call].items()}
