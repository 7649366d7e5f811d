"""`python -m tests.tools.soak`: verify against flaky implementations for ten minutes; ends with 1 if anything grows."""

from __future__ import annotations

import sys
import time

import click

from tests.tools.progress_line import progress_line
from tests.tools.soak.measuring import Sample, growth
from tests.tools.soak.running import Course, run


@click.command(context_settings={"show_default": True})
@click.option("--seconds", type=float, default=600.0)
@click.option("--seed", type=int, default=1)
def main(seconds: float, seed: int) -> None:
    """Gate implementations that crash, hang, drip and garble, again and again, and look at what this process holds."""
    before = time.monotonic()
    course = run(seconds, seed, after=progress_line(_stands))
    for line in lines(course, time.monotonic() - before):
        click.echo(line)
    sys.exit(1 if course.faults else 0)


def lines(course: Course, seconds: float):
    """What is said of a course."""
    yield f"{course.rounds} rounds of verify in {seconds:.0f} s; ended with {dict(sorted(course.codes.items()))}"
    yield "cases: " + ", ".join(f"{count:,} {status}" for status, count in sorted(course.statuses.items()) if count)
    yield from (f"not started: {reason}" for reason in course.not_started[:5])
    marks = sorted({0, *(len(course.samples) * part // 4 for part in (1, 2, 3)), len(course.samples) - 1})
    yield "round    resident MiB  handles  threads  children"
    for number in marks:
        yield f"{number:5}  {_shown(course.samples[number])}"
    kept = course.samples[len(course.samples) // 4 :]
    if len(kept) > 1:
        yield f"memory after warming up: {growth([each.resident for each in kept]) / 1024:+.1f} KiB a round"
    yield from course.faults or ["nothing grew, and nothing was left"]


def _shown(held: Sample) -> str:
    return f"{held.resident / 2**20:14.1f} {held.handles:8} {held.threads:8} {held.children:9}"


def _stands(course: Course) -> str:
    return f"{course.rounds} rounds, {len(course.troubles)} troubles"


if __name__ == "__main__":
    main()
