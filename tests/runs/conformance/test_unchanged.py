"""An implementation that overwrites the judge, or itself, during a run fails the run."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import hypcheck
from hypcheck.cli.main import main
from hypcheck.record import read
from hypcheck.record.lines import DriftLine
from hypcheck.record.reader import FILE
from hypcheck.runs.fingerprint import code_fingerprint

REACHES_US = ("--isolate", "off")
"""Isolated, none of these implementations could write over a file, or call hypcheck."""

SUBJECT = """
from pathlib import Path
from hypcheck import classify as right

def attacks(rows):
    {attack}
    return right(rows)
"""


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """A folder with a package of its own, which may be written over."""
    site = tmp_path_factory.mktemp("site")
    package = Path(hypcheck.__file__).parent
    shutil.copytree(package, site / "hypcheck")
    shutil.copytree(package.parent / "cases", site / "cases")
    return site


def gated(site, folder, attack, *options):
    """The run that gates who attacks: its code, what it said, and its folder."""
    folder.mkdir()
    (folder / "subject.py").write_text(SUBJECT.format(attack=attack), encoding="utf-8")
    words = ["verify", "python:subject.py:attacks", "--families", "tower-body", "--count", "20", *REACHES_US, *options]
    code = (
        "import sys; sys.modules['matplotlib'] = sys.modules['jinja2'] = None\n"
        "from hypcheck.cli.main import main\n"
        "if __name__ == '__main__':\n    code = main(sys.argv[1:]); print('ended with', code)\n"
    )
    (folder / "run.py").write_text(code, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "run.py", *words, "--out", "out"],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(site), "PYTHONDONTWRITEBYTECODE": ""},
        capture_output=True,
        text=True,
        check=False,
    )
    return done.stdout + done.stderr


@pytest.mark.parametrize("options", [(), ("--workers", "2")], ids=["alone", "two-workers"])
def test_implementation_that_overwrites_the_judge_fails_and_the_file_is_named(installed, tmp_path, options):
    site = tmp_path / "site"
    shutil.copytree(installed, site)
    verdict, lines = (site / "hypcheck" / part for part in ("report/verdict.py", "runs/consistency.py"))
    attack = f"[Path(each).write_text('raise SystemExit(0)') for each in ({str(verdict)!r}, {str(lines)!r})]"
    said = gated(site, tmp_path / "run", attack, *options)
    if "ended with 70" in said and options:  # the second worker was begun behind the attack
        assert "hypcheck's own files were changed while an implementation was asked" in said
        return
    assert "ended with 1" in said
    assert f"hypcheck's own file {verdict} was changed while an implementation was asked" in said
    record = read(tmp_path / "run" / "out" / FILE)
    assert record.footer.exit_code == 1
    assert [line.sentence.split()[3] for line in record.of(DriftLine)] == [str(verdict), str(lines)]
    assert json.loads((tmp_path / "run" / "out" / "summary.json").read_text())["passed"] is False


def test_implementation_that_overwrites_compiled_python_of_hypcheck_fails(installed, tmp_path):
    site = tmp_path / "site"
    shutil.copytree(installed, site)
    source = site / "hypcheck" / "runs" / "judge.py"
    attack = (
        f"import importlib.util; p = Path(importlib.util.cache_from_source({str(source)!r}));"
        " head = p.read_bytes(); p.write_bytes(head[:-1] + bytes([head[-1] ^ 1]))"
    )
    said = gated(site, tmp_path / "run", attack)
    assert "ended with 1" in said
    assert ".pyc was changed while an implementation was asked" in said


def test_implementation_that_overwrites_itself_fails(installed, tmp_path):
    said = gated(installed, tmp_path / "run", "Path('subject.py').write_text('def attacks(rows): return right(rows)')")
    assert "ended with 1" in said
    assert "subject.py, which is under test, was changed while it was asked" in said


def test_unchanged_run_passes_and_its_header_has_the_fingerprint(installed, tmp_path):
    said = gated(installed, tmp_path / "run", "pass")
    assert "ended with 0" in said
    program = read(tmp_path / "run" / "out" / FILE).header.program
    assert program == code_fingerprint()  # the copy is that of the tree


LATE = """
import sys
{before}
from hypcheck.implementations import worker_session

begun, before = worker_session.WorkerSession.__init__, []

def begins(*arguments):
    before.append(set(sys.modules))
    begun(*arguments)

worker_session.WorkerSession.__init__ = begins
from hypcheck.cli.main import main

print("code", main(sys.argv[1:]))
print("late", sorted(name for name in set(sys.modules) - before[0] if name.split(".")[0] == "hypcheck"))
"""


@pytest.mark.parametrize(
    ("name", "before"),
    [("too_clear", ""), ("dies_on_the_axis", "sys.modules.update(matplotlib=None, jinja2=None)")],
)
def test_hypcheck_imports_no_module_of_its_own_after_foreign_code_has_started(tmp_path, name, before):
    words = ["verify", f"python:tests.runs.faulty:{name}", "--families", "axis,ring", "--count", "9", "--restarts", "2"]
    done = subprocess.run(
        [sys.executable, "-c", LATE.format(before=before), *words, "--out", str(tmp_path / "out")],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stdout.splitlines()[-2:] == ["code 1", "late []"]


def test_known_failures_that_change_during_a_run_fail_it_and_are_not_updated(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("known.toml").write_text("")
    Path("subject.py").write_text(
        "import hypcheck\n"
        "def f(rows):\n"
        "    open('known.toml', 'w').write('# nothing\\n')\n"
        "    return hypcheck.classify(rows)\n"
    )
    words = ["verify", "python:subject.py:f", "--count", "0", "--known-failures", "known.toml", "--update", *REACHES_US]
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.setitem(sys.modules, "jinja2", None)
    assert main([*words, "--out", "out"]) == 1
    assert "known.toml, which is under test, was changed while it was asked" in capsys.readouterr().out
    assert Path("known.toml").read_text() == "# nothing\n"
