"""Pictures of `simulate tower`: the paper's Figure 4 redrawn, and its Table 5 over the step v·t."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from hypcheck.report.plots.style import Look, colour, look, new_figure
from hypcheck.report.plots.svg import Plot
from hypcheck.report.simulation.tower_flights import flights

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plots(result: dict[str, Any]) -> Iterator[Plot]:
    """The flights, and the table where there is one."""
    yield flights(result)
    if result["table_5"] is not None:
        yield _table(result["table_5"])


def _table(table: dict[str, Any]) -> Plot:
    figure = new_figure(620, 400)
    axes = figure.subplots()
    other = table["second_row_read_as_0.25"]
    ours = [
        (time * speed, percent, error or 0.0)
        for time, percents, errors in (
            *zip(table["t"], table["percent"], table["standard_error"], strict=True),
            (other["t"], other["percent"], other["standard_error"]),
        )
        for speed, percent, error in zip(table["v"], percents, errors, strict=True)
    ]
    across, percents, errors = zip(*sorted(ours), strict=True)
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
        style = look(place)
        steps = [time * speed for speed in table["v"]]
        axes.plot(
            steps, printed, linestyle="none", marker=style.marker, color=style.colour, label=f"printed, t = {time:g} s"
        )
    told = "printed, t = 0.2 s read as 0.25 s"
    _printed(axes, table["v"], other["t"], table["printed"][1], look(1), told, markerfacecolor="none")
    axes.set(xlabel="step v·t (m)", ylabel="executions with Δ ≤ 0 (%)")
    axes.legend(frameon=True, facecolor=colour("surface"), edgecolor="none", framealpha=1)
    said = (
        f"The printed figures of Table 5 and simulated ones of {table['runs']:,} runs over the step v·t. "
        f"Root mean square difference {table['root_mean_square_difference']:.2f} as printed, "
        f"{other['root_mean_square_difference']:.2f} with the second row read as 0.25 s. {table['statement']}"
    )
    return Plot("tower-table-5", "The paper's Table 5, printed and simulated", said, figure)


def _printed(
    axes: Axes, speeds: list[float], time: float, figures: list[float], style: Look, told: str, **paint: str
) -> None:
    steps = [time * speed for speed in speeds]
    axes.plot(steps, figures, linestyle="none", marker=style.marker, color=style.colour, label=told, **paint)  # type: ignore[arg-type]
