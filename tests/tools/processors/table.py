"""The table of processors: what was asked of each, what was wrong, and what the header costs there."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from tests.tools.processors.builds import Build
from tests.tools.processors.jobs import Tally
from tests.tools.processors.measure import PARTS, Cost

HEAD = (
    "processor",
    "compiled by",
    "answers",
    "wrong",
    *(f"-Os, {part}" for part in PARTS),
    "stack, upright",
    "stack, leaning",
    "asks for",
)


@dataclass(frozen=True)
class Result:
    """What became of a processor: answers by level, and what the header costs."""

    build: Build
    tallies: dict[str, Tally]
    cost: Cost

    @property
    def asked(self) -> Counter[str]:
        """Answers by stratum, of all levels."""
        return sum((tally.asked for tally in self.tallies.values()), Counter())

    @property
    def faults(self) -> list[str]:
        """What is not as it must be, in sentences."""
        found = [f"{self.build.name}, {level}: {row}" for level, tally in self.tallies.items() for row in tally.rows]
        found += [f"{self.build.name}: the object asks for {name}" for name in self.cost.foreign]
        return found + [f"{self.build.name}: {sentence}" for sentence in self.cost.too_deep]


def told(result: Result) -> str:
    """A result in a few lines: all strata, and what is wrong."""
    lines = [row(result)]
    for level, tally in result.tallies.items():
        counts = (f"{name} {count:,} ({tally.wrong[name]} wrong)" for name, count in tally.asked.items())
        lines.append(f"    {level}: {', '.join(counts)}")
    return "\n".join((*lines, *result.faults[:10]))


def row(result: Result) -> str:
    """A result as a line of the table."""
    build, cost = result.build, result.cost
    flags = " ".join(flag for flag in build.flags if not flag.startswith("-I") and flag != "-DBARE")
    levels = ", ".join(level for level in build.levels if level != "plain")
    wrong = sum(sum(tally.wrong.values()) for tally in result.tallies.values())
    cells = (
        f"{build.name}: {build.title}" + (f" ({levels} and plain)" if levels else ""),
        f"`{build.compiler} {flags}`",
        f"{sum(result.asked.values()):,}",
        f"{wrong:,}",
        *(f"{size:,}" for size in cost.sizes.values()),
        *_stacks(cost),
        ", ".join(f"`{name}`" for name in cost.symbols),
    )
    return f"| {' | '.join(cells)} |"


def _stacks(cost: Cost) -> Iterator[str]:
    for place, used in enumerate(cost.used):
        yield f"{used:,}" + (f" (≤ {cost.bounds[place]:,})" if cost.bounds else "")


def changed(page: str, result: Result) -> str:
    """The page with the line of this processor instead of the one that it has, or after the others."""
    head = f"| {' | '.join(HEAD)} |\n|{'---|' * len(HEAD)}\n"
    start, end = "<!-- processors -->\n", "<!-- end of processors -->"
    before, _, rest = page.partition(start)
    inside, _, after = rest.partition(end)
    lines = [line for line in inside.splitlines()[2:] if line]
    name = re.escape(result.build.name)
    others = [line for line in lines if not re.match(rf"\| {name}:", line)]
    place = next((k for k, line in enumerate(lines) if line not in others), len(others))
    others.insert(place, row(result))
    return f"{before}{start}{head}" + "\n".join(others) + f"\n{end}{after}"
