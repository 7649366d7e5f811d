"""The adapters that `hypcheck init` writes: each is built by the printed command, asked, and gated."""

from __future__ import annotations

import json
import os
import platform
import re
import shlex
import shutil
import subprocess
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.implementations.builtin import builtin
from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.session import Limits
from hypcheck.scaffold.project import LANGUAGES, Language, Project
from hypcheck.vectors.families import FAMILIES
from tests.support.inside import EMITTED_LANGUAGES
from tests.support.without_drawing import COMMAND
from tests.tools.miniatures import restarts_of

TOOLS = {
    "c": ("cc",),
    "cpp": ("c++",),
    "rust": ("cargo", "rustc"),
    "go": ("go",),
    "java": ("javac", "java"),
    "javascript": ("node",),
    "python": ("python3",),
}
COMMANDS = [name for name, language in LANGUAGES.items() if language.spec.startswith("command:")]
ASKED = [*FAMILIES]
"""Families to ask: hard ones, where the last bit decides, and extreme ones, where squares overflow."""

PROTOCOL = Path(__file__).parents[2] / "docs" / "protocol.md"


ANSWERS = {
    "c": ("c1 > 0;", "c1 > 0 ? 1 : -1;"),
    "cpp": ("c1 > 0;", "c1 > 0 ? 1 : -1;"),
    "rust": ("(delta > 0.0 && c2 < 0.0 && c1 > 0.0) as i8", "if delta > 0.0 && c2 < 0.0 && c1 > 0.0 { 1 } else { -1 }"),
    "go": ("return 0", "return -1"),
    "java": ("? 1 : 0", "? 1 : -1"),
    "javascript": ("? 1 : 0", "? 1 : -1"),
    "python": ("return np.asarray(", "return -1 + 2 * np.asarray("),
}
"""The changes for a predicate that answers +1 and −1 in place of 1 and 0."""


_ESCAPED = (r"\"binary\":true", r"\"tilt\":true,\"binary\":true")
_PLAIN = ('"binary":true', '"tilt":true,"binary":true')
_CALL = "return predicate(alpha, gamma, b, d, x, y, z)"
_C = (f"(void)axis_x, (void)axis_y, (void)axis_z;\n    {_CALL};", "return alpha + axis_x < axis_y && axis_y < axis_z;")
_TERNARY = "return alpha + axisX < axisY && axisY < axisZ ? 1 : 0"
SWITCHED = {
    "c": (_ESCAPED, (f"{_C[0]}\n", f"(void)gamma, (void)b, (void)d, (void)x, (void)y, (void)z;\n    {_C[1]}\n")),
    "cpp": (_PLAIN, (f"{_C[0]}\n", f"(void)gamma, (void)b, (void)d, (void)x, (void)y, (void)z;\n    {_C[1]}\n")),
    "rust": (
        _PLAIN,
        (
            "{\n    predicate([alpha, gamma, b, d, x, y, z])",
            ("{\n    let _ = (gamma, b, d, x, y, z);\n    (alpha + _axis_x < _axis_y && _axis_y < _axis_z) as i8"),
        ),
    ),
    "go": (_PLAIN, (_CALL, "if alpha+axisX < axisY && axisY < axisZ {\n\t\treturn 1\n\t}\n\treturn 2 - 2")),
    "java": (_ESCAPED, (_CALL, _TERNARY)),
    "javascript": (("binary: true", "tilt: true, binary: true"), (_CALL, _TERNARY)),
    "python": (
        ('"question": "exterior"', '"tilt": True, "question": "exterior"'),
        (
            "return predicate(*columns[:7])",
            ("x, y, z = columns[7:]\n    return np.asarray((columns[0] + x < y) & (y < z), dtype=np.int8)"),
        ),
    ),
}
"""What to change to be asked about tilted spheroids, and for a predicate that reads the axis."""


def asked(spec):
    """The implementation: any fault would cost a restart, and none is forgiven."""
    return open_implementation(spec, Limits(restarts=0))


@dataclass(frozen=True)
class Built:
    """A project that was written and built; `typed` are the commands that init printed."""

    language: Language
    folder: Path
    typed: list[str]
    environment: dict[str, str]

    def run(self, command: str) -> subprocess.CompletedProcess[str]:
        """A command line as a user's shell runs it."""
        words = ["/bin/sh", "-c", command]
        return subprocess.run(words, cwd=self.folder, env=self.environment, capture_output=True, text=True, check=False)

    def talk(self, spec: str, said: bytes) -> bytes:
        """What the command replies to that, until it leaves by itself once its input ends."""
        words = shlex.split(spec.removeprefix("command:"))
        done = subprocess.run(words, cwd=self.folder, input=said, capture_output=True, check=False, timeout=60)
        assert done.returncode == 0, done.stderr
        assert done.stderr == b""
        return done.stdout


@pytest.fixture(scope="session", params=LANGUAGES)
def built(request, tmp_path_factory):
    """The project of one language, in a repository that has workspaces and modules of its own."""
    name = request.param
    missing = [tool for tool in TOOLS[name] if shutil.which(tool) is None]
    if missing:
        pytest.skip(f"{missing[0]} is not on the PATH")
    folder = tmp_path_factory.mktemp("engine")
    programs = tmp_path_factory.mktemp("bin")
    (folder / "Cargo.toml").write_text("[workspace]\nmembers = []\n")
    (folder / "go.work").write_text("go 1.20\n")
    (folder / "package.json").write_text('{"type": "commonjs"}\n')
    (programs / "hypcheck").write_text(f'#!/bin/sh\nexec {shlex.join(COMMAND)} "$@"\n')
    (programs / "hypcheck").chmod(0o755)
    environment = {**os.environ, "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}"}
    project = Built(LANGUAGES[name], folder, [], environment)
    done = project.run(f"hypcheck init --language {name} --name stub")
    assert done.returncode == 0, done.stderr
    project.typed.extend(line.strip() for line in done.stdout.splitlines() if line.startswith("    "))
    done = project.run(project.typed[0])
    assert done.returncode == 0, done.stderr
    return project


@pytest.fixture
def spec(built, monkeypatch):
    """The SPEC of the built project, where the caller stands in its folder."""
    monkeypatch.chdir(built.folder)
    return built.language.spec


commands = pytest.mark.parametrize("built", COMMANDS, indirect=True)


@pytest.fixture(scope="module")
def rows():
    return np.concatenate([FAMILIES[name].rows(1, 300) for name in ASKED])


@pytest.fixture(scope="module")
def expected(rows):
    """What Table 2 answers in float64, evaluated from the program that the derivation proves."""
    answers = builtin("table-2-float64").answer(rows)
    assert 0.1 < answers.mean() < 0.9
    return answers


def test_generated_adapter_describes_its_stub_implementation(built, spec):
    with asked(spec) as it:
        declared = it.declared
    assert (declared.name, declared.precision, declared.question) == ("stub", "float64", "exterior")
    assert declared.domain.regimes == ("c2>=a",)
    assert not declared.refuses
    if spec.startswith("command:"):
        assert declared.binary
        assert declared.time
        assert declared.language.replace("c++", "cpp") == built.language.name


def test_generated_adapter_answers_exactly_as_table_2(built, spec, rows, expected):
    with asked(spec) as it:
        for batch in (None, 65536, 4097, 1):
            some = slice(0, 200 if batch == 1 else None)
            answered = it.classify(rows[some], batch=batch)
            assert answered.answered.all(), answered.reasons
            assert np.flatnonzero(answered.answers != expected[some]).tolist() == []
        assert restarts_of(it) == 0


def test_generated_adapter_answers_a_batch_of_the_largest_size(built, spec):
    many = FAMILIES["uniform"].rows(3, 65536)
    with asked(spec) as it:
        answered = it.classify(many, batch=65536)
    assert answered.answers.tolist() == builtin("table-2-float64").answer(many).tolist()


def test_generated_adapter_reports_times_that_grow_with_repetitions(built, spec, rows):
    with asked(spec) as it:
        once, often = (it.time(rows, repeat) for repeat in (1, 50))
    assert once is not None
    assert often is not None
    assert 0 < once
    assert 50 * 1000 < often < 60e9


@commands
def test_generated_adapter_reads_decimal_numbers_exactly(built, spec, rows, expected):
    """Through the runner: a filter keeps the adapter from offering the binary form."""
    text_only = """exec "$0" "$@" | sed -u '1s/"binary":true/"binary":false/'"""
    words = ["sh", "-c", text_only, *shlex.split(spec.removeprefix("command:"))]
    with asked("command:" + json.dumps(words)) as it:
        assert not it.description.binary
        answered = it.classify(rows)
        assert answered.answered.all(), answered.reasons
    assert np.flatnonzero(answered.answers != expected).tolist() == []


def test_generated_adapter_works_with_another_predicate_in_place_of_the_stub(
    built, rows, expected, tmp_path, monkeypatch
):
    """One that answers -1 too, which bytes and signs must carry."""
    other = replace(built, folder=tmp_path / "other")
    shutil.copytree(built.folder, other.folder)
    monkeypatch.chdir(other.folder)
    path = other.folder / built.language.folder / built.language.predicate
    stub = path.read_text()
    before, after = ANSWERS[built.language.name]
    assert stub.count(before) == 1
    changed, count = re.subn(r"(question\W+)exterior", r"\1position", stub.replace(before, after))
    assert count == 1
    path.write_text(changed)
    assert other.run(built.typed[0]).returncode == 0
    with asked(built.language.spec) as it:
        assert it.declared.question == "position"
        assert it.classify(rows).answers.tolist() == (2 * expected - 1).tolist()
        assert it.time(rows, 2)
    if built.language.name in COMMANDS:
        said = b"classify 1 2 text\n1 2 1 1 4 0 0\n1 2 1 1 1.5 0 0\n"
        assert other.talk(built.language.spec, said).partition(b"\n")[2] == b"1 2\n1\n-1\n"


def test_generated_adapter_that_declares_tilt_passes_ten_numbers_a_row_to_its_predicate(
    built, rows, expected, tmp_path, monkeypatch
):
    """The stub answers as if each spheroid stood upright; a predicate in its place gets all ten numbers in order."""
    axes = np.random.default_rng(5).standard_normal((len(rows), 3)) * 10
    axes[::7] *= 1e300
    axes[3::7, 0] = 5e-324
    tilted = np.column_stack([rows, axes])
    other = replace(built, folder=tmp_path / "tilted")
    shutil.copytree(built.folder, other.folder)
    monkeypatch.chdir(other.folder)
    path = other.folder / built.language.folder / built.language.predicate
    for turn, (before, after) in enumerate(SWITCHED[built.language.name]):
        stub = path.read_text()
        assert stub.count(before) == 1
        path.write_text(stub.replace(before, after))
        assert other.run(built.typed[0]).returncode == 0
        ordered = (tilted[:, 0] + tilted[:, 7] < tilted[:, 8]) & (tilted[:, 8] < tilted[:, 9])
        with asked(built.language.spec) as it:
            assert it.declared.tilt
            assert it.classify(tilted).answers.tolist() == (ordered if turn else expected).astype(int).tolist()
            assert it.time(tilted[:100], 2)
            if not turn:
                assert it.classify(rows[:100]).answers.tolist() == expected[:100].tolist()
    if built.language.name in COMMANDS:
        said = b"classify 1 2 tilted-text\n1 2 1 1 4 0 0 0 2 3\n1 2 1 1 4 0 0 0 3 2\n" + b"classify 2 1 text\n"
        replies = other.talk(built.language.spec, said).partition(b"\n")[2]
        assert re.fullmatch(rb"1 2\n1\n0\nerror [ -~]+\n", replies)


NONSENSE = [
    b"", b"hello", b"classify", b"classify 1", b"classify 1 2", b"classify 1 1 base64", b"classify 1 1 text now",
    b"classify x 1 text", b"classify -1 1 text", b"classify 1 x text", b"classify 1 -1 text", b"classify 1 1.5 text",
    b"classify 1 65537 binary", b"classify 1 99999999999999999999 binary", b"classify 99999999999999999999 1 text",
    b"time 1 1 binary", b"time 1 1 0 binary", b"time 1 1 -1 binary", b"time 1 1 1 text", b"time 1 1 99999999999 binary",
    b"x" * 100_000, b"\xff\xfe\x00",
]  # fmt: skip
NO_ROWS = [
    b"", b"1 2 1 1 4 0", b"1 2 1 1 4 0 0 0", b"1 2 1 1 4 0 zero", b"1 2 1 1 4,0 0 0", b"1 2 1 1 4 0 0.0.0",
    b"1 2 1 1 4 0 1e", b"1 2 1 1 4 0 0" + b" " * 2000 + b"1",
]  # fmt: skip
GOOD, ANSWER = b"classify 7 1 text\n1 2 1 1 4 0 0\n", b"7 1\n1\n"


@commands
def test_generated_adapter_replies_error_to_an_invalid_question_or_row_and_answers_the_next(built, spec):
    invalid = [line + b"\n" for line in NONSENSE]
    invalid += [b"classify 1 3 text\n1 2 1 1 4 0 0\n" + row + b"\n1 2 1 1 4 0 0\n" for row in NO_ROWS]
    replies = built.talk(spec, b"".join(each + GOOD for each in invalid)).partition(b"\n")[2]
    assert re.sub(rb"error [ -~]+\n", b"error\n", replies) == (b"error\n" + ANSWER) * len(invalid)


@commands
def test_generated_adapter_reads_nan_and_infinities(built, spec):
    """As rows to be refused are written; the stub answers all of them 0."""
    said = b"classify 1 3 text\nnan 2 1 1 4 0 0\n1 2 1 1 inf 0 0\n1 2 1 1 -inf 0 -0.0\n"
    assert built.talk(spec, said + GOOD).partition(b"\n")[2] == b"1 3\n0\n0\n0\n" + ANSWER


@commands
def test_generated_adapter_replies_to_a_question_without_rows_with_no_answers(built, spec):
    said = b"classify 1 0 text\nclassify 2 0 binary\n" + GOOD
    assert built.talk(spec, said).partition(b"\n")[2] == b"1 0\n2 0\n" + ANSWER


@commands
@pytest.mark.parametrize("left", [b"classify 1", b"classify 1 2 text\n1 2 1 1 4 0 0\n", b"classify 1 2 binary\n1234"])
def test_generated_adapter_exits_quietly_wherever_its_input_ends(built, spec, left):
    replies = built.talk(spec, GOOD + left).partition(b"\n")[2]
    assert re.fullmatch(re.escape(ANSWER) + rb"(error [ -~]+\n)?", replies)


@commands
def test_example_session_in_docs_protocol_equals_what_the_generated_adapter_replies(built, spec):
    said, shown = [], []
    for line in PROTOCOL.read_text(encoding="utf-8").partition("## Lines")[0].splitlines():
        if line.startswith(("    → ", "    ← ")):
            (said if line[4] == "→" else shown).append(raw(line[6:]))
    heard = built.talk(spec, b"".join(said))
    first, _, replies = heard.partition(b"\n")
    described, expected = json.loads(first), json.loads(shown[0])
    assert described | {"name": expected["name"], "language": expected["language"]} == expected
    assert re.sub(rb"3 \d+ 1\n", b"3 13204 1\n", replies) == b"".join(shown[1:])


def raw(shown: str) -> bytes:
    """The bytes of a line of the page: between brackets words of eight bytes, or answers of one."""
    if not shown.startswith("["):
        return shown.encode() + b"\n"
    return b"".join(bytes.fromhex(word)[::-1] for word in shown.strip("[]").split())


@pytest.mark.parametrize("built", ["c", "cpp"], indirect=True)
def test_generated_predicate_can_be_built_and_verified_alone_as_a_library(built, spec, rows, expected):
    predicate = (built.folder / built.language.folder / built.language.predicate).read_text()
    build, verify = re.findall(r"^(?: \*|//) {5}(.+)$", predicate, flags=re.MULTILINE)
    done = built.run(build)
    assert done.returncode == 0, done.stderr
    with asked(shlex.split(verify)[2]) as it:
        assert it.declared.name == "stub"
        assert it.declared.question == "exterior"
        answered = it.classify(rows)
    assert answered.answered.all()
    assert answered.answers.tolist() == expected.tolist()


def test_generated_stub_passes_on_the_scenes_of_the_paper_and_fails_on_the_ring(built, spec, text_reports):
    _, passes, fails, *_ = (shlex.split(typed) for typed in built.typed)
    assert passes[0] == fails[0] == "hypcheck"
    assert main([*passes[1:], "--out", "passed"]) == 0
    assert main([*fails[1:], "--families", "ring", "--count", "100", "--out", "failed"]) == 1
    passed, failed = (json.loads((built.folder / out / "summary.json").read_text()) for out in ("passed", "failed"))
    assert passed["implementations"][0]["right"] > 800
    assert failed["implementations"][0]["wrong"] > 10
    assert failed["implementations"][0]["name"] == "stub"


@pytest.mark.parametrize("built", [name for name in LANGUAGES if name in EMITTED_LANGUAGES], indirect=True)
def test_the_last_command_that_init_prints_writes_a_predicate_that_passes_the_gate(
    built, tmp_path, monkeypatch, text_reports
):
    other = replace(built, folder=tmp_path / "other")
    shutil.copytree(built.folder, other.folder)
    monkeypatch.chdir(other.folder)
    build, _, gate, emit = built.typed
    for command in (emit, build, f"{gate} --count 0 --families '*'"):
        done = other.run(command)
        assert done.returncode == 0, done.stdout + done.stderr
    assert "HELD: pair, exact" in done.stdout


KERNELS = {
    "certified": ("--method", "certified"),
    "a scene": ("--scene", "tower", "--question", "position"),
    "a whole scene": ("--scene", "tower", "--whole", "--question", "position"),
    "any axis": ("--scene", "tilted.toml"),
}
TILTED = """name = "tilted"
[mover]
b = 0.25
d = 0.15
axis = "free"
[[hyperboloid]]
alpha = 2
gamma = 17.8
[region]
x = [-3, 3]
y = [-3, 3]
z = [-9, 9]
"""


@pytest.mark.parametrize("built", ["c", "cpp", "rust"], indirect=True)
@pytest.mark.parametrize("kernel", KERNELS)
def test_every_kernel_that_emit_writes_fits_the_adapter(built, kernel, tmp_path, monkeypatch):
    other = replace(built, folder=tmp_path / "other")
    shutil.copytree(built.folder, other.folder)
    monkeypatch.chdir(other.folder)
    (other.folder / "tilted.toml").write_text(TILTED)
    path = Path(built.language.folder, built.language.predicate)
    words = ["--language", built.language.name, "--output", str(path)]
    assert main(["emit", *KERNELS[kernel], *words]) == 0
    done = other.run(built.typed[0])
    assert done.returncode == 0, done.stderr
    tilted = kernel == "any axis"
    with asked(built.language.spec) as it:
        assert it.declared.tilt is tilted
        sizes = it.declared.domain.settings[0].sizes if it.declared.domain.settings else (2.0, 17.8, 0.25, 0.15)
        row = [*sizes, 1.1 * sizes[0] + sizes[2], 0.0, 0.0, *([0.3, 0.0, 1.0] if tilted else [])]
        assert it.classify(np.array([row])).answers.tolist() == [1]


@pytest.mark.skipif(platform.system() != "Linux", reason="other linkers ask for both functions")
@pytest.mark.parametrize("built", ["c", "cpp"], indirect=True)
def test_adapter_reports_that_the_predicate_lacks_the_function_that_its_description_requires(built, tmp_path):
    other = replace(built, folder=tmp_path / "other")
    shutil.copytree(built.folder, other.folder)
    path = other.folder / built.language.folder / built.language.predicate
    (before, after), _ = SWITCHED[built.language.name]
    stub = path.read_text().replace(before, after, 1)
    path.write_text(stub[: stub.index("void hypcheck_classify_tilted")])
    assert other.run(f"{built.typed[0]} -w").returncode == 0
    done = other.run(f"./{built.language.folder}/adapter")
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith("the predicate lacks the function that its description asks for, see predicate.h")


def test_git_ignores_the_build_products_of_a_generated_project(built, spec):
    if shutil.which("git") is None:
        pytest.skip("git is not on the PATH")
    project = Project(built.language, "stub")
    built.run("git init --quiet .")
    done = built.run("git status --porcelain --untracked-files=all -- 'hypcheck-*'")
    shown = {line[3:] for line in done.stdout.splitlines()}
    written = {path for path in project.files() if path.startswith("hypcheck-")}
    assert shown - {"hypcheck-rust/Cargo.lock"} == written
