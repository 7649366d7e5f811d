"""`hypcheck init`: the files that it writes, their content, and the files that it keeps."""

from __future__ import annotations

import errno
import json
import re
import subprocess
import sys
from importlib.resources import files

import pytest

from hypcheck.cli.main import main
from hypcheck.implementations.spec import parse_spec
from hypcheck.scaffold.project import LANGUAGES, LONGEST_NAME, STUBS, Project, safe_name, shared_files
from tests.support.inside import EMITTED_LANGUAGES

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


SHARED = ["hypcheck.toml", ".github/workflows/hypcheck.yml", ".gitignore"]


def every_file(folder, language, name: str) -> dict[str, str]:
    """What init writes into an empty folder."""
    project = Project(language, name)
    return project.files() | shared_files(folder / "empty", project, None, force=True)[0]


def test_init_writes_every_file_of_a_language_and_prints_the_next_commands(language, tmp_path, capsys):
    project = Project(language, "engine")
    expected = every_file(tmp_path, language, "engine")
    assert init("--language", language.name, "--directory", tmp_path, "--name", "engine") == 0
    assert tree(tmp_path) == expected
    assert set(expected) - set(project.files()) == set(SHARED)
    printed = capsys.readouterr().out
    *listed, nothing = printed.partition("\n\n")[0].splitlines()
    assert [line.split("   ")[0] for line in listed] == [str(tmp_path / path) for path in expected]
    assert nothing.startswith("nothing to install was named: edit the step")
    typed = [line.strip() for line in printed.splitlines() if line.startswith("    ")]
    assert typed == [*project.commands, *([project.emit] if language.name in EMITTED_LANGUAGES else [])]
    assert f"in {tmp_path}:" in printed


def test_init_writes_to_the_working_directory_and_uses_its_name_by_default(tmp_path, monkeypatch, capsys):
    folder = tmp_path / "Moteur à tiges"
    folder.mkdir()
    monkeypatch.chdir(folder)
    assert init("--language", "rust") == 0
    assert '"name":"Moteur-a-tiges"' in (folder / "hypcheck-rust/src/predicate.rs").read_text()
    assert "Type next:" in capsys.readouterr().out


def test_template_folder_has_the_files_of_the_language_table_and_init_fills_every_placeholder(language, tmp_path):
    folder = files("hypcheck.scaffold").joinpath("templates")
    there = {str(path.relative_to(folder / language.name)) for path in (folder / language.name).rglob("*")}
    assert {path for path in there if "." in path and "__pycache__" not in path} == set(language.files)
    assert language.predicate in language.files
    for path, text in every_file(tmp_path, language, "engine").items():
        assert not re.search(r"@[A-Z]+@", text), path
        assert text.endswith("\n")
        assert "\t" not in text or path.endswith(".go")
        assert "\r" not in text


def test_only_the_predicate_file_says_that_it_is_a_stub_to_be_replaced(language, tmp_path):
    written = every_file(tmp_path, language, "engine")
    saying = [path for path, text in written.items() if "Replace this with your predicate" in text]
    assert saying == [f"{language.folder}/{language.predicate}"]


def test_adapter_of_each_question_is_the_shared_template_without_the_part_of_the_other_question(language):
    marks = re.compile(r"@(position|passage|end)@\n")
    for name in language.files:
        text = files("hypcheck.scaffold").joinpath("templates", language.name, *name.split("/")).read_text()
        found = marks.findall(text)
        if name == language.predicate or not found:
            continue
        assert re.fullmatch("(P?W?E)*", "".join({"position": "P", "passage": "W", "end": "E"}[each] for each in found))
        assert "end" in found
        one, other = (Project(language, "x", stub).filled(language.name, name).splitlines() for stub in STUBS)
        assert one != other
        shared = [line for line in marks.split(text)[0].splitlines() if "@" not in line]
        assert all(line in one and line in other for line in shared)
        assert len(one) + len(other) > 1.3 * len(text.splitlines())  # most lines are of both


def test_every_template_folder_belongs_to_a_language():
    folders = {each.name for each in files("hypcheck.scaffold").joinpath("templates").iterdir()}
    assert folders == {"common", *LANGUAGES, *(f"{name}-passage" for name in LANGUAGES)}


def test_generated_settings_are_valid_toml_and_name_the_adapter(language, tmp_path):
    text = every_file(tmp_path, language, "engine")["hypcheck.toml"]
    assert tomllib.loads(text) == {"specs": [language.spec], "tolerance": 8}
    assert parse_spec(language.spec).kind in {"command", "python"}
    commented = re.sub(r"^# (\w+ = )", r"\1", text, flags=re.MULTILINE)
    assert set(tomllib.loads(commented)) == {
        "specs", "tolerance", "question", "precision", "families", "known_failures"
    }  # fmt: skip


@pytest.mark.parametrize("taken", ["hypcheck.toml", ".github/workflows/hypcheck.yml", "hypcheck-c/predicate.c"])
def test_init_keeps_existing_files_unless_forced(taken, tmp_path, capsys):
    (tmp_path / taken).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / taken).write_text("mine")
    assert init("--language", "c", "--directory", tmp_path) == 2
    assert f"{tmp_path / taken} exists; nothing was written; --force" in capsys.readouterr().err
    assert tree(tmp_path) == {taken: "mine"}
    assert init("--language", "c", "--directory", tmp_path, "--force") == 0
    assert tree(tmp_path) == every_file(tmp_path, LANGUAGES["c"], safe_name(tmp_path.name))


def test_init_counts_a_dangling_link_as_an_existing_file(tmp_path, capsys):
    (tmp_path / "hypcheck.toml").symlink_to(tmp_path / "nowhere")
    assert init("--language", "c", "--directory", tmp_path) == 2
    assert "hypcheck.toml exists" in capsys.readouterr().err
    assert not (tmp_path / "nowhere").exists()


@pytest.mark.parametrize("fails_at", [1, 3, 7, 8, 9, 14])
@pytest.mark.parametrize("error", [OSError(errno.ENOSPC, "No space left on device"), KeyboardInterrupt()])
def test_init_leaves_all_files_as_they_were_on_a_full_disk_or_an_interrupt(
    fails_at, error, tmp_path, monkeypatch, capsys
):
    target = tmp_path / "new" / "engine"
    calls = []

    def fsync(_):
        calls.append(1)
        if len(calls) == fails_at:
            raise error

    monkeypatch.setattr("hypcheck.tables.streams.os.fsync", fsync)
    assert len(every_file(target, LANGUAGES["c"], "engine")) == 7
    assert init("--language", "c", "--directory", target) == (2 if isinstance(error, OSError) else 130)
    assert len(calls) == fails_at
    assert list(tmp_path.iterdir()) == []


def test_project_name_keeps_only_safe_characters():
    assert safe_name("engine_2.0-rc") == "engine_2.0-rc"
    assert safe_name("Größe & Co") == "Groe-Co"
    assert safe_name('a"; rm -rf ~ #\n\\') == "a-rm-rf"
    assert safe_name("@BUILD@") == "BUILD"
    assert safe_name("--..__") == safe_name("δ") == safe_name("") == ""
    assert len(safe_name("x" * 1000)) == LONGEST_NAME


def test_init_refuses_a_name_without_safe_characters_and_reports_a_changed_name(tmp_path, capsys):
    assert init("--language", "python", "--directory", tmp_path, "--name", "δ") == 2
    assert "--name is 'δ'; it must have a letter or a digit" in capsys.readouterr().err
    assert init("--language", "python", "--directory", tmp_path, "--name", 'x"y') == 0
    assert "the name 'x\"y' is written as x-y" in capsys.readouterr().out
    assert '"name": "x-y"' in (tmp_path / "hypcheck-python/predicate.py").read_text()
    (tmp_path / "δ").mkdir()
    assert init("--language", "c", "--directory", tmp_path / "δ") == 0
    assert r"\"name\":\"predicate\"" in (tmp_path / "δ/hypcheck-c/predicate.c").read_text()


def test_init_help_loads_no_heavy_library(tmp_path):
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
