"""Pictures of simulations: a walk in the forest with its phantoms, and flights inside a cooling tower.

The forest has these: the walk from above, an invisible wall, the forest in space. The tower has these: the paper's
Figure 4 redrawn, its Table 5 over the step v·t, and a tilted quadcopter.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import SubFigure
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from hypcheck.geometry.rows import Floats
from hypcheck.report.plots.planes import FAINT, paint_letters
from hypcheck.report.plots.style import Plot, colour, curve_style, new_figure, power_of_ten


def axes_in_space(figure: Any, place: tuple[float, float, float, float], elevation: int, azimuth: int) -> Any:  # noqa: ANN401 - matplotlib does not type axes in space
    """Add axes in metres, seen from a direction in degrees, with transparent walls for light and dark ground."""
    axes = figure.add_axes(place, projection="3d")
    axes.patch.set_visible(False)
    axes.view_init(elev=elevation, azim=azimuth)
    axes.set(xlabel="x (m)", ylabel="y (m)", zlabel="z (m)")
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
    axes.tick_params(labelsize=9, pad=1)
    axes.tick_params(axis="z", pad=7)  # keep numbers away from the axes
    axes.zaxis.labelpad = 9
    return axes


def _hyperboloid(
    body: dict[str, Any], heights: tuple[float, float], levels: int, facets: int
) -> tuple[Floats, Floats, Floats]:
    """Compute the points (x, y, z) of a surface about its own centre, at `levels` heights and `facets` angles."""
    z, angle = np.meshgrid(np.linspace(*heights, levels), np.linspace(0, 2 * np.pi, facets), indexing="ij")
    radius = body["alpha"] * np.hypot(1, z / body["gamma"])
    return radius * np.cos(angle), radius * np.sin(angle), z


def _circle(centre: Sequence[float], radius: float, pieces: int) -> tuple[list[float], list[float]]:
    """Return the x and the y of the corners of a circle that is drawn as straight pieces."""
    angles = [2 * math.pi * step / pieces for step in range(pieces + 1)]
    x, y = centre[:2]
    return [x + radius * math.cos(angle) for angle in angles], [y + radius * math.sin(angle) for angle in angles]


def _mark_contacts(axes: Iterable[Any], ways: dict[str, Any] | None) -> None:
    """Mark the mover's centre at first contacts on sweeps, in a plane or in space; nothing if there are no sweeps."""
    points = []
    for contact in ways["contacts"] if ways else []:
        start, end = np.array(contact["start"]), np.array(contact["end"])
        points.append(start + contact["first_upper"] * (end - start))
    if not points:
        return
    for panel in axes:
        panel.plot(
            *np.transpose(points)[: 3 if panel.name == "3d" else 2],
            linestyle="none",
            marker="P",
            markersize=7,
            color=colour("series-4"),
            label="first contact on the way",
            zorder=5,
        )


TRUNKS = {1: ("trunk wider than the walker", "series-3"), 2: ("trunk narrower than the walker", "share-1")}
"""The labels of the two types of trees, and their colours, which differ in lightness too."""

_MARKED = "A"
"""The letter of the place that is enlarged."""

_STOPS = {
    "contact": ("rightly refused", "x", 11, "ink"),
    "phantom": ("stopped by a phantom", "*", 100, "clear"),
}
"""The label, the marker, its size and its colour for each kind of stop."""

_RING: dict[str, Any] = {"color": colour("series-1"), "linewidth": 0.9, "linestyle": (0, (5, 2))}
_RING_LABEL = "ring of a tree that stopped her"
_ELEVATION, _AZIMUTH = 34, -58
"""The direction from which the forest in space is seen, in degrees."""

_PIECES, _FACETS, _LEVELS = 48, 14, 7
"""Straight pieces of a circle from above; facets of a trunk in space around it and, one less, along it."""


def forest_plots(result: dict[str, Any]) -> Iterator[Plot]:
    """Yield the walk from above, and the forest in space."""
    yield _walk(result)
    yield _space(result)


def _walk(result: dict[str, Any]) -> Plot:
    """Draw the walk from above, beside the surroundings of a phantom if the result has them."""
    wall = result["wall"]
    figure = new_figure(760 if wall else 520, 520)
    panels = figure.subplots(1, 2, width_ratios=[1.75, 1]) if wall else [figure.subplots()]
    _forest_from_above(panels[0], result)
    if wall:
        _wall(panels[1], panels[0], wall)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4 if wall else 3)
    steps = result["steps"]
    description = (
        f"{steps['tried']:,} steps of a walker among {len(result['trees'])} trees who obeys Procedure 1 in float32: "
        f"{steps['contact']:,} rightly refused, {steps['phantom']:,} stopped by phantoms, that is, on rings where Δ "
        "vanishes though nothing is near."
    )
    return Plot("forest-walk", "A walk in the forest, and its invisible walls", description, figure)


def _forest_from_above(axes: Axes, result: dict[str, Any]) -> None:
    """Draw the trunks at the walker's height, the walk, and where it stopped."""
    level = result["path"][0][2]
    for kind, (label, name) in TRUNKS.items():
        for place, tree in enumerate(tree for tree in result["trees"] if tree["type"] == kind):
            radius = tree["alpha"] * math.hypot(1, (level - tree["center"][2]) / tree["gamma"])
            paint = {"facecolor": colour(name), "edgecolor": colour("ink"), "linewidth": 0.5}
            axes.fill(*_circle(tree["center"], radius, _PIECES), label="" if place else label, **paint)
    x, y, _ = zip(*result["path"], strict=True)
    axes.plot(x, y, color=colour("soft"), linewidth=0.45, label="walk", zorder=1.5)
    limits = axes.get_xlim(), axes.get_ylim()
    _draw_rings(axes, result["trees"])
    axes.set(xlim=limits[0], ylim=limits[1])
    _draw_stops(axes, result["stops"], 2, linewidths=0.7, zorder=3)
    _mark_contacts([axes], result["ways"])
    axes.set_aspect("equal")
    axes.set(xlabel="x (m)", ylabel="y (m)")
    axes.grid(visible=False)
    axes.set_title("from above")


def _draw_rings(axes: Any, trees: list[dict[str, Any]], *height: float) -> None:  # noqa: ANN401 - in space with a height
    """Draw the rings of the trees that stopped the walker; each is only a few millimetres thin."""
    guilty = [tree for tree in trees if tree["phantom"] and tree["ring"] is not None]
    for place, tree in enumerate(guilty):
        ring = _circle(tree["center"], tree["ring"], _PIECES)
        axes.plot(*ring, *height, **_RING, label="" if place else _RING_LABEL)


def _draw_stops(axes: Any, stops: list[dict[str, Any]], coordinates: int, **look: Any) -> None:  # noqa: ANN401
    """Draw where the walker was stopped, in axes of two or of three coordinates."""
    for kind, (label, marker, size, paint) in _STOPS.items():
        tried = [stop["tried"][:coordinates] for stop in stops if stop["kind"] == kind]
        if tried:
            columns = zip(*tried, strict=True)
            axes.scatter(*columns, label=label, marker=marker, s=size, color=colour(paint), **look)


def _wall(axes: Axes, whole: Axes, wall: dict[str, Any]) -> None:
    """Draw the surroundings of a phantom, in millimetres from it, and mark it in the whole picture."""
    millimetres = 1000 * wall["half"]
    span = (-millimetres, millimetres)
    colours = {"e": FAINT, "E": colour("clear"), "c": colour("ink"), "C": colour("contact")}
    paint_letters(axes, wall["lines"], colours, span, span)
    axes.set_aspect("equal")
    axes.set(xlabel=f"x from {_MARKED} (mm)", ylabel=f"y from {_MARKED} (mm)")
    axes.set_title(f"the invisible wall at {_MARKED}")
    labels = {"e": "free, and float32 says so", "E": "free, but float32 says contact"}
    seen = {letter for line in wall["lines"] for letter in line}
    handles = [Patch(facecolor=colours[kind], label=label) for kind, label in labels.items() if kind in seen]
    axes.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.24), fontsize=9)
    x, y, _ = wall["center"]
    whole.annotate(
        _MARKED,
        (x, y),
        xytext=(9, 6),
        textcoords="offset points",
        fontweight="bold",
        bbox={"facecolor": colour("surface"), "edgecolor": "none", "pad": 1},
        zorder=4,
    )


def _space(result: dict[str, Any]) -> Plot:
    """Draw the trunks in space, and the walk on the ground."""
    figure = new_figure(760, 480)
    place = (-0.12, -0.16, 1.22, 1.42)  # wider than its content
    axes = axes_in_space(figure.subfigures(), place, _ELEVATION, _AZIMUTH)
    axes.computed_zorder = False  # drawn in parts, it would hide marks behind trunks
    for tree in sorted(result["trees"], key=_nearness):
        _trunk(axes, tree)
    foot = result["path"][0][2] - result["walker"]["d"]
    x, y, z = zip(*result["path"], strict=True)
    axes.plot(x, y, [foot] * len(x), color=colour("soft"), linewidth=0.45, label="walk, on the ground")
    _draw_stops(axes, result["stops"], 3, depthshade=False, zorder=5)
    _draw_rings(axes, result["trees"], z[0])
    _mark_contacts([axes], result["ways"])
    axes.set_box_aspect((1, 1, 0.32), zoom=0.84)
    trunks = [Patch(facecolor=colour(paint), edgecolor=colour("ink"), label=label) for label, paint in TRUNKS.values()]
    handles, _ = axes.get_legend_handles_labels()
    figure.legend(handles=[*trunks, *handles], loc="outside lower center", ncols=3)
    description = (
        f"{len(result['trees'])} trunks as hyperboloids of one sheet, the walk on the ground, and where it stopped."
    )
    return Plot("forest-space", "The forest in space", description, figure)


def _nearness(tree: dict[str, Any]) -> float:
    """Return a tree's nearness to the viewer of the forest in space; trees that are drawn later hide earlier ones."""
    angle = math.radians(_AZIMUTH)
    return float(tree["center"][0]) * math.cos(angle) + float(tree["center"][1]) * math.sin(angle)


def _trunk(axes: Any, tree: dict[str, Any]) -> None:  # noqa: ANN401 - axes in space
    """Draw a trunk in space."""
    heights = tree["height"] or (-tree["gamma"], tree["gamma"])
    points = _hyperboloid(tree, heights, _LEVELS, _FACETS)
    x, y, z = (middle + values for middle, values in zip(tree["center"], points, strict=True))
    paint = colour(TRUNKS[tree["type"]][1])
    surface = axes.plot_surface(x, y, z, color=paint, linewidth=0, rcount=_LEVELS, zorder=3)
    surface.set_rasterized(True)  # thousands of facets are smaller as a picture


_RINGED: dict[str, Any] = {
    "linestyle": "none",
    "marker": "o",
    "markerfacecolor": "none",
    "markeredgecolor": colour("ink"),
    "markeredgewidth": 1.1,
}
"""The mark of a position where Δ ≤ 0; it encloses the flight's own mark."""

_FRAMED: dict[str, Any] = {"frameon": True, "facecolor": colour("surface"), "edgecolor": "none", "framealpha": 1}
"""The style of a legend that lies over curves."""


def tower_plots(result: dict[str, Any]) -> Iterator[Plot]:
    """Yield the flights, and Table 5 and the tilted quadcopter if the result has them."""
    yield flights(result)
    if result["table_5"] is not None:
        yield _table(result["table_5"])
    if result["pitch"] is not None:
        yield _pitch(result["assumptions"], result["pitch"])


def flights(result: dict[str, Any]) -> Plot:
    """Draw the flights of a result in space and from above, and Δ along them."""
    assumptions, flown = result["assumptions"], result["flights"]
    figure = new_figure(760, 580)
    halves: Any = figure.subfigures(1, 2, width_ratios=[1, 1.1])
    left, right = halves
    above, along = right.subplots(2, 1, height_ratios=[1.35, 1], gridspec_kw={"hspace": 0.08})
    solid = _tower_in_space(left, assumptions, flown["paths"])
    _tower_from_above(above, assumptions, flown["paths"])
    _discriminants(along, flown["paths"])
    _mark_contacts([solid, above], flown["ways"])
    handles = [handle for axes in (above, along) for handle in axes.get_legend_handles_labels()[0]]
    figure.legend(handles=handles, loc="outside lower center", ncols=4)
    description = (
        f"Inside a hyperboloid with α = {assumptions['alpha']:g} m and γ = {assumptions['gamma']:g} m, "
        f"{len(flown['paths'])} random flights with steps of {flown['step']:g} m, from the side and from above, and "
        "the discriminant Δ of the body's cubic at each position: at one height it falls towards the wall, across "
        "heights it does not tell how near the wall is, and where it is not above 0 the rotors are asked."
    )
    return Plot("tower-flights", "Flights inside a cooling tower, and Δ along them", description, figure)


def _tower_in_space(figure: SubFigure, assumptions: dict[str, Any], paths: list[dict[str, Any]]) -> Any:  # noqa: ANN401 - axes in space
    """Draw the tower as a wire frame, and the flights in it; return the axes."""
    axes = axes_in_space(figure, (-0.33, 0.0, 1.6, 1.0), 20, -60)  # a square, wider than its content
    wires = _hyperboloid(assumptions, _heights(assumptions, paths), 15, 25)
    axes.plot_wireframe(*wires, color=colour("soft"), linewidth=0.4, alpha=0.55)
    for place, path in enumerate(paths):
        style, positions = curve_style(place), np.array(path["positions"])
        axes.plot(*positions.T, **style.line, marker=style.marker, markersize=3, zorder=3)
        axes.plot(*positions[_touching(path)].T, **_RINGED, markersize=7, zorder=4)
    axes.set_box_aspect((1, 1, 2.2), zoom=0.84)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(3))
    figure.text(0.44, 0.975, "in space (z drawn shorter)", ha="center", va="top")
    return axes


def _heights(assumptions: dict[str, Any], paths: list[dict[str, Any]]) -> tuple[float, float]:
    """Return the lowest and the highest drawn height of the tower: of the modelled part, or of what the flights use."""
    if assumptions["height"] is not None:
        return float(assumptions["height"][0]), float(assumptions["height"][1])
    heights = [position[2] for path in paths for position in path["positions"]]
    return min(heights) - 1, max(heights) + 1


def _touching(path: dict[str, Any]) -> Any:  # noqa: ANN401 - an array of bool
    """Return for each position whether Δ ≤ 0."""
    return np.array(path["discriminant"]) <= 0


def _tower_from_above(axes: Axes, assumptions: dict[str, Any], paths: list[dict[str, Any]]) -> None:
    """Draw the tower's waist and its widest circle from above, and the flights."""
    widest = max(math.hypot(1, height / assumptions["gamma"]) for height in _heights(assumptions, paths))
    end = "end of what is drawn" if assumptions["height"] is None else "the tower's end"
    circles: tuple[tuple[float, Any, str], ...] = ((1.0, "-", "waist"), (widest, (0, (1, 1.2)), end))
    for factor, dashes, label in circles:
        circle = _circle((0, 0), assumptions["alpha"] * factor, 96)
        axes.plot(*circle, color=colour("soft"), linestyle=dashes, linewidth=1, label=label)
    for place, path in enumerate(paths):
        style, positions = curve_style(place), np.array(path["positions"])[:, :2]
        axes.plot(*positions.T, **style.line, marker=style.marker, markersize=3.5)
        axes.plot(*positions[_touching(path)].T, **_RINGED, markersize=8)
    axes.set_aspect("equal")
    axes.set(xlabel="x (m)", ylabel="y (m)")
    axes.set_title("from above")


def _discriminants(axes: Axes, paths: list[dict[str, Any]]) -> None:
    """Draw Δ at each position of the flights, and mark where Δ ≤ 0."""
    exponent = math.floor(math.log10(max(abs(value) for path in paths for value in path["discriminant"]) or 1.0))
    ringed: list[tuple[int, float]] = []
    for number, path in enumerate(paths, start=1):
        style, scaled = curve_style(number - 1), [value / 10.0**exponent for value in path["discriminant"]]
        places = range(1, len(scaled) + 1)
        axes.plot(places, scaled, **style.line, marker=style.marker, markersize=3.5, label=f"flight {number}")
        ringed += [(place, value) for place, value in zip(places, scaled, strict=True) if value <= 0]
    axes.axhline(0, color=colour("ink"), linewidth=0.8)
    xs, ys = [place for place, _ in ringed], [value for _, value in ringed]
    axes.plot(xs, ys, **_RINGED, markersize=8, label="Δ ≤ 0: rotors asked")
    axes.set(xlabel="position", ylabel=f"Δ ({power_of_ten(exponent)})" if exponent else "Δ")
    axes.set_title("Δ along the way")


def _table(table: dict[str, Any]) -> Plot:
    """Draw the printed percentages of Table 5 and the simulated ones over the step v·t."""
    figure = new_figure(620, 400)
    axes = figure.subplots()
    other = table["second_row_read_as_0.25"]
    rows = [
        *zip(table["t"], table["percent"], table["standard_error"], strict=True),
        (other["t"], other["percent"], other["standard_error"]),
    ]
    simulated = [
        (time * speed, percent, 2 * (error or 0.0))
        for time, percents, errors in rows
        for speed, percent, error in zip(table["v"], percents, errors, strict=True)
    ]
    across, percents, errors = zip(*sorted(simulated), strict=True)
    axes.plot(across, percents, color=colour("soft"), linewidth=0.6, zorder=1)
    bars: dict[str, Any] = {"fmt": "none", "color": colour("soft"), "capsize": 2.5, "linewidth": 1.2}
    axes.errorbar(across, percents, yerr=errors, **bars, label="simulated, ± 2 standard errors")
    printed: list[tuple[int, float, str, dict[str, Any]]] = [
        *((row, time, f"printed, t = {time:g} s", {}) for row, time in enumerate(table["t"])),
        (1, other["t"], "printed, t = 0.2 s read as 0.25 s", {"markerfacecolor": "none"}),
    ]
    for row, time, label, look in printed:
        steps = [time * speed for speed in table["v"]]
        axes.plot(steps, table["printed"][row], **curve_style(row).marks, label=label, **look)
    axes.set(xlabel="step v·t (m)", ylabel="executions with Δ ≤ 0 (%)")
    axes.legend(**_FRAMED)
    description = (
        f"The printed figures of Table 5 and simulated ones of {table['runs']:,} runs over the step v·t. "
        f"Root mean square difference {table['root_mean_square_difference']:.2f} as printed, "
        f"{other['root_mean_square_difference']:.2f} with the second row read as 0.25 s. {table['statement']}"
    )
    return Plot("tower-table-5", "The paper's Table 5, printed and simulated", description, figure)


def _pitch(assumptions: dict[str, Any], pitch: dict[str, Any]) -> Plot:
    """Draw the body upright and tilted beside the wall, and the share of answers changed by the tilt, over the step."""
    figure = new_figure(760, 380)
    section, shares = figure.subplots(1, 2, width_ratios=[1, 1.5])
    _section(section, assumptions, pitch["degrees"])
    cells = sorted(pitch["cells"], key=lambda cell: float(cell["t"] * cell["v"]))
    steps = [cell["t"] * cell["v"] for cell in cells]
    dangerous = [cell["dangerous"] for cell in cells]
    needless = [cell["wrong"] - cell["dangerous"] for cell in cells]
    kinds = ((needless, "needless: refused, though clear"), (dangerous, "dangerous: accepted, though not clear"))
    for place, (counts, label) in enumerate(kinds):
        style = curve_style(place)
        percents = [100 * count / max(1, cell["moves"]) for count, cell in zip(counts, cells, strict=True)]
        shares.plot(steps, percents, **style.line, marker=style.marker, label=label)
    shares.set_ylim(bottom=-0.02 * max(1e-9, shares.get_ylim()[1]))
    shares.set(xlabel="step v·t (m)", ylabel="wrong answers about horizontal moves (%)")
    shares.legend(**_FRAMED)
    total = pitch["total"]
    description = (
        f"Left: the body in a section through the tower's axis, upright and tilted outwards by {pitch['degrees']:g} "
        f"degrees, where the upright one just touches the wall. Right: of {total['moves']:,} horizontal moves the "
        f"upright model's answer is wrong about {total['wrong']:,}, dangerous for {total['dangerous']:,}."
    )
    return Plot("tower-pitch", "A quadcopter tilted into its movement, and the upright model", description, figure)


def _section(axes: Axes, assumptions: dict[str, Any], degrees: float) -> None:
    """Draw the body from the side, upright and tilted, where its upright ellipse touches the wall at the waist."""
    alpha, gamma, b, d = (assumptions[name] for name in ("alpha", "gamma", "b", "d"))
    across, up = (size * np.array(part) for size, part in zip((b, d), _circle((0, 0), 1, 96), strict=True))
    for place, (lean, label) in enumerate(((0.0, "upright"), (math.radians(degrees), f"tilted by {degrees:g}°"))):
        x = alpha - b + across * math.cos(lean) + up * math.sin(lean)
        z = up * math.cos(lean) - across * math.sin(lean)
        axes.plot(x, z, **curve_style(place).line, label=label)
    heights = [1.6 * b * step / 20 for step in range(-20, 21)]
    wall = [alpha * math.hypot(1, z / gamma) for z in heights]
    axes.plot(wall, heights, color=colour("ink"), linewidth=1.6, label="wall")
    axes.set_aspect("equal")
    axes.set(xlabel="distance from the axis (m)", ylabel="z (m)")
    axes.legend(loc="upper left", **_FRAMED)
