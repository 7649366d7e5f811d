"""Pictures of simulations: axes with units, no overlaps, the same file each time, and the drawn data."""

from __future__ import annotations

import itertools
from dataclasses import replace
from functools import cache
from xml.etree import ElementTree

import numpy as np
import pytest

from hypcheck.paper.forest import ForestPlan, simulate_forest
from hypcheck.paper.tower import ExactQuestions, TowerPlan, simulate_tower
from hypcheck.report.plots.simulations import TRUNKS, forest_plots, tower_plots
from hypcheck.report.plots.style import colour, standalone, styled
from hypcheck.scene.reading import read_scene

TOWER = read_scene("tower")
SHORT = replace(TOWER, flight=replace(TOWER.flight, distance=3.0))


@cache
def flown(scene=SHORT, runs=2, pitch=None):
    return simulate_tower(TowerPlan(scene, 1, 5.0, 0.2, runs, ExactQuestions(pitch=pitch)), None, lambda _: None)


@cache
def walked(steps, seed=3):
    return simulate_forest(ForestPlan(read_scene("forest"), seed, steps, continuous=False))


RESULTS = {
    "tower": lambda: (tower_plots, flown()),
    "tower leaning": lambda: (tower_plots, flown(pitch=35.0)),
    "tower without a table": lambda: (tower_plots, flown(runs=0)),
    "simplest": lambda: (tower_plots, flown(read_scene("tower-simplest"), runs=0)),
    "forest": lambda: (forest_plots, walked(1500)),
    "forest without phantoms": lambda: (forest_plots, walked(15)),
}


@pytest.mark.parametrize("name", RESULTS)
def test_simulation_picture_axes_have_units_and_nothing_overlaps(name):
    plots, result = RESULTS[name]()
    with styled():
        for plot in plots(result):
            plot.figure.canvas.draw()
            flat = [axes for axes in plot.figure.axes if axes.name != "3d"]
            boxes = [axes.get_tightbbox() for axes in plot.figure.axes if axes.name != "3d"]
            boxes += [legend.get_window_extent() for legend in plot.figure.legends]
            assert not any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))
            frame = plot.figure.bbox
            for box in boxes:
                assert frame.x0 - 1 <= box.x0 <= box.x1 <= frame.x1 + 1
                assert frame.y0 - 1 <= box.y0 <= box.y1 <= frame.y1 + 1
            for axes in plot.figure.axes:
                labels = [axes.get_xlabel(), axes.get_ylabel(), *([axes.get_zlabel()] if axes not in flat else [])]
                assert all(label in ("position", "Δ") or label.endswith(")") for label in labels), labels


def test_same_simulation_result_gives_the_same_picture_file():
    for plots, result in (RESULTS["tower without a table"](), RESULTS["forest without phantoms"]()):
        with styled():
            files = [standalone(next(plots(result))) for _ in range(2)]
        assert files[0] == files[1]
        ElementTree.fromstring(files[0])  # noqa: S314 - just written
        assert b"<desc" in files[0]


def test_flights_of_the_tower_are_drawn_at_their_positions():
    result = flown(runs=0)
    with styled():
        (plot,) = tower_plots(result)
    above, along, solid = sorted(plot.figure.axes, key=lambda axes: axes.name == "3d")
    for place, path in enumerate(result["flights"]["paths"]):
        positions = np.array(path["positions"])
        touching = np.array(path["discriminant"]) <= 0
        way, ringed = solid.lines[2 * place : 2 * place + 2]
        assert np.allclose(np.array(way.get_data_3d()).T, positions)
        assert np.allclose(np.array(ringed.get_data_3d()).T.reshape(-1, 3), positions[touching])
        way, ringed = above.lines[2 + 2 * place : 4 + 2 * place]
        assert np.allclose(way.get_xydata(), positions[:, :2])
        assert np.allclose(ringed.get_xydata().reshape(-1, 2), positions[touching, :2])
        drawn = along.lines[place].get_ydata()
        assert np.allclose(drawn / drawn[0], np.array(path["discriminant"]) / path["discriminant"][0])
    assert "Δ (10" in along.get_ylabel()


def test_table_5_is_drawn_over_the_length_of_a_step():
    table = flown()["table_5"]
    with styled():
        _, plot = tower_plots(flown())
    (axes,) = plot.figure.axes
    lines = {line.get_label(): line for line in axes.lines}
    printed = lines["printed, t = 0.2 s"]
    assert np.allclose(printed.get_xdata(), [1.0, 1.2, 1.4, 1.6, 1.8, 2.0])
    assert printed.get_ydata().tolist() == table["printed"][1]
    other = lines["printed, t = 0.2 s read as 0.25 s"]
    assert np.allclose(other.get_xdata(), [1.25, 1.5, 1.75, 2.0, 2.25, 2.5])
    assert other.get_markerfacecolor() == "none"
    assert "not identified by the table" in plot.description


def test_shares_of_wrong_answers_by_pitch_are_drawn_over_the_length_of_a_step():
    result = flown(pitch=35.0)
    with styled():
        *_, plot = tower_plots(result)
    assert plot.name == "tower-pitch"
    section, shares = plot.figure.axes
    needless, dangerous = shares.lines
    for line, wanted in (
        (needless, lambda cell: cell["wrong"] - cell["dangerous"]),
        (dangerous, lambda cell: cell["dangerous"]),
    ):
        expected = sorted(
            (cell["t"] * cell["v"], 100 * wanted(cell) / cell["moves"]) for cell in result["pitch"]["cells"]
        )
        assert np.allclose(sorted(line.get_xydata().tolist()), expected)
    upright, leaning, wall = section.lines
    assert max(upright.get_xdata()) == pytest.approx(2.0)
    assert max(leaning.get_xdata()) < 2.0
    assert min(wall.get_xdata()) == 2.0


def test_every_stop_of_the_walk_is_drawn_with_the_ring_of_its_tree():
    result = walked(1500)
    with styled():
        plot, _ = forest_plots(result)
    above, wall = plot.figure.axes
    drawn = {each.get_label(): each.get_offsets() for each in above.collections}
    for kind, label in (("contact", "rightly refused"), ("phantom", "stopped by a phantom")):
        tried = [stop["tried"][:2] for stop in result["stops"] if stop["kind"] == kind]
        assert np.allclose(np.array(drawn[label]), tried)
    guilty = [tree for tree in result["trees"] if tree["phantom"]]
    rings = [line for line in above.lines if line.get_linestyle() == "--"]
    assert len(rings) == len(guilty) > 0
    for line, tree in zip(rings, guilty, strict=True):
        assert np.allclose(np.hypot(*(line.get_xydata() - tree["center"][:2]).T), tree["ring"])
    image = wall.images[0].get_array()
    letters = np.array([list(line) for line in result["wall"]["lines"]])
    from matplotlib.colors import to_rgba

    assert np.allclose(image[letters == "E"], to_rgba(colour("clear")))


def test_trunk_colours_of_kinds_of_trees_differ_in_lightness():
    """Whoever sees no colours still tells them apart."""
    from matplotlib.colors import to_rgb

    light = [np.dot([0.2126, 0.7152, 0.0722], to_rgb(colour(paint))) for _, paint in TRUNKS.values()]
    assert abs(light[0] - light[1]) > 0.25


@pytest.mark.parametrize("name", ["tower-flights", "forest-walk", "forest-space"])
def test_first_contacts_of_simulated_sweeps_are_marked_at_their_place(name):
    contact = {"start": [0.0, 1.0, 2.0], "end": [1.0, 1.0, 0.0], "first_lower": 0.25, "first_upper": 0.25}
    plots, result = (tower_plots, flown(runs=0)) if name.startswith("tower") else (forest_plots, walked(15))
    if name.startswith("tower"):
        result = {**result, "flights": {**result["flights"], "ways": {"contacts": [contact]}}}
    else:
        result = {**result, "ways": {"contacts": [contact]}}
    with styled():
        plot = next(plot for plot in plots(result) if plot.name == name)
    marked = [line for axes in plot.figure.axes for line in axes.lines if "first contact" in str(line.get_label())]
    assert marked
    for line in marked:
        at = line.get_data_3d() if hasattr(line, "get_data_3d") else line.get_data()
        assert [float(each[0]) for each in at] == [0.25, 1.0, 1.5][: len(at)]
