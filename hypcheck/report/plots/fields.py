"""Where each judged method of a verification errs in the half plane, in semi-axes of the hyperboloid: r/α and |z|/γ."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.report.digest import Implementation, implementations
from hypcheck.report.plots import heat
from hypcheck.report.plots.raster import FAINT
from hypcheck.report.plots.style import SMALL, colour, new_figure
from hypcheck.report.plots.svg import Plot

CELLS, PER_UNIT = 64, 8
"""Cells of the record in each direction, and in one semi-axis; the last of each stands for all that lies beyond."""


def plots(record: Record) -> Iterator[Plot]:
    """A small plot for each method that erred."""
    for number, each in enumerate(implementations(record)):
        found = heat.cells(row for group in each.groups for row in group.place_bins)
        if any(wrong for _, wrong in found.values()):
            yield _plot(f"fields-{number}", each, found)


def _plot(name: str, each: Implementation, found: heat.Cells) -> Plot:
    import numpy as np  # noqa: PLC0415
    from matplotlib.colors import to_rgba  # noqa: PLC0415

    drawn = new_figure(SMALL, 170)
    axes = drawn.subplots()
    image = np.zeros((CELLS, CELLS, 4))
    steps: Counter[str] = Counter()
    for (across, up), (asked, wrong) in found.items():
        role = heat.step(asked, wrong)
        steps[role] += 1
        image[min(up, CELLS - 1), min(across, CELLS - 1)] = to_rgba(FAINT if role == "share-0" else colour(role))
    end = CELLS / PER_UNIT
    axes.imshow(image, extent=(0, end, 0, end), origin="lower", interpolation="nearest", aspect="auto")
    axes.grid(visible=False)
    axes.set(xlabel="r/α", ylabel="|z|/γ")
    axes.set_xticks(range(0, 9, 2))
    axes.set_yticks(range(0, 9, 2))
    asked, wrong = (sum(counts[k] for counts in found.values()) for k in (0, 1))
    some = sum(number for role, number in steps.items() if role != "share-0")
    said = (
        f"Share of wrong answers over r/α and |z|/γ: {wrong:,} of {asked:,} wrong, in {some:,} of {len(found):,} cells."
    )
    return Plot(name, each.name, said, drawn)
