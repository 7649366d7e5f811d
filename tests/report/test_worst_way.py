"""The picture of an implementation's worst way: which case it shows, what stands in it, and when there is none."""

from __future__ import annotations

import pytest

from hypcheck.report import markdown
from hypcheck.report.drawings import ReportContext
from hypcheck.report.model import drawn_sweep, implementations
from hypcheck.report.plots import draw_plots
from hypcheck.report.write import files_of
from tests.report.record_samples import group, hexes, record

SIZES = (4.0, 6.0, 1.0, 0.5)
THROUGH = ((60, 1, 0.2), (-140, 1, 0.2))
"""From outside through the waist and out: r falls from 60 to 1 and grows to 140."""

CLEAR = ((9, 0, 0), (7, 0, 1))


def case(name, start, end, error, *, answer=0, truth=1, axis=None, **others):
    return {
        "case": name,
        "row": hexes(map(float, (*SIZES, *start))),
        "end": hexes(map(float, end)),
        **({} if axis is None else {"axis": hexes(map(float, axis))}),
        "truth": truth,
        "answer": answer,
        "mistake": "false-contact" if answer else "false-clear",
        "status": "wrong",
        "backward_error": error,
        "backward_error_u": error,
        **others,
    }


def ways(*cases, tested=True):
    """The record of a run about ways with these worst cases."""
    return record([ways_group(*cases, tested=tested)], exit_code=1)


def ways_group(*cases, tested=True):
    """The line of an implementation with these worst cases about ways."""
    under_test = {"spec": "builtin:mine", "failing": ["wrong"], "faults": []} if tested else {}
    counts = {"right": 10, "wrong": len(cases)}
    return group("mine", "float64", "way-long", counts, cases, question="passage", **under_test)


def test_picture_of_sweeps_shows_the_worst_sweep_of_an_upright_spheroid():
    found = ways(
        case("way-long/1/1/3", *THROUGH, 2.0),
        case("way-long/1/1/4", *CLEAR, 3.0, answer=1, truth=0),
        case("tilted-way-uniform/1/1/5", *THROUGH, 9.0, axis=(1, 0, 1)),
    )
    (each,) = implementations(found)
    assert drawn_sweep(each).case == "way-long/1/1/4"
    (plot,) = draw_plots("ways", found)
    assert plot.title == "mine: way-long/1/1/4"
    assert plot.description == "way-long/1/1/4: clear on the sweep; answered: in contact on the sweep."


def test_picture_of_sweeps_draws_a_straight_sweep_as_a_curve_and_marks_first_contact_in_both_panels():
    (plot,) = draw_plots("ways", ways(case("way-long/1/1/3", *THROUGH, 2.0)))
    assert plot.description == (
        "way-long/1/1/3: in contact on the sweep, first at 0.275 of it; answered: clear on the sweep."
    )
    whole, near = plot.figure.axes
    curve = max(whole.lines, key=lambda line: len(line.get_xdata()))
    rs = curve.get_xdata()
    assert (rs[0], rs[-1]) == pytest.approx((60.0, 140.0), rel=1e-3)
    assert rs.min() == pytest.approx(1.0)
    for axes in (whole, near):
        marks = [line.get_xdata()[0] for line in axes.lines if line.get_marker() == "+"]
        assert marks == pytest.approx([4 + 1.0], rel=0.01)  # one radius outside the waist, nearly
    assert near.get_xlim()[1] - near.get_xlim()[0] < 6 < whole.get_xlim()[1]


def test_picture_of_sweeps_draws_a_wrong_time_as_a_separate_body():
    late = case("way-long/1/1/3", *THROUGH, 7.0, answer=1, mistake="late", time=0.5, first=[0.275, 0.276])
    (plot,) = draw_plots("ways", ways(late))
    assert plot.description.endswith("answered: in contact on the sweep, first at 0.5.")
    labels = [text.get_text() for legend in plot.figure.legends for text in legend.get_texts()]
    assert labels[-2:] == ["first contact", "at the answered time"]


def test_report_refers_to_the_picture_of_sweeps_only_if_the_run_has_a_wrong_upright_sweep():
    found = ways(case("way-long/1/1/3", *THROUGH, 2.0))
    assert "ways.svg" in files_of(found)
    assert "](ways.svg)" in markdown.render(found, ReportContext(["ways.svg"])).decode()
    leaning = ways(case("tilted-way-uniform/1/1/5", *THROUGH, 9.0, axis=(1, 0, 1)))
    for without in (ways(), leaning, ways(case("way-long/1/1/3", *THROUGH, 2.0), tested=False)):
        assert "ways.svg" not in files_of(without)
        assert "worst sweeps" not in markdown.render(without).decode()
