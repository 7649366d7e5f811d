"""`hypcheck derive` and `hypcheck simulate`: the paper's derivation and claims, and its two applications."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hypcheck.cli import options
from hypcheck.cli.commands import CommandGroup
from hypcheck.cli.running import watched
from hypcheck.errors import Exit, InputError
from hypcheck.messages import printable
from hypcheck.paper.derive import FORMATS, PARTS

if TYPE_CHECKING:
    from hypcheck.scene.model import SceneModel


_HELP = """Show the derivation step by step, the proofs of the propositions, and a verdict on each claim of the paper.

sympy derives everything while it is printed: formulas are compared with what follows from the two surfaces, and
counterexamples are found among small rational pairs and proved by certificates.

\b
hypcheck derive
hypcheck derive --only ledger
hypcheck derive --claim "Proposition 3"
hypcheck derive --format latex --output derivation.tex
hypcheck derive --format erratum --output erratum.tex

Ends with 0 if everything shown holds, with 6 if the derivation disagrees with a result that it should show.
"""


@click.command(help=_HELP, short_help="Show the derivation and the ledger of the paper's claims, checked.")
@click.option("--format", "form", type=click.Choice(tuple(FORMATS)), default="text", show_default=True)
@click.option("--only", multiple=True, type=click.Choice(tuple(PARTS)), help="A part; several may be given.")
@click.option("--claim", metavar="NUMBER", help="One claim in full: 12, A.2b, 'Remark 4', 'Table 2', 'Proposition 5'.")
@click.option(
    "--output", default="-", show_default=True, metavar="FILE", help="The file to write, complete or not at all."
)
@click.pass_context
def derive(context: click.Context, /, form: str, only: tuple[str, ...], claim: str | None, output: str) -> None:
    """Derive, and print the results."""
    if claim is not None and only:
        raise InputError("--claim shows one claim, and --only parts of all; use one of them")
    if form == "erratum" and (claim is not None or only):
        raise InputError("--format erratum writes one whole note; it takes neither --claim nor --only")
    from hypcheck.paper.derive import erratum
    from hypcheck.paper.derive.content import Selection
    from hypcheck.paper.derive.formats import WRITERS

    chosen = Selection(() if claim is not None else only or tuple(PARTS), claim)
    _write(WRITERS[form](chosen), output)
    if form == "erratum" and output != "-":
        click.echo(erratum.compile_note(Path(output)), err=True)
    failing = chosen.failing
    if failing:
        click.echo(
            f"hypcheck: the derivation disagrees with results that it should show: {', '.join(failing)}", err=True
        )
    context.exit(Exit.ORACLES_DISAGREE if failing else Exit.HELD)


def _write(lines: Iterable[str], output: str) -> None:
    """Write lines to standard output as they come, or to a file that appears when it is complete."""
    if output == "-":
        for line in lines:
            click.echo(line)
        return
    from hypcheck.tables.streams import replace_output

    with replace_output(output) as file:
        for line in lines:
            file.write(f"{line}\n".encode())


OUT = click.option("--out", type=options.OutputPath(), help="A folder for the JSON and the pictures.")
CONTINUOUS = click.option("--continuous", is_flag=True, help="Also decide exactly what happens between the positions.")
ENDS = click.option(
    "--ends", is_flag=True, help="Also decide exactly beside what ends, not by the centre's height alone."
)
SHOW = click.option("--show-scene", is_flag=True, help="Print the file of a shipped scene, for you to change, and end.")

common = options.with_options(options.SEED, CONTINUOUS, ENDS, OUT, options.FORMAT, SHOW)
"""A decorator that gives a command the options that both simulations have."""


@click.group(
    cls=CommandGroup, short_help="Simulate the paper's two applications: a walker among trees, a quadcopter in a tower."
)
def simulate() -> None:
    """Simulate the two applications of the paper, with every assumption in a scene file (docs/simulate.md).

    They are the walker among trees of section 3.1 and the quadcopter in a cooling tower of sections 3.2 and 4.
    """


@simulate.command(short_help="A walker among many trees, by Procedure 1 in float32.")
@click.option(
    "--scene",
    "name",
    type=options.SCENE,
    default="forest",
    show_default=True,
    help="A scene file, or a shipped scene.",
)
@click.option("--steps", type=options.IntegerOption(0), help="Steps to try.  [default: the scene's]")
@common
def forest(name: str, steps: int | None, seed: int, out: Path | None, form: str, **flags: bool) -> None:
    """A walker among trees of both types (section 3.1), by Procedure 1 with the values that Table 2 precomputes.

    The walker obeys the procedure in float32. Shown are the evaluations that a line makes needless, and phantom
    contacts: places far from any tree where the procedure stops the walker nevertheless.
    """
    if flags["show_scene"]:
        _show(name)
        return
    from hypcheck.paper.forest import ForestPlan, simulate_forest
    from hypcheck.paper.simulation_text import forest_lines

    plan = ForestPlan(_scene(name), seed, steps, flags["continuous"], flags["ends"])
    with _ready_folder("forest", out), watched(plan.count, "steps") as pace:
        result = simulate_forest(plan, pace.advance)
    _deliver(result, form, forest_lines(result), out)


@simulate.command(short_help="A quadcopter in a cooling tower, by Procedures 2.a and 2.b; Table 5 reproduced.")
@click.option(
    "--scene",
    "name",
    type=options.SCENE,
    default="tower",
    show_default=True,
    help="A scene file, or tower-simplest.",
)
@click.option("--table", type=click.Choice(["5"]), help="Reproduce the paper's Table 5.")
@click.option(
    "--runs", type=options.IntegerOption(1, 1_000_000), help="Runs of each cell of the table.  [default: 1000]"
)
@click.option(
    "--speed",
    type=options.NumberOption(1e-6, 1e6),
    default=5.0,
    show_default=True,
    help="Speed of the flights in the figure, m/s.",
)
@click.option(
    "--time",
    type=options.NumberOption(1e-6, 1e6),
    default=0.2,
    show_default=True,
    help="Response time of these flights, s.",
)
@click.option(
    "--pitch",
    type=options.NumberOption(0, 90),
    metavar="DEGREES",
    help="Fly the table with a quadcopter tilted by this angle into its movement, and count the wrong answers.",
)
@options.workers("Processes for the table.  [default: one a processor]")
@common
def tower(
    name: str,
    table: str | None,
    runs: int | None,
    speed: float,
    time: float,
    pitch: float | None,
    workers: int | None,
    seed: int,
    out: Path | None,
    form: str,
    **flags: bool,
) -> None:
    """A quadcopter in a cooling tower (sections 3.2 and 4), by Procedures 2.a and 2.b.

    Three flights of 25 positions, as in the paper's Figure 4. With --table 5 also the executions with Δ ≤ 0 for each
    speed and response time, with standard errors, beside the printed figures. With --pitch the same flights are asked
    about a tilted quadcopter: how often the upright model's answer is wrong, and how often that is dangerous. The
    same seed gives the same result, whatever the number of workers.
    """
    if flags["show_scene"]:
        _show(name)
        return
    from hypcheck.paper.simulation_text import tower_lines
    from hypcheck.paper.tower import ExactQuestions, TowerPlan, simulate_tower
    from hypcheck.processes import processes, usable_processors

    flown = table is not None or pitch is not None
    if runs is not None and not flown:
        raise InputError("--runs is for the table; it needs --table 5 or --pitch")
    flights = (1000 if runs is None else runs) if flown else 0
    plan = TowerPlan(
        _scene(name), seed, speed, time, flights, ExactQuestions(flags["continuous"], pitch, flags["ends"])
    )
    moves = [block.moves for blocks in plan.blocks().values() for block in blocks]
    count = min(workers or usable_processors(), len(moves))
    with _ready_folder("tower", out), processes(count) as executor, watched(sum(moves), "flights") as pace:
        result = simulate_tower(plan, executor, pace.advance)
    _deliver(result, form, tower_lines(result), out)


def _scene(name: str) -> SceneModel:
    from hypcheck.scene.reading import read_scene

    return read_scene(name)


def _show(name: str) -> None:
    """Print the file of a shipped scene. Raises InputError if there is none of this name."""
    from hypcheck.scene.reading import shipped_scenes, shipped_text

    if name not in shipped_scenes():
        raise InputError(f"--show-scene: {name!r} is not a shipped scene; there are {', '.join(shipped_scenes())}")
    click.echo(shipped_text(name), nl=False)


def _ready_folder(kind: str, out: Path | None) -> AbstractContextManager[None]:
    """Return a context that makes the folder `out` before anything is simulated; it does nothing if `out` is None."""
    if out is None:
        return nullcontext()
    from hypcheck.report.write import ready_for

    return ready_for(kind, out)


def _deliver(result: dict[str, Any], form: str, lines: Iterable[str], out: Path | None) -> None:
    """Write the files, then print the result; the names of the files go to standard error."""
    import json

    written = []
    if out is not None:
        from hypcheck.report.write import write_simulation

        written = write_simulation(result, out)
    for line in [json.dumps(result)] if form == "json" else lines:
        click.echo(printable(line))
    for line in written:
        click.echo(printable(line), err=True)
