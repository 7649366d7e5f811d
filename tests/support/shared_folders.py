"""Folders that one process of the tests makes, and that all of them read."""

from __future__ import annotations

import fcntl
import os


def made_once(tmp_path_factory, name, make):
    """A folder that `make(folder)` fills once in a run of the tests, whatever number of processes run them."""
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / name
    folder.mkdir(exist_ok=True)
    with (folder.parent / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder.parent / f"{name}.made").exists():
            make(folder)
            (folder.parent / f"{name}.made").touch()
    return folder
