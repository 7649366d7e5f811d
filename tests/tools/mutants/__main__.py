"""`python -m tests.tools.mutants [NAME]… [--out FILE]`: gate all, report each, end with 1 where one escaped.

NAME is an implementation (signs.c0) or a module (signs); FILE becomes the page of all of them, and
their data is written beside it.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import click

from tests.tools.mutants import table
from tests.tools.mutants.collection import Mutant, mutants
from tests.tools.mutants.gating import Result, gate


@click.command(context_settings={"show_default": True})
@click.argument("names", nargs=-1)
@click.option("--out", type=click.Path(path_type=Path, dir_okay=False), help="The page to write, of all of them.")
@click.option("--jobs", type=click.IntRange(1), default=os.cpu_count() or 1, help="Implementations gated at a time.")
def main(names: tuple[str, ...], out: Path | None, jobs: int) -> None:
    """Gate the wrong and the right implementations, or those named, and say what became of each."""
    if names and out is not None:
        raise click.UsageError("--out is the page of all implementations; leave the names out")
    results = []
    for result in gated(chosen(names), jobs):
        results.append(result)
        click.echo(line(result))
    if out is not None:
        pages = {out: table.render, out.with_name(table.RULINGS): table.rulings}
        for path, text in {**pages, out.with_name(table.REJECTIONS): table.rejections}.items():
            path.write_text(text(results), encoding="utf-8")
    amiss = [result for result in results if not result.as_expected]
    click.echo(f"{len(results)} gated, {len(amiss)} not judged as they must be")
    for result in amiss:
        click.echo(f"\n{line(result)}\n  {result.mutant.sentence}\n{result.ruling.said}")
    sys.exit(1 if amiss else 0)


def chosen(names: Iterable[str]) -> list[Mutant]:
    """The mutants of these names and modules; all where there are none."""
    everything, wanted = mutants(), set(names)
    unknown = wanted - {name for mutant in everything for name in (mutant.name, mutant.module)}
    if unknown:
        raise click.UsageError(f"there is no implementation or module {', '.join(sorted(unknown))}")
    return [mutant for mutant in everything if not wanted or {mutant.name, mutant.module} & wanted]


def gated(some: list[Mutant], jobs: int) -> Iterator[Result]:
    """Their results, in order, as they come."""
    with ProcessPoolExecutor(min(jobs, max(len(some), 1))) as pool:
        yield from pool.map(gate, some)


def line(result: Result) -> str:
    """One result in a line."""
    killed_by = result.ruling.killed_by
    most = sorted(killed_by, key=lambda family: -killed_by[family])[:4]
    by = f"{sum(killed_by.values()):6,} cases of {len(killed_by)} families: " if killed_by else ""
    named = ", ".join(f"{family} {killed_by[family]}" for family in most)
    more = ", …" if len(killed_by) > len(most) else ""
    without = f", {result.without.verdict} without the options" if result.without else ""
    verdict = f"{result.ruling.verdict}{without}"
    return f"{'✓' if result.as_expected else '✗'} {result.mutant.name:48} {verdict:10} {by}{named}{more}".rstrip()


if __name__ == "__main__":
    main()
