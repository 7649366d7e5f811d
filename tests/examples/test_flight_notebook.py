"""The notebook runs from top to bottom, as a reader runs it, and its cells agree with each other."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

NOTEBOOK = Path(__file__).parents[2] / "examples" / "flight.ipynb"


def test_every_cell_of_the_notebook_runs_in_its_order(capsys):
    matplotlib = pytest.importorskip("matplotlib", reason="it draws; pip install 'hypcheck[report]' brings it")
    matplotlib.use("Agg")
    names: dict[str, object] = {}
    cells = json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]
    for cell in cells:
        if cell["cell_type"] == "code":
            assert (cell["outputs"], cell["execution_count"]) == ([], None)  # what it prints is made, not kept
            exec("".join(cell["source"]), names)  # noqa: S102 - it is what a notebook does
    said = capsys.readouterr().out.splitlines()
    assert said[0].split()[0] in ("contact", "clear")
    assert len(names["figure"].axes) >= 2
    assert names["high"] - names["low"] <= 1e-9
    small = names["small"]  # a ball of radius 0.01: for a ball, distance and radius add up
    assert small.distance_lower + 0.01 <= names["high"]
    assert names["low"] <= small.distance_upper + 0.01 + 1e-9
