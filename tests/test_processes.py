"""Processes of our own start whole or not at all, whatever interrupts their parent meanwhile."""

from __future__ import annotations

import subprocess
import sys

import pytest

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


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_a_parent_that_is_interrupted_has_told_its_processes_what_they_are(name):
    command = [sys.executable, "-c", STARTS.format(name=name)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (130, "")
