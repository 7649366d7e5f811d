"""Which files an isolated program sees: what it needs, what --see shows, and nothing that holds answers."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from hypcheck.cli.main import main
from hypcheck.implementations.process import Process
from hypcheck.isolation.view import PACKAGE, hidden_paths, needed_paths, private_folders
from tests.isolation.test_isolation import both, isolated, line_of
from tests.support.inside import kernel_classify

A_MODULE = Path(kernel_classify.__file__).relative_to(PACKAGE)
"""By this module a copy of hypcheck is known."""

READS = """
import os, sys
def seen(path):
    try:
        return sorted(os.listdir(path)) if os.path.isdir(path) else open(path).read()
    except OSError as error:
        return type(error).__name__
import json
print(json.dumps([seen(path) for path in json.loads(sys.stdin.readline())]), flush=True)
sys.stdin.read()
"""


def read_by_program(paths, ways, words=(), **options):
    """What an isolated program reads at each of the paths, which are not among its words."""
    process = Process((sys.executable, "-I", "-S", "-c", READS, *map(str, words)), isolated(ways, **options))
    try:
        process.send([json.dumps([str(path) for path in paths]).encode() + b"\n"])
        return json.loads(line_of(process))
    finally:
        process.kill()


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A project that is a git repository with a built program, a vendored copy of hypcheck, and a folder beside it."""
    here = tmp_path / "project"
    files = (
        "project/.git/HEAD",
        "project/build/adapter",
        f"project/vendored/hypcheck/{A_MODULE}",
        "beside/data",
    )
    for path in files:
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(f"text of {path}")
    monkeypatch.chdir(here)
    return tmp_path


@both
def test_program_sees_its_project_but_no_repository_no_copy_of_hypcheck_and_nothing_beside(ways, project):
    here = project / "project"
    paths = (
        here / "build/adapter",
        here / ".git/HEAD",
        here / "vendored/hypcheck" / A_MODULE,
        project / "beside/data",
    )
    mine, *others = read_by_program(paths, ways)
    assert mine == "text of project/build/adapter"
    assert {*others} <= {"FileNotFoundError", "PermissionError"}


@both
def test_program_sees_neither_vectors_nor_builds_of_a_checkout_of_hypcheck_in_its_project(ways, project):
    checkout = project / "project/vendored"
    (checkout / "pyproject.toml").write_text("[project]")
    paths = [checkout / name / "file" for name in ("cases", "build", "dist", ".git", "docs")]
    for path in paths:
        path.parent.mkdir()
        path.write_text("text")
    *others, documents = read_by_program(paths, ways)
    assert {*others} <= {"FileNotFoundError", "PermissionError"}
    assert documents == "text"


@both
def test_program_started_in_a_folder_of_a_repository_sees_all_of_that_but_its_history(ways, project, monkeypatch):
    inner = project / "project/tests"
    inner.mkdir()
    monkeypatch.chdir(inner)
    paths = (project / "project/build/adapter", project / "project/.git/HEAD", project / "beside/data")
    mine, *others = read_by_program(paths, ways)
    assert mine == "text of project/build/adapter"
    assert {*others} <= {"FileNotFoundError", "PermissionError"}


@both
def test_program_in_a_home_that_is_a_repository_does_not_see_the_whole_home(ways, project, monkeypatch):
    (project / ".git").mkdir()
    (project / "project/.git/HEAD").unlink()
    (project / "project/.git").rmdir()
    monkeypatch.setenv("HOME", str(project))
    mine, beside = read_by_program((project / "project/build/adapter", project / "beside/data"), ways)
    assert mine == "text of project/build/adapter"
    assert beside in {"FileNotFoundError", "PermissionError"}


@both
def test_program_sees_what_see_names_although_it_is_hidden_or_beside_its_project(ways, project):
    paths = (project / "project/.git/HEAD", project / "beside/data")
    seen = (str(project / "project/.git"), str(project / "beside"))
    assert read_by_program(paths, ways, seen=seen) == ["text of project/.git/HEAD", "text of beside/data"]


@both
def test_program_never_sees_this_package_its_vectors_or_the_reports_even_if_see_names_them(ways, project):
    paths = (PACKAGE / A_MODULE, PACKAGE.parent / "cases/manifest.json", project / "beside/data")
    seen = (str(PACKAGE.parent), str(project))
    found = read_by_program(paths, ways, seen=seen, hidden=(str(project / "beside"),))
    assert {*found} <= {"FileNotFoundError", "PermissionError"}


@both
def test_program_sees_what_its_words_name_and_its_interpreter_with_what_is_installed_beside_it(ways, project):
    tool = project / "tool"
    for path, text in (("bin/run", f"#!{sys.executable}\n"), ("lib/part", "a part"), ("../data/rows", "rows")):
        (tool / path).parent.mkdir(parents=True, exist_ok=True)
        (tool / path).write_text(text)
    script = project / "data/script"
    script.write_text(f"#!{tool / 'bin/run'}\n")
    paths = (tool / "lib/part", project / "data/rows")
    assert read_by_program(paths, ways, (script,)) == ["a part", "rows"]
    assert {*read_by_program(paths, ways)} <= {"FileNotFoundError", "PermissionError"}


@both
def test_program_sees_a_package_that_is_linked_into_the_packages_of_its_python(ways, project, monkeypatch):
    for path in ("store/linked/code.py", "packages/other.py"):
        (project / path).parent.mkdir(parents=True)
        (project / path).write_text(f"text of {path}")
    (project / "packages/linked").symlink_to(project / "store/linked")
    monkeypatch.syspath_prepend(str(project / "packages"))
    paths = (project / "packages/linked/code.py", project / "packages/other.py")
    assert read_by_program(paths, ways) == ["text of store/linked/code.py", "text of packages/other.py"]


def test_root_has_no_folder_that_is_seen_whole_but_those_of_the_system(project):
    needed = needed_paths((sys.executable,), os.environ)
    private = private_folders(needed)
    shown = {name for name in os.listdir("/") if os.path.isdir(f"/{name}") and not os.path.islink(f"/{name}")}
    system = {
        "bin",
        "dev",
        "etc",
        "gnu",
        "lib",
        "lib32",
        "lib64",
        "libx32",
        "nix",
        "opt",
        "proc",
        "sbin",
        "snap",
        "sys",
    }
    assert shown - {path[1:] for path in private} <= system | {"usr", "var"}
    assert str(project / "project") in needed


@pytest.mark.skipif(os.path.islink("/var") or not os.path.isdir("/var/lib"), reason="it needs a home in /var")
def test_home_in_a_folder_of_the_system_is_private_unless_all_of_it_is_needed(monkeypatch):
    monkeypatch.setenv("HOME", "/usr/lib")
    assert "/usr/lib" not in private_folders(())
    monkeypatch.setenv("HOME", "/var/lib")
    assert "/var/lib" in private_folders(())
    assert "/var/lib" not in private_folders(("/var/lib",))


def test_checkout_of_an_action_and_what_was_built_beside_this_package_are_hidden(project, monkeypatch):
    monkeypatch.setenv("GITHUB_ACTION_PATH", str(project / "beside"))
    hidden = hidden_paths((), needed_paths((sys.executable,), os.environ))
    assert str(project / "beside") in hidden
    assert str(PACKAGE) in hidden
    checkout = PACKAGE.parent
    for name in (".git", "build", "cases") if (checkout / "pyproject.toml").is_file() else ():
        assert str(checkout / name) in hidden or not (checkout / name).exists()


def test_run_says_first_what_see_shows_and_lists_it_as_weaker(project, capsys, text_reports):
    spec = f"command:{sys.executable} -I -S -c pass"
    assert main(["verify", spec, "--see", "../beside", "--see", "build", "--out", "out"]) == 5
    said = capsys.readouterr()
    first, second = said.err.splitlines()[0], said.out.splitlines()[1]
    assert f"; --see shows it {project / 'beside'}, {project / 'project/build'}; " in first
    assert second == "weaker than the default: --see ../beside, build, not nothing (command line)"
    assert main(["verify", spec, "--see", "nowhere", "--out", "out"]) == 2
    assert "--see is 'nowhere', which is not there; it must be a file or folder" in capsys.readouterr().err


@both
def test_installed_packages_of_this_python_are_seen(ways, project):
    code = "import numpy; print(numpy.__file__)"
    numpy = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout.strip()
    (found,) = read_by_program([Path(numpy)], ways)
    assert "Error" not in found[:40]
