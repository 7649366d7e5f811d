"""Output for GitHub Actions: annotations that foreign text cannot end, and a step summary that is never too large."""

from __future__ import annotations

import json
import re
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.cli.main import main
from hypcheck.report import code_hosts, markdown
from tests.report import record_samples
from tests.support.without_drawing import draw_nothing

ANNOTATION = re.compile(r"::error title=([^,:\r\n]*)::([^\r\n]*)")


def failing(number, text="not proved"):
    """A record with that many failed proofs."""
    proof = {"type": "proof", "formula": "f", "quantity": "q", "holds": False, "statement": text}
    return record_samples.record([proof] * number, exit_code=6)


def unescaped(text):
    """As the runner reads data and properties."""
    for code, character in (("%0D", "\r"), ("%0A", "\n"), ("%3A", ":"), ("%2C", ","), ("%25", "%")):
        text = text.replace(code, character)
    return text


@pytest.mark.parametrize("number", [0, 1, 9, 10, 11, 500])
def test_github_gets_at_most_ten_annotations(number):
    lines = code_hosts.error_lines(failing(number))
    assert len(lines) == min(number, 10)
    if number > 10:
        assert f"and {number - 9} more failures" in lines[-1]
    assert all(ANNOTATION.fullmatch(line) for line in lines)


@given(record_samples.FOREIGN, record_samples.FOREIGN)
def test_foreign_text_cannot_end_an_annotation(name, text):
    body = [{"type": "implementation", "spec": name, "name": name, "started": False, "trouble": text}]
    (line,) = code_hosts.error_lines(record_samples.record(body, exit_code=5))
    title, message = ANNOTATION.fullmatch(line).groups()
    assert unescaped(title).startswith("hypcheck: ")
    assert unescaped(message).isprintable()


def test_annotations_are_escaped_as_the_github_runner_reads_them():
    body = [{"type": "implementation", "spec": "s", "name": "a,b:c%0A", "started": False, "trouble": "1:2,3%25"}]
    (line,) = code_hosts.error_lines(record_samples.record(body, exit_code=5))
    assert line == "::error title=hypcheck%3A a%2Cb%3Ac%250A%2C start::1:2,3%2525"


def test_the_replay_command_has_a_separate_line_in_an_annotation():
    case = record_samples.worst("ring/1/1/7", "wrong", 3.1e6)
    group = record_samples.group(
        "m", "float64", "ring", {"wrong": 1}, [case], spec="command:a b", failing=["wrong"], faults=[]
    )
    (line,) = code_hosts.error_lines(record_samples.record([group], exit_code=1))
    assert line.endswith("%0Areplay: hypcheck replay ring/1/1/7 'command:a b'")


@given(st.lists(st.text("ab\n", max_size=30), min_size=1, max_size=30), st.integers(-5, 400))
def test_step_summary_is_cut_only_at_the_end_of_a_line(texts, room):
    report = ("\n".join(texts) + "\n").encode()
    cut = code_hosts.fitting(report, room)
    assert len(cut) <= max(room, 0)
    if len(report) <= room:
        assert cut == report
    elif cut:
        kept, _, note = cut.partition(b"\n*Cut here")
        assert note
        assert report.startswith(kept)
        assert kept.endswith(b"\n")


def test_a_step_summary_of_more_than_a_mebibyte_is_cut_with_a_note(tmp_path):
    path = tmp_path / "summary.md"
    path.write_bytes(b"of an earlier command\n")
    record = record_samples.record(
        [record_samples.finding(f"f{n}", "ring", inside=True, reason=f"{n} " * 40) for n in range(6000)]
    )
    assert len(markdown.render(record)) > 1 << 20
    assert code_hosts.append_summary(record, path) is None
    written = path.read_bytes()
    assert written.startswith(b"of an earlier command\n# hypcheck verify\n")
    assert written.endswith(b"report.md has the rest.*\n")
    assert (1 << 20) - 2000 < len(written) < 1 << 20
    assert code_hosts.append_summary(record, path) is None
    assert path.stat().st_size < 1 << 20


def test_a_step_summary_that_cannot_be_written_is_reported_and_fails_no_run(tmp_path):
    assert "no step summary" in code_hosts.append_summary(record_samples.record(), tmp_path)


def run(monkeypatch, tmp_path, capsys, *words, on=True):
    monkeypatch.setenv("GITHUB_ACTIONS", "true" if on else "false")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(tmp_path / "summary.md"))
    code = main(["verify", *words, "--families", "ring", "--count", "3", "--out", str(tmp_path / "out")])
    return code, capsys.readouterr().out.splitlines()


def test_a_run_reports_a_step_summary_that_cannot_be_written_and_keeps_its_exit_code(monkeypatch, tmp_path, capsys):
    (tmp_path / "summary.md").mkdir()
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(tmp_path / "summary.md"))
    draw_nothing(monkeypatch)
    assert main(["verify", "builtin:fast", "--families", "ring", "--count", "3", "--out", str(tmp_path / "out")]) == 0
    assert capsys.readouterr().err.splitlines()[-1].startswith("hypcheck: no step summary")


def test_a_failing_run_on_github_prints_annotations_and_writes_the_step_summary(monkeypatch, tmp_path, capsys):
    code, lines = run(monkeypatch, tmp_path, capsys, "builtin:table-2-float64")
    assert code == 1
    stop, *rest = lines
    token = stop.removeprefix("::stop-commands::")
    assert re.fullmatch("[0-9a-f]{32}", token)
    end = rest.index(f"::{token}::")
    assert any(" wrong of " in line for line in rest[:end])
    assert [line.startswith("::error title=hypcheck%3A table-2-float64%2C ring::") for line in rest[end + 1 :]] == [
        True
    ]
    assert (tmp_path / "summary.md").read_bytes() == (tmp_path / "out" / "report.md").read_bytes()


def test_a_run_outside_github_prints_no_annotations(monkeypatch, tmp_path, capsys):
    code, lines = run(monkeypatch, tmp_path, capsys, "builtin:table-2-float64", on=False)
    assert code == 1
    assert not [line for line in lines if line.startswith("::")]
    assert not (tmp_path / "summary.md").exists()


def test_workflow_commands_in_foreign_text_are_suspended(monkeypatch, tmp_path, capsys):
    """What a crashed program wrote on standard error is quoted in the summary; the runner must not obey it."""
    program = "import sys; print('::add-mask::a\\n##[error]b', file=sys.stderr); sys.exit(3)"
    spec = f"command:{json.dumps([sys.executable, '-c', program])}"
    code, lines = run(monkeypatch, tmp_path, capsys, spec)
    assert code == 5
    inside = lines[1 : lines.index(lines[0].replace("::stop-commands::", "::") + "::")]
    assert any("add-mask" in line for line in inside)
    (annotation,) = lines[len(inside) + 2 :]
    assert ANNOTATION.fullmatch(annotation)


def test_on_github_is_true_only_if_github_actions_is_true_in_the_environment():
    assert code_hosts.on_github({"GITHUB_ACTIONS": "true"})
    assert not code_hosts.on_github({"GITHUB_ACTIONS": "1"})
    assert not code_hosts.on_github({})
