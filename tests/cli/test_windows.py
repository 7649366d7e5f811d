"""Without what POSIX alone has, commands that start no program work, and the others refuse in one sentence.

Windows is imitated: Python's own modules are loaded first, then its name of the system is changed, and modules,
functions and signals that Windows lacks are taken away.
"""

from __future__ import annotations

import subprocess
import sys

import pytest

WINDOWS = """
import concurrent.futures.process, multiprocessing.connection, multiprocessing.managers, multiprocessing.shared_memory
import multiprocessing.popen_spawn_posix, asyncio.subprocess, shutil, subprocess
import click, mpmath, numpy, os, signal, sympy, sys
for name in ("fcntl", "resource", "termios", "pwd", "grp"):
    sys.modules[name] = None
for place, names in (
    (os, ("fork", "getuid", "geteuid", "killpg", "setsid", "sched_getaffinity", "getloadavg", "sysconf", "fchmod")),
    (signal, ("SIGKILL", "SIGHUP", "SIGALRM", "SIGCHLD", "pthread_sigmask", "setitimer", "sigwait")),
):
    for name in names:
        if hasattr(place, name):
            delattr(place, name)
sys.platform = "win32"
from hypcheck.cli.main import process
process()
"""

PAIR = "--alpha 1 --gamma 2 --b 1 --d 1 --center 2.5 0 0"


def on_windows(folder, *words):
    return subprocess.run(
        [sys.executable, "-c", WINDOWS, *words], cwd=folder, capture_output=True, text=True, timeout=100, check=False
    )


@pytest.mark.parametrize("command", ["verify", "replay", "hunt", "minimise", "bench", "engines", "simulate"])
def test_windows_refuses_a_command_that_starts_programs_in_one_sentence_but_help_still_works(command, tmp_path):
    done = on_windows(tmp_path, command)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(
        f"hypcheck: error: 'hypcheck {command}' starts programs and watches them, which it can"
    )
    assert done.stderr.count("\n") == 1
    assert not [*tmp_path.iterdir()]
    assert on_windows(tmp_path, command, "--help").returncode == 0


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        (f"classify {PAIR}", "exterior"),
        (f"classify {PAIR} --axis 1 0 1 --json", '"exterior"'),
        ("plan tower", "Table 2 as printed"),
        ("emit --scene tower --language c", "hypcheck"),
        ("cases show ring-0001", "contact"),
        ("explain ring", "hypcheck replay"),
        ("derive --only costs", "Table 2"),
        ("info", "python"),
        ("init --language python", "predicate.py"),
    ],
)
def test_a_command_that_starts_no_program_works(words, wanted, tmp_path):
    done = on_windows(tmp_path, *words.split())
    assert (done.returncode, done.stderr) == (0, "")
    assert wanted in done.stdout
