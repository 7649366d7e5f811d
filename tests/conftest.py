"""Settings that every test shares."""

from __future__ import annotations

import gc
import os
import signal

import pytest
from hypothesis import HealthCheck, settings

from tests.undrawn import draw_nothing

# In CI the examples are the same in every run, so that a red build means the change and not the dice.
settings.register_profile("ci", derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("developer", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("ci" if os.environ.get("CI") else "developer")

# A shell's background job ignores Ctrl-C, and under nohup a closed terminal too; what is tested here is not that.
for number, handler in ((signal.SIGINT, signal.default_int_handler), (signal.SIGHUP, signal.SIG_DFL)):
    if signal.getsignal(number) is signal.SIG_IGN:
        signal.signal(number, handler)

# A worker holds all test modules, sympy and matplotlib. To look through them again and again for garbage would take a
# fifth of its time: they are kept out of it, and the collector runs rarely.
gc.disable()


def pytest_collection_finish():
    """What is loaded stays loaded."""
    gc.freeze()
    gc.set_threshold(50_000, 20, 20)
    gc.enable()


@pytest.fixture
def text_reports(monkeypatch):
    """Runs of the test write their reports in text alone."""
    draw_nothing(monkeypatch)
