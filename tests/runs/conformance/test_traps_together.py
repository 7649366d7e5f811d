"""`verify SPEC` rejects implementations that are wrong only where traps of several columns meet, at its defaults.

Each of them is right about tilted spheroids, about ends and about sweeps, and wrong where a special axis, a special
place or an uncommon size comes together with another of these, or where a coordinate is nearly zero beside another.
"""

from __future__ import annotations

import numpy as np
import pytest

from hypcheck import classify, passage
from hypcheck.cli.main import main
from hypcheck.geometry.rows import PAIRS, SWEEPS

pytestmark = [pytest.mark.usefixtures("text_reports"), pytest.mark.slow]

UPRIGHT, TILT, HEIGHTS = {}, {"tilt": True}, {"tilt": True, "heights": True}


def by_name(question, rows):
    """The columns of rows by name."""
    layout = SWEEPS if question == "passage" else PAIRS
    return dict(zip(layout.columns(rows.shape[1]), rows.T, strict=True))


def answers(question, row):
    if question == "passage":
        return passage(row).hit.astype(np.int8)
    return np.array(classify(row))


def lean(row):
    """The tangent of the axis's angle from the vertical, inf if it is horizontal, and the axis's greatest number."""
    x, y, z = (row[name] for name in ("axis_x", "axis_y", "axis_z"))
    greatest = np.max(np.abs([x, y, z]), axis=0)
    with np.errstate(divide="ignore"):
        return np.hypot(x / greatest, y / greatest) / np.abs(z / greatest), greatest


def ended(row):
    return np.isfinite(row["z_min"]) | np.isfinite(row["z_max"])


def tilted(row):
    return (row["axis_x"] != 0) | (row["axis_y"] != 0)


def on_the_axis(row):
    return ended(row) & tilted(row) & (row["x"] == 0) & (row["y"] == 0)


def leaning_little(row):
    return ended(row) & (lean(row)[0] > 0) & (lean(row)[0] < 1e-4)


def nearly_flat(row):
    return ended(row) & (lean(row)[0] > 1e3) & (row["axis_z"] != 0)


def long_axis(row):
    return ended(row) & (lean(row)[1] > 1e30)


def short_axis(row):
    return ended(row) & (lean(row)[1] < 1e-30)


def needle(row):
    return ended(row) & tilted(row) & (row["d"] > 1000 * row["b"])


def huge_tilted(row):
    return tilted(row) & (row["b"] > 1e4)


def tiny_ended(row):
    return ended(row) & (row["b"] < 1e-4)


def huge_sweep(row):
    return row["b"] > 1e4


def length(row):
    return np.abs([row[f"{name}1"] - row[f"{name}0"] for name in "xyz"]).max(axis=0)


def still_beside_an_end(row):
    return ended(row) & (length(row) == 0)


def along_the_axis_of_an_end(row):
    return ended(row) & (np.abs([row[name] for name in ("x0", "y0", "x1", "y1")]).max(axis=0) == 0)


def long_axis_of_a_sweep(row):
    return lean(row)[1] > 1e10


def tilted_vertical_beside_an_end(row):
    return ended(row) & tilted(row) & (row["x0"] == row["x1"]) & (row["y0"] == row["y1"]) & (length(row) > 0)


def leaning_little_on_a_sweep(row):
    return leaning_little(row) if "z_min" in row else (lean(row)[0] > 0) & (lean(row)[0] < 1e-4)


def nearly_on_the_plane_of_y(row):
    return (row["x"] != 0) & (np.abs(row["x"]) < 1e-12 * np.abs(row["y"]))


def hardly_above_the_waist(row):
    return (row["z"] != 0) & (np.abs(row["z"]) < 1e-150)


def hardly_off_the_axis(row):
    across = np.hypot(row["x"], row["y"])
    return (across > 0) & (across < 1e-6 * row["b"])


def begun_hardly_off_the_plane_of_x(row):
    return (row["y0"] != 0) & (np.abs(row["y0"]) < 1e-12 * np.abs(row["x0"]))


@pytest.mark.parametrize(
    ("question", "takes", "wrong_where", "family"),
    [
        ("position", UPRIGHT, nearly_on_the_plane_of_y, "nearly-zero"),
        ("position", UPRIGHT, hardly_above_the_waist, "nearly-zero"),
        ("position", TILT, hardly_off_the_axis, "tilted-nearly-zero"),
        ("position", HEIGHTS, nearly_on_the_plane_of_y, "ended-nearly-zero"),
        ("position", HEIGHTS, hardly_off_the_axis, "tilted-ended-nearly-zero"),
        ("passage", UPRIGHT, begun_hardly_off_the_plane_of_x, "way-nearly-zero"),
        ("position", TILT, huge_tilted, "tilted-whole-domain"),
        ("position", HEIGHTS, on_the_axis, "tilted-ended-coincidences"),
        ("position", HEIGHTS, leaning_little, "tilted-ended-traps"),
        ("position", HEIGHTS, nearly_flat, "tilted-ended-traps"),
        ("position", HEIGHTS, long_axis, "tilted-ended-traps"),
        ("position", HEIGHTS, short_axis, "tilted-ended-traps"),
        ("position", HEIGHTS, needle, "tilted-ended-traps"),
        ("position", HEIGHTS, tiny_ended, "ended-whole-domain"),
        ("passage", UPRIGHT, huge_sweep, "way-whole-domain"),
        ("passage", TILT, long_axis_of_a_sweep, "tilted-way-traps"),
        ("passage", TILT, leaning_little_on_a_sweep, "tilted-way-traps"),
        ("passage", HEIGHTS, still_beside_an_end, "ended-way-lengths"),
        ("passage", HEIGHTS, along_the_axis_of_an_end, "ended-way-coincidences"),
        ("passage", HEIGHTS, leaning_little_on_a_sweep, "tilted-ended-way-traps"),
        ("passage", HEIGHTS, tilted_vertical_beside_an_end, "tilted-ended-way-coincidences"),
    ],
    ids=lambda value: value.__name__ if callable(value) else None,
)
def test_an_implementation_that_is_wrong_only_where_two_traps_meet_is_rejected(
    tmp_path, built_in, question, takes, wrong_where, family
):
    def right(rows):
        return answers(question, by_name(question, rows))

    def wrong(rows):
        row = by_name(question, rows)
        correct = answers(question, row)
        other = 1 - correct if question == "passage" else np.where(correct == 0, 1, 0)
        return np.where(wrong_where(row), other, correct).astype(np.int8)

    def ending(function):
        spec = built_in(function, question=question, **takes)
        options = ["--families", family, "--count", "60", "--isolate", "off", "--out", str(tmp_path)]
        return main(["verify", spec, *options])

    assert (ending(right), ending(wrong)) == (0, 1)
