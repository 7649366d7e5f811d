"""A command that is refused or interrupted before its first result leaves every file as it was, and adds none."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from hypcheck.cli.main import main
from tests.support.shared_folders import made_once
from tests.support.without_drawing import COMMAND, draw_nothing

PRECIOUS = b"of the user\n"

RUN = "reports/latest"
SILENT = f"command:{sys.executable} -c 'import time; time.sleep(100)'"

REFUSED = [
    (("verify", "builtin:nope"), 2),
    (("verify", "builtin:fast", "builtin:nope"), 2),
    (("verify", "nonsense"), 2),
    (("verify", "builtin:fast", "--families", "nope"), 2),
    (("verify", "builtin:fast", "--families", ","), 2),
    (("verify", "builtin:fast", "--known-failures", "nowhere.toml"), 2),
    (("verify", "builtin:fast", "--known-failures", "precious", "--update"), 2),
    (("verify", "builtin:fast", "--memory", "much"), 2),
    (("verify", "builtin:fast", "--resume", "nowhere"), 2),
    (("verify", "--self", "--oracles", "nope"), 2),
    (("verify", "--self", "--families", "nope"), 2),
    (("verify", "builtin:fast", "--count", "2", "--out", "in-the-way"), 2),
    (("verify", "builtin:numpy-roots", "--families", "scale", "--domain", '{"magnitude": [1e-300, 2e-300]}'), 2),
    (("verify", "command:./nowhere"), 5),
    (("verify", "command:./nowhere", "--families", "ring", "--count", "1"), 5),
    (("bench", "--methods", "nope"), 2),
    (("bench", "--methods", " "), 2),
    (("bench", "--workloads", "x"), 2),
    (("bench", "--workloads", "x", "--tilted"), 2),
    (("bench", "--baseline", "nowhere"), 2),
    (("bench", "--baseline", "precious"), 2),
    (("bench", "--scene", "nope"), 2),
    (("bench", "--scene", "tower", "--methods", "fast"), 2),
    (("bench", "nonsense"), 2),
    (("bench", "--quick", "--out", "in-the-way"), 2),
    (("hunt", "builtin:nope", "--out", "cases.json"), 2),
    (("hunt", "builtin:table-2-float64", "--queries", "500", "--out", "precious"), 2),
    (("hunt", "command:./nowhere", "--out", "cases.json"), 5),
    (("engines", "verify", "nope", "--cache", "cache"), 2),
    (("engines", "verify", "--cache", "cache"), 2),
    (("engines", "bench", "nope", "--cache", "cache"), 2),
    (("engines", "bench", "--cache", "cache"), 2),
    (("report", "nowhere", "--out", RUN), 2),
    (("report", "precious", "--out", RUN), 2),
    (("report", "precious", "--out", "report.html"), 2),
    (("report", RUN, "--against", "precious", "--out", RUN), 2),
    (("report", RUN, "--out", "in-the-way", "--format", "json", "--format", "markdown", "--format", "badge"), 2),
    (("simulate", "forest", "--scene", "nope", "--out", "simulated"), 2),
    (("simulate", "tower", "--runs", "3", "--out", "simulated"), 2),
    (("simulate", "forest", "--steps", "3", "--out", "in-the-way"), 2),
    (("cases", "freeze", "nope", "--into", "frozen"), 2),
    (("cases", "freeze", "ring", "nope", "--into", "frozen"), 2),
    (("cases", "freeze", "tower-body", "ring", "--into", "frozen"), 2),
    (("cases", "freeze", "ring", "--into", "nowhere"), 2),
    (("cases", "generate", "nope", "--output", "cases.json"), 2),
    (("cases", "generate", "ring*", "--output", "cases.json"), 2),
    (("emit", "--scene", "nope", "--language", "c", "--output", "kernel.c"), 2),
    (("emit", "--scene", "tower", "--language", "c", "--output", "kernel.c", "--proof", "nowhere/proof.v"), 2),
    (("emit", "--scene", "tower", "--language", "c", "--output", "kernel.c", "--proof", "in-the-way"), 2),
    (("emit", "--scene", "tower", "--language", "c", "--output", "kernel.c", "--proof", "kernel.c"), 2),
    (("emit", "--method", "nope", "--language", "c", "--output", "kernel.c"), 2),
    (("init", "--language", "c", "--directory", "project"), 2),
    (("init", "--language", "rust", "--directory", "project", "--from", "nowhere"), 2),
    (("record", "repair", "precious", "--out", "record.jsonl"), 2),
    (("record", "repair", "nowhere", "--out", "record.jsonl"), 2),
    (("classify", "--input", "precious", "--format", "csv", "--output", "answers.csv"), 2),
    (("classify", "--input", "nowhere.csv", "--output", "answers.csv"), 2),
]
"""Commands and the codes that they end with."""


def _make(folder):
    """The files of a user: runs with reports, a project, frozen vectors, and whatever the commands would replace."""
    run = folder / RUN
    with pytest.MonkeyPatch.context() as patch:
        draw_nothing(patch)
        assert main(["verify", "builtin:fast", "--families", "tower-body", "--count", "2", "--out", str(run)]) == 0
    for name in ("report.html", "map.svg"):  # which take a second to draw
        (run / name).write_bytes(PRECIOUS)
    (run / "notes.txt").write_bytes(PRECIOUS)
    (run / "record.jsonl.part").write_bytes((run / "record.jsonl").read_bytes()[:-200])  # of a run that was killed
    for copy in ("reports/bench", "reports/engines/bench", "in-the-way"):
        shutil.copytree(run, folder / copy)
    for name in ("summary.json", "report.md", "simulate-forest.json"):
        (folder / "in-the-way" / name).unlink(missing_ok=True)
        (folder / "in-the-way" / name / "of-the-user").mkdir(parents=True)
    assert main(["init", "--language", "c", "--directory", str(folder / "project")]) == 0
    for name in ("tower-body.json", "ring.json"):
        (folder / "frozen").mkdir(exist_ok=True)
        (folder / "frozen" / name).write_bytes(PRECIOUS)
    assert main(["cases", "generate", "ring", "--count", "2", "--output", str(folder / "cases.json")]) == 0
    assert main(["cases", "generate", "tower-body", "--output", str(folder / "frozen" / "tower-body.json")]) == 0
    shutil.copytree(run, folder / "simulated")
    (folder / "reports/engines/README.md").write_bytes(PRECIOUS)
    for name in ("precious", "kernel.c", "derivation.tex", "record.jsonl", "report.html", "answers.csv"):
        (folder / name).write_bytes(PRECIOUS)


@pytest.fixture
def files(tmp_path, tmp_path_factory, monkeypatch):
    """The folder of such a user, in which the command runs."""
    folder = tmp_path / "work"
    shutil.copytree(made_once(tmp_path_factory, "refused", _make), folder)
    monkeypatch.chdir(folder)
    return folder


def contents(folder: Path) -> dict[str, bytes | None]:
    """Every path below the folder; of a file, its bytes."""
    every = (Path(place, name) for place, folders, names in os.walk(folder) for name in (*folders, *names))
    return {str(each.relative_to(folder)): each.read_bytes() if each.is_file() else None for each in every}


@pytest.mark.parametrize(("words", "code"), REFUSED, ids=lambda each: " ".join(each) if isinstance(each, tuple) else "")
def test_a_refused_command_leaves_every_file_as_it_was(files, capsys, words, code):
    before = contents(files)
    ended = main(list(words))
    said = capsys.readouterr().err
    assert ended == code, said
    assert contents(files) == before
    assert "Traceback" not in said


INTERRUPTED = [
    ("verify", SILENT),
    ("verify", "--self"),
    ("bench", SILENT),
    ("hunt", SILENT, "--out", "cases.json"),
    ("simulate", "tower", "--table", "5", "--runs", "900000", "--out", "simulated"),
    ("derive", "--format", "erratum", "--output", "derivation.tex"),
    ("cases", "generate", "ring", "--count", "1000000", "--output", "cases.json"),
    ("cases", "freeze", "worst-cancellation", "--into", "frozen"),
]


def wait_for_numpy(process):
    """Wait until a command has begun to work, which all of these do with numpy."""
    until = time.monotonic() + 60
    while "/numpy/" not in Path(f"/proc/{process.pid}/maps").read_text():
        assert process.poll() is None
        assert time.monotonic() < until
        time.sleep(0.02)
    time.sleep(0.3)
    return ""


@pytest.mark.skipif(not Path("/proc/self/maps").exists(), reason="the system does not tell what a process has loaded")
@pytest.mark.parametrize("words", INTERRUPTED, ids=" ".join)
def test_a_command_that_is_interrupted_before_its_first_result_leaves_every_file_as_it_was(files, words):
    before = contents(files)
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[2])}
    process = subprocess.Popen(
        [*COMMAND, *words],
        env=environment, cwd=files, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    try:
        said = process.stderr.readline() if words[0] in {"verify", "bench"} else wait_for_numpy(process)
        process.send_signal(signal.SIGINT)
        said += process.communicate(timeout=60)[1]
    finally:
        process.kill()
    assert process.returncode == 130, said
    assert contents(files) == before
