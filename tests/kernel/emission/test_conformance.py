"""Emitted kernels in conformance runs, as users run them: `hypcheck emit`, a compiler, `hypcheck verify`."""

from __future__ import annotations

import json
import shutil
import subprocess

import pytest

from hypcheck.cli.main import main
from hypcheck.vectors import fixed_sizes
from tests.kernel.emission.building import COMMANDS, skip_without

pytestmark = pytest.mark.usefixtures("text_reports")


def emit(path, language, *options, scene="tower"):
    assert main(["emit", "--scene", scene, "--language", language, "--output", str(path), *options]) == 0


def gated(folder, spec, count=60):
    """What verify says of it, and how it ended; each setting has its own families, of so many cases."""
    code = main(["verify", spec, "--out", str(folder / "out"), "--count", str(count)])
    summary = json.loads((folder / "out" / "summary.json").read_text(encoding="utf-8"))
    return code, summary["implementations"][0]


@pytest.mark.parametrize(
    ("language", "precision", "scene"),
    [("c", "float64", "forest"), ("cpp", "float32", "tower"), ("rust", "float64", "tower-simplest")],
)
def test_an_emitted_library_passes_the_conformance_run(language, precision, scene, tmp_path, capsys, monkeypatch):
    skip_without(language)
    if scene == "forest":  # of 58 settings; test_scenes.py asks its kernel the rows that are searched for each
        monkeypatch.delitem(fixed_sizes.TRAPS, "razor")
    code, library = tmp_path / "kernel.source", tmp_path / "kernel.so"
    emit(code, language, "--precision", precision, scene=scene)
    kind = {"c": ["-x", "c"], "cpp": ["-x", "c++"], "rust": []}[language]
    end = ["-lm"] if language == "c" else []
    subprocess.run([*COMMANDS[language], *kind, str(code), *end, "-o", str(library)], check=True)
    ended, found = gated(tmp_path, f"library:{library}", 3 if scene == "forest" else 60)
    assert ended == 0, capsys.readouterr()
    assert found["asked"] > 600
    assert found["worst_backward_error_u"] <= 8


def test_an_emitted_python_kernel_passes_the_conformance_run(tmp_path):
    emit(tmp_path / "kernel.py", "python")
    ended, found = gated(tmp_path, f"python:{tmp_path / 'kernel.py'}:classify")
    assert (ended, found["precision"]) == (0, "float64")
    assert found["asked"] > 600


def test_an_emitted_javascript_kernel_can_replace_a_users_predicate(tmp_path):
    skip_without("javascript")
    assert main(["init", "--language", "javascript", "--directory", str(tmp_path)]) == 0
    (adapter,) = tmp_path.rglob("adapter.mjs")
    emit(adapter.with_name("predicate.mjs"), "javascript", "--precision", "float32")
    ended, found = gated(tmp_path, f"command:{json.dumps([shutil.which('node'), str(adapter)])}")
    assert (ended, found["precision"]) == (0, "float32")
    assert found["asked"] > 600


def test_a_wrong_emitted_kernel_fails_the_conformance_run(tmp_path, capsys):
    """The families of its own sizes judge it: a line moved inward by a millionth claims what touches."""
    emit(tmp_path / "kernel.py", "python", "--question", "position")
    text = (tmp_path / "kernel.py").read_text(encoding="utf-8")
    (line,) = [line for line in text.splitlines() if line.strip().startswith("intercept_1 = ")][:1]
    name, _, value = line.partition(" = ")
    spoiled = text.replace(line, f"{name} = {float(value) * (1 - 1e-6)!r}", 1)
    assert spoiled != text
    (tmp_path / "kernel.py").write_text(spoiled, encoding="utf-8")
    ended, found = gated(tmp_path, f"python:{tmp_path / 'kernel.py'}:classify")
    assert ended == 1
    assert found["wrong"] > 0


def test_emit_writes_the_same_text_to_standard_output_and_to_a_file(tmp_path, capsysbinary):
    emit(tmp_path / "kernel.c", "c")
    assert main(["emit", "--scene", "tower", "--language", "c"]) == 0
    assert capsysbinary.readouterr().out == (tmp_path / "kernel.c").read_bytes()
