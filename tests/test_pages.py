"""The pages for those who change hypcheck name files and rooms that exist."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from hypcheck import toml

ROOT = Path(__file__).parents[1]
ARCHITECTURE = ROOT / "docs" / "architecture.md"
CONTRIBUTING = ROOT / "CONTRIBUTING.md"


@pytest.mark.parametrize("page", [ARCHITECTURE, CONTRIBUTING], ids=lambda page: page.name)
def test_every_file_that_a_page_for_contributors_names_exists(page):
    named = re.findall(r"`([\w.]+(?:/[\w.]*)+)`", page.read_text(encoding="utf-8"))
    assert len(named) > 15
    assert [path for path in named if not any((root / path).exists() for root in (ROOT, ROOT / "hypcheck"))] == []


def test_the_picture_of_the_rooms_has_the_layers_of_the_import_contract():
    settings = toml.parsed((ROOT / "pyproject.toml").read_text(encoding="utf-8"), "pyproject.toml")
    layers, *_ = settings["tool"]["importlinter"]["contracts"]
    picture = ARCHITECTURE.read_text(encoding="utf-8").split("```")[1]
    drawn = [set(line[:43].split()) for line in picture.strip("\n").splitlines()]
    assert drawn == [set(re.findall(r"(?<=hypcheck\.)\w+", layer)) for layer in layers["layers"]]


def test_the_picture_of_the_rooms_has_every_room():
    rooms = {path.stem for path in (ROOT / "hypcheck").iterdir() if path.is_dir() or path.suffix == ".py"}
    picture = ARCHITECTURE.read_text(encoding="utf-8").split("```")[1]
    assert rooms - {"__init__", "__main__", "__pycache__"} <= set(picture.split())
