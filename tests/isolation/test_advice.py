"""An error that isolation causes says so and what to do; an error that comes without isolation too does not."""

from __future__ import annotations

import json
import os
import resource
import sys

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.session import StartError
from hypcheck.isolation.advice import isolation_advice
from hypcheck.isolation.launch import Isolation, Means
from tests.isolation.test_isolation import both, isolated

ROW = "2,5,1,0.5,2.5,0,0"
ASKS_HYPCHECK = "def classify(rows):\n    import hypcheck\n    return hypcheck.classify(rows)\n"
OWN = (
    "; it runs isolated, and does not see hypcheck; 'hypcheck emit --method exact --language python' writes a file "
    "that needs nothing else, and --isolate off runs code that you trust without"
)
WRITES = "it runs isolated, and can write only to its scratch folder, which TMPDIR names; --isolate off runs code"


def function_that(tmp_path, *lines: str) -> str:
    """The SPEC of a Python function that does these lines before it answers."""
    path = tmp_path / "code" / "function.py"
    path.parent.mkdir(exist_ok=True)
    path.write_text("".join(f"    {line}\n" for line in ("def classify(rows):", *lines, "return [0] * len(rows)"))[4:])
    return f"python:{path}:classify"


def reason_of(spec, limits) -> str:
    """Why the implementation fails: when it is started, or asked about a row."""
    try:
        with open_implementation(spec, limits) as it:
            answered = it.classify(np.ones((1, 7)))
    except StartError as error:
        return one_word(str(error))
    assert answered.reasons, "it answered"
    return one_word(answered.reasons[0])


def one_word(text: str) -> str:
    """The text, where a program that is isolated in part is said to be isolated."""
    return text.replace("it runs partly isolated", "it runs isolated")


CAUSED = {
    "import hypcheck.kernel": OWN,
    "from hypcheck import classify": OWN,
    "open('forged', 'w')": WRITES,
    "open({outside!r} + '/made', 'w')": "and does not see the folder '{outside}', which may be why; --isolate off",
    "open({outside!r} + '/data')": "it runs isolated, and does not see '{outside}/data'; put it into the working",
    "import subprocess; subprocess.run([{outside!r} + '/data'])": "and does not see '{outside}/data'",
    "import sys; sys.path.append({outside!r}); import beside": "and does not see '{outside}'; put it into",
    "import urllib.request as u; u.urlopen('http://example.org')": "it runs isolated, without a network and",
    "import socket; socket.socket()": "it runs isolated, which refuses sockets, memory in no file and some",
    "import os; os.memfd_create('x')": "which refuses sockets, memory in no file and some other system calls",
    "import os; os.environ['ENGINE_DATA']": "and does not see the environment variable ENGINE_DATA; --pass-env E",
}
"""What a function does that isolation stops, and what is said of it."""


def test_a_library_that_the_loader_does_not_find_is_blamed_on_isolation_as_a_possible_cause():
    text = "liba.so: libb.so.2: cannot open shared object file: No such file or directory"
    said = isolation_advice(text, (sys.executable,), Isolation("auto", here=Means(True, 7, True)))
    assert said.startswith(
        "; it runs isolated, and does not see every folder that may have libb.so.2, which may be why; "
    )
    assert "show the folder by --see" in said
    assert not isolation_advice(text, (sys.executable,), Isolation("off"))


ISOLATED = Isolation("auto", here=Means(True, 7, True))


def test_a_missing_hypcheck_is_blamed_on_isolation_only_if_the_programs_python_has_it(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)  # with no folder of this name
    text = "ModuleNotFoundError: No module named 'hypcheck'"
    assert isolation_advice(text, (sys.executable,), ISOLATED).endswith(OWN)
    assert not isolation_advice(text, ("/no/such/folder/python3",), ISOLATED)


@pytest.mark.skipif(not os.path.exists("/dev/ptmx"), reason="it names a file that Linux has")
def test_a_device_is_hidden_unless_isolated_programs_have_it():
    text = "No such file or directory: '{}'"
    assert "does not see '/dev/ptmx'" in isolation_advice(text.format("/dev/ptmx"), (sys.executable,), ISOLATED)
    assert "'/dev/null'" not in isolation_advice(text.format("/dev/null"), (sys.executable,), ISOLATED)


def test_a_read_only_folder_is_not_blamed_on_isolation_if_the_account_could_not_write_there_either():
    text = "OSError: [Errno 30] Read-only file system: '{}/file'"
    assert WRITES in isolation_advice(text.format(os.getcwd()), (sys.executable,), ISOLATED)
    assert not isolation_advice(text.format("/no/such/folder"), (sys.executable,), ISOLATED)


@pytest.mark.parametrize(("limit", "blamed"), [(resource.RLIM_INFINITY, True), (1_000_000, True), (20, False)])
def test_a_missing_process_is_blamed_on_isolation_only_if_the_system_allows_more(limit, blamed, monkeypatch):
    monkeypatch.setattr(resource, "getrlimit", lambda _: (limit, limit))
    said = isolation_advice(f"RuntimeError: can't start new thread {limit}", (sys.executable,), ISOLATED)
    assert ("processes and threads at most, which may be why" in said) is blamed


NOT_CAUSED = (
    "import no_such_module",
    "import hypcheck.no_such_module",
    "from hypcheck import no_such_name",
    "import hypcheck; hypcheck.no_such_name",
    "import sys; sys.path.append('/no/such/folder'); import beside",
    "open('/no/such/file')",
    "open('no-such-file')",
    "open('/no/such/folder/file', 'w')",
    "import os; os.environ['NO_SUCH_VARIABLE']",
    "import subprocess; subprocess.run(['no-such-program'])",
    "raise ValueError('the ring has no normal')",
)


def reasons_of(tmp_path, lines, limits):
    """Why a function fails that does one of these lines at each row, by the line: one process is asked of them all."""
    path = tmp_path / "code" / "function.py"
    path.parent.mkdir()
    attempts = "".join(f"def attempt_{number}():\n    {line}\n\n\n" for number, line in enumerate(lines))
    path.write_text(f"{attempts}def classify(rows):\n    globals()[f'attempt_{{int(rows[0][4])}}']()\n    return [0]\n")
    rows = np.ones((len(lines), 7))
    rows[:, 4] = range(len(lines))
    with open_implementation(f"python:{path}:classify", limits) as it:
        answered = it.classify(rows, batch=1)
    return {line: one_word(answered.reasons.get(number, "it answered")) for number, line in enumerate(lines)}


@both
def test_an_error_that_isolation_causes_has_advice(ways, monkeypatch, tmp_path):
    """The programs of a test lie in the folder for temporary files, of which an isolated program sees only its own."""
    outside, here = tmp_path / "outside", tmp_path / "here"
    for folder in (outside, here):
        folder.mkdir()
    (outside / "data").write_text("#!/bin/sh\n")
    (outside / "data").chmod(0o755)
    (outside / "beside.py").write_text("")
    monkeypatch.setenv("ENGINE_DATA", "wanted")
    monkeypatch.chdir(here)
    reasons = reasons_of(tmp_path, [line.format(outside=str(outside)) for line in CAUSED], isolated(ways))
    for sentence, (line, reason) in zip(CAUSED.values(), reasons.items(), strict=True):
        assert sentence.format(outside=outside) in reason, (line, reason)


@both
def test_a_command_that_isolation_stops_gets_the_advice_in_any_language(ways):
    code = "import sys; sys.exit('Error: EROFS: read-only file system, open \\'cache.bin\\'')"
    spec = "command:" + json.dumps([sys.executable, "-I", "-S", "-c", code])
    assert WRITES in reason_of(spec, isolated(ways))
    code = "from hypcheck import classify"
    spec = "command:" + json.dumps([sys.executable, "-c", code])
    assert reason_of(spec, isolated(ways)).endswith(OWN)


@both
def test_an_error_that_comes_without_isolation_too_does_not_blame_it(ways, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    for line, reason in reasons_of(tmp_path, NOT_CAUSED, isolated(ways)).items():
        assert "it runs isolated" not in reason, line
        assert "it raised " in reason, line


def test_a_program_that_is_not_isolated_is_not_reported_as_isolated(monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    spec = function_that(tmp_path, "import os, signal; os.kill(os.getpid(), signal.SIGSYS)")
    main(["replay", ROW, spec, "--isolate", "off", "--restarts", "0"])
    said = capsys.readouterr().out
    assert "it was ended by SIGSYS" in said
    assert "isolation" not in said
    assert "it runs isolated" not in said


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("verify", "SPEC", "--families", "ring", "--count", "1", "--out", "out"), 1),
        (("replay", ROW, "SPEC"), 1),
        (("hunt", "SPEC", "--queries", "4"), 1),
        (("minimise", "SPEC", ROW), None),
        pytest.param(
            (
                "bench",
                "python:imports.py:classify",
                "--quick",
                "--methods",
                "table-2-float64",
                "--workloads",
                "uniform",
                "--out",
                "out",
            ),
            5,
            marks=pytest.mark.thorough,
        ),
    ],
    ids=lambda words: words[0] if isinstance(words, tuple) else "",
)
def test_every_command_says_that_isolation_hides_hypcheck(words, code, monkeypatch, tmp_path, capsys, text_reports):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "asks.py").write_text(ASKS_HYPCHECK)
    (tmp_path / "imports.py").write_text("from hypcheck import classify\n")
    assert main([word.replace("SPEC", "python:asks.py:classify") for word in words]) in ({code} if code else {1, 2, 5})
    streams = capsys.readouterr()
    assert OWN in one_word(" ".join((streams.out + streams.err).split()))
    if words[0] == "verify":
        assert OWN in one_word(json.loads((tmp_path / "out" / "summary.json").read_text())["failures"][0]["message"])
        assert "does not see hypcheck" in (tmp_path / "out" / "report.md").read_text()
        assert json.dumps(OWN)[1:-1] in one_word((tmp_path / "out" / "record.jsonl").read_text())


@pytest.mark.skipif(os.geteuid() != 0, reason="only the superuser has rights to lose")
@both
def test_a_file_that_only_the_superuser_may_read_is_blamed_on_isolation(ways, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    closed = tmp_path / "closed"
    closed.write_text("")
    os.chown(closed, 12345, 12345)
    closed.chmod(0o600)
    reason = reason_of(function_that(tmp_path, "open('closed')"), isolated(ways))
    assert "it runs isolated, and has none of the superuser's rights" in reason
