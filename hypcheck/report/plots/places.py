"""Where each method of a benchmark is wrong in the half plane of a scene, and in the ring."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from msgspec.structs import asdict

from hypcheck.record import Record
from hypcheck.record.measurements import Places
from hypcheck.report.plots import raster
from hypcheck.report.plots.style import SMALL, colour, new_figure
from hypcheck.report.plots.svg import Plot
from hypcheck.report.text import listed

MISTAKES = {"c": ("false clear", "clear"), "w": ("false contact", "contact"), "s": ("wrong side", "side")}
"""The letters of wrong answers: what they are called, and the role of their colour."""


def plots(record: Record) -> Iterator[Plot]:
    """A small plot for each method, scene and region in which it is wrong."""
    for number, line in enumerate(record.of(Places)):
        if any(set(text) & set(MISTAKES) for text in line.wrong):
            yield _plot(f"places-{number}", line)


def right(record: Record) -> list[str]:
    """The methods that are wrong nowhere in all that was looked at."""
    wrong = {line.method for line in record.of(Places) if any(set(text) & set(MISTAKES) for text in line.wrong)}
    return [name for name in dict.fromkeys(line.method for line in record.of(Places)) if name not in wrong]


def _plot(name: str, line: Places) -> Plot:
    drawn = new_figure(SMALL, 185)
    axes = drawn.subplots()
    r, z = (line.r[0], line.r[1]), (line.z[0], line.z[1])
    colours = {letter: colour(role) for letter, (_, role) in MISTAKES.items()}
    raster.show(axes, line.wrong, {".": raster.FAINT, **colours}, r, z)
    raster.surface(axes, (line.scene.alpha, line.scene.gamma), r, z, colour("ink"))
    raster.mark(axes, line.wrong, colours, r, z)
    axes.set(xlabel="r (m)", ylabel="z (m)")
    axes.locator_params(nbins=4)
    counts = Counter(letter for text in line.wrong for letter in text)
    found = [f"{counts[letter]:,} {what}" for letter, (what, _) in MISTAKES.items() if counts[letter]]
    where = "near the ring" if line.region == "ring" else "around the scene"
    scene = ", ".join(f"{size} {value:g}" for size, value in asdict(line.scene).items())
    said = f"Wrong answers {where} ({scene}) at {sum(counts.values()):,} grid points: {listed(found)}."
    return Plot(name, f"{line.method}, {where}", said, drawn)
