"""A figure as SVG: classes in place of colours, no style attributes, ids of its own, the same bytes every time."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from xml.etree import ElementTree

import pytest

from hypcheck.errors import UnavailableError
from hypcheck.report import plots
from hypcheck.report.colours import colour_rules
from hypcheck.report.drawings import render_picture
from hypcheck.report.plots import draw_plots
from hypcheck.report.plots.style import ROLES, Plot, colour, inline, new_figure, standalone, styled
from tests.report import record_samples
from tests.report.bench_lines import bench_record

SVG = "{http://www.w3.org/2000/svg}"


def simple(name="p", tips=2, title="a title", label="<x> & $y$"):
    """Two marks, a line and a label."""
    with styled():
        drawn = new_figure(200, 150)
        axes = drawn.subplots()
        axes.plot([0, 1], [0, 1], color=colour("series-1"))
        axes.plot([0, 1], [0, 1], linestyle="none", marker="o", color=colour("series-2"), gid="marks")
        axes.set_xlabel(label)
    return Plot(name, title, "a description", drawn, {"marks": [f"mark {number}" for number in range(tips)]})


def parsed(text):
    return ElementTree.fromstring(text)  # noqa: S314 - just written


def test_svg_plot_uses_classes_for_colours_and_no_inline_style():
    text = inline(simple())
    assert "style" not in text
    assert not set(re.findall(r"#[0-9a-f]{6}", text)) & {light for light, _ in ROLES.values()}
    classes = set(" ".join(re.findall(r'class="([^"]*)"', text)).split()) - {"plot"}
    assert {"s-series-1", "f-series-2", "f-ink"} <= classes
    for each in classes:
        assert f".{each}{{" in colour_rules()


def test_foreign_text_in_a_plot_stays_text():
    assert [each.text for each in parsed(inline(simple())).iter(f"{SVG}text")].count("<x> & $y$") == 1


def test_every_mark_of_an_svg_plot_has_its_tooltip():
    root = parsed(inline(simple()))
    assert [use.find(f"{SVG}title").text for use in root.iter(f"{SVG}use") if use.find(f"{SVG}title") is not None] == [
        "mark 0",
        "mark 1",
    ]


def test_svg_plot_with_more_tooltips_than_marks_raises_value_error():
    with pytest.raises(ValueError, match="marks has 2 marks and 3 tooltips"):
        inline(simple(tips=3))


def test_svg_plot_has_a_title_and_a_description():
    root = parsed(inline(simple(title="\x1b[31m<b>\u202e")))
    assert root.get("role") == "img"
    texts = {each.get("id"): each.text for each in root if each.get("id")}
    assert [texts[name] for name in root.get("aria-labelledby").split()] == [r"\x1b[31m<b>\u202e", "a description"]


def test_two_svg_plots_share_no_id():
    first, second = (set(re.findall(r'id="([^"]*)"', inline(simple(name)))) for name in ("p", "q"))
    assert first
    assert not first & second
    used = set(re.findall(r'(?:href="#|url\(#)([^")]*)', inline(simple("p"))))
    assert used <= first


def test_a_standalone_plot_follows_the_colour_scheme_and_has_a_background():
    root = parsed(standalone(simple()))
    style = root.find(f"{SVG}style").text
    assert "@media screen and (prefers-color-scheme:dark){" in style
    assert "text-rendering" not in {name for element in root.iter() for name in element.attrib}  # cairosvg cannot
    for role, (_, dark) in ROLES.items():
        assert f".f-{role}{{fill:{dark}}}.s-{role}{{stroke:{dark}}}" in style
    ground = root.find(f"{SVG}rect")
    assert (ground.get("width"), ground.get("height"), ground.get("class")) == ("100%", "100%", "f-surface")


def test_marks_of_a_standalone_plot_carry_their_light_colours_as_attributes():
    """A viewer without variables of style sheets, or without style sheets, shows the same picture as a browser."""
    root = parsed(standalone(simple()))
    assert "var(" not in standalone(simple()).decode()
    found = {
        (name, element.get("fill" if name[0] == "f" else "stroke"))
        for element in root.iter()
        for name in (element.get("class") or "").split()
        if name != "plot"
    }
    expected = {"s-series-1", "f-series-2", "f-ink", "f-surface"}
    assert {(name, ROLES[name[2:]][0]) for name in expected} <= found
    assert all(colour == ROLES[name[2:]][0] for name, colour in found)


@pytest.mark.parametrize("name", ["errors", "pareto", "front"])
def test_pictures_of_a_benchmark_have_all_their_plots(name):
    root = parsed(render_picture(name, bench_record(), {}))
    inner = root.findall(f"{SVG}svg")
    assert len(inner) == len(list(draw_plots(name, bench_record())))
    width, height = (float(each) for each in root.get("viewBox").split()[2:])
    places = [[float(each.get(name)) for name in ("x", "y", "width", "height")] for each in inner]
    for number, (x, y, across, up) in enumerate(places):
        assert x + across <= width + 1e-6
        assert y + up <= height + 1e-6
        for x2, y2, across2, up2 in places[:number]:
            assert x >= x2 + across2 or x2 >= x + across or y >= y2 + up2 or y2 >= y + up
    with pytest.raises(UnavailableError, match="the record has no"):
        render_picture(name, record_samples.record(), {})


def test_pictures_of_the_same_record_are_the_same_bytes_in_every_process():
    """A picture of a benchmark, and the map of a run of verify behind it."""
    code = (
        "import sys; from hypcheck.report import plots; from hypcheck.report.drawings import render_picture;"
        "from tests.report import record_samples as samples;"
        "from tests.report.bench_lines import bench_record;"
        "sys.stdout.buffer.write(render_picture('pareto', bench_record(), {}) + plots.render_map(samples.record()))"
    )
    found = {
        subprocess.run(
            [sys.executable, "-c", code], env={**os.environ, "PYTHONHASHSEED": seed}, check=True, capture_output=True
        ).stdout
        for seed in ("1", "2")
    }
    content = render_picture("pareto", bench_record(), {}) + plots.render_map(record_samples.record())
    assert found == {content}
    assert b"<dc:date>" not in content
    assert b"Matplotlib v" not in content
