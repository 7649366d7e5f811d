"""Public functions answer the same, and rightly, whatever the rounding mode and the treatment of subnormals is."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys

import pytest

from tests.support.inside import choice

pytestmark = pytest.mark.skipif(
    platform.machine() != "x86_64" or platform.libc_ver()[0] != "glibc",
    reason="the test sets MXCSR of x86-64 in the fenv_t of glibc",
)

DOWNWARD_FLUSHED, UPWARD_FLUSHED = 3, 5
EVERY = range(10)
"""The numbers of all settings."""


@pytest.mark.parametrize(
    ("kernel", "first", "others"),
    [
        ("compiled", DOWNWARD_FLUSHED, (0, 8)),
        pytest.param("numpy", UPWARD_FLUSHED, (9,), marks=pytest.mark.thorough),
        pytest.param("compiled", DOWNWARD_FLUSHED, EVERY, marks=pytest.mark.thorough),
        pytest.param("numpy", UPWARD_FLUSHED, EVERY, marks=pytest.mark.thorough),
    ],
)
def test_public_functions_are_right_in_every_float_environment_and_do_not_change_it(kernel, first, others):
    """`first` is the setting under which hypcheck is loaded, so that its constants are computed under it."""
    if kernel == "compiled" and choice().kernel != "compiled":
        pytest.skip(choice().reason)
    run = subprocess.run(
        [sys.executable, "-m", "tests.kernel.environment_calls", *map(str, (first, *others))],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "HYPCHECK_KERNEL": kernel},
        timeout=600,
    )
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout)
    assert found["trouble"] == []
    assert found["calls"] > 150
    assert found["truths"] > 30
