"""Processes of our own start whole or not at all, whatever interrupts their parent, and none outlives it."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path

import pytest

from hypcheck.processes import interrupts_deferred
from tests.tools.miniatures import all_gone, needs_proc, token  # noqa: F401

STARTS = """
import signal, sys, threading, time
from multiprocessing import util
from hypcheck.processes import fresh, perform

spawn, sent = util.spawnv_passfds, []

def interrupted(path, args, passed):
    process = spawn(path, args, passed)
    if "resource_tracker" not in args[-1] and not sent:  # a process that waits for what it is to do
        sent.append(signal.pthread_kill(other.ident, signal.{name}))  # to a thread that holds nothing, as a system may
        time.sleep(0.2)
    return process

ends = threading.Event()
other = threading.Thread(target=ends.wait, daemon=True)
other.start()
signal.signal(signal.SIGTERM, signal.default_int_handler)
util.spawnv_passfds = interrupted
try:
    with fresh(2) as executor:
        list(perform(abs, range(5), executor))
except KeyboardInterrupt:
    sys.exit(130)
sys.exit("not interrupted")
"""


def test_signals_are_not_deferred_in_a_thread_other_than_the_main_one():
    def work():
        with interrupts_deferred():
            seen.append(signal.getsignal(signal.SIGINT))

    seen = [signal.getsignal(signal.SIGINT)]
    with interrupts_deferred():
        deferring = signal.getsignal(signal.SIGINT)
    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen[0] is seen[1]
    assert deferring is not seen[0]


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_an_interrupted_run_ends_its_worker_processes_without_tracebacks(name):
    command = [sys.executable, "-c", STARTS.format(name=name)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (130, "")


BUSY = """
import sys, time
from hypcheck.processes import fresh, one_each
if __name__ == "__main__":
    with fresh(2) as executor:
        executor.submit(abs, 1).result()  # the others wait for what they are to do
        {more}
        print("begun", flush=True)
        time.sleep(60)
"""


@needs_proc
@pytest.mark.parametrize("more", ["executor.submit(time.sleep, 60)", "next(one_each(time.sleep, [0, 60], 2))"])
def test_no_worker_process_outlives_a_run_that_is_killed(more, tmp_path, token):  # noqa: F811
    file = tmp_path / "busy.py"
    file.write_text(BUSY.format(more=more))
    with (tmp_path / "said").open("wb") as said:
        parent = subprocess.Popen([sys.executable, file], stdout=subprocess.PIPE, stderr=said)
    with parent:
        assert parent.stdout is not None
        assert parent.stdout.readline() == b"begun\n"
        parent.kill()
    assert all_gone(token) == []
    assert (tmp_path / "said").read_bytes() == b""


LEFT = """
import os, sys
from multiprocessing import get_context
from hypcheck.processes import interrupts_held
with interrupts_held():
    held = get_context("spawn").Lock()
os._exit(0)
"""


def test_shared_resources_of_a_killed_process_are_removed_without_warnings():
    done = subprocess.run([sys.executable, "-c", LEFT], capture_output=True, timeout=60, check=True)
    assert done.stderr == b""


CLOSED = """
import os, signal, time
from multiprocessing import get_context
from hypcheck.processes import interrupts_held
signal.signal(signal.SIGHUP, lambda *_: None)
with interrupts_held():
    held = get_context("spawn").Lock()
time.sleep(0.5)  # the process that looks after it has begun
os.killpg(0, signal.SIGHUP)
time.sleep(0.2)
del held
"""


def test_a_closed_terminal_does_not_end_the_resource_tracker():
    """It gets the signal as all of us do, and would be begun again, knowing nothing."""
    command = [sys.executable, "-c", CLOSED]
    done = subprocess.run(command, capture_output=True, timeout=60, check=True, start_new_session=True)
    assert done.stderr == b""


STANDARD = ("multiprocessing", "types", "socket", "random", "json")
"""Modules that Python's own processes load when they begin, or that many people name a file after."""

SUBJECT = """
import helper
import numpy as np


def f(rows):
    return np.full(len(rows), helper.ANSWER, dtype=np.int8)
"""


def folder_with_namesakes(folder: Path, names: Iterable[str]) -> None:
    """Files that say so when they are executed, and end the process that does."""
    for name in names:
        (folder / f"{name}.py").write_text(f"open('executed-{name}', 'w').close()\nraise SystemExit('{name}')\n")


def ended_in(folder: Path, *words: str, path: Path | None = None) -> subprocess.CompletedProcess[str]:
    """A command that ran in a folder whose files of standard names nobody executed."""
    environment = {**os.environ, "PYTHONPATH": str(path)} if path else None
    done = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True, timeout=120, check=False)
    assert sorted(path.name for path in folder.glob("executed-*")) == [], done.stderr
    return done


@pytest.mark.thorough
@pytest.mark.parametrize("shared", ["--workers=2", "--cluster=local:1"])
def test_workers_do_not_execute_files_in_the_working_directory_named_like_standard_modules(shared, tmp_path_factory):
    """A module that the SPEC names is found there all the same. Reports are written without drawing."""
    tmp_path, undrawn = tmp_path_factory.mktemp("here"), tmp_path_factory.mktemp("undrawn")
    (undrawn / "sitecustomize.py").write_text("import sys\nsys.modules['matplotlib'] = None\n")
    if "cluster" in shared and not find_spec("distributed"):
        pytest.skip("distributed is not installed")
    script = shutil.which("hypcheck", path=os.path.dirname(sys.executable))
    assert script, "the tests need the command that the installation makes"
    folder_with_namesakes(tmp_path, STANDARD)
    (tmp_path / "subject.py").write_text(SUBJECT)
    (tmp_path / "helper.py").write_text("ANSWER = 1\n")  # which is right everywhere in the ring
    done = ended_in(
        tmp_path,
        script,
        "verify",
        "python:subject:f",
        "--families=ring",
        "--count=10",
        "--out=out",
        shared,
        path=undrawn,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("HELD: subject:f: "), done.stdout


def test_python_m_hypcheck_does_not_execute_files_in_the_working_directory_named_like_standard_modules(tmp_path):
    """But for types, which Python itself loads from there before any file of ours."""
    folder_with_namesakes(tmp_path, set(STANDARD) - {"types"})
    assert ended_in(tmp_path, sys.executable, "-m", "hypcheck", "info", "--json").returncode == 0
