"""Settings that every test shares."""

from __future__ import annotations

import gc
import os
import resource
import signal
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests.support.without_drawing import draw_nothing

# In CI the examples are the same in every run, so that a red build means the change and not the dice. They are a fifth
# there: what others than these would find is found where they are drawn anew, before a commit.
settings.register_profile(
    "ci", max_examples=20, derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("developer", deadline=None, suppress_health_check=[HealthCheck.too_slow])
IN_CI = bool(os.environ.get("CI"))
settings.load_profile("ci" if IN_CI else "developer")

# A shell's background job ignores Ctrl-C, and under nohup a closed terminal too; what is tested here is not that.
for number, handler in ((signal.SIGINT, signal.default_int_handler), (signal.SIGHUP, signal.SIG_DFL)):
    if signal.getsignal(number) is signal.SIG_IGN:
        signal.signal(number, handler)

os.environ.pop("CI", None)  # with it set, verify asks fresh rows too, as many in each run as others of a seed

# Else numpy starts a thread for each processor in each of a thousand processes, of which none multiplies matrices: that
# takes a tenth of the time of all tests.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# A worker holds all test modules, sympy and matplotlib. To look through them again and again for garbage would take a
# fifth of its time: they are kept out of it, and the collector runs rarely.
gc.disable()

SLOW = {
    "": "action corpus environment page_commands processes properties transcripts wheel",
    "bench": "c_library claims foreign kernel_targets run scenes",
    "cli": "completion detach exits pytest_plugin refused settings startup",
    "derivation": "chains formulas proofs repaired_formulas rounding",
    "engines": "adapters cli findings placing scene",
    "isolation": "advice isolation",
    "implementations": "commands fcl_naive functions libraries processes",
    "kernel": "float_environment header languages parallel_lines sanitizers",
    "kernel/emission": "arithmetic conformance extremes foreign_text kernels limits prefix scenes text",
    "paper": "ledger_cli ledger_formats ledger_tilted ledger_procedures ledger_search ledger_verdicts motion "
    "simulate_cli tower witnesses",
    "record": "integrity",
    "report": "browser cli_report github goldens hostile junit markdown page plots reference_bench scene_map "
    "simulation_pictures svg write",
    "runs": "self_check self_check_interrupted",
    "runs/cluster": "cluster cluster_interrupted cluster_refused cluster_versions local_cluster",
    "runs/conformance": "conformance conformance_reports extremes fresh not_asked retest schedule unchanged workers",
    "runs/hunt": "hunt_cli minimise search",
    "runs/replay": "replay",
    "runs/resume": "consistency interrupted resume resume_refused",
    "scaffold": "adapters requirement shared",
    "tables": "blocks processes tables",
    "tools/attack": "attack",
    "tools/evidence": "faults",
    "tools/fuzz": "fuzz",
    "tools/hostile": "hostile",
    "tools/mutants": "mutants",
    "tools/soak": "soak",
    "truth": "float_boxes mesh swept nearest nearest_bounds roots_table",
    "vectors": "razor",
    "vectors/frozen": "cases_cli files labels metadata reading",
}
"""Modules, by folder, that take two seconds of a processor or more, or wait for much: `make check` leaves them out."""

THOROUGH = {
    "bench": "c_library claims foreign kernel_targets scenes tilted",
    "cli": "completion detach pytest_plugin",
    "derivation": "repaired_formulas rounding",
    "implementations": "fcl_naive",
    "kernel": "header parallel_lines sanitizers scene_tilted tilted_integers tilted_sanitizers",
    "kernel/emission": "conformance extremes foreign_text kernels tilted limits prefix scenes text",
    "proofs": "proofs",
    "paper": "erratum flights forest ledger_cli ledger_search motion pitch simulate_cli tower",
    "report": "browser github hostile junit plots reference_bench scene_map simulation_pictures svg",
    "runs": "self_check_interrupted",
    "runs/cluster": "cluster cluster_interrupted cluster_refused cluster_versions local_cluster",
    "runs/conformance": "conformance_reports extremes unchanged workers",
    "runs/hunt": "minimise search",
    "runs/resume": "consistency resume",
    "scaffold": "adapters passages",
    "tables": "processes",
    "tools/attack": "attack",
    "tools/evidence": "faults",
    "tools/evidence/battery": "battery",
    "tools/evidence/fuzzing": "replay",
    "tools/fuzz": "fuzz",
    "tools/soak": "soak",
    "truth": "float_boxes nearest nearest_bounds roots_table",
    "vectors": "razor",
    "vectors/frozen": "files tilted_files",
}
"""Modules, by folder, that repeat with many rows or processes what others test with few: `make thorough` runs them."""


@pytest.hookimpl(optionalhook=True)
def pytest_configure_node(node):
    """Tell a worker whether this is CI: the variable that says so is gone when it starts."""
    node.workerinput["in_ci"] = IN_CI


def pytest_configure(config):
    """Draw in a worker as it was told."""
    told = getattr(config, "workerinput", {})
    if "in_ci" in told:
        settings.load_profile("ci" if told["in_ci"] else "developer")


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers():
    """One more than there are processors: many tests wait for processes that they started."""
    return (os.cpu_count() or 1) + 1


def module_of(folder, name):
    """The file of a module that a table names."""
    return Path(__file__).parent / folder / f"test_{name}.py"


MODULES = {
    marker: frozenset(module_of(folder, name) for folder, names in table.items() for name in names.split())
    for marker, table in (("slow", SLOW), ("thorough", THOROUGH))
}
"""The files of slow and of thorough modules."""


def pytest_ignore_collect(collection_path, config):
    """Leave out, and do not import, the modules none of whose tests would run."""
    chosen = (config.option.markexpr or "").split(" and ")
    left_out = (modules for marker, modules in MODULES.items() if f"not {marker}" in chosen)
    return True if any(collection_path in modules for modules in left_out) else None


def pytest_collection_modifyitems(items):
    """Mark the tests of slow and of thorough modules."""
    for marker, modules in MODULES.items():
        for item in items:
            if item.path in modules:
                item.add_marker(marker)


def pytest_collection_finish():
    """What is loaded stays loaded."""
    gc.freeze()
    gc.set_threshold(50_000, 20, 20)
    gc.enable()


@pytest.fixture(scope="session", autouse=True)
def own_files_are_read_once():
    """Runs in this process take hypcheck's own files for unchanged: to read a thousand twice is a fifth of a small run.

    tests/runs/test_plan.py tests how they are read and compared, and processes that tests start read them.
    """
    from hypcheck.runs import fingerprint

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fingerprint, "_own_files", cache(fingerprint._own_files))
        yield


@pytest.fixture
def text_reports(monkeypatch):
    """Runs of the test write their reports in text alone, and ask 60 single rows again in place of 1,100.

    Either would take most of the time of a small run.
    """
    from hypcheck.runs import plan
    from hypcheck.runs.cases import Pace

    draw_nothing(monkeypatch)
    monkeypatch.setattr(plan, "ConformancePlan", partial(plan.ConformancePlan, pace=Pace(single_rows=60)))


@pytest.fixture
def built_in(monkeypatch):
    """The SPEC by which a function answers in this process: for tests of what a run makes of answers.

    Further values are those of its description.
    """
    from hypcheck.implementations import builtin
    from hypcheck.implementations.method import Method

    declares = {}

    class Session(builtin.BuiltinSession):
        def __init__(self, name):
            super().__init__(name)
            self.description = replace(self.description, **declares.get(name, {}))

    def spec(function, **declared):
        name = function.__name__
        timed = function if declared.get("times") else None
        monkeypatch.setitem(builtin.methods(), name, Method(name, "a function of a test", function, timed=timed))
        monkeypatch.setattr(builtin, "BuiltinSession", Session)
        declares[name] = {"version": "", "binary": False, "time": False, **declared}
        return f"builtin:{name}"

    return spec


FEW_FAMILIES = ("tower-body", "uniform", "ring", "axis", "extreme-float64", "tilted-uniform", "way-still")


@pytest.fixture
def few_families():
    """There are these families alone, and afterwards all in their order. To ask all families takes seconds."""
    from hypcheck.vectors.families import ALL

    everything = dict(ALL)
    for name in everything.keys() - set(FEW_FAMILIES):
        del ALL[name]
    yield
    ALL.clear()
    ALL.update(everything)


@pytest.fixture
def small_files():
    """Let files of this process grow to so many bytes only: writes fail as on a full disk. None: to any length."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)

    def limit(most):
        resource.setrlimit(resource.RLIMIT_FSIZE, before if most is None else (most, before[1]))

    yield limit
    limit(None)
