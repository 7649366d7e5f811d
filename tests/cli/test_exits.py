"""However a run ends: the contracted status, one clear sentence, no traceback."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
import threading
import time
from io import StringIO
from itertools import permutations

import click
import pytest

from hypcheck.cli import commands
from hypcheck.cli import main as cli_main
from hypcheck.cli.commands import ending_of
from hypcheck.cli.main import main
from hypcheck.cli.running import in_colour
from hypcheck.errors import (
    PRECEDENCE,
    Exit,
    HypcheckError,
    InputError,
    NothingJudgedError,
    Terminated,
    UnavailableError,
    first_that_applies,
)

HYPCHECK = [sys.executable, "-m", "hypcheck"]
TABLE = ["classify", "--input", "-", "--format", "csv"]
BUFFERED = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}


def test_exit_codes_keep_their_numbers():
    assert {code.name: int(code) for code in Exit} == {
        "HELD": 0,
        "WRONG": 1,
        "USAGE": 2,
        "SLOWER": 3,
        "INCONCLUSIVE": 4,
        "NOT_STARTED": 5,
        "ORACLES_DISAGREE": 6,
        "INTERNAL": 70,
        "INTERRUPTED": 130,
        "CLOSED_PIPE": 141,
        "TERMINATED": 143,
    }
    assert all(code.meaning for code in Exit)


def test_of_several_exit_codes_the_first_in_precedence_applies():
    order = [130, 70, 2, 6, 5, 1, 3, 4, 0]
    for first, second in permutations(order, 2):
        assert first_that_applies([first, second]) == min(first, second, key=order.index)
    assert first_that_applies([]) is Exit.HELD
    assert first_that_applies(order) is Exit.INTERRUPTED
    assert set(PRECEDENCE) == set(Exit)


@pytest.mark.parametrize("kind", [InputError, NothingJudgedError, UnavailableError, HypcheckError])
def test_an_expected_error_ends_with_its_exit_code_and_its_message_in_one_line(kind):
    ending = ending_of(kind("a.csv: what\nis wrong"))
    assert ending.code == kind.exit_code
    assert ending.lines == ("hypcheck: error: a.csv: what is wrong",)


def test_error_messages_escape_control_characters():
    assert ending_of(InputError("a\x1b[31m\udc80 α")).lines == ("hypcheck: error: a\\x1b[31m\\udc80 α",)


def test_a_full_disk_ends_2_and_is_not_reported_as_an_internal_error():
    assert ending_of(OSError(28, "No space left on device")).code == Exit.USAGE
    assert ending_of(OSError("something else")).code == Exit.INTERNAL


@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_verify_ends_with_its_code_even_if_a_standard_stream_is_closed(stream, monkeypatch, tmp_path, text_reports):
    monkeypatch.setattr(sys, stream, None)  # Python does this if the descriptor is closed
    arguments = ["verify", "builtin:table-2-float64", "--families", "ring", "--count", "0", "--out", str(tmp_path)]
    assert main(arguments) == Exit.WRONG
    assert (tmp_path / "report.md").is_file()


class Terminal(StringIO):
    """A stream that says it is a terminal."""

    def isatty(self):  # noqa: D102 - as every stream has it
        return True


@pytest.mark.parametrize(
    ("environment", "coloured"),
    [({}, True), ({"NO_COLOR": "1"}, False), ({"NO_COLOR": ""}, True), ({"TERM": "dumb"}, False)],
)
def test_output_on_a_terminal_is_coloured_unless_the_environment_forbids_it(environment, coloured, monkeypatch):
    monkeypatch.delenv("NO_COLOR", raising=False)
    for name, value in ({"TERM": "xterm"} | environment).items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(sys, "stdout", Terminal())
    assert in_colour() is coloured


def broken(error: BaseException) -> click.Command:
    """A command that fails so."""

    @click.command()
    def command() -> None:
        raise error

    return command


@pytest.mark.parametrize(
    ("error", "code", "told"),
    [
        (ZeroDivisionError("division\nby zero"), 70, "internal error: ZeroDivisionError: division by zero\n"),
        (AssertionError(), 70, "internal error: AssertionError\n"),
        (SystemExit(3), 70, "internal error: SystemExit: 3\n"),
        (KeyboardInterrupt(), 130, "interrupted\n"),
        (click.Abort(), 130, "interrupted\n"),
        (BrokenPipeError(), 141, ""),
    ],
)
def test_an_unexpected_error_or_interrupt_ends_without_a_traceback(error, code, told, monkeypatch, capsys):
    monkeypatch.setattr(commands.LazyGroup, "get_command", lambda *_: broken(error))
    assert main(["classify"]) == code
    errors = capsys.readouterr().err
    assert errors.startswith(f"hypcheck: {told}" if told else "")
    assert bool(errors) is bool(told)
    assert "Traceback" not in errors
    assert ("please report it" in errors) is (code == 70)


def test_main_restores_the_handler_of_sigterm():
    before = signal.signal(signal.SIGTERM, signal.SIG_IGN)
    try:
        main(["--version"])
        assert signal.getsignal(signal.SIGTERM) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGTERM, before)


def test_a_command_in_another_thread_is_answered_without_a_handler_of_signals(capsys):
    codes = []
    words = ["classify", "--alpha", "1", "--gamma", "2", "--b", "1", "--d", "1", "--center", "2.5", "0", "0"]
    thread = threading.Thread(target=lambda: codes.append(main(words)))
    thread.start()
    thread.join()
    assert codes == [0]
    assert capsys.readouterr().out.startswith("exterior\n")


def test_an_error_while_an_object_is_freed_is_left_to_python(monkeypatch):
    lost = []

    class Freed:
        def __del__(self):
            raise ValueError("lost")

    monkeypatch.setattr(sys, "__unraisablehook__", lambda unraisable: lost.append(str(unraisable.exc_value)))
    with cli_main._terminable():
        freed = Freed()
        del freed
    assert lost == ["lost"]


def test_a_closed_terminal_does_not_end_a_run_that_ignores_sighup():
    """nohup starts programs in this way."""
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with cli_main._terminable():
            signal.raise_signal(signal.SIGHUP)
    finally:
        signal.signal(signal.SIGHUP, before)


@pytest.mark.parametrize(("name", "error"), [("SIGINT", KeyboardInterrupt), ("SIGTERM", Terminated)])
def test_an_interrupt_inside_the_del_method_of_an_object_is_not_lost(name, error, capsys):
    class Freed:
        def __del__(self) -> None:
            signal.raise_signal(getattr(signal, name))

    with pytest.raises(error), cli_main._terminable():  # noqa: PT012 - it is raised where nothing happens
        freed = Freed()
        del freed
        for _ in range(500):  # and not once for long: a machine that stands still for a while counts that as well
            time.sleep(0.01)
    assert capsys.readouterr().err == ""


def test_a_closed_output_pipe_adds_nothing_to_the_message_of_another_error():
    """What was printed before the error and could not be written is not tried again when the interpreter ends."""
    code = """
import click, sys
from hypcheck.cli import commands
from hypcheck.cli.main import main

@click.command()
def command():
    print("held back in the buffer")
    raise click.UsageError("no")

commands.LazyGroup.get_command = lambda *_: command
sys.exit(main(["classify"]))
"""
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run([sys.executable, "-c", code], env=BUFFERED, stdout=write, stderr=subprocess.PIPE, check=False)
    os.close(write)
    assert done.returncode == Exit.USAGE
    assert len(done.stderr.splitlines()) == 2


def test_a_reached_system_limit_ends_2_and_is_not_reported_as_an_internal_error():
    ending = ending_of(OSError(errno.EMFILE, os.strerror(errno.EMFILE)))
    assert ending.code == Exit.USAGE
    assert ending.lines == ("hypcheck: error: a limit of the system is reached: too many open files; see `ulimit -a`",)


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGHUP, 143)])
def test_an_interrupted_classify_leaves_the_old_output_file_and_no_partial_one(number, code, tmp_path):
    target = tmp_path / "answers.csv"
    target.write_text("what was there")
    process = subprocess.Popen([*HYPCHECK, *TABLE, "--output", target], stdin=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdin is not None
    row = b"1,2,1,1,2.5,0,0\n"
    process.stdin.write(b"alpha,gamma,b,d,x,y,z\n" + row * 70_000)  # some are read, answered and written beside
    process.stdin.flush()
    deadline = time.monotonic() + 30
    while len(os.listdir(tmp_path)) < 2 and time.monotonic() < deadline:
        time.sleep(0.01)
    assert len(os.listdir(tmp_path)) == 2, "the file beside the target has not appeared"
    process.send_signal(number)
    _, errors = process.communicate()
    assert process.returncode == code
    assert errors.count(b"\n") == 1
    assert os.listdir(tmp_path) == ["answers.csv"]
    assert target.read_text() == "what was there"
