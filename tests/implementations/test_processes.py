"""Processes of foreign implementations: alone in their group, and all ended, however they or hypcheck end."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
import zlib

import pytest

from hypcheck.errors import InputError
from hypcheck.implementations import memory
from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.process import ONE_THREAD, Process
from hypcheck.implementations.session import FaultError, Limits, Outcome, StartError
from tests.tools.miniatures import LIMITS, NOT_ISOLATED, all_gone, command, function, living, needs_proc, rows


@pytest.fixture(params=[LIMITS, NOT_ISOLATED], ids=["isolated", "not isolated"])
def run(request):
    """Starts a Python program, which is killed at the end of the test where it still lives."""
    started = []

    def start(code: str) -> Process:
        started.append(Process((sys.executable, "-c", code), request.param))
        return started[-1]

    yield start
    for process in started:
        process.kill()


def to_the_end(process: Process) -> None:
    """Listen until it has ended, which raises FaultError."""
    until = time.monotonic() + 10
    while time.monotonic() < until:
        process.pump(until)


def hear(process: Process, size: int) -> bytes:
    """That many bytes of its standard output."""
    until = time.monotonic() + 10
    while len(process.incoming) < size:
        process.pump(until)
        assert time.monotonic() < until
    return bytes(process.incoming)


def eventually(holds) -> None:
    """That it holds within 5 seconds."""
    until = time.monotonic() + 5
    while not holds():
        assert time.monotonic() < until
        time.sleep(0.01)


def test_a_process_has_a_session_of_its_own_and_an_environment_that_asks_for_one_thread(run):
    told = "'%9d %9d %9s' % (os.getsid(0), os.getpgrp(), os.environ['OMP_NUM_THREADS'])"
    process = run(f"import os, sys; print({told}, flush=True); sys.stdin.read()")
    session, group, threads = map(int, hear(process, 29).split())
    process.goodbye()
    assert session == group != os.getpgrp()
    assert threads == 1 == int(ONE_THREAD["OPENBLAS_NUM_THREADS"])


def test_writing_to_a_process_and_reading_from_it_do_not_block_each_other(run):
    """It echoes as it reads, 8 MB, far more than both pipes hold, and floods standard error meanwhile."""
    code = (
        "import os, sys\n"
        "while data := os.read(0, 1 << 16):\n"
        "    sys.stderr.write('x' * len(data)); sys.stdout.buffer.write(data); sys.stdout.flush()\n"
    )
    process = run(code)
    sent = bytes(range(256)) * (1 << 15)
    process.send((sent[:5], sent[5:]))
    assert process.sending
    assert hear(process, len(sent)) == sent
    assert not process.sending
    process.goodbye()


def test_a_small_question_reaches_a_process_in_one_read_and_a_large_one_complete(run):
    """Whoever reads its first line is awakened once, and finds the rows there too."""
    process = run(
        "import os, zlib; first = rest = os.read(0, 1 << 16); print(len(first), flush=True)\n"
        "while len(rest) < 2_000_010: rest += os.read(0, 1 << 16)\n"
        "print('%10d' % zlib.crc32(rest), flush=True)"
    )

    def slowly():
        for part in small:
            yield part
            time.sleep(0.3)

    small, large = (b"a line\n", b"abc"), (b"another", bytes(range(250)) * 4000, b"", b"7" * 999_993)
    process.send(slowly())
    assert hear(process, 3) == b"10\n"
    process.send(large)
    assert int(hear(process, 14)[3:]) == zlib.crc32(b"".join((*small, *large)))


def test_a_process_that_ends_at_the_end_of_its_input_is_not_killed(run):
    process = run("import sys; sys.stdin.read(); sys.stderr.write('by itself')")
    process.goodbye()
    assert process.stderr == ("by itself",)


@needs_proc
@pytest.mark.parametrize("name", ["ignores_goodbye", "detaches"])
def test_a_process_that_does_not_end_is_killed_with_its_children(name, token):
    with open_implementation(command(name), NOT_ISOLATED) as it:  # isolated, the launcher does this: tests/isolation
        it.classify(rows())
        eventually(lambda: len(living(token)) == 5)  # the command, its child, the guard with its clock
        start = time.monotonic()
    assert time.monotonic() - start < 3
    assert all_gone(token) == []


# An interrupt may fall between the opening of a file of /proc and its `with`: Python closes it then, with a warning.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_an_interrupt_of_hypcheck_during_a_question_leaves_no_process(token):
    """As an interrupt from the keyboard, which reaches us alone, since they are in another group."""
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    it = open_implementation(function("loops"), Limits())
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        it.classify(rows())
    timer.join()
    assert time.monotonic() - start < 5
    assert all_gone(token) == []
    with it:  # and whoever goes on gets the answers to the question then asked
        assert it.classify(rows(lucky=True)).answered.all()


STOPS = """
import os, signal, sys, time
from hypcheck.implementations import process
from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.session import Limits
from hypcheck.isolation.launch import Isolation

process.LOOK = 0.1
with open_implementation(sys.argv[1], Limits(isolation=Isolation("off"))) as it:  # isolated, it reaches no parent
    assert it.classify([[1, 13, 1, 1, 2, 0, 0]]).answered.all()
print("answered")
"""


def stopped_by_a_signal_that_tells(process: int) -> bool:
    """Whether the system tells which signal stopped a process, as the guard needs to know."""
    os.kill(process, signal.SIGSTOP)
    os.waitid(os.P_PID, process, os.WSTOPPED | os.WNOWAIT)
    with open(f"/proc/{process}/stat") as file:
        return file.read().split()[-1] == str(int(signal.SIGSTOP))


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells by which signal a process was stopped")
def test_an_implementation_that_stops_its_parent_does_not_hang_the_run(token):
    with subprocess.Popen([sys.executable, "-I", "-S", "-c", "import time; time.sleep(60)"]) as sleeper:
        told = stopped_by_a_signal_that_tells(sleeper.pid)
        sleeper.kill()
    if not told:
        pytest.skip("this kernel does not tell by which signal a process was stopped")
    words = [sys.executable, "-c", STOPS, command("stops_its_parent")]
    ours = subprocess.Popen(words, stdout=subprocess.PIPE)
    with ours:
        assert ours.communicate(timeout=30)[0] == b"answered\n"
    assert all_gone(token) == []


@needs_proc
@pytest.mark.parametrize("isolation", ["auto", pytest.param("off", marks=pytest.mark.thorough)])
def test_no_process_outlives_hypcheck_even_if_it_is_killed(isolation, token):
    """An endless loop does not see that its input ended, nor does a child: the guard does, or the launcher."""
    code = (
        "import sys\n"
        "from hypcheck.implementations.implementation import open_implementation\n"
        "from hypcheck.implementations.session import Limits\n"
        "from hypcheck.isolation.launch import Isolation\n"
        "def asked(spec):\n"
        f"    it = open_implementation(spec, Limits(isolation=Isolation({isolation!r})))\n"
        "    it.classify([[1, 2, 1, 1, 2, 0, 0]])\n"
        "    return it\n"
        "every = [asked(spec) for spec in sys.argv[1:]]\n"
        "print('asked', flush=True)\n"
        "every[-1].classify([[1, 13, 1, 1, 2, 0, 0]])\n"
        "sys.stdin.read()\n"
    )
    specs = [command(name) for name in ("ignores_goodbye", "detaches", "loops")]
    words = [sys.executable, "-c", code, *specs]
    ours = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    with ours:
        assert ours.stdout.readline() == b"asked\n"
        eventually(lambda: len(living(token)) >= 9)
        ours.kill()
    assert all_gone(token) == []


def test_the_memory_of_a_process_includes_its_children(run, monkeypatch):
    code = (
        "import subprocess, sys, time\n"
        "child = subprocess.Popen([sys.executable, '-c', "
        "'import time; x = bytearray(b\"1\") * (150 << 20); print(1, flush=True); time.sleep(60)'])\n"
        "time.sleep(60)\n"
    )
    process = run(code)
    hear(process, 1)
    watch = process._memory
    assert 150 << 20 < watch.used() < 250 << 20
    if shutil.which("ps"):
        monkeypatch.setattr(memory, "_all_processes", memory._by_ps)
        assert 150 << 20 < watch.used() < 250 << 20
    process.kill()
    eventually(lambda: watch.used() == 0)


HOLDS = "x = bytearray(b'1') * (150 << 20); os.write(1, b'1'); time.sleep(60)"


WITHOUT = f"subprocess.Popen([sys.executable, '-c', {'import os, time; ' + HOLDS!r}], env={{}}, start_new_session=True)"


@needs_proc
@pytest.mark.parametrize(
    "code",
    [
        f"import os, time\nif not os.fork():\n    os.setsid(); {HOLDS}\ntime.sleep(60)",
        f"import os, time\nif not os.fork():\n    os.setsid()\n    if not os.fork():\n        {HOLDS}\ntime.sleep(60)",
        f"import os, subprocess, sys, time\n{WITHOUT}\ntime.sleep(60)",
    ],
    ids=["its child", "an orphan", "a child without its environment"],
)
def test_the_memory_of_a_process_includes_children_in_other_sessions(run, code):
    process = run(code)
    hear(process, 1)
    assert process._memory.used() > 150 << 20


@needs_proc
def test_the_memory_of_a_process_includes_orphans_that_were_seen_before(run):
    """A look finds it while its parent lives, which ends when it is told to."""
    code = (
        "import os, subprocess, sys\n"
        "if not os.fork():\n"
        f"    {WITHOUT}\n"
        "    sys.stdin.readline(); os._exit(0)\n"
        "os.wait(); os.write(1, b'2'); sys.stdin.read()"
    )
    process = run(code)
    hear(process, 1)
    assert process._memory.used() > 150 << 20
    process.send([b"\n"])
    hear(process, 2)
    assert process._memory.used() > 150 << 20


@needs_proc
def test_memory_that_a_process_shares_with_its_children_counts_once(run):
    """Four processes with the same 150 MiB, of which each would seem to have all; LIMITS allow 400 MiB."""
    code = (
        "import mmap, os\n"
        "shared = mmap.mmap(-1, 150 << 20)\n"
        "os.fork(); os.fork()\n"
        "for place in range(0, len(shared), 4096): shared[place] = 1\n"
        "os.write(1, b'1'); os.read(0, 1)\n"
    )
    process = run(code)
    hear(process, 4)
    resident = sum(each.resident for each in process._memory._ours(list(memory._all_processes())))
    assert resident > LIMITS.memory
    assert 150 << 20 < process._memory.used() < 300 << 20


def test_memory_that_a_process_reserves_without_using_it_does_not_count(run):
    """As sanitizers, Go and the JVM do: 64 GB of addresses, none of them used."""
    reserved = "mmap.mmap(-1, 64 << 30, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS, prot=0)"
    process = run(f"import mmap, sys; m = {reserved}; print(1, flush=True); sys.stdin.read()")
    hear(process, 1)
    until = time.monotonic() + 0.3
    while time.monotonic() < until:
        process.pump(until)
    process.goodbye()


def test_a_memory_leak_over_many_short_questions_is_found(tmp_path):
    (tmp_path / "leaks.py").write_text(
        "held = []\n\n\ndef f(rows):\n    held.append(b'x' * (1 << 20))\n    return [0] * len(rows)\n"
    )
    with open_implementation(f"python:{tmp_path / 'leaks.py'}:f", Limits(memory=200 << 20, restarts=0)) as it:
        answered = it.classify(rows(4000), batch=1)
    assert answered.count(Outcome.CRASH) == 1
    assert "memory: its processes grew to 0." in answered.reasons[answered.count(Outcome.ANSWERED)]


@pytest.mark.parametrize(
    ("code", "sentence"),
    [
        ("import os; os.kill(os.getpid(), 9)", "ended by SIGKILL; the system does that too when memory runs out"),
        ("import os; os._exit(139)", "ended by itself with exit status 139, as a shell reports SIGSEGV"),
        ("import os; os._exit(200)", "ended by itself with exit status 200$"),
        ("import os, signal; os.kill(os.getpid(), signal.SIGTERM)", "ended by SIGTERM$"),
    ],
)
def test_the_end_of_a_process_is_reported_with_its_cause(code, sentence, run):
    process = run(code)
    with pytest.raises(FaultError, match=sentence) as caught:
        to_the_end(process)
    process.kill()
    process.kill()
    assert caught.value.outcome is Outcome.CRASH


def test_a_program_that_ends_while_its_child_keeps_its_output_open_has_ended():
    """The child, which would sleep for minutes, is killed."""
    spec = "command:" + json.dumps(["sh", "-c", "sleep 300 & exit 3"])
    began = time.monotonic()
    with pytest.raises(StartError, match="it ended by itself with exit status 3 before it described itself"):
        open_implementation(spec, NOT_ISOLATED)
    assert time.monotonic() - began < 30


def test_the_last_standard_error_of_a_process_is_read_after_its_end(run):
    code = "import os, time; os.write(2, b'first\\n'); os.close(1); time.sleep(0.2); os.write(2, b'last words\\n')"
    process = run(code)
    with pytest.raises(FaultError):
        hear(process, 1)
    process.kill()
    assert process.stderr == ("first", "last words")


def test_no_file_descriptor_stays_open_after_many_restarts():
    def descriptors() -> int:
        return len(os.listdir("/dev/fd"))

    with open_implementation(command("segfaults"), LIMITS) as it:
        it.classify(rows())
        before = descriptors()
        for _ in range(2):
            it.classify(rows())
        assert descriptors() == before


ASKS = """
import sys
from hypcheck.implementations.session import Outcome
from hypcheck.implementations.session import Limits
from hypcheck.implementations.implementation import open_implementation
with open_implementation(sys.argv[1], Limits(timeout=0.7, restarts=0)) as it:
    print(it._supervisor.session()._process._popen.pid, flush=True)
    answered = it.classify([[1.0] * 7] * 40)
    print(answered.count(Outcome.ANSWERED), *answered.reasons.values(), flush=True)
"""


@pytest.mark.parametrize("spec", [command("steady", "0.02"), function("naps")], ids=["command", "function"])
def test_time_in_which_hypcheck_and_the_process_are_stopped_does_not_count_for_the_timeout(spec):
    """As a container is frozen and a virtual machine is moved."""
    with subprocess.Popen([sys.executable, "-c", ASKS, spec], stdout=subprocess.PIPE, text=True) as asking:
        asked = int(asking.stdout.readline())
        time.sleep(0.2)
        for sent, pause in ((signal.SIGSTOP, 1.2), (signal.SIGCONT, 0.0)):
            os.kill(asked, sent)
            asking.send_signal(sent)
            time.sleep(pause)
        assert asking.stdout.readline() == "40\n"


@pytest.mark.parametrize("bad", [{"timeout": 0}, {"startup_timeout": float("inf")}, {"memory": -1}, {"restarts": -1}])
def test_limits_refuses_zero_negative_and_infinite_values(bad):
    with pytest.raises(InputError, match="the limit"):
        Limits(**bad)
