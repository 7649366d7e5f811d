"""The adapters of `hypcheck init --question passage`: each language answers about sweeps as the stub in Python does."""

from __future__ import annotations

import runpy
import shutil
import subprocess

import numpy as np
import pytest
from click.testing import CliRunner

from hypcheck.cli.setup import init
from hypcheck.geometry.rows import SWEEPS, with_axis
from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.session import Limits
from hypcheck.scaffold.project import LANGUAGES, STUBS, Project
from hypcheck.vectors.families import SWEEP_FAMILIES
from tests.scaffold.test_adapters import TOOLS

SWITCHES = {
    "javascript": ("binary: true", "times: true, tilt: true, binary: true"),
    "python": ('"question": "passage"', '"times": True, "tilt": True, "question": "passage"'),
    "go": ('"binary":true', '"times":true,"tilt":true,"binary":true'),
    "rust": ('"binary":true', '"times":true,"tilt":true,"binary":true'),
    "cpp": ('"binary":true', '"times":true,"tilt":true,"binary":true'),
}
ESCAPED = (r"\"binary\":true", r"\"times\":true,\"tilt\":true,\"binary\":true")
"""What to change in the description to be asked about times and axes."""


@pytest.fixture(scope="module")
def rows():
    return np.concatenate([SWEEP_FAMILIES[name].rows(1, 300) for name in ("way-anywhere", "way-tunnelling")])


@pytest.fixture(scope="module")
def expected(rows, tmp_path_factory):
    """Hits and times of the stub in Python, which is read here and run in this process."""
    path = tmp_path_factory.mktemp("stub") / "predicate.py"
    path.write_text(Project(LANGUAGES["python"], "stub", "passage").files()["hypcheck-python/predicate.py"])
    stub = runpy.run_path(str(path))
    stub["hypcheck"]["times"] = True
    hits, times = stub["classify"](rows)
    assert 0.5 < hits.mean() < 0.99
    return hits, times


def built(project):
    done = subprocess.run(["/bin/sh", "-c", project.build], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("name", LANGUAGES)
def test_generated_adapter_for_sweeps_passes_on_answers_times_and_axes_of_its_stub(
    name, rows, expected, tmp_path, monkeypatch
):
    if missing := [tool for tool in TOOLS[name] if shutil.which(tool) is None]:
        pytest.skip(f"{missing[0]} is not on the PATH")
    monkeypatch.chdir(tmp_path)
    assert CliRunner().invoke(init, ["--language", name, "--question", "passage", "--name", "stub"]).exit_code == 0
    project = Project(LANGUAGES[name], "stub", "passage")
    built(project)
    hits, times = expected
    with open_implementation(project.language.spec, Limits(restarts=0)) as it:
        assert (it.declared.question, it.declared.times, it.declared.tilt) == ("passage", False, False)
        for batch in (None, 65536, 7):
            answered = it.classify(rows, batch=batch)
            assert answered.answers.tolist() == hits.tolist(), answered.reasons
        assert it.time(rows, 2)
    stub = tmp_path / project.predicate
    before, after = SWITCHES.get(name, ESCAPED)
    text = stub.read_text()
    assert text.count(before) == 1
    stub.write_text(text.replace(before, after))
    built(project)
    with open_implementation(project.language.spec, Limits(restarts=0)) as it:
        assert (it.declared.times, it.declared.tilt) == (True, True)
        answered = it.classify(with_axis(rows, SWEEPS))
    assert answered.answers.tolist() == hits.tolist(), answered.reasons
    np.testing.assert_array_equal(answered.times, times)
    if name != "python":
        said = b"classify 7 2 passage-text\n1 1 1 1 3 0 0 0 0 0 0 0 1\n1 1 1 1 3 0 0 2 0 0 0 0 1\nclassify 8 1 text\n"
        words = project.language.spec.removeprefix("command:")
        told = subprocess.run(["/bin/sh", "-c", words], input=said, capture_output=True, check=True).stdout
        lines = told.splitlines()[1:]
        assert (lines[0], lines[2], lines[3]) == (b"7 2", b"0", b"error the question is not understood")
        assert float(lines[1].removeprefix(b"1 ")) == 2 / 3


def test_stub_about_positions_is_written_by_default_and_the_one_about_sweeps_on_request():
    assert STUBS == ("position", "passage")
    for language in LANGUAGES.values():
        written = Project(language, "x", "passage").files()
        assert set(written) == set(Project(language, "x").files())
        stub = written[f"{language.folder}/{language.predicate}"]
        assert "passage" in stub
        assert "exterior" not in stub
