"""Pages name what exists, and the index of the pages and the site list each page once, in the same order."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from ruamel.yaml import YAML

import hypcheck
from hypcheck import toml

ROOT = Path(__file__).parents[1]
ARCHITECTURE = ROOT / "docs" / "architecture.md"
CONTRIBUTING = ROOT / "CONTRIBUTING.md"
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").glob("**/*.md"), *(ROOT / "cases").glob("*.md")])


@pytest.mark.parametrize("page", [ARCHITECTURE, CONTRIBUTING], ids=lambda page: page.name)
def test_every_file_that_a_page_for_contributors_names_exists(page):
    named = re.findall(r"`([\w.]+(?:/[\w.]*)+)`", page.read_text(encoding="utf-8"))
    assert len(named) > 15
    assert [path for path in named if not any((root / path).exists() for root in (ROOT, ROOT / "hypcheck"))] == []


def test_the_architecture_diagram_has_the_layers_of_the_import_contract():
    settings = toml.parsed((ROOT / "pyproject.toml").read_text(encoding="utf-8"), "pyproject.toml")
    layers, *_ = settings["tool"]["importlinter"]["contracts"]
    picture = ARCHITECTURE.read_text(encoding="utf-8").split("```")[1]
    drawn = [set(line[:43].split()) for line in picture.strip("\n").splitlines()]
    assert drawn == [set(re.findall(r"(?<=hypcheck\.)\w+", layer)) for layer in layers["layers"]]


def test_the_architecture_diagram_has_every_top_level_module_and_folder():
    rooms = {path.stem for path in (ROOT / "hypcheck").iterdir() if path.is_dir() or path.suffix == ".py"}
    picture = ARCHITECTURE.read_text(encoding="utf-8").split("```")[1]
    assert rooms - {"__init__", "__main__", "__pycache__"} <= set(picture.split())


def pages_in(nav):
    for entry in nav:
        for value in entry.values():
            yield from pages_in(value) if isinstance(value, list) else (value,)


def test_the_site_navigation_has_every_page_once_in_the_order_of_the_index():
    settings = YAML(typ="safe").load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))
    listed = [page for page in pages_in(settings["nav"]) if page != "docs/explorer.html"]
    index = (ROOT / "docs" / "README.md").read_text(encoding="utf-8").partition("## To learn")[2]
    linked = [(ROOT / "docs" / link).resolve() for link in re.findall(r"\]\(([^)#]+)", index)]
    in_order = list(dict.fromkeys(path.relative_to(ROOT).as_posix() for path in linked))
    assert listed == ["README.md", "docs/README.md", *(page for page in in_order if page != "README.md")]
    assert {page.relative_to(ROOT).as_posix() for page in PAGES} <= set(listed)
    assert len(listed) == len(set(listed))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_link_on_a_page_of_the_project_leads_to_a_file(page):
    links = re.findall(r"\]\((?!https?:|#)([^)#\s]+)", page.read_text(encoding="utf-8"))
    assert [link for link in links if not (page.parent / link).is_file()] == []


def test_the_page_of_the_python_interface_has_every_public_name():
    described = re.findall(r"^::: (.*)$", (ROOT / "docs" / "api.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert sorted(described) == sorted(".".join(hypcheck._HOMES[name]) for name in hypcheck.__all__ if name[0] != "_")


def test_the_pages_name_the_tag_of_the_newest_version_in_the_changelog():
    newest = re.findall(r"^## (.*)$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)[0]
    pages = [(ROOT / "docs" / name).read_text(encoding="utf-8") for name in ("ci.md", "tutorial.md")]
    tags = [re.findall(r"(?:hypcheck@|rev: )v([\d.]+)\b", page) for page in pages]
    assert tags == [[newest] * 2, [newest]]
