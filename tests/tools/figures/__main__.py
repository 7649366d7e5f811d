"""The pictures of docs/figures.md, redrawn from simulations, the README's of the two bodies, and that of a landing.

Each is drawn as SVG and PDF.

`python -m tests.tools.figures` (`make figures`) writes them.
"""

from __future__ import annotations

import io
from functools import cache
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.backends.backend_pdf import FigureCanvasPdf

from hypcheck.paper.forest import ForestPlan, simulate_forest
from hypcheck.paper.tower import TowerPlan, simulate_tower
from hypcheck.report.plots.simulations import flights, forest_plots
from hypcheck.report.plots.style import Plot, standalone, styled
from hypcheck.scene.reading import read_scene
from tests.tools.figures import bodies, landing, paper

DOCS = Path(__file__).resolve().parents[3] / "docs"
DRAWN_WITH = DOCS / "figures" / "drawn-with.txt"
SEED = 3


def versions() -> str:
    """What decides how a picture's bytes come out."""
    return f"matplotlib {matplotlib.__version__}, numpy {np.__version__}\n"


def printed(plot: Plot) -> bytes:
    """The plot as PDF, for LaTeX; surfaces are images of 200 dots an inch, letters stay letters."""
    stream = io.BytesIO()
    with styled(), matplotlib.rc_context({"pdf.fonttype": 42, "figure.dpi": 200}):
        plot.figure.set_dpi(200)
        plot.figure.set_facecolor("white")
        FigureCanvasPdf(plot.figure).print_pdf(stream, metadata={"CreationDate": None, "Title": plot.title})
    return stream.getvalue()


def both(path: str, plot: Plot) -> dict[str, bytes]:
    """The plot's two files, by their paths."""
    return {f"{path}.svg": standalone(plot), f"{path}.pdf": printed(plot)}


@cache
def pictures() -> dict[str, bytes]:
    """Every picture that takes seconds, by its path below docs/; Table 5's takes minutes and is not among them."""
    walked = simulate_forest(ForestPlan(read_scene("forest"), SEED, None, continuous=True))
    flown = simulate_tower(TowerPlan(read_scene("tower"), 1, 5.0, 0.2, 0), None, lambda _: None)
    with styled():
        drawn = {plot.name: plot for plot in (*forest_plots(walked), flights(flown), *paper.plots(walked, flown))}
        files: dict[str, bytes] = {}
        for name, plot in drawn.items():
            files |= both(f"{'figures' if name.startswith('figure') else 'simulate'}/{name}", plot)
        return files


def bodies_pictures() -> dict[str, bytes]:
    """The pictures of the two bodies and of the landing, which take no simulation."""
    with styled():
        return both("figures/bodies", bodies.plot()) | both("figures/landing", landing.plot())


def main() -> None:
    """Write them."""
    DRAWN_WITH.parent.mkdir(exist_ok=True)
    for name, content in (pictures() | bodies_pictures()).items():
        (DOCS / name).write_bytes(content)
    DRAWN_WITH.write_text(versions(), encoding="utf-8")


if __name__ == "__main__":
    main()
