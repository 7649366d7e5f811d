"""Commands about a scene: `plan` and `emit`, `flight` and `show`.

What the scene needs, and a kernel that contains only that; what happens on a flight through it, in words and as a
picture.
"""

from __future__ import annotations

import json
import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hypcheck.cli import options
from hypcheck.errors import InputError
from hypcheck.messages import printable

if TYPE_CHECKING:
    from collections.abc import Iterator

    from hypcheck.kernel.scene import Scene
    from hypcheck.kernel.specialise.plan import ScenePlan
    from hypcheck.scene.model import SceneModel
    from hypcheck.tables.csv_table import FlightTable

_PLAN_HELP = """Show which computations SCENE needs, which are left out, why that is allowed, and what it saves.

SCENE is a file (docs/scenes.md) or a shipped scene; `hypcheck emit` writes the kernel that the plan describes.

\b
hypcheck plan tower
hypcheck plan forest.toml --precision float32 --json
hypcheck plan tower --measure
"""


@click.command(help=_PLAN_HELP, short_help="Show what a scene needs, and what can be left out.")
@click.argument("scene", metavar="SCENE", type=options.SCENE)
@click.option("--precision", default="float64", show_default=True, metavar="FORMAT", help="float32 or float64.")
@click.option("--question", metavar="WHAT", help="position, exterior, interior or contact.  [default: the scene's]")
@click.option("--measure", is_flag=True, help="Compile the kernel, and time it beside Table 2 as printed.")
@click.option("--json", "as_json", is_flag=True, help="One JSON object.")
def plan(scene: str, precision: str, question: str | None, measure: bool, as_json: bool) -> None:
    """Plan, and print the plan."""
    from hypcheck.kernel.emission.plan_text import plan_as_json, plan_lines
    from hypcheck.kernel.specialise.plan import plan_of

    plan = plan_of(asked_scene(scene, question), precision)
    times = list(_measured(plan)) if measure else []
    if as_json:
        measured = {"measured": times} if measure else {}
        click.echo(json.dumps(plan_as_json(plan) | measured))
        return
    for text in plan_lines(plan):
        click.echo(printable(text))
    for place, took in enumerate(times, start=1):
        click.echo(printable(f"{place}. {took['says']}"))


def asked_scene(scene: str, question: str | None) -> SceneModel:
    """Return the scene from a file or a shipped scene; `question`, if given, replaces its question.

    Raises InputError.
    """
    from hypcheck.scene.model import QUESTIONS
    from hypcheck.scene.reading import read_scene

    model = read_scene(scene)
    if question is not None:
        if question not in QUESTIONS:
            raise InputError(f"the question is {question!r}; it must be one of {', '.join(QUESTIONS)}")
        model = replace(model, question=question)
    return model


def _measured(plan: ScenePlan) -> Iterator[dict[str, Any]]:
    """Compile and time the kernel of each setting; yield its savings. Raises UnavailableError without a C compiler."""
    from tempfile import TemporaryDirectory

    from hypcheck.bench.scene import kernel_savings

    with TemporaryDirectory(prefix="hypcheck-plan-") as folder:
        yield from kernel_savings(plan, Path(folder))


LANGUAGES = ("c", "cpp", "rust", "javascript", "python")

_EMIT_HELP = """Generate source code: a kernel with only what a scene needs, or a method for one pair of any sizes.

With --method exact the file answers every float64 row rightly: floats where a proved bound allows, whole numbers for
the rest, without dependencies. With --method certified it has only the floats, and answers 2 if they cannot decide; so
do dual and local-maximum, which prove the answer by a concave function instead of the discriminant. With tilted the
spheroid has an axis; clearance also gives bounds of its clearance; passage says whether it has contact on a straight
sweep, and gives a time before which it has none.

SCENE is a file (docs/scenes.md) or a shipped scene. Its sizes and constant heights are folded in, and only its question
is answered; `hypcheck plan` shows what is left out and why. The first comment of the kernel states the proved bounds.

\b
hypcheck emit --scene tower --language c --output kernel.c
hypcheck emit --scene forest.toml --language rust --precision float32 --output kernel.rs
cc -O3 -fPIC -shared kernel.c -lm -o kernel.so && hypcheck verify library:./kernel.so
hypcheck emit --method exact --language c --output pair.c

C, C++ and Rust have the names and the signature that `verify library:` expects; the Python file is for
`python:kernel.py:classify`; the JavaScript module takes the place of predicate.mjs in the adapter of
`hypcheck init --language javascript`.

With --sweeps the file says whether a straight motion of the mover has contact in the whole scene, and gives a time
before which it has none.

With --whole the kernel also has the hyperboloids' places and heights and the mover's parts, in tables of any length,
and one more function: hypcheck_whole(n, x, y, z, heading, answers), in JavaScript and Python whole(x, y, z, heading),
which answers the scene's question for the mover's centre in the scene's coordinates.

Kernels that are linked into one program, or beside hypcheck.h, need different names: with `--prefix tower` the
functions are tower_classify, tower_classify_scene and tower_describe (C, C++, Rust). `verify library:` asks for the
default names.
"""


@click.command(help=_EMIT_HELP, short_help="Generate source code for a scene, or for one pair.")
@click.option(
    "--method",
    metavar="METHOD",
    type=options.Names(options.pair_methods),
    help="Of one pair, without a scene: exact, certified, dual, local-maximum, tilted, clearance or passage.",
)
@click.option("--scene", metavar="SCENE", type=options.SCENE, help="A scene file, or the name of a shipped scene.")
@click.option("--language", required=True, type=click.Choice(LANGUAGES), help="The language of the kernel.")
@click.option("--precision", default="float64", show_default=True, metavar="FORMAT", help="float32 or float64.")
@click.option("--question", metavar="WHAT", help="position, exterior, interior or contact.  [default: the scene's]")
@click.option("--whole", is_flag=True, help="The whole scene: places, heights and parts too, of any number of trees.")
@click.option("--sweeps", is_flag=True, help="The whole scene, asked about straight motions of the mover.")
@click.option("--prefix", default="hypcheck", show_default=True, metavar="NAME", help="Prefix of the function names.")
@click.option(
    "--output", default="-", show_default=True, metavar="FILE", help="The file to write; - is standard output."
)
@click.option(
    "--proof", metavar="FILE", help="Also write a proof of the discriminant's bound, for Coq (docs/proofs.md)."
)
@click.pass_context
def emit(
    context: click.Context,
    /,
    method: str | None,
    scene: str | None,
    language: str,
    precision: str,
    question: str | None,
    whole: bool,
    sweeps: bool,
    prefix: str,
    output: str,
    proof: str | None,
) -> None:
    """Write the kernel of a scene, or the code for one pair."""
    from hypcheck.kernel.emission.dialects import require_prefix
    from hypcheck.kernel.emission.pair import emitted_pair, emitted_scene, needs_routine
    from hypcheck.kernel.printing.coq import proof_of
    from hypcheck.tables.streams import write_files

    command, proved = _command(context), None
    if method is not None:
        scenes = {"--scene": scene, "--question": question, "--proof": proof}
        extra = [name for name, value in scenes.items() if value is not None]
        extra += [] if precision == "float64" else ["--precision"]
        extra += [option for option, is_given in (("--whole", whole), ("--sweeps", sweeps)) if is_given]
        if extra:
            raise InputError(f"{extra[0]} is for a scene; --method {method} is for one pair of any sizes, without it")
        text = emitted_pair(method, language, command, prefix)
    elif scene is None:
        raise InputError("emit needs --scene SCENE, or --method exact for one pair of any sizes")
    else:
        require_prefix(prefix, language)
        model = asked_scene(scene, question)
        if sweeps or (whole and needs_routine(model)):
            _require_routine(sweeps, whole, question, proof, precision)
            text = emitted_scene(model, language, command, prefix, sweep=sweeps)
        else:
            plan, text = _kernel(model, language, precision, command, prefix, whole=whole)
            proved = None if proof is None else proof_of(plan)
    if proof is not None and os.path.realpath(proof) == os.path.realpath(output):
        raise InputError(f"--proof {proof} is --output too; name another file")
    proofs = {} if proof is None or proved is None else {proof: proved.encode()}
    write_files({output: text.encode(), **proofs})


def _require_routine(sweeps: bool, whole: bool, question: str | None, proof: str | None, precision: str) -> None:
    """Raise InputError if an option does not apply to code that answers by a routine."""
    if sweeps and whole:
        raise InputError("--whole is about positions, --sweeps about straight motions; give one of them")
    if sweeps and question is not None:
        raise InputError("--question is about positions; --sweeps asks for contact on a straight motion")
    if proof is not None:
        raise InputError("--proof is for kernels of pairs, and of whole scenes in which nothing is tilted")
    if precision != "float64":
        raise InputError(f"no kernel is made in {precision}: sweeps, and scenes with something tilted, need float64")


def _command(context: click.Context) -> list[str]:
    """Return the words of the command that writes the same code, without the options that name the output files."""
    command = ["hypcheck", "emit"]
    for option in context.command.params:
        value = context.params[str(option.name)]
        if option.name not in ("output", "proof") and value not in (None, False, option.default):
            command += [option.opts[0]] if value is True else [option.opts[0], value]
    return command


def _kernel(
    model: SceneModel, language: str, precision: str, command: list[str], prefix: str, *, whole: bool
) -> tuple[ScenePlan, str]:
    """Plan a scene, or (`whole`) the scene with its places and heights; return the plan and the text of its kernel."""
    from hypcheck.kernel.emission.kernel import emitted, emitted_whole, whole_plan
    from hypcheck.kernel.specialise.plan import plan_of

    if whole:
        plan = whole_plan(model, precision)
        return plan, emitted_whole(model, plan, language, command, prefix)
    plan = plan_of(model, precision)
    return plan, emitted(plan, language, command, prefix)


_FLIGHT_HELP = """Find the first contact on flights through SCENE, and their least distance, exactly.

SCENE is a file (docs/scenes.md) or a shipped scene. PATH is a CSV file of corners of the mover's centre, which goes
straight from each to the next: columns x, y, z; optional are heading (degrees) and axis_x, axis_y, axis_z for the
segment that begins there, and flight, if the file has several. Standard input is - .

\b
hypcheck flight tower path.csv
hypcheck flight forest.toml flights.csv --json

The answer is the first segment with contact, counted from 0, bounds of the time within it, and the hyperboloid; or that
the flight is clear. The least distance is that of the mover itself, without its parts, at all times, given as two
bounds. The exit code is 0 with contact and without.
"""


@click.command(
    help=_FLIGHT_HELP, short_help="Find the first contact on flights through a scene, and how near they come."
)
@click.argument("scene", metavar="SCENE", type=options.SCENE)
@click.argument("path", metavar="PATH")
@click.option("--json", "as_json", is_flag=True, help="One JSON object for each flight, a line each.")
def flight(scene: str, path: str, as_json: bool) -> None:
    """Read, decide, and print."""
    from hypcheck.kernel.scene import Scene
    from hypcheck.tables.csv_table import read_flights

    world = Scene.from_toml(scene)
    for answer in _answers(world, read_flights(path)):
        click.echo(json.dumps(answer) if as_json else printable(_in_words(answer)))


def _answers(scene: Scene, table: FlightTable) -> list[dict[str, Any]]:
    """Decide the flights, and return the printed answer for each; its `contact` is None if there is none."""
    heading = 0.0 if table.headings is None else table.headings
    contacts = scene.first_contact(table.paths, heading, axis=table.axes)
    names = [body.name for body in scene.model.hyperboloids]
    least, answers = contacts.least, []
    for place, name in enumerate(table.names):
        hit = bool(contacts.hit[place])  # type: ignore[index]  # many flights have arrays
        contact = {
            "segment": int(contacts.segment[place]),  # type: ignore[index]
            "time_lower": float(contacts.time_lower[place]), "time_upper": float(contacts.time_upper[place]),
            "hyperboloid": names[int(contacts.index[place])], "center": contacts.center[place].tolist(),
        } if hit else None  # fmt: skip
        answers.append({
            "flight": name or None, "segments": max(len(table.paths[place]) - 1, 1), "hit": hit, "contact": contact,
            "least": {
                "distance_lower": float(least.distance_lower[place]),
                "distance_upper": float(least.distance_upper[place]),
                "segment": int(least.segment[place]), "time": float(least.time[place]),
                "hyperboloid": names[int(least.index[place])], "center": least.center[place].tolist(),
            } if least.segment[place] >= 0 else None,
        })  # fmt: skip
    return answers


def _in_words(answer: dict[str, Any]) -> str:
    """Return the answer about a flight as a sentence."""
    contact, least = answer["contact"], answer["least"]
    begin = "" if answer["flight"] is None else f"flight {answer['flight']}: "
    if not (contact or least):
        return f"{begin}clear; the least distance is not known, for lengths of the scene are too large for its bounds"
    where = f"({', '.join(f'{part:.6g}' for part in (contact or least)['center'])})"
    if contact is not None:
        return (
            f"{begin}contact on segment {contact['segment']} with {contact['hyperboloid']}, at time "
            f"{contact['time_lower']!r} … {contact['time_upper']!r} of it, the centre at {where}"
        )
    return (
        f"{begin}clear; the least distance {least['distance_lower']:.10g} … {least['distance_upper']:.10g} is on "
        f"segment {least['segment']}, from {least['hyperboloid']}, the centre at {where}"
    )


_SHOW_HELP = """Write a page that shows SCENE in three dimensions, and a flight through it.

SCENE is a file (docs/scenes.md) or a shipped scene, and --path a CSV file as of `hypcheck flight`, of one flight. The
page needs a browser and nothing else, no network either. It turns with the mouse, with fingers and with keys; a slider
moves the mover along the flight, and a curve below has the least distance.

\b
hypcheck show tower --out tower.html
hypcheck show forest.toml --path path.csv --out view.html
"""


@click.command(help=_SHOW_HELP, short_help="Write a page that shows a scene, and a flight through it, in 3-D.")
@click.argument("scene", metavar="SCENE", type=options.SCENE)
@click.option("--path", metavar="FILE", help="A flight: a CSV file with the columns x, y, z, or - .")
@click.option("--out", required=True, type=options.OutputPath(), metavar="FILE", help="The page to write.")
def show(scene: str, path: str | None, out: Path) -> None:
    """Read, draw, and write."""
    from hypcheck.kernel.scene import Scene
    from hypcheck.tables.csv_table import read_flights
    from hypcheck.tables.streams import write_files

    world = Scene.from_toml(scene)
    if path is None:
        page = world.show()
    else:
        table = read_flights(path)
        if len(table.paths) > 1:
            raise InputError(f"{path} has {len(table.paths)} flights; a page shows one")
        heading = 0.0 if table.headings is None else table.headings
        page = world.show(table.paths[0], heading, axis=table.axes)
    write_files({str(out): page.html.encode()})
    click.echo(f"wrote {printable(str(out))}")
