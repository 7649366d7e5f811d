"""A file that is not a record of the same interrupted run is refused in one sentence, and nothing changes."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from hypcheck.cli.main import main
from hypcheck.record import Recorder, read
from hypcheck.record.fields import as_json
from hypcheck.record.reader import FILE, GROWING
from hypcheck.record.writer import FolderInUseError, folder_locked
from hypcheck.runs.fingerprint import MOST_FILES, fingerprints, not_hashed, sha256
from tests.report.record_samples import text_and_record
from tests.runs.interruption import in_small_steps, paused_bytes, started, wait_for, words
from tests.runs.resume.test_interrupted import needs_proc
from tests.support.records import resealed

pytestmark = pytest.mark.usefixtures("text_reports")


@pytest.fixture(scope="module")
def paused(tmp_path_factory):
    return paused_bytes(tmp_path_factory)


@pytest.fixture
def small_steps(monkeypatch, text_reports):
    """The steps of the run that was paused."""
    in_small_steps(monkeypatch.setattr)


def files_in(folder):
    """Every file with its content and when it was written."""
    return {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in folder.rglob("*") if path.is_file()}


def refused(out, capsys, *more):
    """The sentence with which the run is refused."""
    before = files_in(out)
    assert main(words(out, *more)) == 2
    assert files_in(out) == before
    said, errors = capsys.readouterr()
    assert said == ""
    (line,) = errors.splitlines()
    return line


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda lines: lines[0]["options"].update(seed=2), "--seed was 2, and is 1 now"),
        (lambda lines: lines[0]["options"].update(families=["ring"]), '--families was ["ring"], and is'),
        (lambda lines: lines[0]["options"].update(specs=["builtin:fast"]), 'specs was ["builtin:fast"], and is'),
        (lambda lines: lines[0].update(schema="1.2.0"), 'schema was "1.2.0", and is "1.10.0" now'),
        (lambda lines: lines[0].update(schema="2.0.0"), "has schema 2.0.0; this program reads 1.x"),
        (lambda lines: lines[0].update(hypcheck="0.0.1"), 'hypcheck was "0.0.1", and is'),
        (lambda lines: lines[0]["versions"].update(numpy="1.0"), 'numpy was "1.0", and is'),
        (lambda lines: lines[-1].update(cases=7), "the number of cases was 7, and is"),
        (lambda lines: lines[-1].update(program="00"), 'the sha256 of hypcheck\'s own files was "00", and is'),
        (lambda lines: lines[-1]["declared"].update(version="9"), "the version that python:tests.runs.faulty"),
        (lambda lines: lines[0]["files"].update(dict.fromkeys(lines[0]["files"], "00")), "the sha256 of "),
        (lambda lines: lines[-1].pop("state"), "line 6, progress: it lacks state"),
        (lambda lines: lines[-1].update(state={}), "line 6, progress: state lacks done"),
    ],
)
def test_record_of_a_run_with_other_options_is_not_resumed(paused, tmp_path, capsys, change, said):
    lines = [json.loads(line) for line in paused.splitlines()]
    change(lines)
    (tmp_path / GROWING).write_bytes(resealed(lines))
    assert said in refused(tmp_path, capsys, "--resume", str(tmp_path))


def test_record_of_another_command_is_not_resumed(tmp_path, capsys):
    (tmp_path / "ours.jsonl").write_text(text_and_record()[0], encoding="utf-8")
    said = refused(tmp_path, capsys, "--resume", str(tmp_path / "ours.jsonl"))
    assert "it is the record of a run of `verify without SPEC`, which always begins from its start" in said
    header = {**as_json(read(tmp_path / "ours.jsonl").header), "options": {"command": "bench"}}
    (tmp_path / "bench.jsonl").write_bytes(resealed([header]))
    said = refused(tmp_path, capsys, "--resume", str(tmp_path / "bench.jsonl"))
    assert "it is the record of a run of `bench`, which always begins from its start" in said


def test_run_of_a_changed_implementation_is_not_resumed(tmp_path, capsys):
    code = tmp_path / "subject.py"
    code.write_text("def zero(rows):\n    return [0] * len(rows)\n", encoding="utf-8")
    specs = [f"python:{code}:zero", "builtin:fast"]
    options = ["--families", "ring", "--count", "0", "--out", str(tmp_path / "out")]
    assert main(["verify", *specs, *options]) == 1
    path = tmp_path / "out" / FILE
    path.write_bytes(path.read_bytes()[:-9])
    code.write_text("def zero(rows):\n    return [1] * len(rows)\n", encoding="utf-8")
    capsys.readouterr()
    assert main(["verify", *specs, *options, "--resume", str(path)]) == 2
    assert f"{path} cannot be resumed: the sha256 of {code} was " in capsys.readouterr().err


STARTS = {
    "python:subject.py:none": "beside.py",
    "python:package.module:none": "package/part.py",
    "command:python3 adapter.py": "deep/inner.py",
    "command:python3 -m package.module": "package/part.py",
    "command:sh -c ./prog": "prog",
    "command:sh -c 'exec ./prog --fast'": "prog",
    "command:env MODE=1 ./prog": "prog",
    "command:./prog --weights=weights.bin": "weights.bin",
    "command:java -cp lib.jar:other.jar Main": "other.jar",
    "command:sh -c 'echo it'\\''s; ./prog'": "prog",
}
"""A file that each of these starts, and does not name as the target of the SPEC."""


@pytest.fixture
def beside(tmp_path, monkeypatch):
    """The folder of these files, as the working directory."""
    monkeypatch.chdir(tmp_path)
    for name, text in {
        "subject.py": "import beside\n",
        "beside.py": "import json\n",
        "package/__init__.py": "",
        "package/module.py": "from . import part\n",
        "package/part.py": "X = 1\n",
        "adapter.py": "from deep.inner import X\n",
        "deep/__init__.py": "",
        "deep/inner.py": "X = 1\n",
        "prog": "#!/bin/sh\nexit 1\n",
        **dict.fromkeys(("weights.bin", "lib.jar", "other.jar"), "1"),
    }.items():
        Path(name).parent.mkdir(exist_ok=True)
        Path(name).write_text(text)
    Path("prog").chmod(0o755)
    return tmp_path


@pytest.mark.parametrize("spec", STARTS)
def test_file_that_an_implementation_starts_is_hashed(spec, beside):
    assert sha256(Path(STARTS[spec])) in [
        found for name, found in fingerprints([spec]).items() if Path(name).resolve() == beside / STARTS[spec]
    ]


def test_files_that_a_command_does_not_show_are_named_in_its_first_line_and_in_the_record(
    tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    Path("x.js").write_text("process.exit(1)\n")
    Path("loads.py").write_text("import importlib\nimportlib.import_module('json')\n")
    spec = ["command:sh x.js", "command:python3 loads.py"]
    assert main(["verify", *spec, "--families", "ring", "--count", "0", "--out", "out"]) == 5
    expected = ["what sh loads besides", "what loads.py loads as it runs (import_module)"]
    assert f"; not hashed: {', '.join(expected)}" in capsys.readouterr().err
    assert read(Path("out")).header.not_hashed == expected


def test_a_program_that_a_shell_finds_on_its_path_is_hashed(beside, monkeypatch):
    monkeypatch.setenv("PATH", f"{beside}{os.pathsep}{os.environ['PATH']}")
    assert str(beside / "prog") in fingerprints(["command:sh -c 'prog --fast'"])


def test_imports_of_a_file_that_are_not_python_are_named_and_not_hashed(beside):
    Path("subject.py").write_text("import beside\ndef f(rows) return 0\n")
    assert not_hashed(["python:subject.py:f"]) == ["what subject.py imports, as it cannot be parsed"]
    assert [Path(name).name for name in fingerprints(["python:subject.py:f"])] == ["subject.py"]


@pytest.mark.slow
def test_an_implementation_of_very_many_files_is_hashed_in_part(beside):
    for number in range(MOST_FILES + 1):
        Path(f"part{number}.py").touch()
    Path("subject.py").write_text("".join(f"import part{number}\n" for number in range(MOST_FILES + 1)))
    assert not_hashed(["python:subject.py:f"]) == [f"what is beyond {MOST_FILES:,} files"]
    assert len(fingerprints(["python:subject.py:f"])) == MOST_FILES


@pytest.mark.parametrize("content", [b"", b"\x7fELF", b"\x7fELF\x02\x01\x01" + bytes(57), b"\x7fELF" + b"\xff" * 200])
def test_file_that_only_begins_like_a_library_is_hashed_without_other_files(content, beside):
    Path("lib.so").write_bytes(content)
    assert list(fingerprints(["library:lib.so"]).values()) == [sha256(Path("lib.so"))]
    assert not_hashed(["library:lib.so"]) == []


@pytest.mark.skipif(sys.platform != "linux" or shutil.which("cc") is None, reason="needs ELF and a C compiler")
def test_library_that_a_library_needs_by_its_own_search_path_is_hashed(tmp_path):
    (tmp_path / "inner.c").write_text("int inner(void) { return 0; }")
    (tmp_path / "outer.c").write_text("int inner(void); int outer(void) { return inner(); }")
    built = {"inner": [], "outer": ["-L.", "-linner", "-Wl,-rpath,$ORIGIN"]}
    for name, more in built.items():
        words = ["cc", "-shared", "-fPIC", f"{name}.c", "-o", f"lib{name}.so", *more]
        subprocess.run(words, cwd=tmp_path, check=True)
    assert {str(tmp_path / f"lib{name}.so") for name in built} == {*fingerprints([f"library:{tmp_path}/libouter.so"])}


@needs_proc
def test_folder_of_a_running_run_is_refused(tmp_path, capsys):
    process = started(tmp_path / "out")
    wait_for(process, tmp_path / "out", b"progress")
    process.send_signal(signal.SIGSTOP)
    try:
        for more in ([], ["--resume", str(tmp_path / "out")]):
            assert "out: another run is writing its record there" in refused(tmp_path / "out", capsys, *more)
        said = refused(tmp_path, capsys, "--resume", str(tmp_path / "out" / GROWING))
        assert "out: another run is writing its record there" in said
    finally:
        process.kill()
        process.communicate()


def test_folder_of_a_run_can_be_locked_by_one_process_at_a_time(tmp_path):
    with folder_locked(tmp_path), pytest.raises(FolderInUseError), folder_locked(tmp_path):
        pass
    with folder_locked(tmp_path):
        pass


@pytest.mark.usefixtures("small_steps")
def test_resume_refuses_a_folder_that_cannot_be_written(paused, tmp_path, capsys):
    (tmp_path / FILE).write_bytes(paused)
    said = refused(tmp_path, capsys, "--resume", str(tmp_path), "--out", "/proc/nowhere")
    assert "cannot make the folder /proc/nowhere" in said


@pytest.mark.usefixtures("small_steps")
def test_read_only_record_is_resumed_into_another_folder(paused, tmp_path):
    (tmp_path / "kept").mkdir()
    path = tmp_path / "kept" / FILE
    path.write_bytes(paused)
    path.chmod(0o400)
    path.parent.chmod(0o500)
    before = files_in(path.parent)
    try:
        assert main(words(tmp_path / "out", "--resume", str(path))) == 1
        assert files_in(path.parent) == before
    finally:
        path.parent.chmod(0o700)


def test_resume_without_out_writes_into_the_folder_of_the_record(tmp_path):
    command = ["verify", "builtin:fast", "--families", "ring", "--count", "3"]
    assert main([*command, "--out", str(tmp_path)]) == 0
    path = tmp_path / FILE
    path.write_bytes(path.read_bytes()[:-9])
    (tmp_path / "summary.json").unlink()
    assert main([*command, "--resume", str(path)]) == 0
    assert read(path).footer
    assert (tmp_path / "summary.json").is_file()


def test_finished_record_is_reported_and_stays_unchanged(tmp_path, capsys):
    words = ["verify", "builtin:fast", "--families", "ring", "--count", "3", "--out", str(tmp_path)]
    assert main(words) == 0
    before = (tmp_path / FILE).read_bytes()
    capsys.readouterr()
    assert main([*words, "--resume", str(tmp_path)]) == 0
    assert "is the record of a finished run, which ended with 0" in capsys.readouterr().out
    assert (tmp_path / FILE).read_bytes() == before
    for lost in ("summary.json", "measurements.csv"):
        (tmp_path / lost).unlink()
        assert main([*words, "--resume", str(tmp_path)]) == 0
        assert (tmp_path / lost).is_file()
    shutil.move(tmp_path / FILE, tmp_path / GROWING)  # killed before it was renamed
    assert main([*words, "--resume", str(tmp_path)]) == 0
    assert sorted(path.name for path in tmp_path.glob("record*")) == [FILE]
    assert os.path.getmtime(tmp_path / "summary.json") >= os.path.getmtime(tmp_path / FILE)


def test_folder_that_appears_at_the_path_of_the_record_during_the_run_loses_nothing(tmp_path, capsys, monkeypatch):
    def settle(recorder, path):
        path.mkdir()
        kept(recorder, path)

    kept = Recorder.settle
    monkeypatch.setattr(Recorder, "settle", settle)
    assert main(["verify", "builtin:fast", "--families", "ring", "--count", "3", "--out", str(tmp_path)]) == 2
    assert f"is a directory; the finished part is in {tmp_path / GROWING}" in capsys.readouterr().err
    assert read(tmp_path / GROWING).footer
