"""An isolated program cannot touch the judge, the machine or the answers; with namespaces, and without."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pytest

import hypcheck
from hypcheck.cli.main import main
from hypcheck.errors import InputError
from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.process import Process
from hypcheck.implementations.session import FaultError, Limits, StartError
from hypcheck.implementations.worker_session import WORKER_MODULES
from hypcheck.isolation import launch
from hypcheck.isolation.launch import Isolation, Means, NotIsolatedError, isolation_text

HERE = launch.available()
WITHOUT_NAMESPACES = Means(False, HERE.landlock, HERE.seccomp, ("no namespaces: a test",))

SAID = isolation_text(HERE.names, HERE.missing)
needs_namespaces = pytest.mark.skipif(not HERE.whole, reason=f"a program here is {SAID}")
needs_landlock = pytest.mark.skipif(HERE.landlock < 6, reason=f"a program here is {SAID}")
both = pytest.mark.parametrize(
    "ways",
    [
        pytest.param(HERE, marks=needs_namespaces, id="namespaces"),
        pytest.param(WITHOUT_NAMESPACES, marks=needs_landlock, id="Landlock"),
    ],
)

OBSERVES = """
import json, os, signal, sys
judge, outside, vectors, hidden = int(sys.argv[1]), *sys.argv[2:5]
seen = {}

def attempt(name, step):
    try:
        seen[name] = step()
    except BaseException as error:
        seen[name] = type(error).__name__

def content(path):
    with open(path, "rb") as file:
        return len(file.read())

def write(path):
    with open(path, "w") as file:
        return file.write("forged")

attempt("write outside", lambda: write(outside))
attempt("write into the scratch folder", lambda: write(os.path.join(os.environ["TMPDIR"], "mine")))
attempt("write to shared memory", lambda: write("/dev/shm/hypcheck-test"))
attempt("read a vector", lambda: content(vectors))
attempt("read the package", lambda: content(sys.argv[5]))
attempt("read the record", lambda: content(hidden))
attempt("read Python", lambda: content(os.__file__) > 0)
attempt("token", lambda: os.environ.get("GITHUB_TOKEN"))
attempt("passed variable", lambda: os.environ.get("ENGINE_DATA"))
attempt("stop the judge", lambda: os.kill(judge, signal.SIGSTOP))
attempt("signal everybody", lambda: os.kill(-1, signal.SIGUSR1))
attempt("the judge's environment", lambda: content(f"/proc/{judge}/environ"))
attempt("the judge's memory", lambda: content(f"/proc/{judge}/mem"))
attempt("processes", lambda: sum(name.isdigit() for name in os.listdir("/proc")))

def connect():
    import socket
    socket.socket()

attempt("socket", connect)
attempt("memory in no process", lambda: os.memfd_create("hidden"))
attempt("a new user", lambda: os.unshare(0x10000000) if hasattr(os, "unshare") else "PermissionError")
seen["descriptors"] = sorted(map(int, os.listdir("/proc/self/fd")))[-1]
os.write(1, json.dumps(seen).encode() + b"\\n")
sys.stdin.read()
"""


def isolated(ways: Means, **options: object) -> Limits:
    """Limits for programs that these means isolate."""
    return Limits(isolation=Isolation("auto", here=ways, **options))


def line_of(process: Process) -> bytes:
    """The first line of its output."""
    until = time.monotonic() + 10
    while b"\n" not in process.incoming:
        process.pump(until)
        assert time.monotonic() < until
    return bytes(process.incoming).partition(b"\n")[0]


@both
def test_an_isolated_program_cannot_reach_vectors_records_sockets_or_the_judge(ways, monkeypatch, tmp_path):
    package = Path(hypcheck.__file__).parent
    vectors = next(iter(sorted((package / "cases").rglob("*.json"))), None) or next(
        iter(sorted((package.parent / "cases").rglob("*.json")))
    )
    record = tmp_path / "reports" / "record.jsonl"
    record.parent.mkdir()
    record.write_text("the answers")
    monkeypatch.setenv("GITHUB_TOKEN", "secret")
    monkeypatch.setenv("ENGINE_DATA", "wanted")
    monkeypatch.chdir(tmp_path)
    limits = isolated(ways, hidden=(str(record.parent),), variables=("ENGINE_DATA",))
    paths = (tmp_path / "forged", vectors, record, package / "__init__.py")
    process = Process((sys.executable, "-I", "-S", "-c", OBSERVES, str(os.getpid()), *map(str, paths)), limits)
    try:
        seen = json.loads(line_of(process))
    finally:
        process.kill()
    assert seen.pop("write outside") in {"OSError", "PermissionError"}
    assert not (tmp_path / "forged").exists()
    for attempt in ("read a vector", "read the package", "read the record"):
        assert seen.pop(attempt) in {"FileNotFoundError", "PermissionError"}, attempt
    for attempt in ("stop the judge", "the judge's environment", "the judge's memory"):
        assert seen.pop(attempt) in {"ProcessLookupError", "FileNotFoundError", "PermissionError"}, attempt
    assert seen.pop("signal everybody") in {None, "ProcessLookupError", "PermissionError"}
    assert seen.pop("processes") <= 3 or not ways.namespaces
    assert seen.pop("write to shared memory") == (6 if ways.namespaces else "PermissionError")
    assert seen.pop("descriptors") <= 3
    assert seen == {
        "write into the scratch folder": 6,
        "read Python": True,
        "token": None,
        "passed variable": "wanted",
        "socket": "PermissionError",
        "memory in no process": "OSError",
        "a new user": "PermissionError",
    }
    assert not list(Path(tempfile.gettempdir()).glob("hypcheck-scratch-*/mine"))


@both
@pytest.mark.parametrize(
    ("code", "sentence"),
    [
        ("import os; os.kill(os.getpid(), 9)", "ended by SIGKILL; the system does that too"),
        ("import os; os._exit(200)", "ended by itself with exit status 200$"),
        (
            "import ctypes; ctypes.CDLL(None).mount(b'x', b'/', b'tmpfs', 0, b'')",
            "ended by SIGSYS; isolation does that",
        ),
    ],
    ids=["killed", "exits", "mounts"],
)
def test_the_end_of_an_isolated_program_is_reported_with_its_cause(code, sentence, ways):
    process = Process((sys.executable, "-I", "-S", "-c", code), isolated(ways))
    with pytest.raises(FaultError, match=sentence):
        line_of(process)
    process.kill()


@both
def test_a_daemon_that_an_isolated_program_starts_ends_with_it(ways, tmp_path):
    """It leaves the group, the session and its parent, and has no environment by which it could be known."""
    seconds = f"{600 + os.getpid() / 1e7:.7f}"
    code = f"setsid env -i sleep {seconds} > /dev/null 2>&1 & sleep 0.1; echo; exec sleep 60"
    process = Process(("/bin/sh", "-c", code), isolated(ways))
    line_of(process)
    assert seconds in sleeping()
    process.kill()
    assert seconds not in sleeping()


@both
def test_an_isolated_program_ends_if_hypcheck_is_killed(ways, tmp_path):
    """No guard is needed: the launcher sees that the pipe, which hypcheck holds open, is closed."""
    seconds = f"{600 + os.getpid() / 1e7 + 0.5:.7f}"
    code = (
        "import sys\n"
        "from hypcheck.isolation.launch import Isolation\n"
        "from hypcheck.isolation.launch import Means\n"
        "from hypcheck.implementations.process import Process\n"
        "from hypcheck.implementations.session import Limits\n"
        f"limits = Limits(isolation=Isolation('auto', here={ways!r}))\n"
        f"process = Process(('/bin/sh', '-c', 'setsid sleep {seconds} & exec sleep {seconds}'), limits)\n"
        "print('started', flush=True); sys.stdin.read()\n"
    )
    environment = {**os.environ, "TMPDIR": str(tmp_path)}  # nobody is left to remove the scratch folder
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", code], env=environment, **pipes) as ours:
        assert ours.stdout.readline() == b"started\n"
        ours.kill()
    until = time.monotonic() + 5
    while seconds in sleeping() and time.monotonic() < until:
        time.sleep(0.01)
    assert seconds not in sleeping()


def test_an_isolated_implementation_that_does_not_start_gets_a_hint_about_isolate_off():
    code = "open('/forged', 'w')"
    if not HERE.names:
        pytest.skip(f"a program here is {SAID}")
    with pytest.raises(StartError, match=r"isolated, and can write only to its scratch folder, .*without$"):
        open_implementation("command:" + json.dumps([sys.executable, "-I", "-S", "-c", code]), isolated(HERE))


def sleeping() -> str:
    """The command lines of all processes."""
    return "\n".join(_line(each) for each in Path("/proc").glob("[0-9]*"))


def _line(folder: Path) -> str:
    try:
        return (folder / "cmdline").read_text().replace("\0", " ")
    except OSError:
        return ""


@both
@pytest.mark.parametrize(
    ("word", "sentence"),
    [("no-such-program", "was not found; it must be on the PATH"), ("/etc/passwd", "is not executable")],
)
def test_a_program_that_cannot_be_run_is_reported_as_without_isolation(word, sentence, ways):
    with pytest.raises(StartError, match=sentence):
        Process((word,), isolated(ways))


@both
def test_an_isolated_program_in_the_temporary_folder_can_be_run(ways, tmp_path):
    program = tmp_path / "program"
    program.write_text("#!/bin/sh\necho found; read rest\n")
    program.chmod(0o755)
    process = Process((str(program),), isolated(ways))
    assert line_of(process) == b"found"
    process.kill()


ECHOES = """
def classify(rows):
    import hypcheck
    return hypcheck.classify(rows)
"""


@both
def test_an_isolated_function_cannot_import_hypcheck_to_get_the_answer(ways, tmp_path):
    (tmp_path / "echoes.py").write_text(ECHOES)
    with open_implementation(f"python:{tmp_path / 'echoes.py'}:classify", isolated(ways)) as it:
        answered = it.classify(np.ones((2, 7)))
    assert not answered.answered.any()
    assert "hypcheck" in answered.reasons[0]
    assert re.search("ModuleNotFoundError|PermissionError", answered.reasons[0]), answered.reasons


def test_the_worker_imports_only_the_modules_of_hypcheck_that_isolation_shows_it():
    """A module that it is not shown would be missing where it is isolated; one too many might hold an answer."""
    code = "import sys, hypcheck.implementations.worker; print(*(m for m in sys.modules if m.startswith('hypcheck')))"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    wanted = {f"hypcheck/{name}".removesuffix("/__init__").replace("/", ".") for name in WORKER_MODULES}
    assert set(loaded) - {"hypcheck.implementations._calls"} == wanted


@needs_namespaces
def test_the_process_limit_of_isolation_holds_in_the_namespace_alone():
    """A program that starts processes without end gets no more, and this system's limit stays."""
    before = Path("/proc/sys/kernel/pid_max").read_text()
    code = (
        "import os, sys\n"
        "for number in range(2000):\n"
        "    try:\n        child = os.fork()\n"
        "    except OSError:\n        break\n"
        "    if not child: sys.stdin.read(); os._exit(0)\n"
        "os.write(1, b'%d\\n' % number)\n"
    )
    limits = Limits(isolation=Isolation("on", threads=310))  # the system allows no less than 301
    process = Process((sys.executable, "-I", "-S", "-c", code), limits)
    try:
        started = int(line_of(process))
    finally:
        process.kill()
    if started == 1999:
        pytest.skip("this system counts neither processes of a namespace nor those of the superuser")
    assert 200 < started < 310
    assert Path("/proc/sys/kernel/pid_max").read_text() == before


@needs_namespaces
def test_the_scratch_folder_of_an_isolated_program_has_a_size_limit():
    code = (
        "import errno, os\n"
        "try:\n"
        "    for name in range(9):\n"
        "        open(os.path.join(os.environ['TMPDIR'], str(name)), 'wb').write(bytes(300_000))\n"
        "except OSError as error:\n    print(errno.errorcode[error.errno], name)\n"
    )
    process = Process(
        (sys.executable, "-I", "-S", "-c", code), Limits(isolation=Isolation("on", scratch_bytes=1 << 20))
    )
    assert line_of(process) == b"ENOSPC 3"
    process.kill()


def test_a_program_is_not_isolated_if_isolation_is_off():
    limits = Limits(isolation=Isolation("off"))
    process = Process((sys.executable, "-I", "-S", "-c", "import os; print(os.getppid()); input()"), limits)
    assert int(line_of(process)) == os.getpid()
    process.kill()
    assert (
        isolation_text(limits.isolation.means.names, limits.isolation.means.missing)
        == "not isolated (--isolate is off)"
    )


@pytest.mark.parametrize(
    ("found", "sentence"),
    [
        (Means(True, 7, True), "isolated by namespaces, Landlock 7 and seccomp"),
        (Means(True, 0, True, ("no Landlock: old",)), "isolated by namespaces and seccomp (no Landlock: old)"),
        (
            Means(False, 7, True, ("no user",)),
            "partly isolated: no user; by Landlock 7 and seccomp",
        ),
        (Means(False, 0, True, ("no a", "no b")), "partly isolated: no a; no b; by seccomp"),
        (Means(True, 7, False, ("no seccomp: old",)), "partly isolated: no seccomp: old; by namespaces and Landlock 7"),
        (Means(), "not isolated"),
    ],
    ids=["all", "no Landlock", "no namespaces", "seccomp alone", "no seccomp", "nothing"],
)
def test_a_program_is_isolated_or_partly_isolated_and_what_is_missing_comes_first(found, sentence):
    assert isolation_text(found.names, found.missing) == sentence
    assert sentence.startswith(found.word)


@pytest.mark.usefixtures("text_reports")
def test_isolation_that_a_variable_turns_off_is_listed_as_weaker_than_the_default(monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HYPCHECK_ISOLATE", "off")
    words = ("verify", f"command:{sys.executable} -I -S -c pass", "--out", "out")
    assert main([*words]) == 5
    weaker = "weaker than the default: --isolate off, not auto (HYPCHECK_ISOLATE)"
    assert weaker in capsys.readouterr().out
    header = json.loads((tmp_path / "out" / "record.jsonl").read_text().splitlines()[0])
    shown = {"option": "--isolate", "value": "off", "default": "auto", "source": "HYPCHECK_ISOLATE"}
    assert header["settings"]["weakened"] == [shown]
    assert main([*words, "--isolate", "auto"]) == 5
    assert "weaker" not in capsys.readouterr().out


def test_isolation_on_is_refused_with_the_reason_if_the_system_lacks_namespaces():
    lacking = Means(missing=("no namespaces: cannot make namespaces: operation not permitted",))
    with pytest.raises(NotIsolatedError, match="cannot make namespaces: operation not permitted") as refused:
        launch.means_of("on", lacking)
    assert refused.value.exit_code == 5
    assert launch.means_of("auto", lacking) is lacking
    with pytest.raises(InputError, match="one of auto, on, off"):
        Isolation("perhaps")


def test_verify_prints_and_records_how_an_implementation_is_isolated(tmp_path, monkeypatch, capsys, text_reports):
    """The first line names the means, and the record has them; the program ends at once, so that nothing is asked."""
    monkeypatch.chdir(tmp_path)
    spec = f"command:{sys.executable} -I -S -c pass"
    assert main(["verify", spec, "--count", "1", "--families", "ring", "--out", "out", "--isolate", "auto"]) == 5
    assert capsys.readouterr().err.splitlines()[0] == f"hypcheck: verifying {spec}; {SAID}"
    header = json.loads((tmp_path / "out" / "record.jsonl").read_text().splitlines()[0])
    assert header["isolation"] == {"mode": "auto", "means": [*HERE.names], "missing": [*HERE.missing]}
    assert header["options"]["limits"]["isolate"] == "auto"
