"""A long check runs where something that it reads has changed, and only there; what it reads is known."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from hypcheck.proofs import build
from tests.kernel.compiling import needs_compiler
from tests.tools.checked import CHECKS, ROOT, files
from tests.tools.processors import jobs

TOOL = "tests/tools/checked.py"
READS = """
import os, sys
opened = set()
def note(event, arguments):
    if event == "open" and isinstance(arguments[0], (str, os.PathLike)):
        opened.add(os.path.abspath(arguments[0]))
sys.addaudithook(note)
from pathlib import Path
{program}
opened |= {{module.__file__ for module in list(sys.modules.values()) if getattr(module, "__file__", None)}}
print(*sorted(path for path in opened if Path(path).is_file()), sep="\\n")
"""
"""Prints the files that a program reads, the sources of its modules among them."""

SAYS_NOTHING_OF_PROOFS = [f"hypcheck/{name}.py" for name in ("__init__", "float_environment", "messages", "version")]
"""What every module of hypcheck loads before it begins, and the words of errors."""


def read_by(program):
    """The files of the repository that a program of Python reads, as git names them; not what is built or cached."""
    done = subprocess.run(
        [sys.executable, "-c", READS.format(program=program)], cwd=ROOT, capture_output=True, text=True, check=True
    )
    names = [os.path.relpath(path, ROOT) for path in done.stdout.splitlines()]
    other = re.compile(r"\.\.|\.venv/|build/|.*__pycache__/|.*\.so$")
    return {name for name in names if not other.match(name)}


@pytest.fixture
def repository(tmp_path):
    """A repository with the tool and with proofs that end with the code of the file `code`."""
    (tmp_path / TOOL).parent.mkdir(parents=True)
    (tmp_path / ".ci").mkdir()
    (tmp_path / "hypcheck/proofs").mkdir(parents=True)
    (tmp_path / "hypcheck/__init__.py").touch()  # else the package that is installed would be run
    shutil.copy(ROOT / TOOL, tmp_path / TOOL)
    program = "import sys; print('proving'); sys.exit(int(open('code').read()))\n"
    (tmp_path / "hypcheck/proofs/__main__.py").write_text(program, encoding="utf-8")
    (tmp_path / "code").write_text("0", encoding="utf-8")
    git = shutil.which("git") or "git"
    subprocess.run([git, "init", "--quiet"], cwd=tmp_path, check=True)
    subprocess.run([git, "add", "."], cwd=tmp_path, check=True)
    return tmp_path


def check(repository, *words):
    """The exit code and the output of the tool."""
    command = [sys.executable, TOOL, "proofs", *words]
    done = subprocess.run(command, cwd=repository, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout


def test_check_that_passed_runs_again_only_after_a_change_or_on_demand(repository):
    assert check(repository, "--list") == (1, "proofs: to be checked\n")
    code, output = check(repository)
    assert (code, output.splitlines()[0]) == (0, "proving")
    unchanged = re.compile(r"proofs: unchanged since they were checked \(digest [0-9a-f]{16}\)\n")
    assert [(code, bool(unchanged.fullmatch(output))) for code, output in [check(repository)]] == [(0, True)]
    assert check(repository, "--list")[0] == 0
    assert "proving" in check(repository, "--again")[1]
    (repository / "hypcheck/proofs/__main__.py").write_text("print('other proofs')\n", encoding="utf-8")
    assert check(repository, "--list")[0] == 1
    assert "other proofs" in check(repository)[1]


def test_check_that_failed_runs_again_and_ends_with_its_code(repository):
    (repository / "code").write_text("3", encoding="utf-8")
    assert [check(repository) for _ in range(2)] == [(3, "proving\n")] * 2


def test_digest_of_the_proofs_has_every_file_that_proving_reads(tmp_path):
    """All that is read before, between and after the calls of Coq, which itself reads the build folder alone."""
    program = f"""
from hypcheck.proofs import __main__, build, printed_c, weakenings
into = Path({str(tmp_path)!r})
for name in build.FILES:
    into.joinpath(name + ".v").write_text(build.source(name))
printed_c.changes(2, seed=45)
weakenings.made(build.source), weakenings.reasons(), build.weakened()
opened |= set(build.frozen_files())
"""
    read = read_by(program)
    assert {"hypcheck/proofs/weakened.toml", "hypcheck/proofs/header/Stages.v", "cases/ring.json"} <= read
    known = set(files(CHECKS["proofs"].sources))
    assert {name for name in read - known if name not in SAYS_NOTHING_OF_PROOFS} == set()
    assert {f"hypcheck/proofs/{path.name}" for path in build.SOURCES.glob("*.ml")} <= known


@needs_compiler
def test_digest_of_the_processors_covers_every_file_that_their_programs_compile_or_read():
    folder = ROOT / "tests/tools/processors"
    command = ["cc", "-MM", f"-I{ROOT / 'hypcheck/kernel/core'}", f"-I{folder}", str(folder / "program.c")]
    made = subprocess.run(command, capture_output=True, text=True, check=True).stdout.replace("\\\n", " ").split()[1:]
    compiled = {Path(name).resolve().relative_to(ROOT).as_posix() for name in made}
    some = ("ring", "tilted-uniform", "way-still", "ended-rim", "invalid", "way-invalid", "ended-invalid")
    read = read_by(f"from tests.tools.processors import jobs; list(jobs.frozen({some}))")
    assert {name for name in read if "cases/" in name} >= {f"cases/{name}.json" for name in some}
    frozen = {name for name in read if "cases/" in name} | {f"cases/{name}.json" for name in jobs.FROZEN}
    assert "hypcheck/kernel/core/hypcheck.h" in compiled
    assert "cases/ring.json" in frozen
    assert compiled | frozen <= set(files(CHECKS["processors"].sources))
