"""Pages name what exists, and the index of the pages and the site list each page once, in the same order."""

from __future__ import annotations

import doctest
import json
import re
import subprocess
import sys

import pytest
from ruamel.yaml import YAML

import hypcheck
from hypcheck import toml
from tests.support.pages import PAGES, ROOT, Typed, parts

ARCHITECTURE = ROOT / "docs" / "architecture.md"
CONTRIBUTING = ROOT / "CONTRIBUTING.md"
NOT_LISTED = {"reports/README.md"}
"""A page for those who look into the folder; the index lists what is in it."""
HELP = [ROOT / "hypcheck/cli/setup.py", ROOT / "hypcheck/scaffold/requirement.py", ROOT / "action.yml"]
"""Texts beside the pages that say from where hypcheck is installed."""


def named(page):
    """The page's path in the repository."""
    return page.relative_to(ROOT).as_posix()


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
    assert {named(page) for page in PAGES} - NOT_LISTED <= set(listed)
    assert len(listed) == len(set(listed))


def test_no_page_of_prose_has_more_than_2500_words():
    long = {"docs/mathematics.md", "docs/paper.md"}  # the mathematics, and the ledger
    folders = {ROOT, ROOT / "docs", ROOT / "cases"}
    pages = [page for page in PAGES if page.parent in folders and page.name != "CHANGELOG.md"]
    assert {named(page) for page in pages if len(page.read_text("utf-8").split()) > 2500} == long


@pytest.mark.parametrize("page", sorted((ROOT / "docs").glob("*.md")), ids=named)
def test_a_page_says_first_for_whom_it_is_and_what_they_can_do_afterwards(page):
    _, first, *_ = page.read_text(encoding="utf-8").split("\n\n")
    assert re.match(r"For (all|every|those|readers|users|programmers|researchers|beginners)", first)
    assert re.search(r"\. Afterwards\s", first)


def links(page):
    text = re.sub(r"```.*?```|`[^`\n]*`", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    return [link for link in re.findall(r"\]\(([^)\s]+)\)", text) if "://" not in link]


def anchors(page):
    """The anchors of a page's headings, as GitHub makes them."""
    heads = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_every_link_on_a_page_leads_to_an_existing_file_and_heading(page):
    for link in links(page):
        path, _, anchor = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        assert target.is_file(), link
        assert not anchor or anchor in anchors(target), link


@pytest.mark.parametrize("page", [page for page in PAGES if "```python\n>>>" in page.read_text("utf-8")], ids=named)
def test_python_sessions_on_a_page_give_what_they_show(page):
    blocks = re.findall(r"^```python\n(>>>.*?)^```$", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    session = doctest.DocTestParser().get_doctest("\n".join(blocks), {}, page.name, None, 0)
    assert len(session.examples) > 3
    assert doctest.DocTestRunner().run(session).failed == 0


def test_the_page_of_the_python_interface_has_every_public_name():
    described = re.findall(r"^::: (.*)$", (ROOT / "docs" / "api.md").read_text(encoding="utf-8"), re.MULTILINE)
    homes = (".".join(hypcheck._HOMES[name]) for name in hypcheck.__all__ if name[0] != "_")
    assert sorted(described) == sorted(home.removesuffix("_at_once") for home in homes)  # C has no signature to print


def versions_named(text):
    """Versions of hypcheck from which a text says that it can be installed: tags, releases and files."""
    places = r"hypcheck(?:\.git)?@(v?\d[\w.]*)|rev: (v?\d[\w.]*)|hypcheck(?:\[\w+\])?==(\d[\w.]*)|hypcheck-(\d[\d.]*\d)"
    return {version for found in re.findall(places, text) for version in found if version}


def tags():
    """The tags of the repository; none where there is no git."""
    try:
        done = subprocess.run(["git", "tag"], cwd=ROOT, capture_output=True, text=True, check=False)  # noqa: S607
    except OSError:
        return set()
    return set(done.stdout.split())


def test_no_page_and_no_help_names_a_version_that_git_has_no_tag_of():
    for path in [*PAGES, *HELP]:
        released = {tag.lstrip("v") for tag in tags()}
        assert {version.lstrip("v") for version in versions_named(path.read_text("utf-8"))} <= released, named(path)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("- uses: OWNER/hypcheck@v1", {"v1"}),
        ("git+https://host/o/hypcheck.git@v0.2.0", {"v0.2.0"}),
        ("rev: v0.2.0", {"v0.2.0"}),
        ("pip install 'hypcheck[report]==1.2'", {"1.2"}),
        ("hypcheck-1.2.0-py3-none-any.whl", {"1.2.0"}),
        ("- uses: OWNER/hypcheck@COMMIT, actions/cache@v4, hypcheck==VERSION, hypcheck-VERSION.whl", set()),
    ],
)
def test_versions_named_finds_only_tags_releases_and_files_of_hypcheck(text, found):
    assert versions_named(text) == found


def test_the_readme_begins_with_the_two_commands_for_a_clone_and_then_pip():
    typed = [part.words for part in parts((ROOT / "README.md").read_text("utf-8")) if isinstance(part, Typed)]
    assert typed[:2] == ["make verify", "make test"]
    assert next(words for words in typed if words.startswith("pip")) == "pip install ."


def test_continuous_integration_calls_the_test_command_of_the_readme_and_builds_the_site():
    lines = (ROOT / ".ci" / "run").read_text(encoding="utf-8").splitlines()
    assert "make test" in lines
    assert any(line.startswith("make docs ") for line in lines)


def test_no_committed_report_names_a_folder_of_the_machine_that_made_it():
    made = [path for path in (ROOT / "reports").rglob("*") if path.suffix in {".md", ".json", ".jsonl"}]
    known = subprocess.run(["git", "ls-files", "reports"], cwd=ROOT, capture_output=True, text=True, check=True).stdout  # noqa: S607
    folder = re.compile(r"""["' `](/(?!usr/bin/)[a-z]+/[^"' `\\]*)""")
    named_by = {
        named(path): folder.findall(path.read_text("utf-8"))[:1] for path in made if named(path) in known.split()
    }
    assert {name: found for name, found in named_by.items() if found} == {}


def test_every_make_command_on_a_page_is_a_target_of_the_makefile():
    targets = re.findall(r"^([\w%-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)
    known = re.compile("|".join(target.replace("%", r"[\w-]+") for target in targets))
    for page in PAGES:
        called = re.findall(r"(?:`|\$ )make ([a-z][\w-]*)", page.read_text(encoding="utf-8"))
        assert [target for target in called if not known.fullmatch(target)] == [], named(page)


def test_first_sentences_say_position_relative_to_a_hyperboloid():
    (about,) = re.findall(r'^description = "(.*)"', (ROOT / "pyproject.toml").read_text("utf-8"), re.MULTILINE)
    helped = subprocess.run(
        [sys.executable, "-m", "hypcheck", "--help"], capture_output=True, text=True, check=True
    ).stdout
    for text in (about, helped, *(page.read_text("utf-8") for page in (ROOT / "README.md", ROOT / "cases/README.md"))):
        first = " ".join(text.split())[:400]
        assert re.search(r"position of a spheroid .*relative to a (circular )?hyperboloid", first), first


@pytest.mark.parametrize(
    ("words", "content"),
    [
        (r"more than ([\d,]+) certified vectors", "positions"),
        (r"rows of ten numbers: more than ([\d,]+) further vectors", "tilted-positions"),
    ],
)
def test_readme_states_in_thousands_how_many_frozen_vectors_test_an_implementation(words, content):
    (said,) = re.findall(words, " ".join((ROOT / "README.md").read_text("utf-8").split()))
    files = [json.loads(path.read_text("utf-8")) for path in sorted((ROOT / "cases").glob("*.json"))]
    asked = sum(
        len(file["cases"]) for file in files if file.get("content") == content and not file["family"]["extreme"]
    )
    assert asked // 1000 == int(said.replace(",", "")) // 1000
