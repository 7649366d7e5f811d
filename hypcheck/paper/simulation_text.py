"""`simulate forest` and `simulate tower` as text: the lines of a result, whose JSON the schemas describe."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from typing import Any

from hypcheck.messages import counted

WIDTH = 100

SHOWN = 8
"""Phantoms, and first contacts of a walk, that are listed one by one."""

SHOWN_OF_FLIGHTS = 6
"""First contacts of flights that are listed one by one; the JSON has more."""


def forest_lines(result: dict[str, Any]) -> Iterator[str]:
    """Yield the lines of the text about a walk. `result` is that of `simulate_forest`, in the form of its JSON."""
    trees, walker, steps = result["trees"], result["walker"], result["steps"]
    wide = sum(tree["type"] == 1 for tree in trees)
    yield (
        f"{result['scene']}, seed {result['seed']}: {counted(len(trees), 'tree')} ({wide} of type 1, "
        f"{len(trees) - wide} of type 2), a walker of b = {walker['b']:g}, d = {walker['d']:g}"
    )
    yield from _regime_line(result["outside_stated_regime"])
    yield (
        f"{counted(steps['tried'], 'step')} of {walker['step']:g} tried by Table 2 in float32: {steps['made']:,} made, "
        f"{steps['contact']:,} rightly refused,"
    )
    yield f"  {steps['phantom']:,} stopped by a phantom, {steps['edge']:,} turned back at the region's edge"
    if steps["wrongly_allowed"]:
        lead = "leads" if steps["wrongly_allowed"] == 1 else "lead"
        yield f"  {steps['wrongly_allowed']:,} of the made ones {lead} into contact"
    yield from _question_lines(result["questions"])
    phantoms = result["phantoms"]
    yield (
        f"phantoms, contact with nothing: {phantoms['float32']:,} in float32, {phantoms['float64']:,} in float64, "
        f"{phantoms['float32_after_line']:,} in float32 where the line is asked first"
    )
    yield (
        f"  Procedure 1 put right: {phantoms['float32_repaired']:,} in float32, {phantoms['float64_repaired']:,} in "
        f"float64; it decides {result['repaired']['float32_differs']:,} and "
        f"{result['repaired']['float64_differs']:,} steps otherwise"
    )
    yield from _stop_lines(result["stops"])
    if result["ways"] is not None:
        ways = result["ways"]
        touching = "1 touches" if ways["touching"] == 1 else f"{ways['touching']:,} touch"
        yield f"{counted(ways['made'], 'made step')}: {touching} a tree on the way"
        for contact in ways["contacts"][:SHOWN]:
            yield f"  {_from_to(contact)}: {contact['tree']} first at {contact['first_upper']:.3g} of the way"
    if "ends" in result:
        yield from _ends_of_trees(result["ends"])


def _ends_of_trees(ends: dict[str, Any]) -> Iterator[str]:
    """Yield the lines about the errors of a test by the centre's height for trees that end."""
    yield "Trees as they end, where the walk asks for the height of the centre alone:"
    for name, what in (("steps", "step"), ("questions", "question")):
        questions, needless, dangerous = (ends[name][key] for key in ("asked", "needless", "dangerous"))
        yield (
            f"  of {counted(questions, what)} the centre's height decides {needless + dangerous:,} otherwise: "
            f"{dangerous:,} dangerous, {needless:,} needlessly refused"
        )
    for place in ends["places"][:SHOWN]:
        x, y, z = place["at"]
        what = "touches" if place["dangerous"] else "is clear of"
        yield f"  at ({x:.3f}, {y:.3f}, {z:.3f}) the walker {what} {place['tree']}"


def _ends_of_tower(ends: dict[str, Any]) -> Iterator[str]:
    """Yield the lines about the errors of a test by the centre's height for a tower that ends."""
    yield "The tower as it ends, where the flights ask for the height of the centre alone:"
    for name, what in (("flights", "of the figure"), ("table_5", "of the table")):
        counts = ends[name]
        if counts is None:
            continue
        tested, reaching, beyond, touching = (counts[key] for key in ("asked", "reaching", "beyond", "touching"))
        moves = counted(tested, "move")
        yield f"  flights {what}: of {moves} asked about the body reaches beyond an end in {reaching:,};"
        yield (
            f"    there the centre's height decides {counts['needless'] + counts['dangerous']:,} otherwise: "
            f"{counts['dangerous']:,} dangerous, {counts['needless']:,} needlessly refused"
        )
        share = _share(touching, beyond)
        yield f"    of {counted(beyond, 'draw')} to beyond the height {touching:,} would touch the wall{share}"


def _regime_line(names: list[str]) -> Iterator[str]:
    """Yield the lines about trees outside the regime of Procedure 1; none if there is no such tree."""
    if names:
        listed = ", ".join(names[:SHOWN]) + (", …" if len(names) > SHOWN else "")
        text = f"Procedure 1 claims nothing about trees with (gamma/d)^2 < alpha/b: {len(names)}, {listed}"
        yield from textwrap.wrap(text, WIDTH)


def _question_lines(questions: dict[str, int]) -> Iterator[str]:
    """Yield the lines about the numbers of questions, one for each step and tree, and how they were answered."""
    total, line = questions["asked"], questions["line"]
    share = f" ({100 * line / total:.2f} %)" if total else ""
    yield f"{counted(total, 'question')}, one for each step and tree: a line answers {line:,} of them{share} without Δ"
    outside = questions["outside_height"]
    if outside:
        verbs = ("is", "has") if outside == 1 else ("are", "have")
        yield f"  {outside:,} more {verbs[0]} outside the modelled height and {verbs[1]} no answer"


def _stop_lines(stops: list[dict[str, Any]]) -> Iterator[str]:
    """Yield the lines about phantoms: some of them, and the number of the others."""
    phantoms = [stop for stop in stops if stop["kind"] == "phantom"]
    for stop in phantoms[:SHOWN]:
        x, y, z = stop["tried"]
        yield f"  at ({x:.3f}, {y:.3f}, {z:.3f}), {stop['gap']:.2f} from touching: {', '.join(stop['trees'])}"
    if len(phantoms) > SHOWN:
        yield f"  and {len(phantoms) - SHOWN:,} more"


_TURNS = {
    "executed": "a turn asks the procedure in place, ignores the answer, and a step ahead follows",
    "obeyed": "a turn asks the procedure in place, is not made if the answer is no, and else a step ahead follows",
    "free": "a turn asks nothing",
}


def tower_lines(result: dict[str, Any]) -> Iterator[str]:
    """Yield the lines of the text about flights. `result` is that of `simulate_tower`, in the form of its JSON."""
    yield from _assumed(result["assumptions"], result["seed"])
    yield ""
    yield from _flown(result["flights"])
    table = result["table_5"]
    if table is not None:
        yield ""
        yield from _table(table, result["assumptions"]["distance"])
        if table["ways"] is not None:
            yield ""
            yield "On the ways between the positions of these runs:"
            yield from _ways(table["ways"])
    if result["pitch"] is not None:
        yield ""
        yield from pitch_lines(result["pitch"])
    if "ends" in result:
        yield ""
        yield from _ends_of_tower(result["ends"])
    yield ""
    yield from textwrap.wrap(result["statement"], WIDTH)


def _assumed(scene: dict[str, Any], seed: int) -> Iterator[str]:
    """Yield the lines about the scene and the assumptions of its flights."""
    yield f"{scene['scene']}, seed {seed}"
    yield f"  tower alpha = {scene['alpha']:g}, gamma = {scene['gamma']:g}; {_height(scene['height'])}"
    yield (
        f"  body b = {scene['b']:g}, d = {scene['d']:g}; rotors b_s = {scene['b_s']:g}, d_s = {scene['d_s']:g}, "
        f"l = {scene['l']:g}, g1 = heading {scene['g1_from_heading']:+g} degrees"
    )
    turns = 1 - scene["straight"] - scene["vertical"]
    ahead = "ahead or back, half each" if scene["backward"] else "ahead"
    yield f"  draws: straight {scene['straight']:g} ({ahead}), up or down {scene['vertical']:g}, turns {turns:g}"
    yield f"  turns within {scene['largest_turn']:g} degrees: {_TURNS[scene['turn']]}"
    yield f"  a refused movement turns by {scene['refused_turn']:g} degrees, left or right"
    yield f"  {_start(scene['start'])}"


def _height(span: Sequence[float] | None) -> str:
    """Return the words for the heights between which the tower exists."""
    if span is None:
        return "no end of its height is modelled"
    return f"its height from {span[0]:g} to {span[1]:g}, beyond which an up or down is drawn again"


def _start(start: dict[str, Any]) -> str:
    """Return the words for the places at which flights begin."""
    radius, margin, (low, high) = start["radius"], start["margin"], start["z"]
    disc = f"of radius {radius:g}" if margin is None else f"that ends {margin:g} before the wall"
    at = f"z = {low:g}" if low == high else f"z uniform from {low:g} to {high:g}"
    return f"flights begin at {at}, uniform over the disc {disc}, heading anywhere"


def _flown(flights: dict[str, Any]) -> Iterator[str]:
    """Yield the lines about the flights of the figure."""
    paths = flights["paths"]
    yield (
        f"{counted(len(paths), 'flight')} of {counted(len(paths[0]['positions']), 'position')}, "
        f"steps of {flights['step']:g} ({flights['speed']:g} m/s for {flights['time']:g} s)"
    )
    for number, path in enumerate(paths, start=1):
        least, most = min(path["discriminant"]), max(path["discriminant"])
        made = len(path["positions"]) - 1
        yield (
            f"  {number}: {counted(path['executions'], 'execution')}, of which {made} moves made and "
            f"{counted(path['refused'], 'attempt')} refused; Δ ≤ 0 in {path['touching']};"
        )
        yield (
            f"     Δ at its positions from {least:.3g} to {most:.3g} (refused attempts lead to none); "
            f"{counted(path['outside_height'], 'draw')} beyond the height"
        )
    if flights["ways"] is not None:
        yield from _ways(flights["ways"])


def _table(table: dict[str, Any], distance: float) -> Iterator[str]:
    """Yield the lines of Table 5, ours and the printed one."""
    yield f"Table 5: executions with Δ ≤ 0, percent; means of {counted(table['runs'], 'run')} of {distance:g} m"
    yield "  (± standard error; below: printed, and ours less printed in standard errors of the difference)"
    yield "       v (m/s)" + "".join(f"{speed:>14}" for speed in table["v"])
    rows = zip(
        table["t"],
        table["percent"],
        table["standard_error"],
        table["printed"],
        table["difference_in_standard_errors"],
        strict=True,
    )
    for row in rows:
        yield from _row(*row)
    other = table["second_row_read_as_0.25"]
    yield "  the second row, if its t is a misprint for 0.25:"
    difference = other["difference_in_standard_errors"]
    yield from _row(other["t"], other["percent"], other["standard_error"], table["printed"][1], difference)
    yield (
        f"  root mean square difference of the 18 figures: {table['root_mean_square_difference']:.2f} as printed, "
        f"{other['root_mean_square_difference']:.2f} with t = 0.25 in the second row"
    )
    executions, refused, outside = (
        _between(table[name], other[name]) for name in ("executions", "refused", "outside_height")
    )
    yield f"  a run: {executions} executions, {refused} movements refused, {outside} draws outside the modelled height"


def _between(rows: Sequence[Sequence[float]], other: Sequence[float]) -> str:
    """Return the least and the greatest of all values as text."""
    values = [value for row in (*rows, other) for value in row]
    return f"{min(values):,.0f} to {max(values):,.0f}"


def _row(
    time: float,
    percents: Sequence[float],
    errors: Sequence[float | None],
    printed: Sequence[float],
    differences: Sequence[float | None],
) -> Iterator[str]:
    """Yield the lines of one row of Table 5: our figures, the printed ones, and the differences in standard errors."""
    ours = "".join(f"{_with_error(percent, error):>14}" for percent, error in zip(percents, errors, strict=True))
    yield f"  t = {time:4g} s  {ours}"
    yield "  printed     " + "".join(f"{figure:>14.4f}" for figure in printed)
    shown = ("–" if difference is None else f"{difference:+.1f}" for difference in differences)
    yield "  difference  " + "".join(f"{difference:>14}" for difference in shown)


def _with_error(percent: float, error: float | None) -> str:
    """Return a figure with its standard error as text, if there is one."""
    return f"{percent:.2f}" if error is None else f"{percent:.2f} ± {error:.2f}"


def _ways(ways: dict[str, Any]) -> Iterator[str]:
    """Yield the lines about contact on the sweeps and turns between positions."""
    for name in ("vertical", "horizontal"):
        moves, touching, begun = ways[name], ways[f"{name}_touching"], ways[f"{name}_begun"]
        touch = "touches" if touching == 1 else "touch"
        yield (
            f"  {counted(moves, f'accepted {name} move')}: {touching:,} {touch}{_share(touching, moves)}, "
            f"{begun:,} from their beginning and {touching - begun:,} on the way"
        )
    for contact in ways["contacts"][:SHOWN_OF_FLIGHTS]:
        yield f"    {_from_to(contact)}: rotor {contact['rotor']} first at {contact['first_upper']:.3g} of the way"
    turns, touching = ways["turns"], ways["turns_touching"]
    sweep = f"{touching:,} {'sweeps' if touching == 1 else 'sweep'} a rotor through contact{_share(touching, turns)}"
    yield f"  {counted(turns, 'turn')} in place: {sweep}"
    yield (
        "  at the ends of moves the procedure was wrong "
        + counted(ways["wrongly_accepted"] + ways["wrongly_refused"], "time")
    )
    yield (
        f"  of {counted(ways['asked'], 'move')} asked about, Procedure 2.b put right decides "
        f"{ways['repaired_2b_differs']:,} otherwise than as printed,"
    )
    yield (
        f"  Procedure 2.a put right {ways['repaired_2a_differs']:,}; 2.a as printed decides "
        f"{ways['procedure_2a_differs']:,} otherwise than 2.b as printed"
    )


def pitch_lines(tilt: dict[str, Any]) -> Iterator[str]:
    """Yield the lines about the answers that change if the quadcopter tilts; `tilt` is the part `pitch` of a result."""
    yield f"Tilted by {tilt['degrees']:g} degrees into each movement ahead or back, which Procedure 2.b does not know:"
    total, moves = tilt["total"], tilt["total"]["moves"]
    for name, what, refused in (
        ("", "its answer is wrong about", "needlessly refused"),
        ("body_", "the body alone is judged wrongly for", "clear only tilted"),
    ):
        wrong, dangerous = total[f"{name}wrong"], total[f"{name}dangerous"]
        yield f"  of {counted(moves, 'horizontal move')} {what} {wrong:,}{_share(wrong, moves)}:"
        yield f"    {dangerous:,} dangerous, clear only upright; {wrong - dangerous:,} {refused}"
    near = tilt["near_wall"]
    yield f"  of {counted(near['centres'], 'centre')} within b of the wall the body's position is another"
    for name, what in (("anywhere", "tilted anywhere"), ("outward", "tilted along the radius, outwards")):
        changed, dangerous = near[name]["changed"], near[name]["dangerous"]
        yield f"    for {changed:,}{_share(changed, near['centres'])}, {what}; {dangerous:,} of these are dangerous"


def _from_to(contact: dict[str, Any]) -> str:
    """Return the start and the end of a move as text."""
    start, end = (", ".join(f"{coordinate:.3f}" for coordinate in contact[name]) for name in ("start", "end"))
    return f"({start}) to ({end})"


def _share(part: int, whole: int) -> str:
    """Return a part of a whole in percent as text in brackets; empty if the whole is 0."""
    return f" ({100 * part / whole:.3f} %)" if whole else ""
