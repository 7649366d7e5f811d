"""The text of a kernel: its head counts the operations of its functions, and linters and type checkers find nothing."""

from __future__ import annotations

import ast
import ctypes
import json
import shutil
import subprocess
import sys
from dataclasses import replace

import pytest

from hypcheck.scene.model import QUESTIONS, Hyperboloid, Mover, Region, SceneModel, Span
from hypcheck.scene.reading import read_scene
from tests.kernel.emission.building import COMMAND, built, skip_without
from tests.support.inside import EMITTED_LANGUAGES, description, emitted, operations_before, plan_of
from tests.support.scenes import HILLS, PLAIN, scene

SCENES = {
    "tower": read_scene("tower"),
    "hills": HILLS,
    "plain": PLAIN,
    "steep": scene((3.0, 1.0, 1.0, 1.0)),
    "tiny, with units of its own": scene((1e-30, 1e-30, 1e-31, 1e-31)),
    "far": scene(x=Span(9.0, 12.0), z=Span(-1.0, 1.0)),
    "stump": SceneModel("s", "position", (Hyperboloid("stump", 1.0, 2.0, height=Span(-1.0, 1.0)),), Mover(0.5, 0.5)),
}
MANY = SceneModel(
    "many", "exterior", tuple(Hyperboloid(f"tree {n}", 0.2 + n / 8, 9.0) for n in range(9)), Mover(0.3, 0.9), Region()
)


def text_of(chosen, language):
    return emitted(plan_of(chosen), language, COMMAND)


def counted(function):
    """Operations by kind in a function's syntax, without the call of the search and what is made of its answer."""
    found = {"additions": 0, "multiplications": 0, "divisions": 0, "comparisons": 0}
    kinds = {ast.Add: "additions", ast.Sub: "additions", ast.Mult: "multiplications", ast.Div: "divisions"}
    for node in ast.walk(function):
        if isinstance(node, ast.BinOp):
            found[kinds[type(node.op)]] += 1
        elif isinstance(node, ast.Compare) and not isinstance(node.left, ast.Call):
            found["comparisons"] += not isinstance(node.left, ast.Name) or node.left.id != "z"
    return found


@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.parametrize("name", SCENES)
def test_operation_counts_that_a_kernel_states_in_its_head_equal_those_counted_in_its_code(name, question):
    """Comparisons of z with a modelled height stand before them all and are not counted."""
    plan = plan_of(replace(SCENES[name], question=question))
    module = ast.parse(emitted(plan, "python", COMMAND))
    functions = {each.name: each for each in module.body if isinstance(each, ast.FunctionDef)}
    for place, stages in enumerate(plan.settings, start=1):
        told = operations_before(stages, question)
        assert counted(functions[f"position_{place}"]) == {
            name: getattr(told, name) for name in ("additions", "multiplications", "divisions", "comparisons")
        }


@pytest.mark.parametrize("language", EMITTED_LANGUAGES)
def test_an_emitted_kernel_of_many_settings_describes_each_at_its_function(language):
    text = text_of(MANY, language)
    head, _, rest = text.partition("CANNOT_SAY")
    assert "There are 9 of these" in head
    assert "tree 3" not in head
    for number in range(9):
        assert rest.count(f"the mover and tree {number}.") == 1
    assert "There are" not in text_of(SCENES["tower"], language)


@pytest.mark.parametrize(("name", "language"), [("tower", "c"), ("forest", "c"), ("forest", "cpp"), ("forest", "rust")])
def test_an_emitted_library_returns_a_description_longer_than_an_iso_c_string(name, language, tmp_path):
    """ISO C has no strings of more than 4095 characters; the forest's description is longer."""
    skip_without(language)
    chosen = read_scene(name)
    quickly = {"rust": ["-C", "opt-level=0"]}.get(language, ["-O0"])
    library = ctypes.CDLL(str(built(tmp_path, chosen, language, "float64", *quickly)))
    library.hypcheck_describe.restype = ctypes.c_char_p
    for _ in range(2):
        assert json.loads(library.hypcheck_describe()) == description(plan_of(chosen), language)


@pytest.mark.parametrize("language", EMITTED_LANGUAGES)
@pytest.mark.parametrize("name", ["tower", "plain"])
def test_lines_of_emitted_kernels_are_short_except_the_description(name, language):
    lines = text_of(SCENES[name], language).splitlines()
    longest = [line for line in lines if len(line) > 120 and "protocol" not in line and "code[i] = " not in line]
    assert not longest
    assert not [line for line in lines if line != line.rstrip()]
    assert "\n\n\n\n" not in "\n".join(lines)


@pytest.mark.parametrize("chosen", [SCENES["tower"], PLAIN, HILLS], ids=["tower", "plain", "hills"])
def test_emitted_python_passes_mypy_and_ruff(chosen, tmp_path):
    path = tmp_path / "kernel.py"
    path.write_text(text_of(chosen, "python"), encoding="utf-8")
    for tool in (
        ["ruff", "check", "--isolated", "--no-cache", "--line-length", "120", "--ignore", "E501"],
        ["mypy", "--strict", "--no-incremental", "--config-file="],
    ):
        done = subprocess.run([sys.executable, "-m", *tool, str(path)], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("chosen", [SCENES["tower"], PLAIN, HILLS], ids=["tower", "plain", "hills"])
def test_emitted_javascript_loads_as_a_module(chosen, tmp_path):
    skip_without("javascript")
    path = tmp_path / "kernel.mjs"
    path.write_text(text_of(chosen, "javascript"), encoding="utf-8")
    done = subprocess.run([str(shutil.which("node")), "--check", str(path)], capture_output=True, check=False)
    assert done.returncode == 0, done.stderr
