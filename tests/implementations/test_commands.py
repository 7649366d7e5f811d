"""Commands: each fault ends as its own status and sentence, and costs only its own row."""

from __future__ import annotations

import re
import time

import numpy as np
import pytest

from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.protocol import row_text
from hypcheck.implementations.session import FaultError, Limits, Outcome, StartError, TimingError
from tests.tools.miniatures import (
    LIMITS,
    QUICK,
    UNLUCKY,
    command,
    compiled,
    only_unlucky,
    restarts_of,
    rows,
    signs,
    stderr_of,
    truth,
)

HANGS = ("silent", "short", "drips", "loops")
FAULTS = {
    "prints_before": (Outcome.PROTOCOL, r"wrote 'computing the discriminant \.\.\.' where '\d+ 1' had to come"),
    "pads": (Outcome.PROTOCOL, r"wrote '(\d+)     1' where '\1 1' had to come"),
    "stale": (Outcome.PROTOCOL, r"replied to question \d+ again, when \d+ was asked"),
    "silent": (Outcome.PROTOCOL, r"replied to question \d+ before question \d+"),
    "short": (Outcome.PROTOCOL, r"its reply was short: the next one came after 0 of 1 answers"),
    "long": (Outcome.PROTOCOL, r"wrote '.*' behind a complete reply"),
    "wrong_count": (Outcome.PROTOCOL, "announced 2 answers to 1 rows"),
    "answers_3": (Outcome.PROTOCOL, "answered 3; it must be one of -1, 0, 1 or 2"),
    "answers_nan": (Outcome.PROTOCOL, "answer 1 of 1 is 'nan'; it must be an integer"),
    "drips": (Outcome.TIMEOUT, r"only '\d+ +' of a reply within 0.7 s"),
    "leaves": (Outcome.CRASH, "ended by itself with exit status 1; stderr: terminate called after .*out_of_range"),
    "segfaults": (Outcome.CRASH, "ended by SIGSEGV"),
    "segfaults_with_children": (Outcome.CRASH, "ended by SIGABRT"),
    "loops": (Outcome.TIMEOUT, "no reply within 0.7 s"),
    "eats_memory": (Outcome.CRASH, r"memory: its processes grew to 0\.\d+ GiB, beyond 0.39 GiB"),
    "child_eats_memory": (Outcome.CRASH, r"memory: its processes grew to 0\.\d+ GiB, beyond 0.39 GiB"),
    "reports_error": (Outcome.ERROR, r"reported an error: no root found \\x1b\[2J"),
    "endless_line": (Outcome.PROTOCOL, r"does not end within 4096 bytes: '1+…'"),
    "endless_answer": (Outcome.PROTOCOL, r"longer than 64 bytes: '1+'"),
    "closes_output": (Outcome.PROTOCOL, "closed its standard output and did not end"),
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_of_a_command_fails_only_its_own_row_with_the_reason(name):
    some, (outcome, sentence) = rows(), FAULTS[name]
    with open_implementation(command(name), QUICK if name in HANGS else LIMITS) as it:
        reason = only_unlucky(it.classify(some), outcome, truth(some))
        assert re.search(sentence, reason), reason
        assert it.classify(rows(lucky=True)).answered.all()


@pytest.mark.parametrize("name", ["short", "long", "silent"])
def test_a_fault_of_a_command_in_the_binary_form_fails_only_its_own_row(name):
    some = rows()
    with open_implementation(command(name, "binary"), QUICK if name in HANGS else LIMITS) as it:
        assert it.description.binary
        only_unlucky(it.classify(some), Outcome.PROTOCOL, truth(some))


def test_output_of_a_command_between_two_replies_breaks_the_protocol():
    with open_implementation(command("prints_behind"), LIMITS) as it:
        assert it.classify(rows()).answered.all()
        time.sleep(0.3)
        answered = it.classify(rows(1, lucky=True))
    assert answered.status.tolist() == [Outcome.PROTOCOL]
    assert "wrote 'done' when nothing was asked" in answered.reasons[0]


@pytest.mark.parametrize("form", ["text", "binary"])
def test_a_correct_command_answers_batches_of_every_size_rightly(form):
    some = rows(700)
    expected = truth(some)
    with open_implementation(command("right", form), LIMITS) as it:
        assert it._supervisor.max_batch == (4096 if form == "text" else 65536)
        for n, batch in ((50, 1), (700, 77), (700, 100_000), (700, None)):
            answered = it.classify(some[:n], batch=batch)
            assert answered.answered.all()
            assert answered.answers.tolist() == expected[:n].tolist()
        assert it.classify(some[:0]).answers.shape == (0,)
        assert restarts_of(it) == 0


def test_row_text_writes_numbers_that_read_back_to_the_bit():
    bits = np.random.default_rng(3).integers(0, 2**64, 7 * 700, dtype=np.uint64)
    some = bits.view(np.float64).reshape(-1, 7)
    some = np.vstack([some[np.isfinite(some).all(axis=1)], [[5e-324, 1.0, 1e22, 1e23, -0.0, 0.1, 2.0**-1022]]])
    back = np.array([line.split() for line in b"".join(row_text(some)).splitlines()], dtype=np.float64)
    assert back.tobytes() == some.tobytes()


def test_a_command_that_floods_standard_error_is_answered_and_its_last_lines_are_kept():
    some = rows()
    with open_implementation(command("floods_stderr"), LIMITS) as it:
        answered = it.classify(some)
        assert answered.answers.tolist() == truth(some).tolist()
        assert stderr_of(it)[-1] == r"\x1b[31mwarning �\x00"
        assert all(line.isprintable() for line in stderr_of(it))
        assert sum(map(len, stderr_of(it))) < 50_000


def test_a_slow_reply_of_a_command_is_not_mistaken_for_a_missing_one():
    """The second question that is sent after a while is answered behind the first, and nothing is lost or shifted."""
    some = rows()
    with open_implementation(command("slow_reply"), QUICK) as it:
        for _ in range(2):
            assert it.classify(some).answers.tolist() == truth(some).tolist()


@pytest.mark.parametrize("words", [("0.04",), ("0.04", "0.5")], ids=["steadily", "with a pause"])
def test_a_command_that_keeps_answering_does_not_time_out(words):
    some = rows(lucky=True)
    with open_implementation(command("steady", *words), QUICK) as it:
        began = time.monotonic()
        answered = it.classify(some)
        assert time.monotonic() - began > 2 * QUICK.timeout
        assert restarts_of(it) == 0
    assert answered.answers.tolist() == truth(some).tolist()


def test_command_that_answers_too_slowly_times_out():
    """Two and a half answers in forty are a sixteenth; of a question with one row, its answer is all."""
    with open_implementation(command("steady", "0.45"), QUICK) as it:
        began = time.monotonic()
        with pytest.raises(FaultError) as caught:
            it._supervisor.session().classify(rows(lucky=True))
        assert time.monotonic() - began < 10 * QUICK.timeout
    assert caught.value.outcome == Outcome.TIMEOUT
    assert re.search(r"1 of 40 answers, and hardly one more within 0.7 s", caught.value.reason)


def test_the_answer_cannot_say_of_a_command_counts_as_answered():
    with open_implementation(command("cannot_say"), LIMITS) as it:
        answered = it.classify(rows())
    assert answered.answered.all()
    assert set(answered.answers.tolist()) == {2}


def test_a_command_that_never_writes_a_number_is_given_up_after_all_restarts():
    with open_implementation(command("without_number"), LIMITS) as it:
        answered = it.classify(rows())
        assert restarts_of(it) == LIMITS.restarts
    assert answered.count(Outcome.PROTOCOL) == LIMITS.restarts + 1
    assert answered.count(Outcome.NOT_RUN) == len(rows()) - LIMITS.restarts - 1
    assert re.search("not asked: 6 restarts are used up; the last process: it wrote '-?1'", answered.reasons[39])
    assert sorted(answered.reasons) == list(range(40))


def test_a_command_that_never_answers_is_given_up_after_three_timeouts():
    """One of all rows, and one each of the first two."""
    with open_implementation(command("hangs"), QUICK) as it:
        answered = it.classify(rows())
        assert restarts_of(it) == 2
    assert answered.status.tolist() == [Outcome.TIMEOUT] * 2 + [Outcome.NOT_RUN] * 38
    assert answered.reasons[39].startswith(
        "not asked: it hung on 3 questions in a row and never answered any; the last: no reply within 0.7 s"
    )


@pytest.mark.thorough
def test_a_command_that_answered_once_may_time_out_as_often_as_restarts_allow():
    some = rows()
    some[1:5, 1] = 13.0
    with open_implementation(command("loops"), QUICK) as it:
        answered = it.classify(some[:10])
    assert answered.status.tolist() == [Outcome.ANSWERED] + [Outcome.TIMEOUT] * 4 + [Outcome.ANSWERED] * 5


def test_a_command_without_restarts_gets_no_rows_after_the_first_row_that_fails():
    with open_implementation(command("segfaults"), Limits(restarts=0)) as it:
        answered = it.classify(rows())
    expected = [Outcome.ANSWERED] * UNLUCKY + [Outcome.CRASH] + [Outcome.NOT_RUN] * (39 - UNLUCKY)
    assert answered.status.tolist() == expected
    assert answered.reasons[UNLUCKY].startswith("it was ended by SIGSEGV")


def test_a_crash_that_only_several_rows_together_cause_is_reported():
    some = rows()
    with open_implementation(command("dies_of_two"), LIMITS) as it:
        answered = it.classify(some)
    assert answered.status.tolist() == [Outcome.CRASH] + [Outcome.ANSWERED] * 39
    assert "in a question of 40 rows from this one on, though not in smaller ones" in answered.reasons[0]
    assert answered.answers[1:].tolist() == truth(some)[1:].tolist()


def test_a_command_that_ends_after_one_question_fails_at_the_second():
    with open_implementation(command("one_row_each"), LIMITS) as it:
        answered = it.classify(rows(10, lucky=True), batch=1)
    assert answered.status[0] == Outcome.ANSWERED
    assert "ended by itself with exit status 0" in answered.reasons[1]


def test_a_command_whose_description_changes_after_a_restart_is_given_up():
    with open_implementation(command("changes_its_mind"), LIMITS) as it:
        answered = it.classify(rows())
    assert answered.count(Outcome.CRASH) == 1
    assert answered.count(Outcome.NOT_RUN) == 39
    assert answered.reasons[39] == "not asked: started again, it describes itself otherwise than before"


def test_a_command_whose_state_changes_its_answers_is_not_restarted_to_repair_them():
    """A restart is a new process: what was counted in the old one is gone."""
    some = rows()
    with open_implementation(command("stateful"), LIMITS) as it:
        first = it.classify(some, batch=40)
        assert first.answers.tolist() == truth(some).tolist()
        it.classify(some, batch=20)
        assert it.classify(some).answers.tolist() == (-truth(some)).tolist()
        it.close()
        assert it.classify(some).answers.tolist() == truth(some).tolist()
        assert restarts_of(it) == 0


def test_answers_that_depend_on_the_batch_size_reach_the_caller_unchanged():
    some = rows()
    with open_implementation(command("minds_batch_size"), LIMITS) as it:
        assert it.classify(some, batch=1).answers.tolist() == truth(some).tolist()
        wrong = np.flatnonzero(it.classify(some, batch=8).answers != truth(some))
    assert wrong.tolist() == [7, 15, 23, 31, 39]


BAD_DESCRIPTIONS = [
    ("gate 1.0 ready", "its first line is not a description: the description is 'gate 1.0 ready'; it must be JSON"),
    ('{"protocol":1,"name":"x",', "it must be JSON"),
    ('{"protocol":1,"name":"x","name":"y"}', "duplicate key 'name'"),
    ('\ufeff{"protocol":1,"name":"x"}', "it must be JSON"),
    ("[1, 2]", r"the description is \[1, 2\]; it must be an object with protocol, name"),
    ('{"name":"x"}', "the description has no protocol; it must be 1, the only version"),
    ('{"protocol":1}', "the description has no name; it must be a text that is not empty"),
    ('{"protocol":1,"name":" "}', "the description's name is ' '; it must be a text that is not empty"),
    ('{"protocol":2,"name":"x"}', "the description's protocol is 2; it must be 1"),
    (
        '{"protocol":1,"name":"x","presicion":"float32"}',
        "has the key 'presicion', which is not known; did you mean precision",
    ),
    ('{"protocol":1,"name":"x","precision":"double"}', "precision is 'double'; it must be one of float16"),
    ('{"protocol":1,"name":"x","binary":1}', "binary is 1; it must be true or false"),
    ('{"protocol":1,"name":"x","domain":{"ratio":[2,1]}}', r"ratio is \[2.0, 1.0\]"),
    ("[" * 60_000, "it must be JSON"),
    ("", "it must be JSON"),
]


@pytest.mark.parametrize(("line", "sentence"), BAD_DESCRIPTIONS, ids=range(len(BAD_DESCRIPTIONS)))
def test_a_command_with_an_invalid_description_is_refused_at_its_start(line, sentence):
    with pytest.raises(StartError, match=sentence) as caught:
        open_implementation(command("describes", line), LIMITS)
    assert caught.value.exit_code == 5
    assert str(caught.value).startswith("command:")
    assert str(caught.value).isprintable()


def test_a_command_without_a_description_is_refused_with_its_standard_error():
    for way in ("nothing", "drip"):
        with pytest.raises(StartError, match=r"no description came within 0\.5 s; stderr: loading tables"):
            open_implementation(command("never_describes", way), Limits(startup_timeout=0.5))
    with pytest.raises(StartError, match="first line does not end within 65536 bytes"):
        open_implementation(command("never_describes", "flood"), LIMITS)
    with pytest.raises(StartError, match="exit status 1 before it described itself; stderr: Error: Unable to access"):
        open_implementation(command("dies_at_start"), LIMITS)


def test_a_command_that_the_system_cannot_run_is_refused_with_the_reason(tmp_path):
    script = tmp_path / "no interpreter"
    script.write_text("#!/no/such/interpreter\n")
    plain = tmp_path / "plain"
    plain.write_bytes(b"\x7fELF and no more")
    with pytest.raises(StartError, match="'no-such-program' was not found; it must be on the PATH"):
        open_implementation("command:no-such-program --gate")
    with pytest.raises(StartError, match="is not executable"):
        open_implementation(f"command:'{script}'")
    for path in (script, plain):
        path.chmod(0o755)
    with pytest.raises(StartError, match=r"interpreter .* was not found"):
        open_implementation(f"command:'{script}'")
    with pytest.raises(StartError, match="not a program for this machine"):
        open_implementation(f"command:'{plain}'")


def test_a_command_is_run_in_the_working_directory_of_the_caller_without_a_shell(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    line = '{"protocol":1,"name":"$HOME; touch made"}'
    program = command("describes", line).replace(";", ";")
    with open_implementation(program, LIMITS) as it:
        assert it.description.name == "$HOME; touch made"
    assert list(tmp_path.iterdir()) == []


def test_a_command_is_timed_by_its_own_clock_and_checked_by_its_checksum():
    some = rows(lucky=True)
    with open_implementation(command("right", "binary"), LIMITS) as it:
        assert it.time(some, 5) == 5000
    with open_implementation(command("right"), LIMITS) as it:
        assert it.time(some, 5) is None
    with (
        open_implementation(command("miscounts_time"), LIMITS) as it,
        pytest.raises(TimingError, match="timed with the checksum 40, but its answers sum to"),
    ):
        it.time(some, 1)


@pytest.mark.parametrize("form", ["true", "false"])
def test_a_compiled_command_answers_large_batches(form, tmp_path):
    program = compiled("command", tmp_path / "sign", f"-DBINARY={form}")
    some = rows(1 << 18 if form == "true" else 1 << 14)
    with open_implementation(f"command:{program}") as it:
        assert it.classify(some).answers.tolist() == signs(some).tolist()


def test_a_command_that_replies_before_it_has_read_all_rows_breaks_the_protocol():
    """Seen where a question is more than a pipe holds; after an error the rest would be taken for questions."""
    some = rows(2048)
    with open_implementation(command("hasty"), Limits(restarts=0)) as it:
        assert "it replied before it had read the rows" in it.classify(some, batch=2048).reasons[0]
    with open_implementation(command("hasty", "error"), Limits(restarts=0)) as it:
        answered = it.classify(some, batch=2048)
    # Its error is read, unless it has left by the time the rest of the rows is written to it; the row that it did not
    # read ends it, as a question that it does not understand.
    asked = answered.status.tolist().index(Outcome.NOT_RUN)
    assert set(answered.status[:asked].tolist()) <= {Outcome.ERROR, Outcome.CRASH}
    assert asked <= 2
    assert set(answered.status[asked:].tolist()) == {Outcome.NOT_RUN}


def test_the_row_on_which_the_sample_commands_fail_is_valid():
    assert truth(rows())[UNLUCKY] in {-1, 0, 1}
    assert set(truth(rows()).tolist()) == {-1, 0, 1}
