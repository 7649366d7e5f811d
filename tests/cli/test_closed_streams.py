"""Standard streams that are closed before the program starts."""

from __future__ import annotations

import os
import subprocess
import sys

TELLS = """
import os
from hypcheck.cli import main
main.main = lambda: os.write(7, str(os.fstat(2).st_rdev).encode())
main.process()
"""


def test_a_closed_standard_stream_is_opened_on_the_null_device_at_the_start():
    read, write = os.pipe()

    def begin():
        os.dup2(write, 7)
        os.closerange(0, 3)

    with subprocess.Popen([sys.executable, "-c", TELLS], pass_fds=[7], preexec_fn=begin), os.fdopen(read) as told:  # noqa: PLW1509
        os.close(write)
        assert told.read() == str(os.stat(os.devnull).st_rdev)
