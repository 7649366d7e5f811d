"""The part `faults`: every call to the system that changes the folder of a run fails once, in several ways."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.tools.evidence.parts import ROOT, Figures, Unavailable

TITLE = "Faults of the disk"

DISK = Path(__file__).with_name("faulty_disk.c")

CALLS = {
    "m": "mkdir",
    "u": "unlink",
    "o": "open",
    "w": "write",
    "s": "fsync",
    "r": "rename",
    "c": "close",
    "p": "chmod",
}
"""The letters that faulty_disk.c gives to calls."""


def measure(*numbers: int) -> Figures:
    """What runs come to whose n-th call fails, for the given n or for all."""
    compiler = shutil.which("cc")
    if compiler is None or sys.platform != "linux":
        raise Unavailable("a disk that fails needs Linux and a C compiler named cc")
    with tempfile.TemporaryDirectory() as folder:
        disk = Path(folder) / "faulty_disk.so"
        subprocess.run([compiler, "-shared", "-fPIC", "-O1", "-o", disk, DISK, "-ldl"], check=True)
        command = [sys.executable, "-m", "tests.tools.evidence.faulty_runs", folder, *map(str, numbers)]
        seen = os.environ | {"LD_PRELOAD": str(disk)}
        done = subprocess.run(command, cwd=ROOT, env=seen, stdout=subprocess.PIPE, text=True, check=True)
    found = json.loads(done.stdout.splitlines()[-1])
    calls = found.pop("calls")
    return {
        "calls": {name: calls.count(letter) for letter, name in CALLS.items() if letter in calls},
        "wrong": len(found["findings"]),
        **found,
    }


def section(figures: Figures) -> str:
    """The text about faults."""
    calls = figures["calls"]
    kinds = ", ".join(f"{count} {name}" for name, count in calls.items())
    text = f"""\
A small run of `hypcheck verify`, which writes its progress at every step, makes {sum(calls.values())} calls to the
system that change its folder: {kinds}. For each n the run was repeated with a fault in its n-th
call: only that call fails, with "no space left" or a disk error; the disk is full from then on, after half of the data
was written; the disk fails from then on; the process is killed in that call; or a write takes only half of the data,
which is not an error. Half of the runs began in the folder of an earlier run.

There were {figures["cases"]} such runs, and {figures["wrong"]} of them broke a rule. The rules are: exit code 2, one
sentence with the reason and the file, no traceback; the record is readable except for a last line that is cut off; the
earlier record exists until the new one is complete; and the same command, with `--resume` if something was kept, then
gives the result of an uninterrupted run, byte for byte except for times.
"""
    found = [f"- {each['fault']} at call {each['number']}: {each['said']}" for each in figures["findings"]]
    return "\n".join([text, *found])
