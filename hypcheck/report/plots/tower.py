"""Pictures of `simulate tower`: the paper's Figure 4 redrawn, its Table 5 over the step v·t, a leaning quadcopter."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import SubFigure
from matplotlib.ticker import MaxNLocator

from hypcheck.report.plots.style import (
    CurveStyle,
    colour,
    curve_style,
    in_space,
    mark_contacts,
    new_figure,
    power_of_ten,
)
from hypcheck.report.plots.svg import Plot

_RINGED: dict[str, Any] = {
    "linestyle": "none",
    "marker": "o",
    "markerfacecolor": "none",
    "markeredgecolor": colour("ink"),
    "markeredgewidth": 1.1,
}
"""The mark of a position where Δ ≤ 0, about the flight's own."""

_ROUND = [2 * math.pi * step / 96 for step in range(97)]


def flights(result: dict[str, Any]) -> Plot:
    """The flights of a result."""
    assumptions, flown = result["assumptions"], result["flights"]
    figure = new_figure(760, 580)
    halves: Any = figure.subfigures(1, 2, width_ratios=[1, 1.1])
    left, right = halves
    above, along = right.subplots(2, 1, height_ratios=[1.35, 1], gridspec_kw={"hspace": 0.08})
    solid = _solid(left, assumptions, flown["paths"])
    _above(above, assumptions, flown["paths"])
    _discriminants(along, flown["paths"])
    mark_contacts([solid, above], flown["ways"])
    handles = [handle for axes in (above, along) for handle in axes.get_legend_handles_labels()[0]]
    figure.legend(handles=handles, loc="outside lower center", ncols=4)
    said = (
        f"Inside a hyperboloid with α = {assumptions['alpha']:g} m and γ = {assumptions['gamma']:g} m, "
        f"{len(flown['paths'])} random flights with steps of {flown['step']:g} m, from the side and from above, and "
        "the discriminant Δ of the body's cubic at each position: at one height it falls towards the wall, across "
        "heights it does not tell how near the wall is, and where it is not above 0 the rotors are asked."
    )
    return Plot("tower-flights", "Flights inside a cooling tower, and Δ along them", said, figure)


def _solid(figure: SubFigure, assumptions: dict[str, Any], paths: list[dict[str, Any]]) -> Any:  # noqa: ANN401 - axes in space
    axes: Any = figure.add_axes((-0.33, 0.0, 1.6, 1.0), projection="3d")  # a square, wider than what is drawn in it
    axes.patch.set_visible(False)
    low, high = _heights(assumptions, paths)
    height, angle = np.meshgrid(np.linspace(low, high, 15), np.linspace(0, 2 * np.pi, 25), indexing="ij")
    radius = assumptions["alpha"] * np.hypot(1, height / assumptions["gamma"])
    axes.plot_wireframe(
        radius * np.cos(angle), radius * np.sin(angle), height, color=colour("soft"), linewidth=0.4, alpha=0.55
    )
    for place, path in enumerate(paths):
        style = curve_style(place)
        columns = zip(*path["positions"], strict=True)
        axes.plot(*columns, color=style.colour, linestyle=style.dashes, marker=style.marker, markersize=3, zorder=3)
        axes.plot(*_columns(_touching(path), 3), **_RINGED, markersize=7, zorder=4)
    axes.set_box_aspect((1, 1, 2.2), zoom=0.84)
    axes.view_init(elev=20, azim=-60)
    axes.set(xlabel="x (m)", ylabel="y (m)", zlabel="z (m)")
    in_space(axes)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(3))
    figure.text(0.44, 0.975, "in space (z drawn shorter)", ha="center", va="top")
    return axes


def _heights(assumptions: dict[str, Any], paths: list[dict[str, Any]]) -> tuple[float, float]:
    """The part of the tower that is drawn: what is modelled, or what the flights use of it."""
    if assumptions["height"] is not None:
        return float(assumptions["height"][0]), float(assumptions["height"][1])
    heights = [position[2] for path in paths for position in path["positions"]]
    return min(heights) - 1, max(heights) + 1


def _touching(path: dict[str, Any]) -> list[list[float]]:
    """The positions with Δ ≤ 0."""
    return [at for at, value in zip(path["positions"], path["discriminant"], strict=True) if value <= 0]


def _columns(points: list[list[float]], number: int) -> list[list[float]]:
    """The first coordinates of points, each as a list; empty ones where there is no point."""
    return [[point[place] for point in points] for place in range(number)]


def _above(axes: Axes, assumptions: dict[str, Any], paths: list[dict[str, Any]]) -> None:
    widest = max(math.hypot(1, height / assumptions["gamma"]) for height in _heights(assumptions, paths))
    end = "end of what is drawn" if assumptions["height"] is None else "the tower's end"
    circles: tuple[tuple[float, Any, str], ...] = ((1.0, "-", "waist"), (widest, (0, (1, 1.2)), end))
    for factor, dashes, label in circles:
        radius = assumptions["alpha"] * factor
        circle = [(radius * math.cos(angle), radius * math.sin(angle)) for angle in _ROUND]
        across, along = zip(*circle, strict=True)
        axes.plot(across, along, color=colour("soft"), linestyle=dashes, linewidth=1, label=label)
    for place, path in enumerate(paths):
        style = curve_style(place)
        x, y, _ = zip(*path["positions"], strict=True)
        axes.plot(x, y, color=style.colour, linestyle=style.dashes, marker=style.marker, markersize=3.5)
        axes.plot(*_columns(_touching(path), 2), **_RINGED, markersize=8)
    axes.set_aspect("equal")
    axes.set(xlabel="x (m)", ylabel="y (m)")
    axes.set_title("from above")


def _discriminants(axes: Axes, paths: list[dict[str, Any]]) -> None:
    values = [value for path in paths for value in path["discriminant"]]
    exponent = math.floor(math.log10(max(map(abs, values)) or 1.0))
    for place, path in enumerate(paths):
        style = curve_style(place)
        scaled = [value / 10.0**exponent for value in path["discriminant"]]
        axes.plot(
            range(1, len(scaled) + 1),
            scaled,
            color=style.colour,
            linestyle=style.dashes,
            marker=style.marker,
            markersize=3.5,
            label=f"flight {place + 1}",
        )
    axes.axhline(0, color=colour("ink"), linewidth=0.8)
    ringed = [
        (place, value / 10.0**exponent)
        for path in paths
        for place, value in enumerate(path["discriminant"], start=1)
        if value <= 0
    ]
    axes.plot(*_columns([list(each) for each in ringed], 2), **_RINGED, markersize=8, label="Δ ≤ 0: rotors asked")
    axes.set(xlabel="position", ylabel=f"Δ ({power_of_ten(exponent)})" if exponent else "Δ")
    axes.set_title("Δ along the way")


def plots(result: dict[str, Any]) -> Iterator[Plot]:
    """The flights, and the table where there is one."""
    yield flights(result)
    if result["table_5"] is not None:
        yield _table(result["table_5"])
    if result["pitch"] is not None:
        yield _pitch(result["assumptions"], result["pitch"])


def _table(table: dict[str, Any]) -> Plot:
    figure = new_figure(620, 400)
    axes = figure.subplots()
    other = table["second_row_read_as_0.25"]
    simulated = [
        (time * speed, percent, error or 0.0)
        for time, percents, errors in (
            *zip(table["t"], table["percent"], table["standard_error"], strict=True),
            (other["t"], other["percent"], other["standard_error"]),
        )
        for speed, percent, error in zip(table["v"], percents, errors, strict=True)
    ]
    across, percents, errors = zip(*sorted(simulated), strict=True)
    axes.plot(across, percents, color=colour("soft"), linewidth=0.6, zorder=1)
    axes.errorbar(
        across,
        percents,
        yerr=[2 * error for error in errors],
        fmt="none",
        color=colour("soft"),
        capsize=2.5,
        linewidth=1.2,
        label="simulated, ± 2 standard errors",
    )
    for place, (time, printed) in enumerate(zip(table["t"], table["printed"], strict=True)):
        style = curve_style(place)
        steps = [time * speed for speed in table["v"]]
        axes.plot(
            steps, printed, linestyle="none", marker=style.marker, color=style.colour, label=f"printed, t = {time:g} s"
        )
    label = "printed, t = 0.2 s read as 0.25 s"
    _printed(axes, table["v"], other["t"], table["printed"][1], curve_style(1), label, markerfacecolor="none")
    axes.set(xlabel="step v·t (m)", ylabel="executions with Δ ≤ 0 (%)")
    axes.legend(frameon=True, facecolor=colour("surface"), edgecolor="none", framealpha=1)
    said = (
        f"The printed figures of Table 5 and simulated ones of {table['runs']:,} runs over the step v·t. "
        f"Root mean square difference {table['root_mean_square_difference']:.2f} as printed, "
        f"{other['root_mean_square_difference']:.2f} with the second row read as 0.25 s. {table['statement']}"
    )
    return Plot("tower-table-5", "The paper's Table 5, printed and simulated", said, figure)


def _printed(
    axes: Axes, speeds: list[float], time: float, figures: list[float], style: CurveStyle, label: str, **paint: str
) -> None:
    steps = [time * speed for speed in speeds]
    axes.plot(steps, figures, linestyle="none", marker=style.marker, color=style.colour, label=label, **paint)  # type: ignore[arg-type]


def _pitch(assumptions: dict[str, Any], pitch: dict[str, Any]) -> Plot:
    """The body upright and leaning beside the wall, and how often that changes the answer, over the step."""
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
        shares.plot(steps, percents, color=style.colour, marker=style.marker, linestyle=style.dashes, label=label)
    shares.set_ylim(bottom=-0.02 * max(1e-9, shares.get_ylim()[1]))
    shares.set(xlabel="step v·t (m)", ylabel="wrong answers about horizontal moves (%)")
    shares.legend(frameon=True, facecolor=colour("surface"), edgecolor="none", framealpha=1)
    total = pitch["total"]
    said = (
        f"Left: the body in a section through the tower's axis, upright and leaning outwards by {pitch['degrees']:g} "
        f"degrees, where the upright one just touches the wall. Right: of {total['moves']:,} horizontal moves the "
        f"upright model's answer is wrong about {total['wrong']:,}, dangerous for {total['dangerous']:,}."
    )
    return Plot("tower-pitch", "A quadcopter that leans into its movement, and the upright model", said, figure)


def _section(axes: Axes, assumptions: dict[str, Any], degrees: float) -> None:
    """The body where its upright ellipse touches the wall at the waist, from the side."""
    alpha, gamma, b, d = (assumptions[name] for name in ("alpha", "gamma", "b", "d"))
    centre, tilt = alpha - b, math.radians(degrees)
    for style, angle, label in (
        (curve_style(0), 0.0, "upright"),
        (curve_style(1), tilt, f"leaning by {degrees:g}°"),
    ):
        ring = [(b * math.cos(each), d * math.sin(each)) for each in _ROUND]
        x = [centre + across * math.cos(angle) + up * math.sin(angle) for across, up in ring]
        z = [up * math.cos(angle) - across * math.sin(angle) for across, up in ring]
        axes.plot(x, z, color=style.colour, linestyle=style.dashes, label=label)
    heights = [1.6 * b * step / 20 for step in range(-20, 21)]
    wall = [alpha * math.hypot(1, z / gamma) for z in heights]
    axes.plot(wall, heights, color=colour("ink"), linewidth=1.6, label="wall")
    axes.set_aspect("equal")
    axes.set(xlabel="distance from the axis (m)", ylabel="z (m)")
    axes.legend(loc="upper left", frameon=True, facecolor=colour("surface"), edgecolor="none", framealpha=1)
