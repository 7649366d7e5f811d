"""`python -m tests.tools.fuzz`: damaged input for every reader; ends with 1 if a reader ends in a wrong way."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

import click

from tests.tools.fuzz.judging import judged, stop_hangs
from tests.tools.fuzz.readers import READERS
from tests.tools.fuzz.running import GROWTH, Tally, input_of, run
from tests.tools.progress_line import progress_line

KEPT = Path("reports/fuzz")
"""Where the inputs go that end as none may; what is fixed is kept in tests/tools/fuzz/corpus."""


@click.command(context_settings={"show_default": True})
@click.argument("names", metavar="[READER]...", nargs=-1, type=click.Choice(list(READERS)))
@click.option("--count", type=click.IntRange(1), default=20_000, help="Inputs over all readers.")
@click.option("--seed", type=int, default=1)
@click.option("--processes", type=click.IntRange(1), default=os.cpu_count() or 1)
@click.option("--number", type=int, help="Read this one input of one READER, and say what becomes of it.")
def main(names: tuple[str, ...], count: int, seed: int, processes: int, number: int | None) -> None:
    """Mutate real input and read it: each must end as a value or as one sentence, in time and in little memory."""
    if number is not None:
        one(names, seed, number)
        return
    before = time.monotonic()
    tally = run(count, seed, names or tuple(READERS), processes, progress_line(_stands))
    for line in lines(tally, time.monotonic() - before, processes):
        click.echo(line)
    sys.exit(1 if tally.failed else 0)


def one(names: tuple[str, ...], seed: int, number: int) -> None:
    """One input again."""
    if len(names) != 1:
        raise click.UsageError("--number needs one READER")
    stop_hangs()
    data = input_of(names[0], seed, number)
    click.echo(repr(data[:2000]))
    click.echo(judged(READERS[names[0]].read, data, READERS[names[0]].seconds))


def lines(tally: Tally, seconds: float, processes: int):
    """What is said of a run; every finding is put into a file."""
    yield f"{'reader':15} {'inputs':>9} {'value':>9} {'refused':>9} {'finding':>8} {'µs each':>8}"
    for name, kinds in tally.kinds.items():
        count = sum(kinds.values())
        each = 1e6 * tally.seconds[name] / max(count, 1)
        yield f"{name:15} {count:9} {kinds['value']:9} {kinds['refused']:9} {kinds['finding']:8} {each:8.0f}"
    grown = ", ".join(f"{growth / 2**20:.1f}" for growth in tally.growth)
    yield f"{tally.count} inputs in {seconds:.0f} s by {processes} processes; {len(tally.findings)} findings"
    yield f"resident memory grew by {grown} MiB from first to last (at most {GROWTH >> 20})"
    for finding in tally.findings[:50]:
        path = KEPT / f"{finding.reader}-{finding.number}"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(finding.data)
        yield f"{path}: {finding.says}"


def _stands(tally: Tally) -> str:
    return f"{tally.count:,} inputs, {len(tally.findings)} findings"


if __name__ == "__main__":
    main()
