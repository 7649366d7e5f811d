"""Generated pages are made anew one by one, and a release has none that is older than what it describes."""

from __future__ import annotations

import json
import re
import shutil
import subprocess

import pytest
from click.testing import CliRunner

from hypcheck.version import VERSION
from tests.tools import reference
from tests.tools.evidence import parts as evidence
from tests.tools.reference import PARTS, ROOT, Part, main, state, table

GIT = shutil.which("git") or "git"
MAKEFILE = """first second:
	@test ! -e $@.broken
	@echo $@ >> made
"""


def said(*arguments):
    done = CliRunner().invoke(main, list(arguments))
    return done.exit_code, done.output


def git(folder, *words):
    who = ["-c", "user.name=a", "-c", "user.email=a@example.org"]
    return subprocess.run([GIT, *who, *words], cwd=folder, check=True, capture_output=True, text=True).stdout.strip()


@pytest.fixture
def repository(tmp_path, monkeypatch):
    """A repository with two parts, each of which describes a file."""
    parts = tuple(Part(name, f"{name}.md", (f"{name}.source",)) for name in ("first", "second"))
    monkeypatch.setattr(reference, "ROOT", tmp_path)
    monkeypatch.setattr(reference, "PARTS", parts)
    (tmp_path / "reports").mkdir()
    (tmp_path / "reports" / "README.md").write_text("# Reports\n\n| made by |\n", encoding="utf-8")
    (tmp_path / "Makefile").write_text(MAKEFILE, encoding="utf-8")
    for part in parts:
        (tmp_path / part.sources[0]).write_text("1", encoding="utf-8")
    git(tmp_path, "init", "--quiet")
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "--quiet", "-m", "Begin")
    return tmp_path


def made(repository):
    path = repository / "made"
    return path.read_text(encoding="utf-8").split() if path.exists() else []


def states():
    return [state(part) for part in reference.PARTS]


def test_an_interrupted_run_continues_where_it_stopped(repository):
    (repository / "second.broken").touch()
    code, text = said()
    assert (code, made(repository), states()) == (1, ["first"], ["fresh", "not stamped"])
    assert "these failed: second; the others are stamped" in text
    (repository / "second.broken").unlink()
    assert said()[0] == 0
    assert said()[0] == 0
    assert made(repository) == ["first", "second"]


def test_a_part_whose_source_changes_is_reported_as_stale_and_made_again(repository):
    assert said()[0] == 0
    assert said("--check")[0] == 0
    (repository / "first.source").write_text("2", encoding="utf-8")
    assert states() == ["stale", "fresh"]
    code, text = said("--check")
    assert (code, [line.split()[:2] for line in text.splitlines()]) == (1, [["first", "stale"], ["second", "fresh"]])
    assert said("--list")[0] == 0
    code, text = said()
    assert (code, "commit first what it describes" in text) == (1, True)
    git(repository, "commit", "--quiet", "-a", "-m", "Change it")
    assert said()[0] == 0
    assert (made(repository), states()) == (["first", "second", "first"], ["fresh", "fresh"])


def test_a_stamp_names_commit_and_machine_in_the_page_of_reports(repository):
    said("first")
    commit = git(repository, "rev-parse", "--short=8", "HEAD")
    stamp = json.loads((repository / reference.STAMPS).read_text(encoding="utf-8"))["first"]
    assert stamp["commit"] == commit
    page = (repository / reference.PAGE).read_text(encoding="utf-8")
    assert page == "# Reports\n\n" + table()
    assert f"| {commit} | {stamp['machine']} | {stamp['date']} |" in page
    assert "[second.md](../second.md) | not stamped yet |" in page


def test_each_part_has_a_target_of_make_a_page_and_files_that_it_describes():
    make = shutil.which("make") or "make"
    for part in PARTS:
        asked = [make, "--dry-run", "--silent", part.target]
        assert subprocess.run(asked, cwd=ROOT, capture_output=True, check=False).returncode == 0, part.target
        assert (ROOT / part.page).is_file()
        for source in part.sources:
            assert list(ROOT.glob(source)), source


def test_every_part_of_the_evidence_has_its_stamp():
    told = [part.target.removeprefix("evidence-") for part in PARTS if part.page == "docs/evidence.md"]
    assert told == [*evidence.PARTS]


def test_the_page_of_reports_says_from_which_commit_each_page_was_made():
    assert (ROOT / reference.PAGE).read_text(encoding="utf-8").endswith("\n" + table())


def test_no_page_of_a_release_is_older_than_what_it_describes():
    """A release is the commit whose changelog begins with the version that the tree has."""
    first = re.search(r"^## (.+)$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)[1]
    old = [f"{part.page} is {state(part)}; run make reference" for part in PARTS if state(part) != "fresh"]
    assert first != VERSION or old == []
