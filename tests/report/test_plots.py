"""Plots show the record's numbers at their places, each with a tooltip, in looks that differ."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import pytest
from matplotlib.text import Text

from hypcheck.record import read
from hypcheck.record.measurements import SpeedLine
from hypcheck.report.plots import PLOTS, curves, draw_plots, pareto, planes
from hypcheck.report.plots.curves import TANGENT, Octave, curve, in_parts
from hypcheck.report.plots.pareto import ParetoPoint, front
from hypcheck.report.plots.style import ROLES, curve_style, decades, new_figure, power_of_ten, styled, ticks
from tests.report import record_samples
from tests.report.bench_lines import bench_record
from tests.report.test_advice import method
from tests.report.test_worst_way import THROUGH, case, ways


def luminance(colour):
    channels = (int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5))
    linear = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels)
    return sum(weight * c for weight, c in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def contrast(one, other):
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("ground", [0, 1])
def test_plot_colours_have_enough_contrast_with_the_background(ground):
    surface = ROLES["surface"][ground]
    for role, both in ROLES.items():
        least = {"surface": 1, "rule": 1, "share-0": 1, "share-1": 1, "share-2": 1, "ink": 12, "soft": 4.5}.get(role, 3)
        assert contrast(both[ground], surface) >= least, role


def test_no_two_roles_of_a_plot_have_the_same_colour():
    assert len({light for light, _ in ROLES.values()}) == len(ROLES)


def test_all_curves_of_a_plot_have_different_markers_and_dashes():
    looks = [curve_style(place) for place in range(curves.AT_MOST)]
    for one, other in combinations(looks, 2):
        assert one.marker != other.marker
        assert one.dashes != other.dashes
    assert len({(each.colour, each.marker, str(each.dashes)) for each in map(curve_style, range(40))}) == 40


def test_curve_without_wrong_answers_is_drawn_at_the_upper_confidence_limit():
    assert Octave(-3, 300, 0).share == 0.01
    assert Octave(-3, 300, 6).share == 0.02
    assert Octave(-3, 2, 0).share == 1.0


def test_many_distance_exponents_are_merged_in_a_curve_without_losing_cases():
    few = curve("few", {-3.0: (10, 1), -2.0: (20, 0), TANGENT: (5, 2)})
    assert few.octaves == (Octave(TANGENT, 5, 2), Octave(-3, 10, 1), Octave(-2, 20, 0))
    many = curve("many", {float(k): (10, int(k == -30)) for k in range(-40, 0)})
    assert {octave.width for octave in many.octaves} == {3}
    assert (many.asked, many.wrong) == (400, 1)
    wrong = next(octave for octave in many.octaves if octave.wrong)
    assert wrong.exponent <= -30 < wrong.exponent + wrong.width


def test_marks_of_a_curve_are_at_their_distance_exponents():
    found = curve("m", {-9.0: (10, 5), -5.0: (100, 1), -1.0: (1000, 0)})
    with styled():
        plot = curves.curve_plot("p", "title", [found])
    axes = plot.figure.axes[0]
    marks = {line.get_gid(): line for line in axes.lines if line.get_gid()}
    assert [list(line) for line in zip(*marks["p-0-wrong"].get_data(), strict=True)] == [[-8.5, 0.5], [-4.5, 0.01]]
    assert [list(line) for line in zip(*marks["p-0-none"].get_data(), strict=True)] == [[-0.5, 0.003]]
    assert marks["p-0-none"].get_marker() == "v" != marks["p-0-wrong"].get_marker()
    assert plot.tips["p-0-none"] == ["m, about 0.707: 0 of 1,000 wrong, so at most a share of 0.003"]
    legends = [text.get_text() for legend in plot.figure.legends for text in legend.get_texts()]
    assert legends == ["none of n wrong: at most 3/n (95 %)", "m"]


def test_cases_at_infinite_distance_are_left_out_of_a_curve():
    found = curve("one", {-3.0: (5, 1), math.inf: (7, 7)})
    assert [(octave.exponent, octave.asked, octave.wrong) for octave in found.octaves] == [(-3.0, 5, 1)]
    assert curve("none", {math.inf: (7, 0)}).octaves == ()


def test_many_curves_are_divided_evenly_among_plots():
    assert [len(part) for part in in_parts(range(9))] == [4, 5]
    assert [len(part) for part in in_parts(range(8))] == [8]
    assert list(in_parts([])) == []


@pytest.mark.parametrize(
    ("asked", "wrong", "role"),
    [(10, 0, 0), (1000, 1, 1), (100, 1, 1), (100, 2, 2), (10, 1, 2), (10, 2, 3), (10, 5, 3), (10, 6, 4), (1, 1, 4)],
)
def test_heat_map_has_a_colour_step_for_each_share_of_wrong_answers(asked, wrong, role):
    assert planes.step(asked, wrong) == f"share-{role}"


def test_heat_map_merges_cells_by_sums_also_at_negative_indices():
    assert planes.cells([[-1, 0, 5, 1], [-2, 1, 5, 2], [0, 0, 7, 0]], 2) == {(-1, 0): (10, 3), (0, 0): (7, 0)}


def test_pareto_front_has_the_points_that_no_other_point_beats():
    points = [
        ParetoPoint("fast", "C", 1.0, 1e-3, 5000, exact=False),
        ParetoPoint("beaten", "C", 2.0, 1e-2, 5000, exact=False),
        ParetoPoint("alike", "C", 2.0, 1e-3, 5000, exact=False),
        ParetoPoint("better", "C", 3.0, 1e-6, 5000, exact=False),
        ParetoPoint("never wrong", "numpy", 9.0, 0.0, 5000, exact=False),
        ParetoPoint("slow and sure", "numpy", 10.0, 0.0, 5000, exact=False),
        ParetoPoint("useless", "FCL", 20.0, math.inf, 5000, exact=False),
    ]
    assert [point.name for point in front(points)] == ["fast", "better", "never wrong"]


def test_pareto_point_with_too_few_answers_is_drawn_hollow():
    assert ParetoPoint("a", "C", 1.0, 0.0, pareto.ENOUGH, exact=False).shown
    assert not ParetoPoint("a", "C", 1.0, 0.0, pareto.ENOUGH - 1, exact=False).shown
    assert 3 / pareto.ENOUGH == 1 / 1000


def test_plot_labels_overlap_neither_each_other_nor_points_nor_lines():
    points = [(x / 10, y / 10) for x in range(2, 9, 2) for y in range(2, 9)]
    lines = [((0.0, 0.5), (1.0, 0.5))]
    with styled():
        drawn = new_figure(380, 300)
        axes = drawn.subplots()
        axes.set(xlim=(0, 1), ylim=(0, 1))
        pareto.place_labels(axes, points, [f"name {number}" for number in range(len(points))], lines)
        renderer = drawn.canvas.get_renderer()
        boxes = [text.get_window_extent(renderer) for text in axes.texts]
        places = [axes.transData.transform(point) for point in points]
        level = axes.transData.transform((0, 0.5))[1]
    assert len(boxes) > 5
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))
    assert not any(box.contains(*place) for box in boxes for place in places)
    assert not any(box.y0 <= level <= box.y1 for box in boxes)


@pytest.mark.parametrize(
    ("low", "high", "wanted"),
    [
        (1e-9, 2.0, ["10⁻⁸", "10⁻⁶", "10⁻⁴", "0.01", "1"]),
        (0.3, 0.95, ["0.3", "0.4", "0.5", "0.6", "0.8"]),
        (0.15, 0.6, ["0.2", "0.5"]),
        (3e5, 6e5, ["3·10⁵", "4·10⁵", "5·10⁵", "6·10⁵"]),
        (0.5, 2e3, ["1", "10", "100", "10³"]),
    ],
)
def test_a_logarithmic_axis_always_has_two_marks(low, high, wanted):
    assert [label for _, label in ticks(low, high)] == wanted


def test_axis_labels_show_powers_of_ten_as_plain_numbers_or_with_an_exponent():
    assert [power_of_ten(k) for k in (-17, -3, -2, 0, 2, 3)] == ["10⁻¹⁷", "10⁻³", "0.01", "1", "100", "10³"]
    assert decades(1e-18, 1.0) == [-18, -15, -12, -9, -6, -3, 0]


@pytest.mark.parametrize("name", PLOTS)
def test_axes_of_every_plot_have_names(name):
    about_ways = ways(case("way-long/1/1/3", *THROUGH, 2.0))
    records = [about_ways] if name == "ways" else [record_samples.record(), bench_record()]
    found = [axes for record in records for plot in draw_plots(name, record) for axes in plot.figure.axes]
    assert found
    for axes in found:
        assert axes.get_xlabel()
        assert axes.get_ylabel() or len(axes.get_yticklabels()) > 1


@pytest.mark.parametrize(
    ("exact", "reliable", "asked", "explained"),
    [
        (False, 1e-6, 4000, set()),
        (True, 0.0, 4000, {"none wrong", "ringed"}),
        (False, 1e-6, 2900, {"hollow"}),
    ],
)
def test_a_plot_of_errors_against_time_explains_only_the_marks_that_it_has(exact, reliable, asked, explained):
    """A mark is hollow for few answers, has a ring for a promise, and a height of its own without errors."""
    lines = [*method("plain", 1.0, {"uniform": 1e-9}), *method("other", 2.0, {"uniform": reliable}, exact=exact)]
    lines = [line | {"asked": asked} if line["type"] == "accuracy" else line for line in lines]
    (plot, *_) = draw_plots("pareto", bench_record(lines))
    shown = [text.get_text() for text in plot.figure.findobj(Text)]
    marks = ("none wrong", "ringed", "hollow")
    assert {mark for mark in marks if any(text.startswith(mark) for text in shown)} == explained


def test_sweeps_that_were_not_timed_have_no_plot_against_time():
    golden = read(Path(__file__).parent / "goldens" / "bench-ways" / "record.jsonl")
    assert [plot.name for plot in draw_plots("front", golden)] == ["front-missed", "front-false"]
    untimed = replace(golden, lines=tuple(line for line in golden.lines if not isinstance(line, SpeedLine)))
    assert list(draw_plots("front", untimed)) == []


def test_no_plot_is_drawn_for_a_record_without_its_lines():
    for name in PLOTS:
        assert list(draw_plots(name, record_samples.record([]))) == []
