"""`python -m tests.tools.pace`: the speed of `verify` for short and for long runs; ends with 1 if it varies."""

from __future__ import annotations

import contextlib
import io
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import click

from hypcheck.cli.main import main as hypcheck
from hypcheck.cli.options import IntegerOption
from hypcheck.errors import RunOutcome
from hypcheck.record import Recorder
from hypcheck.runs.conformance import run_conformance
from hypcheck.runs.plan import ConformancePlan
from hypcheck.runs.retest import PARTS
from tests.support.records import GrowingText

FAMILY = "tower-body"
SPREAD = 0.15
"""By which part of the fastest pace the slowest may stay behind it."""

HEAD = "         rows  runs processes    start  behind it     rest  rows a second each"

BUILD = ("cc", "-std=c11", "-O2", "-ffp-contract=off", "-o")


@dataclass(frozen=True, slots=True)
class Pace:
    """A run of so many rows, and its seconds: until the first ones were judged, for all behind them, and for the rest.

    The rest is what is asked once a run, whatever its count, where that came last.
    """

    rows: int
    start: float
    behind: int
    seconds: float
    rest: float
    workers: int

    @property
    def each(self) -> float:
        """Rows a second and process, apart from the start and from what is asked once a run."""
        return self.behind / self.seconds / self.workers


@click.command(context_settings={"show_default": True})
@click.argument("counts", nargs=-1, type=IntegerOption(10**6))
@click.option(
    "--workers", type=IntegerOption(1, 64), help="Processes that ask.  [default: as verify has it, by the count]"
)
@click.option("--seconds", type=float, default=10.0, help="A run is made again until so many have passed.")
def main(counts: tuple[int, ...], workers: int | None, seconds: float) -> None:
    """Time verify of a C program asked in binary, with so many rows (by default 1e6 1e7 1e8 1e9)."""
    with tempfile.TemporaryDirectory() as folder:
        spec = f"command:{_adapter(Path(folder))}"
        asked = counts or (10**6, 10**7, 10**8, 10**9)
        found: dict[int, list[Pace]] = {count: [] for count in asked}
        for count in (*asked, *reversed(asked)):  # a machine has its own quicker and slower minutes
            if sum(pace.seconds for pace in found[count]) < seconds:
                found[count] += _repeated(spec, count, workers, seconds / 2)
    click.echo(HEAD)
    for count, some in found.items():
        middle = sorted(some, key=lambda pace: pace.each)[len(some) // 2]
        times = f"{middle.start:6.2f} s {middle.seconds:8.2f} s {middle.rest:6.2f} s"
        click.echo(f"{count:13,} {len(some):5} {middle.workers:9} {times} {middle.each:19,.0f}")
    paces = [median(pace.each for pace in some) for some in found.values()]
    behind = 1 - min(paces) / max(paces)
    click.echo(f"the slowest is {behind:.0%} behind the fastest (at most {SPREAD:.0%})")
    sys.exit(1 if behind > SPREAD else 0)


def _adapter(folder: Path) -> Path:
    """The adapter for C with its stub, compiled."""
    with contextlib.redirect_stdout(io.StringIO()):
        hypcheck(["init", "--language", "c", "--directory", str(folder)])
    sources = [str(folder / "hypcheck-c" / name) for name in ("adapter.c", "predicate.c")]
    subprocess.run([*BUILD, str(folder / "adapter"), *sources], check=True)
    return folder / "adapter"


def _repeated(spec: str, count: int, workers: int | None, seconds: float):
    until = time.perf_counter() + seconds
    yield _timed(spec, count, workers)
    while time.perf_counter() < until:
        yield _timed(spec, count, workers)


def _timed(spec: str, count: int, workers: int | None) -> Pace:
    """A run; it has begun once each process has had time to judge its first chunk.

    The last part of the first round, which asks what is asked once a run, is the last step of a run of one round: all
    processes but one are idle by then, and it takes no longer for more rows.
    """
    marks: list[tuple[float, int]] = []
    plan = ConformancePlan((spec,), families=(FAMILY,), count=count, workers=workers)
    begun = time.perf_counter()
    run_conformance(
        plan, Recorder(GrowingText(), {}), RunOutcome(), lambda rows: marks.append((time.perf_counter(), rows))
    )
    asking = plan.pool_workers or 1
    first = 1 if asking == 1 else 2 * asking
    behind = sum(rows for _, rows in marks[first + 1 :])
    last = -2 if sum(1 for _, rows in marks if not rows) <= PARTS else -1
    times = marks[last][0] - marks[first][0], marks[-1][0] - marks[last][0]
    return Pace(count, marks[first][0] - begun, behind, *times, asking)


if __name__ == "__main__":
    main()
