"""Standard streams that are closed before the program starts."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest


@pytest.mark.slow
def test_an_error_with_standard_error_closed_is_not_written_to_standard_output():
    words = [sys.executable, "-m", "hypcheck", "classify", "--input", "no-such-file.csv", "--output", "-"]
    done = subprocess.run(words, stdout=subprocess.PIPE, preexec_fn=lambda: os.close(2), check=False)
    assert (done.returncode, done.stdout) == (2, b"")


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
