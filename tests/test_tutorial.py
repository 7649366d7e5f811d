"""Whoever types the commands of the tutorial sees what it prints, and the pages that it is one of are all listed."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[1] / "docs"
TUTORIAL = DOCS / "tutorial.md"
PARTS = re.compile(
    r"^```\w+\n(?P<file># (?P<name>[\w.]+)\n[\s\S]*?)^```|^    \$ (?P<command>.*\n(?:    (?!\$).*\n)*)", re.MULTILINE
)


def parts():
    """Files to write, each with its name, and commands to type, each with its exit code and what it prints."""
    for found in PARTS.finditer(TUTORIAL.read_text(encoding="utf-8")):
        if found["name"]:
            yield "write", found["name"], found["file"]
            continue
        command, *shown = found["command"].splitlines()
        code = re.search(r"# ends with (\d+)$", command)
        yield command, int(code[1]) if code else 0, [line.removeprefix("    ") for line in shown]


def is_shown_in(printed, shown):
    """Whether the lines stand in the text in their order; … stands for anything."""
    pattern = ".*".join(re.escape(part) for part in "\n".join(shown).split("…"))
    return re.search(pattern, printed, re.DOTALL) is not None


def test_the_commands_of_the_tutorial_print_what_it_shows(tmp_path):
    programs = {**os.environ, "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    typed = 0
    for what, *rest in parts():
        if what == "write":
            name, text = rest
            (tmp_path / name).write_text(text, encoding="utf-8")
            continue
        code, shown = rest
        command = ["bash", "-c", what]
        ended = subprocess.run(command, cwd=tmp_path, env=programs, capture_output=True, text=True, check=False)
        assert ended.returncode == code, f"{what}\n{ended.stdout}{ended.stderr}"
        assert is_shown_in(ended.stdout, shown), f"{what}\n{ended.stdout}"
        typed += 1
    assert typed == 6


@pytest.mark.parametrize(
    ("shown", "found"), [(["a…", "c"], True), (["…", "c"], True), (["c", "a"], False), (["x"], False)]
)
def test_is_shown_in_finds_output_that_the_tutorial_does_not_show(shown, found):
    assert is_shown_in("a b\nc\n", shown) == found


def links(page):
    text = re.sub(r"```.*?```|`[^`\n]*`", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    return [link for link in re.findall(r"\]\(([^)\s]+)\)", text) if "://" not in link]


def anchors(page):
    """The anchors of a page's headings, as GitHub makes them."""
    heads = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}


PAGES = sorted([*DOCS.glob("*.md"), *DOCS.parent.glob("*.md")])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_link_on_a_docs_page_leads_to_an_existing_file_and_heading(page):
    for link in links(page):
        path, _, anchor = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        assert target.exists(), link
        assert not anchor or anchor in anchors(target), link


def test_the_index_of_the_docs_lists_every_page():
    listed = {(DOCS / link.partition("#")[0]).resolve() for link in links(DOCS / "README.md")}
    assert {page for page in DOCS.glob("*.md") if page.name != "README.md"} <= listed
