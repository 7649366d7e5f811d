"""`hypcheck init`: which files, what stands in them, and what it leaves alone."""

from __future__ import annotations

import errno
import json
import os
import re
import shlex
import subprocess
import sys
from importlib.resources import files

import pytest

from hypcheck.cli.main import main
from hypcheck.errors import InputError
from hypcheck.methods.spec import parse_spec
from hypcheck.scaffold import languages
from hypcheck.scaffold.languages import LANGUAGES
from hypcheck.scaffold.project import Project
from hypcheck.scaffold.wording import LONGEST_NAME, requirement, safe_name
from hypcheck.version import VERSION

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


def init(*arguments: object) -> int:
    return main(["init", *map(str, arguments)])


def tree(folder) -> dict[str, str]:
    return {str(path.relative_to(folder)): path.read_text() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture(params=LANGUAGES.values(), ids=LANGUAGES)
def language(request):
    return request.param


def test_every_file_of_a_language_is_written_and_what_to_type_next_is_told(language, tmp_path, capsys):
    assert init("--language", language.name, "--directory", tmp_path, "--name", "engine") == 0
    project = Project(language, "engine", f"hypcheck=={VERSION}")
    assert tree(tmp_path) == project.files()
    printed = capsys.readouterr().out
    listed = printed.partition("\n\n")[0].splitlines()
    assert [line.split("   ")[0] for line in listed] == [str(tmp_path / path) for path in project.files()]
    typed = [line.strip() for line in printed.splitlines() if line.startswith("    ")]
    assert typed == list(project.commands)
    assert f"in {tmp_path}:" in printed


def test_the_working_directory_is_the_default_and_lends_its_name(tmp_path, monkeypatch, capsys):
    folder = tmp_path / "Moteur à tiges"
    folder.mkdir()
    monkeypatch.chdir(folder)
    assert init("--language", "rust") == 0
    assert '"name":"Moteur-a-tiges"' in (folder / "hypcheck-rust/src/predicate.rs").read_text()
    assert "Type next:" in capsys.readouterr().out


def test_two_languages_live_in_one_project_but_for_the_settings(tmp_path, capsys):
    assert init("--language", "c", "--directory", tmp_path) == 0
    before = tree(tmp_path)
    assert init("--language", "go", "--directory", tmp_path) == 2
    assert tree(tmp_path) == before
    assert init("--language", "go", "--directory", tmp_path, "--force") == 0
    assert before.items() - tree(tmp_path).items() == {
        (path, text) for path, text in before.items() if not path.startswith("hypcheck-c")
    }


def test_templates_are_those_of_the_table_and_nothing_in_them_is_left_open(language):
    folder = files("hypcheck.scaffold").joinpath("templates")
    there = {str(path.relative_to(folder / language.name)) for path in (folder / language.name).rglob("*")}
    assert {path for path in there if "." in path and "__pycache__" not in path} == set(language.files)
    assert language.predicate in language.files
    for path, text in Project(language, "engine", "hypcheck==1").files().items():
        assert not re.search(r"@[A-Z]+@", text), path
        assert text.endswith("\n")
        assert "\t" not in text or path.endswith(".go")
        assert "\r" not in text


def test_the_stub_says_that_it_is_one_where_it_stands(language):
    written = Project(language, "engine", "hypcheck==1").files()
    saying = [path for path, text in written.items() if "Replace this with your predicate" in text]
    assert saying == [f"{language.folder}/{language.predicate}"]


def test_every_folder_of_templates_is_a_language():
    folders = {each.name for each in files("hypcheck.scaffold").joinpath("templates").iterdir()}
    assert folders == {"common", *LANGUAGES}
    assert [each.name for each in languages._LISTED] == list(LANGUAGES)


def test_the_settings_are_toml_and_name_the_adapter(language):
    project = Project(language, "engine", "hypcheck==1")
    settings = tomllib.loads(project.files()["hypcheck.toml"])
    assert settings == {"specs": [language.spec], "tolerance": 8}
    assert parse_spec(language.spec).kind in {"command", "python"}
    commented = re.sub(r"^# (\w+ = )", r"\1", project.files()["hypcheck.toml"], flags=re.MULTILINE)
    assert set(tomllib.loads(commented)) == {
        "specs", "tolerance", "question", "precision", "families", "known_failures"
    }  # fmt: skip


def steps(workflow: str) -> list[str]:
    """The command lines of a workflow."""
    return re.findall(r"run: \|\n +(.*)", workflow)


def test_the_workflow_installs_builds_and_verifies(language):
    project = Project(language, "engine", "hypcheck @ git+https://example.org/hypcheck.git@v1")
    install, build, verify = steps(project.files()[".github/workflows/hypcheck.yml"])
    assert shlex.split(install) == ["python", "-m", "pip", "install", project.requirement]
    assert build == language.build
    assert shlex.split(verify) == ["hypcheck", "verify", language.spec, "--out", "hypcheck-report"]


def test_what_is_in_the_way_is_counted_in_the_singular_and_the_plural(tmp_path, capsys):
    for number, name in enumerate(["hypcheck-c/adapter.c", "hypcheck-c/predicate.c", "hypcheck.toml"]):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("mine")
        assert init("--language", "c", "--directory", tmp_path) == 2
        others = ("", ", and so does 1 other file of init's", ", and so do 2 other files of init's")[number]
        assert f" exists{others}; nothing was written" in capsys.readouterr().err


OTHERS = ["hypcheck.toml", ".github/workflows/hypcheck.yml", "hypcheck-c/predicate.c"]


@pytest.mark.parametrize("taken", OTHERS)
def test_what_is_there_stays_unless_force_is_said(taken, tmp_path, capsys):
    (tmp_path / taken).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / taken).write_text("mine")
    assert init("--language", "c", "--directory", tmp_path) == 2
    assert f"{tmp_path / taken} exists; nothing was written; --force" in capsys.readouterr().err
    assert tree(tmp_path) == {taken: "mine"}
    assert init("--language", "c", "--directory", tmp_path, "--force") == 0
    assert tree(tmp_path) == Project(LANGUAGES["c"], safe_name(tmp_path.name), f"hypcheck=={VERSION}").files()


def test_even_a_dangling_link_counts_as_there(tmp_path, capsys):
    (tmp_path / "hypcheck.toml").symlink_to(tmp_path / "nowhere")
    assert init("--language", "c", "--directory", tmp_path) == 2
    assert "hypcheck.toml exists" in capsys.readouterr().err
    assert not (tmp_path / "nowhere").exists()


def test_a_folder_is_not_replaced_even_by_force(tmp_path, capsys):
    (tmp_path / "hypcheck.toml").mkdir()
    assert init("--language", "c", "--directory", tmp_path, "--force") == 2
    assert f"{tmp_path / 'hypcheck.toml'} is in the way; it must be a file" in capsys.readouterr().err
    assert tree(tmp_path) == {}


@pytest.mark.parametrize("taken", [".github", "hypcheck-c"])
def test_a_file_where_a_folder_must_be_leaves_nothing_half_written(taken, tmp_path, capsys):
    (tmp_path / taken).write_text("mine")
    assert init("--language", "c", "--directory", tmp_path / "") == 2
    assert f"cannot make the folder {tmp_path / taken}" in capsys.readouterr().err
    assert os.listdir(tmp_path) == [taken]


@pytest.mark.parametrize("fails_at", [1, 3, 6, 7, 9, 12])
@pytest.mark.parametrize("error", [OSError(errno.ENOSPC, "No space left on device"), KeyboardInterrupt()])
def test_a_full_disk_or_an_interrupt_leaves_everything_as_it_was(fails_at, error, tmp_path, monkeypatch, capsys):
    target = tmp_path / "new" / "engine"
    calls = []

    def fsync(_):
        calls.append(1)
        if len(calls) == fails_at:
            raise error

    monkeypatch.setattr("hypcheck.tables.streams.os.fsync", fsync)
    project = Project(LANGUAGES["c"], "engine", "hypcheck==1")
    assert len(project.files()) == 6
    assert init("--language", "c", "--directory", target) == (2 if isinstance(error, OSError) else 130)
    assert len(calls) == fails_at
    assert list(tmp_path.iterdir()) == []


def test_names_are_made_safe():
    assert safe_name("engine_2.0-rc") == "engine_2.0-rc"
    assert safe_name("Größe & Co") == "Groe-Co"
    assert safe_name('a"; rm -rf ~ #\n\\') == "a-rm-rf"
    assert safe_name("@BUILD@") == "BUILD"
    assert safe_name("--..__") == safe_name("δ") == safe_name("") == ""
    assert len(safe_name("x" * 1000)) == LONGEST_NAME


def test_a_name_of_nothing_is_refused_and_a_changed_one_is_told(tmp_path, capsys):
    assert init("--language", "python", "--directory", tmp_path, "--name", "δ") == 2
    assert "--name is 'δ'; it must have a letter or a digit" in capsys.readouterr().err
    assert init("--language", "python", "--directory", tmp_path, "--name", 'x"y') == 0
    assert "the name 'x\"y' is written as x-y" in capsys.readouterr().out
    assert '"name": "x-y"' in (tmp_path / "hypcheck-python/predicate.py").read_text()
    (tmp_path / "δ").mkdir()
    assert init("--language", "c", "--directory", tmp_path / "δ") == 0
    assert r"\"name\":\"predicate\"" in (tmp_path / "δ/hypcheck-c/predicate.c").read_text()


SOURCES = {
    "1.2.0": "hypcheck==1.2.0",
    "2.0rc1": "hypcheck==2.0rc1",
    "1.0.post2.dev3": "hypcheck==1.0.post2.dev3",
    "https://example.org/owner/hypcheck.git@v1.2.0": "hypcheck @ git+https://example.org/owner/hypcheck.git@v1.2.0",
    "git+https://example.org:8443/~o/hypcheck@0a1b2c": "hypcheck @ git+https://example.org:8443/~o/hypcheck@0a1b2c",
    "https://example.org/owner/hypcheck/": "hypcheck @ git+https://example.org/owner/hypcheck",
    "ssh://git@example.org/hypcheck.git@release/1.x": "hypcheck @ git+ssh://git@example.org/hypcheck.git@release/1.x",
    "git@example.org:owner/hypcheck.git": "hypcheck @ git+ssh://git@example.org/owner/hypcheck.git",
}


@pytest.mark.parametrize("source", SOURCES)
def test_what_ci_installs_is_a_version_or_a_repository(source):
    wanted = requirement(source)
    assert wanted.text == SOURCES[source]
    assert wanted.pinned == ("==" in wanted.text or "@" in wanted.text.rpartition("/hypcheck")[2])
    assert re.fullmatch(r"[\w @:/.=~+-]+", wanted.text)


BAD_SOURCES = [
    "", "latest", "1.2.", "v1.2.0", ">=1", "1.0 --index-url=http://x", "hypcheck", "./hypcheck", "/srv/hypcheck.git",
    "http://example.org/hypcheck.git", "file:///srv/hypcheck.git", "git://example.org/hypcheck", "https://example.org",
    "https://example.org/hypcheck.git@", "https://example.org/hypcheck@--upload-pack=x", "https://-x/hypcheck",
    "https://example.org/hyp'check", 'https://example.org/"', "https://example.org/$(id)", "https://example.org/a;b",
    "https://example.org/a#egg=b", "https://example.org/a b", "https://example.org/a\nrun: b", "https://example.org/`id`",
    "https://example.org/hypcheck${{secrets.X}}", "-oProxyCommand=x@example.org:hypcheck", "1" * 301,
]  # fmt: skip


@pytest.mark.parametrize("source", BAD_SOURCES)
def test_anything_else_is_refused_before_a_file_is_written(source, tmp_path, capsys):
    assert init("--language", "c", "--directory", tmp_path, f"--from={source}") == 2
    assert "it must be a version such as 1.2.0, or a git URL such as https://" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "source", ["https://token@example.org/h.git", "https://me:secret@example.org/h.git@v1", "ssh://me:secret@x.org/h"]
)
def test_a_secret_is_neither_written_nor_repeated(source, tmp_path, capsys):
    assert init("--language", "c", "--directory", tmp_path, "--from", source) == 2
    said = capsys.readouterr()
    assert "may be a secret before its @" in said.err
    assert "secret@" not in said.err
    assert "token" not in said.err
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(InputError):
        requirement(source)


def test_who_follows_a_branch_is_told(tmp_path, capsys):
    pinned, loose = "https://example.org/hypcheck.git@v1", "https://example.org/hypcheck.git"
    assert init("--language", "c", "--directory", tmp_path / "a", "--from", pinned) == 0
    assert "on the day" not in capsys.readouterr().out
    assert init("--language", "c", "--directory", tmp_path / "b", "--from", loose) == 0
    assert f"installs what {loose} holds on the day" in capsys.readouterr().out


def test_a_language_that_is_none_is_refused(tmp_path, capsys):
    assert init("--language", "fortran", "--directory", tmp_path) == 2
    assert "'fortran' is not one of" in capsys.readouterr().err
    assert init("--directory", tmp_path) == 2


def test_it_loads_nothing_heavy(tmp_path):
    heavy = ("numpy", "sympy", "mpmath", "fcl", "matplotlib")
    code = f"""
import json, sys
from hypcheck.cli.main import main
assert main(["init", "--help"]) == 0
assert main(["init", "--language", "c", "--directory", {str(tmp_path)!r}]) == 0
print(json.dumps([name for name in {heavy!r} if name in sys.modules]), file=sys.stderr)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True)
    assert json.loads(done.stderr.splitlines()[-1]) == []
