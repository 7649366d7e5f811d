"""`hypcheck simulate`: the paper's two applications. Options into a plan, the result as text or JSON, and pictures."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from hypcheck.cli.groups import Group
from hypcheck.cli.options import Number, Place
from hypcheck.cli.progress import watched
from hypcheck.cli.whole import LARGEST_SEED, MOST_PROCESSES, Whole
from hypcheck.errors import InputError
from hypcheck.visible import printable

if TYPE_CHECKING:
    from hypcheck.scene.model import Scene

Command = TypeVar("Command", bound=Callable[..., Any])

SEED = click.option("--seed", type=Whole(0, LARGEST_SEED), default=1, show_default=True)
OUT = click.option("--out", type=Place(), help="A folder for the JSON and the pictures.")
CONTINUOUS = click.option("--continuous", is_flag=True, help="Decide exactly what happens between the positions too.")
FORMAT = click.option(
    "--format", "form", type=click.Choice(["text", "json"]), default="text", show_default=True, help="To the terminal."
)
SHOW = click.option("--show-scene", is_flag=True, help="Print a shipped scene's file, to be changed, and end.")


def common(command: Command) -> Command:
    """The options that both simulations have."""
    for option in (SHOW, FORMAT, OUT, CONTINUOUS, SEED):
        command = option(command)
    return command


@click.group(cls=Group, short_help="The paper's two applications: a walker among trees, a quadcopter in a tower.")
def simulate() -> None:
    """Simulate the two applications of the paper, with every assumption in a scene file (docs/simulate.md).

    They are the walker among trees of section 3.1 and the quadcopter in a cooling tower of sections 3.2 and 4.
    """


@simulate.command(short_help="A walker among many trees, by Procedure 1 in float32.")
@click.option("--scene", "name", default="forest", show_default=True, help="A scene file, or a shipped scene.")
@click.option("--steps", type=Whole(0), help="Steps to try.  [default: as the scene says]")
@common
def forest(name: str, steps: int | None, seed: int, out: Path | None, form: str, **flags: bool) -> None:
    """A walker among trees of both types (section 3.1), by Procedure 1 with what Table 2 takes out of the loop.

    She obeys the procedure in float32. Told are the evaluations that a line makes needless, and the phantom contacts:
    places far from any tree where the procedure stops her all the same.
    """
    if flags["show_scene"]:
        _show(name)
        return
    from hypcheck.paper.forest import ForestPlan, simulate_forest
    from hypcheck.paper.forest_text import forest_lines

    plan = ForestPlan(_scene(name), seed, steps, flags["continuous"])
    length = plan.count
    _make_ready("forest", out)
    with watched(length, "steps") as pace:
        result = simulate_forest(plan, pace.advance)
    _deliver(result, form, forest_lines(result), out)


@simulate.command(short_help="A quadcopter in a cooling tower, by Procedures 2.a and 2.b; Table 5 again.")
@click.option("--scene", "name", default="tower", show_default=True, help="A scene file, or tower-simplest.")
@click.option("--table", type=click.Choice(["5"]), help="Make the paper's Table 5 again.")
@click.option("--runs", type=Whole(1, 1_000_000), help="Runs of each cell of the table.  [default: 1000]")
@click.option(
    "--speed", type=Number(1e-6, 1e6), default=5.0, show_default=True, help="Of the flights in the figure, m/s."
)
@click.option("--time", type=Number(1e-6, 1e6), default=0.2, show_default=True, help="Their response time, s.")
@click.option("--workers", type=Whole(1, MOST_PROCESSES), help="Processes for the table.  [default: one a processor]")
@common
def tower(
    name: str,
    table: str | None,
    runs: int | None,
    speed: float,
    time: float,
    workers: int | None,
    seed: int,
    out: Path | None,
    form: str,
    **flags: bool,
) -> None:
    """A quadcopter in a cooling tower (sections 3.2 and 4), by Procedures 2.a and 2.b.

    Three flights of 25 positions, as in the paper's Figure 4. With --table 5 also the executions with Δ ≤ 0 for each
    speed and response time, with standard errors, beside the printed figures. The same seed gives the same result,
    whatever the number of workers.
    """
    if flags["show_scene"]:
        _show(name)
        return
    from hypcheck.paper.tower import TowerPlan, simulate_tower
    from hypcheck.paper.tower_text import tower_lines
    from hypcheck.processes import processes, usable_processors

    if runs is not None and table is None:
        raise InputError("--runs is of the table; it needs --table 5")
    each = (1000 if runs is None else runs) if table is not None else 0
    plan = TowerPlan(_scene(name), seed, speed, time, each, flags["continuous"])
    moves = [block.moves for blocks in plan.blocks().values() for block in blocks]
    _make_ready("tower", out)
    count = min(workers or usable_processors(), len(moves))
    with processes(count) as executor, watched(sum(moves), "flights") as pace:
        result = simulate_tower(plan, executor, pace.advance)
    _deliver(result, form, tower_lines(result), out)


def _scene(name: str) -> Scene:
    from hypcheck.scene.reading import read_scene

    return read_scene(name)


def _show(name: str) -> None:
    from hypcheck.scene.reading import shipped_scenes, shipped_text

    if name not in shipped_scenes():
        raise InputError(f"--show-scene: {name!r} is no shipped scene; there are {', '.join(shipped_scenes())}")
    click.echo(shipped_text(name), nl=False)


def _make_ready(kind: str, out: Path | None) -> None:
    """See that the folder for the files can take them, before anything is simulated."""
    if out is not None:
        from hypcheck.report.simulation.writing import make_ready

        make_ready(kind, out)


def _deliver(result: dict[str, Any], form: str, lines: Iterable[str], out: Path | None) -> None:
    """The files first, then the result; what was written goes to standard error, beside it."""
    import json

    written = []
    if out is not None:
        from hypcheck.report.simulation.writing import write_simulation

        written = write_simulation(result, out)
    for line in [json.dumps(result)] if form == "json" else lines:
        click.echo(printable(line))
    for line in written:
        click.echo(printable(line), err=True)
