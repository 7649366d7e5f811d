"""Limits of the system are reported in one sentence with exit code 2, not blamed on the implementation under test."""

from __future__ import annotations

import errno
import os
import subprocess
import sys

import pytest

from hypcheck import processes
from hypcheck.cli.main import main
from hypcheck.errors import InputError, SystemLimitError, limit_reached
from hypcheck.implementations.implementation import open_implementation
from tests.tools.miniatures import NOT_ISOLATED, command, function, rows, truth

LIMITED = """
import resource, sys
resource.setrlimit(resource.RLIMIT_NOFILE, (8, 8))
from hypcheck.cli.main import process
process()
"""


@pytest.mark.thorough
@pytest.mark.skipif(sys.platform == "win32", reason="there are no such limits")
@pytest.mark.parametrize("workers", ["1", "2"])
def test_verify_reports_too_few_open_files_as_a_system_limit(workers, tmp_path):
    words = ["verify", function("right"), "--families=ring", "--count=10", f"--workers={workers}", f"--out={tmp_path}"]
    done = subprocess.run([sys.executable, "-c", LIMITED, *words], capture_output=True, text=True, check=False)
    assert done.stderr.splitlines()[-1] == (
        "hypcheck: error: a limit of the system is reached: too many open files; see `ulimit -a`"
    )
    assert done.returncode == 2


@pytest.mark.parametrize("reason", [errno.EROFS, errno.ENOENT, errno.EACCES])
def test_simulate_reports_missing_semaphores_with_shared_memory_as_the_reason(reason, monkeypatch, capsys):
    class Context:
        def Lock(self):
            raise OSError(reason, os.strerror(reason))

    monkeypatch.setattr(processes, "get_context", lambda _: Context())
    assert main(["simulate", "tower", "--table", "5", "--runs", "1", "--workers", "2"]) == 2
    assert capsys.readouterr().err == (
        "hypcheck: error: no process can be given work: the system makes no semaphore (on Linux in /dev/shm): "
        f"{os.strerror(reason).lower()}\n"
    )


def test_an_implementation_can_be_called_without_a_null_device(monkeypatch):
    monkeypatch.setattr(os, "devnull", "/missing/null")
    some = rows(lucky=True)
    with open_implementation(command("right"), NOT_ISOLATED) as it:  # isolated, the launcher does what the guard does
        assert it.classify(some).answers.tolist() == truth(some).tolist()
        assert it._supervisor.session()._process._guard is not None


WITHOUT_NULL = """
import os, sys
os.devnull = "/missing/null"
from hypcheck.cli.main import process
process()
"""


def test_a_missing_null_device_ends_2_only_if_a_standard_stream_is_closed():
    words = [sys.executable, "-c", WITHOUT_NULL, "--version"]
    assert subprocess.run(words, capture_output=True, check=False).returncode == 0
    done = subprocess.run(["sh", "-c", 'exec "$@" <&-', "sh", *words], capture_output=True, text=True, check=False)  # noqa: S607
    assert done.stderr == (
        "hypcheck: error: cannot open /missing/null for a closed standard stream: no such file or directory\n"
    )
    assert done.returncode == 2


def test_only_errors_about_limits_become_system_limit_errors():
    assert isinstance(limit_reached(OSError(errno.EMFILE, "Too many open files")), SystemLimitError)
    assert limit_reached(PermissionError(errno.EACCES, "Permission denied")) is None
    assert limit_reached(InputError("")) is None
