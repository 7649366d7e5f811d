"""`python -m tests.tools.processors [NAME]… [--rows N] [--out FILE]`: hypcheck.h on other processors.

Each NAME is a processor; without one all are asked. Ends with 1 where an answer is wrong. FILE is a page with a table;
the processors that were asked get new lines in it.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import click
import numpy as np

from tests.tools.attack import places, tilted_places
from tests.tools.processors import table
from tests.tools.processors.builds import BUILDS, Build, BuildError, packages_for, program
from tests.tools.processors.jobs import Job, Tally, adversarial, ask, clearances, frozen, ways
from tests.tools.processors.measure import cost
from tests.tools.processors.table import Result


@click.command(context_settings={"show_default": True})
@click.argument("names", nargs=-1, type=click.Choice(list(BUILDS)))
@click.option("--rows", type=click.IntRange(0), default=850_000, help="Adversarial rows, about; some more are asked.")
@click.option("--seed", type=int, default=1, help="What is drawn.")
@click.option("--jobs", type=click.IntRange(1), default=os.cpu_count() or 1, help="Processors asked at a time.")
@click.option("--install", is_flag=True, help="Install what is missing by apt-get, as root.")
@click.option("--out", type=click.Path(path_type=Path, dir_okay=False, exists=True), help="The page to change.")
def main(names: tuple[str, ...], rows: int, seed: int, jobs: int, install: bool, out: Path | None) -> None:
    """Compile hypcheck.h for each processor and compare its answers with the truth."""
    builds = [BUILDS[name] for name in names or BUILDS]
    require(builds, install=install)
    started = time.perf_counter()
    asked = [*frozen(), *ways(seed, 20 + rows // 50), *clearances(seed, 20 + rows // 50), *adversarial(seed, rows)]
    failed = False
    for result in results(builds, asked, jobs):
        click.echo(result if isinstance(result, str) else table.told(result))
        failed |= isinstance(result, str) or bool(result.faults)
        if out is not None and not isinstance(result, str):
            out.write_text(table.changed(out.read_text(encoding="utf-8"), result), encoding="utf-8")
    click.echo(f"{time.perf_counter() - started:.0f} s, seed {seed}")
    sys.exit(1 if failed else 0)


def require(builds: list[Build], *, install: bool) -> None:
    """Raises a UsageError with one sentence where a compiler or an emulator is missing, or installs it."""
    missing = packages_for(builds)
    if missing and install:
        apt = shutil.which("apt-get") or "apt-get"
        for command in ([apt, "update"], [apt, "install", "--yes", "--no-install-recommends", *missing]):
            subprocess.run(command, check=False, env={**os.environ, "DEBIAN_FRONTEND": "noninteractive"})
        missing = packages_for(builds)
    if missing:
        lacking = ", ".join(build.name for build in builds if build.missing)
        packages = " ".join(missing)
        raise click.UsageError(
            f"{lacking} cannot be built or run here; as root: apt-get install --no-install-recommends {packages}"
        )


def results(builds: list[Build], jobs: list[Job], at_a_time: int) -> Iterator[Result | str]:
    """The results in order, or what failed, as they come."""
    random = np.random.default_rng(1)
    deep = np.vstack([places.near_contact(random, 500), places.far(random, 500), *_extreme(7)])
    leaning = np.vstack(
        [tilted_places.near_contact(random, 200), tilted_places.at_the_limits(random, 200), *_extreme(10)]
    )
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(at_a_time) as pool:
        yield from pool.map(lambda build: result(build, jobs, (deep, leaning), Path(folder)), builds)


def _extreme(width: int) -> list[np.ndarray]:
    """The rows of the frozen vectors of extreme families, whose integers are longest."""
    return [job.numbers for job in frozen() if job.kind == ("rows" if width == 7 else "leaning rows")]


def result(build: Build, jobs: list[Job], deep: tuple[np.ndarray, np.ndarray], folder: Path) -> Result | str:
    """One processor compiled, asked and measured; what failed, in words, where it could not be."""
    try:
        built = program(build, folder)
        tallies: dict[str, Tally] = {level: ask(build, built, jobs, level, folder) for level in build.levels}
        return Result(build, tallies, cost(build, built, *deep, folder))
    except (BuildError, ValueError) as error:
        return f"{build.name}: {error}"


if __name__ == "__main__":
    main()
