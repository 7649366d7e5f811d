"""map.svg shows every grid point in the colour of its position, and the wrong ones in theirs; always the same bytes."""

from __future__ import annotations

import subprocess
import sys
from xml.etree import ElementTree

import numpy as np
from hypothesis import given, settings
from matplotlib.colors import to_rgb

from hypcheck.record.fields import as_json
from hypcheck.record.lines import MapLine
from hypcheck.report import plots
from hypcheck.report.plots import planes
from hypcheck.report.plots.style import styled
from tests.report import record_samples


def maps(body=None):
    return record_samples.record(body).of(MapLine)


def of_figure(body=None):
    with styled():
        return planes.maps_together(record_samples.record(body)).figure


def test_each_grid_point_of_the_scene_map_has_the_colour_of_its_position():
    colours = {letter: np.array(to_rgb(colour)) for letter, (_, colour) in planes.REGIONS.items()}
    panels = [axes for axes in of_figure().axes if axes.images]
    assert len(panels) == len(maps())
    for axes, line in zip(panels, maps(), strict=True):
        image = axes.images[0].get_array()
        assert axes.images[0].origin == "lower"  # the first line is the lowest z
        for up, text in enumerate(line.lines):
            for across, letter in enumerate(text):
                wanted = to_rgb(planes.WRONG) if letter.isupper() else colours[letter]
                assert np.allclose(image[up, across], [*wanted, 1])


def test_grid_point_of_the_scene_map_is_drawn_at_its_coordinates():
    tower, ring = (axes for axes in of_figure().axes if axes.images)
    left, right, low, high = tower.images[0].get_extent()
    assert np.allclose(
        [left, right, low, high], [-4.25, 38.25, -26.7, 26.7]
    )  # cells of 8.5 m by 17.8 m about 5 × 3 points
    assert np.allclose(tower.collections[0].get_offsets(), [[25.5, 0.0]])
    assert np.allclose(
        sorted(map(tuple, ring.collections[0].get_offsets())), [(29.7, 0), (29.75, 0), (29.75, 0.05), (29.8, 0)]
    )


def test_scene_map_axes_have_names_and_units_and_the_legend_is_complete():
    figure = of_figure()
    for axes in figure.axes:
        assert "(m)" in axes.get_xlabel()
        assert "(m)" in axes.get_ylabel()
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [
        "exterior",
        "contact",
        "interior",
        "hyperboloid",
        "wrong answer of table-2-float32",
    ]
    figure.canvas.draw()
    box = legend.get_window_extent()
    assert not any(box.overlaps(axes.get_tightbbox()) for axes in figure.axes)


def test_scene_map_colours_differ_in_lightness():
    """Whoever sees no colours, or prints without them, still tells them apart."""
    lightness = sorted(
        float(np.dot([0.2126, 0.7152, 0.0722], to_rgb(colour)))
        for colour in (planes.WRONG, *(colour for _, colour in planes.REGIONS.values()))
    )
    assert min(np.diff(lightness)) > 0.11
    assert lightness[1] - lightness[0] > 0.25  # what is wrong stands out


def test_matplotlib_settings_of_the_user_are_neither_used_nor_changed():
    import matplotlib

    drawn = plots.render_map(record_samples.record())

    with matplotlib.rc_context({"font.size": 30, "axes.facecolor": "red"}):
        before = dict(matplotlib.rcParams)
        assert plots.render_map(record_samples.record()) == drawn
        assert dict(matplotlib.rcParams) == before


def test_importing_the_writer_of_reports_loads_no_matplotlib():
    code = "import sys, hypcheck.report.write; sys.exit('matplotlib' in sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)


@settings(max_examples=4)
@given(foreign=record_samples.FOREIGN)
def test_a_map_with_any_foreign_name_is_valid_svg(foreign):
    body = record_samples.rewritten([as_json(line) for line in maps()], "table-2-float32", f"${foreign}$ \\frac")
    content = plots.render_map(record_samples.record(body))
    ElementTree.fromstring(content)  # noqa: S314
