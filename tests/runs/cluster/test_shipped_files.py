"""The files that a SPEC names, those that are sent to a cluster, and the SPEC as a worker opens it."""

from __future__ import annotations

import json
import shutil
import sys
from pathlib import Path

import pytest

from hypcheck.errors import InputError
from hypcheck.runs.fingerprint import files_of, fingerprints, sha256

pytest.importorskip("distributed")

from hypcheck.runs.dask_executor import files_to_ship, module_sha256, spec_on_worker


@pytest.fixture
def files(tmp_path, monkeypatch):
    """A script, its data and a module, in the working directory."""
    monkeypatch.chdir(tmp_path)
    for name in ("run.sh", "rows.txt", "module.py"):
        (tmp_path / name).write_text(name)
    return tmp_path


@pytest.mark.parametrize(
    ("spec", "named", "sent"),
    [
        ("builtin:fast", [], []),
        ("python:module:f", ["module.py"], []),
        ("python:module.py:f", ["module.py"], ["module.py"]),
        ("python:nowhere:f", [], []),
        ("library:nowhere.so", [], []),
        ("command:./run.sh rows.txt 3 rows.tx", ["run.sh", "rows.txt"], ["run.sh", "rows.txt"]),
        ("command:run.sh rows.txt", ["rows.txt"], ["rows.txt"]),
    ],
)
def test_files_of_a_spec_are_found_and_only_those_given_by_path_are_sent_to_workers(files, spec, named, sent):
    assert [each.path.name for each in files_of(spec)] == named
    assert [each.path.rpartition("/")[2] for each in files_to_ship(spec)] == sent
    assert list(fingerprints([spec]).values()) == [sha256(files / name) for name in named]


def test_program_found_on_the_path_is_not_sent_to_workers():
    (found,) = files_of("command:sh -c true")
    assert str(found.path) == shutil.which("sh")
    assert files_to_ship("command:sh -c true") == ()


def test_fingerprint_of_a_python_module_is_that_of_its_file(files):
    assert module_sha256("python:module:f") == sha256(files / "module.py")
    assert module_sha256("python:nowhere:f") == "(not found)"
    assert module_sha256("python:module.py:f") == module_sha256("command:sh") == ""


def test_paths_of_sent_files_replace_the_paths_in_the_command(files, tmp_path):
    spec = f"command:{sys.executable} rows.txt -v"
    sent = files_to_ship(spec)
    assert spec_on_worker(spec, sent, "w", tmp_path) == "command:" + json.dumps(
        [sys.executable, str(files / "rows.txt"), "-v"]
    )
    (files / "rows.txt").rename(files / "gone")
    there = tmp_path / "there"
    there.mkdir()
    words = json.loads(spec_on_worker(spec, sent, "w", there).removeprefix("command:"))
    assert words == [sys.executable, str(there / "1" / "rows.txt"), "-v"]
    assert (there / "1" / "rows.txt").read_text() == "rows.txt"


def test_file_with_other_content_on_a_worker_is_refused(files, tmp_path):
    sent = files_to_ship("command:./run.sh")
    (files / "run.sh").write_text("another")
    with pytest.raises(InputError, match=r"run\.sh is another file on worker w: sha256 \w{64} there, and \w{64} here"):
        spec_on_worker("command:./run.sh", sent, "w", tmp_path)


def test_a_file_that_cannot_be_sent_to_a_cluster_is_named(tmp_path, monkeypatch):
    path = tmp_path / "mine.py"
    path.write_text("def f(rows): ...")
    assert [each.content for each in files_to_ship(f"python:{path}:f")] == [b"def f(rows): ..."]

    def unreadable(self):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "read_bytes", unreadable)
    with pytest.raises(InputError, match=r"mine\.py cannot be sent to a cluster: permission denied"):
        files_to_ship(f"python:{path}:f")
