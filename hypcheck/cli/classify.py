"""`hypcheck classify`: the answer about one pair, or about every row of a table."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace

import click

from hypcheck.cli.running import watched
from hypcheck.errors import InputError
from hypcheck.geometry.pair import AXIS, CENTER, END, NO_DIRECTION, SIZES, Pair, trouble_with
from hypcheck.tables import FORMATS, route
from hypcheck.tables.numbers import number_of_text

_HELP = """Give the position of a spheroid relative to a hyperboloid: exterior, contact (with tangency) or interior.

Exact for every valid pair: decimals are first rounded to the nearest float64, and these values count as exact. Lengths
and distances are in one unit of your choice. Clearance is in spheroid radii: 1 + clearance is the factor by which the
spheroid, scaled about its centre, would just touch the hyperboloid.

\b
One pair:  hypcheck classify --alpha 1 --gamma 2 --b 1 --d 1 --center 2.5 0 0
Tilted:    hypcheck classify --alpha 1 --gamma 2 --b 1 --d 0.5 --center 2.5 0 0 --axis 1 0 2
A sweep:   hypcheck classify --alpha 1 --gamma 2 --b 1 --d 1 --center 4 0 0 --end 0 0.5 0
It ends:   hypcheck classify --alpha 1 --gamma 2 --b 1 --d 1 --center 2 0 4 --z-max 3 --solid
A table:   hypcheck classify --input pairs.csv --output answers.csv

A sweep is the straight motion of the centre to --end. The answer says whether there is contact on the sweep, both ends
included, and gives a lower and an upper bound of the time of the first contact, from 0 at the start to 1 at the end.

The hyperboloid ends at --z-min and --z-max. Without --solid it is only a wall: contact means contact with the wall, and
a spheroid without contact is interior if its centre lies within the wall and between the ends. With --solid it also has
flat ends, like a trunk.

With --margin the answer has a second position: a spheroid that is not proved to be at least so far away counts as
contact.

A table has the columns (or keys) alpha, gamma, b, d, x, y, z in any order, and axis_x, axis_y, axis_z for tilted
spheroids; all other columns are copied. The output adds position (+1, 0, -1), label, tangent and clearance, with
--margin position_with_margin too. For sweeps, whose end is x1, y1, z1, it adds hit (1 or 0), label, first_lower and
first_upper. z_min, z_max and solid (0 or 1) say where the hyperboloid ends; one of them is enough. A .npy file is
float64 (n, 7), or (n, 10) with the axis last, or (n, 13) with z_min, z_max and solid after the axis; as output it is
int8 (n,), positions, with the margin if one is given. A file appears when it is complete, or not at all; standard
output is written as the rows come.
"""


@click.command(help=_HELP, short_help="Give the position of a spheroid relative to a hyperboloid, with a proof.")
@click.option("--alpha", metavar="NUMBER", help="Radius of the hyperboloid's waist.")
@click.option("--gamma", metavar="NUMBER", help="Its semi-axis along z.")
@click.option("--b", metavar="NUMBER", help="Radius of the spheroid's equator.")
@click.option("--d", metavar="NUMBER", help="Its semi-axis along its axis; without --axis that is the z axis.")
@click.option("--center", nargs=3, metavar="X Y Z", help="Centre of the spheroid; the hyperboloid's is the origin.")
@click.option("--axis", nargs=3, metavar="X Y Z", help="The spheroid's axis, of any length; without it, upright.")
@click.option("--end", nargs=3, metavar="X Y Z", help="Where the centre moves to, straight; without it, no motion.")
@click.option("--z-min", metavar="NUMBER", help="Height of the hyperboloid's lower end; without it, infinite.")
@click.option("--z-max", metavar="NUMBER", help="Height of its upper end; without it, infinite.")
@click.option("--solid", is_flag=True, help="Flat ends belong to it.")
@click.option("--margin", metavar="LENGTH", help="Also give the position if nearer than this counts as contact.")
@click.option("--json", "as_json", is_flag=True, help="Answer with one JSON object, its proof in exact numbers.")
@click.option(
    "--input", "source", metavar="FILE", help="A table of pairs: .csv, .jsonl, .npy, or - for standard input."
)
@click.option("--output", "target", metavar="FILE", help="Where its answers go: .csv, .jsonl, .npy, or - .")
@click.option(
    "--format", "format_name", type=click.Choice(FORMATS), help="The format of - and of names without a known ending."
)
@click.option(
    "--on-invalid",
    type=click.Choice(("fail", "flag")),
    help="A row that is not a valid pair: fail (the default), or flag it as refused (127) and go on.",
)
def classify(
    alpha: str | None,
    gamma: str | None,
    b: str | None,
    d: str | None,
    center: tuple[str, str, str] | None,
    axis: tuple[str, str, str] | None,
    end: tuple[str, str, str] | None,
    z_min: str | None,
    z_max: str | None,
    solid: bool,
    margin: str | None,
    as_json: bool,
    source: str | None,
    target: str | None,
    format_name: str | None,
    on_invalid: str | None,
) -> None:
    """Answer about one pair, or about a table if --input names one."""
    sizes = dict(zip(SIZES, (alpha, gamma, b, d), strict=True))
    vectors = {"--center": center is not None, "--axis": axis is not None, "--end": end is not None}
    heights = {"--z-min": z_min is not None, "--z-max": z_max is not None, "--solid": solid}
    length = None if margin is None else _margin(margin, end)
    for_a_pair = {"--json": as_json} | {f"--{name}": text is not None for name, text in sizes.items()}
    for_a_table = {
        "--output": target is not None,
        "--format": format_name is not None,
        "--on-invalid": on_invalid is not None,
    }
    if source is not None:
        _refuse(for_a_pair | vectors | heights, "is for one pair, and --input for a table; use one of them")
        _answer_table(source, target, format_name, length, mark=on_invalid == "flag")
        return
    _refuse(for_a_table, "is for tables; name one with --input")
    pair = _with_heights(_pair_of(sizes, center, axis), z_min, z_max, solid)
    click.echo(_answered(pair, length, as_json=as_json) if end is None else _swept(pair, end, as_json=as_json))


def _answered(pair: Pair, margin: float | None, *, as_json: bool) -> str:
    """Return the text of the answer about a pair."""
    from hypcheck.answer import answer, answer_as_json, answer_as_text

    return (answer_as_json if as_json else answer_as_text)(answer(pair, margin))


def _margin(text: str, end: tuple[str, str, str] | None) -> float:
    """Return the margin in the text. Raises InputError if it is not a length, or if the question is a sweep."""
    if end is not None:
        raise InputError("--margin is for a position; with --end the question is a sweep, so leave one of them out")
    margin = _number("--", "margin", text)
    if not 0 <= margin < math.inf:
        raise InputError(f"--margin is {text}; it must be a finite number, 0 or more")
    return margin


def _swept(pair: Pair, end: tuple[str, str, str], *, as_json: bool) -> str:
    """Return the text of the answer about the sweep of a pair to `end`. Raises InputError about an invalid number."""
    from hypcheck.answer import sweep_answer, sweep_as_json, sweep_as_text

    numbers = [_number("--end: ", *named) for named in zip(END, end, strict=True)]
    for name, number in zip(END, numbers, strict=True):
        trouble = trouble_with(name, number)
        if trouble is not None:
            raise InputError(f"--end: {trouble}")
    row = (*pair.row[:7], *numbers, *pair.row[7:])
    return (sweep_as_json if as_json else sweep_as_text)(sweep_answer(row))


def _refuse(options: dict[str, bool], reason: str) -> None:
    """Raise InputError if one of these options is given."""
    used = [option for option, is_given in options.items() if is_given]
    if used:
        raise InputError(f"{used[0]} {reason}")


def _answer_table(
    source: str, target: str | None, format_name: str | None, margin: float | None, *, mark: bool
) -> None:
    """Write the answers about a table. Raises InputError if no output is named."""
    if target is None:
        raise InputError("--output is missing; name a file for the answers, or - for standard output")
    streams = route(source, target, format_name)
    from hypcheck.answers import classify_table

    classify_table(streams, mark=mark, watch=_watch, margin=margin)


@contextmanager
def _watch(size: int | None) -> Iterator[Callable[[int, int], object]]:
    """Show a progress bar for `size` rows; None if their number is unknown."""
    with watched(size, "classify", "rows") as pace:
        yield pace.advance


def _pair_of(
    sizes: dict[str, str | None], center: tuple[str, str, str] | None, axis: tuple[str, str, str] | None
) -> Pair:
    """Return the pair with these numbers, given as texts. Raises InputError naming a missing or invalid number."""
    missing = [f"--{name}" for name, text in sizes.items() if text is None] + ["--center"] * (center is None)
    if len(missing) == len(sizes) + 1 and axis is None:
        raise InputError("nothing to classify; give --alpha --gamma --b --d --center X Y Z, or --input and --output")
    if missing:
        verb = "is" if len(missing) == 1 else "are"
        raise InputError(f"{', '.join(missing)} {verb} missing; a pair needs --alpha --gamma --b --d --center X Y Z")
    numbers = [_number("--", name, text or "") for name, text in sizes.items()]
    numbers += [_number("--center: ", *named) for named in zip(CENTER, center or (), strict=True)]
    if axis is None:
        return Pair.from_row(numbers)
    direction = [_number("--axis: ", *named) for named in zip(AXIS, axis, strict=True)]
    if not any(direction):
        raise InputError(f"--axis: {NO_DIRECTION}")
    return Pair.from_row(numbers + direction)


def _with_heights(pair: Pair, z_min: str | None, z_max: str | None, solid: bool) -> Pair:
    """Return the pair with these ends. Raises InputError naming an invalid height."""
    if solid and z_min is None and z_max is None:
        raise InputError("--solid says that flat ends belong to the hyperboloid; give --z-min, --z-max or both")
    low = -math.inf if z_min is None else _number("--", "z-min", z_min)
    high = math.inf if z_max is None else _number("--", "z-max", z_max)
    return replace(pair, z_min=low, z_max=high, solid=float(solid))


def _number(begin: str, name: str, text: str) -> float:
    """Return the number in a text. Raises InputError, whose text starts with `begin`."""
    try:
        return number_of_text(name, text)
    except ValueError as error:
        raise InputError(f"{begin}{error}") from None
