"""The tools that read the GitHub action and the pre-commit hook accept them, and both run what they promise."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner
from ruamel.yaml import YAML

from hypcheck.cli.verify import verify
from hypcheck.isolation.launch import available
from tests.support.transcripts import UNDRAWN

ROOT = Path(__file__).parents[1]
ACTION = ROOT / "action.yml"
CITATION = ROOT / "CITATION.cff"
HOOKS = ROOT / ".pre-commit-hooks.yaml"
PAGE = ROOT / "docs" / "ci.md"
TOOLS = Path(sys.executable).parent

RECORDER = '#!/bin/sh\nprintf "%s\\n" "$0" "$@" >> "$TOLD"\n'
"""A program that writes its own name and its arguments to a file, a line each."""

TAGS = 'rules:\n  unpinned-uses:\n    config:\n      policies:\n        "*": ref-pin\n'
"""Actions may be named by a tag, as in the workflows that `hypcheck init` writes."""


def loaded(path):
    return YAML(typ="safe").load(path)


def tool(*words, cwd=ROOT):
    ended = subprocess.run(words, cwd=cwd, capture_output=True, text=True, check=False)
    return ended.returncode, ended.stdout + ended.stderr


def snippet(begins):
    """The indented block of the page whose first line begins so."""
    blocks = re.findall(r"(?:^    .*\n|^\n(?=    ))+", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    (found,) = [block for block in blocks if block.strip().startswith(begins)]
    return "".join(line.removeprefix("    ") for line in found.splitlines(keepends=True))


def step_named(name):
    (step,) = [each for each in loaded(ACTION)["runs"]["steps"] if each.get("name", "").startswith(name)]
    return step


def ended(name, folder, program="", **given):
    """How the step's script ended with these inputs, and what it gave to later steps; `program` runs as hypcheck."""
    step, output = step_named(name), folder / "output"
    path = folder / "hypcheck/bin/hypcheck"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{program}\n", encoding="utf-8")
    path.chmod(0o755)
    output.write_text("", encoding="utf-8")
    inputs = {variable: given.get(variable, "") for variable in step["env"]}
    runner = {"RUNNER_OS": given.get("RUNNER_OS", "Linux"), "RUNNER_TEMP": str(folder), "GITHUB_OUTPUT": str(output)}
    script = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]]
    run = subprocess.run(
        script, env={**os.environ, **inputs, **runner}, cwd=folder, capture_output=True, text=True, check=False
    )
    told = dict(line.split("=", 1) for line in output.read_text(encoding="utf-8").splitlines())
    return run.returncode, run.stdout, told


def step_run(name, folder, **given):
    """The lines that programs recorded while the step's script ran with these inputs as its environment."""
    step = step_named(name)
    told = folder / "told"
    for program in ("hypcheck/bin/hypcheck", "hypcheck/bin/python", "python3"):
        path = folder / program
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(RECORDER, encoding="utf-8")
        path.chmod(0o755)
    inputs = {variable: given.get(variable, "") for variable in step["env"]}
    path = f"{folder}{os.pathsep}{os.environ['PATH']}"
    environment = {**inputs, "PATH": path, "TOLD": str(told), "RUNNER_TEMP": str(folder), "GITHUB_OUTPUT": os.devnull}
    script = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]]
    subprocess.run(script, env=environment, check=True, cwd=folder)
    return told.read_text(encoding="utf-8").replace(f"{folder}/", "").splitlines()


@pytest.mark.parametrize("given", ["", "off"])
def test_the_action_isolates_by_namespaces_where_the_runner_can_unless_a_variable_says_otherwise(given, tmp_path):
    python = tmp_path / "hypcheck/bin/python"
    python.parent.mkdir(parents=True)
    python.write_text(f'#!/bin/sh\nexec {sys.executable} "$@"\n', encoding="utf-8")
    python.chmod(0o755)
    code, _, told = ended("Isolate", tmp_path, GIVEN=given)
    assert code == 0
    assert told == ({"isolate": "on"} if available().whole and not given else {})
    program = 'echo "$HYPCHECK_ISOLATE" > "$RUNNER_TEMP/seen"'
    code, _, _ = ended("Verify", tmp_path, program, **{name.upper(): value for name, value in told.items()})
    assert code == 0
    assert (tmp_path / "seen").read_text().strip() == told.get("isolate", "")


def schema_check(schema, *files):
    """The exit code and the output of check-jsonschema, in this process: it takes seconds to load."""
    from check_jsonschema import main

    done = CliRunner().invoke(main, ["--builtin-schema", f"vendor.{schema}", *map(str, files)])
    return done.exit_code, done.output


def test_the_action_fits_the_published_schema_of_actions():
    assert schema_check("github-actions", ACTION) == (0, "ok -- validation done\n")


@pytest.mark.parametrize(
    ("schema", "files"),
    [("github-issue-forms", sorted(ROOT.glob(".github/ISSUE_TEMPLATE/*.yml"))), ("citation-file-format", [CITATION])],
)
def test_issue_forms_and_the_citation_fit_their_published_schemas(schema, files):
    assert files
    assert schema_check(schema, *files) == (0, "ok -- validation done\n")


def test_the_schema_check_refuses_an_action_with_a_misspelt_key(tmp_path):
    wrong = tmp_path / "action.yml"
    wrong.write_text(ACTION.read_text(encoding="utf-8").replace("shell: bash", "shel: bash"), encoding="utf-8")
    assert schema_check("github-actions", wrong)[0] == 1


def test_the_action_and_the_hook_pass_the_security_audit(tmp_path):
    for file in (ACTION, HOOKS):
        shutil.copy(file, tmp_path)
    (tmp_path / "zizmor.yml").write_text(TAGS, encoding="utf-8")
    command = [TOOLS / "zizmor", "--offline", "--no-progress", "--strict-collection", "--collect", "all"]
    code, text = tool(*command, "--config", "zizmor.yml", ".", cwd=tmp_path)
    assert code == 0, text
    unsafe = ACTION.read_text(encoding="utf-8").replace(
        '"$RUNNER_TEMP/hypcheck/bin/hypcheck" verify', "${{ inputs.spec }}"
    )
    (tmp_path / "action.yml").write_text(unsafe, encoding="utf-8")
    code, text = tool(*command, "--config", "zizmor.yml", ".", cwd=tmp_path)
    assert code != 0
    assert "template-injection" in text


def test_pre_commit_accepts_the_manifest_of_the_hook():
    assert tool(TOOLS / "pre-commit", "validate-manifest", HOOKS)[0] == 0


def test_the_pre_commit_hook_tests_the_same_rows_at_each_commit_and_leaves_no_file_that_git_would_add(tmp_path):
    """As pre-commit runs it: the words of the entry, and the arguments behind them. It is never the self-check."""
    (hook,) = loaded(HOOKS)
    assert hook["entry"].startswith("env CI=true ")
    git = ["git", "-C", str(tmp_path), "-c", "user.name=a", "-c", "user.email=a@example.org"]
    for words in (["init", "--quiet"], ["commit", "--quiet", "--allow-empty", "--message", "begin"]):
        subprocess.run([*git, *words], check=True)
    words = [*shlex.split(hook["entry"]), "builtin:fast", "--families", "ring", "--count", "3"]
    (tmp_path / ".git" / "sitecustomize.py").write_text(UNDRAWN, encoding="utf-8")
    environment = {**os.environ, "PATH": f"{TOOLS}{os.pathsep}{os.environ['PATH']}"}
    environment["PYTHONPATH"] = str(tmp_path / ".git")
    runs = [
        subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
        for _ in range(2)
    ]
    assert [run.returncode for run in runs] == [0, 0], runs[0].stderr
    first, second = (re.search(r"fresh rows? of each family, of seed \d+", run.stderr) for run in runs)
    assert first
    assert second
    assert first[0] == second[0]
    left = subprocess.run([*git, "status", "--porcelain", "--ignored"], capture_output=True, text=True, check=True)
    assert left.stdout == ""
    assert (tmp_path / ".git" / "hypcheck" / "summary.json").exists()


def test_inputs_of_the_action_reach_verify_as_single_words(tmp_path):
    given = {
        "SPEC": "command:./mine --fast; rm -rf x",
        "FAMILIES": "ring,tang*",
        "TOLERANCE": "16",
        "OUT": "my reports",
    }
    assert step_run("Verify", tmp_path, **given) == [
        "hypcheck/bin/hypcheck",
        *("verify", "--out", "my reports", "--families", "ring,tang*", "--tolerance", "16"),
        *("--", "command:./mine --fast; rm -rf x"),
    ]


def test_inputs_of_the_action_that_are_left_out_leave_the_defaults_of_verify(tmp_path):
    assert step_run("Verify", tmp_path, OUT="out") == ["hypcheck/bin/hypcheck", "verify", "--out", "out"]


WINDOWS = {
    "SPEC": (
        r"library:build\Release\collide.dll",
        r"library:C:\build\collide.dll",
        r"python:src\mine.py:position",
        "python:c:/src/mine.py:position",
        r"command:D:\build\adapter.exe --fast",
        r"library:\\server\share\collide.dll",
    ),
    "FROM": (r"dist\hypcheck.whl", "C:/dist/hypcheck.whl"),
    "OUT": (r"reports\latest", "d:/reports"),
}


@pytest.mark.parametrize(("name", "value"), [(name, value) for name, values in WINDOWS.items() for value in values])
def test_the_action_refuses_a_path_of_windows_in_one_sentence(name, value, tmp_path):
    given = {"OUT": "reports/latest", name: value}
    code, said, _ = ended("Refuse Windows", tmp_path, **given)
    sentence = "which is a path of Windows; write it with / and relative to the top folder of the repository"
    assert (code, said) == (2, f"::error title=hypcheck::{name.lower()} is {value}, {sentence}\n")


def test_the_action_refuses_a_runner_of_windows_in_one_sentence(tmp_path):
    code, said, _ = ended("Refuse Windows", tmp_path, OUT="reports/latest", RUNNER_OS="Windows")
    sentence = "hypcheck does not run on Windows; give the job runs-on: ubuntu-latest"
    assert (code, said) == (2, f"::error title=hypcheck::{sentence}\n")


@pytest.mark.parametrize(
    "spec",
    ["", "builtin:fast", "library:./libcollide.so", "python:a/b.py:f", r'command:["./mine", "a\"b"]', "command:a\\ b"],
)
def test_the_action_takes_paths_of_linux(spec, tmp_path):
    given = {"SPEC": spec, "FROM": "git+https://example.org/h.git@v1", "OUT": "my reports"}
    assert ended("Refuse Windows", tmp_path, **given) == (0, "", {})


def test_each_job_of_a_matrix_and_each_call_in_a_job_uploads_under_a_name_of_its_own(tmp_path):
    (tmp_path / "pyproject.toml").touch()
    names = []
    for number in ("0", "1"):
        folder = tmp_path / number  # of its own for each job, as on the runner
        folder.mkdir()
        given = {"JOB": "gate", "NUMBER": number, "ACTION": str(tmp_path)}
        names += [ended("Name the cache", folder, **given)[2]["artifact"] for _ in range(2)]
    assert names == [
        "hypcheck-report-gate-0",
        "hypcheck-report-gate-0-2",
        "hypcheck-report-gate-1",
        "hypcheck-report-gate-1-2",
    ]
    upload = loaded(ACTION)["runs"]["steps"][-1]["with"]
    assert upload["name"] == loaded(ACTION)["outputs"]["artifact"]["value"] == "${{ steps.names.outputs.artifact }}"
    assert step_named("Name the cache")["env"]["NUMBER"] == "${{ strategy.job-index }}"


def test_a_named_artifact_keeps_its_name(tmp_path):
    (tmp_path / "pyproject.toml").touch()
    given = {"JOB": "gate", "NUMBER": "3", "ACTION": str(tmp_path), "ARTIFACT": "mine"}
    assert ended("Name the cache", tmp_path, **given)[2]["artifact"] == "mine"


@pytest.mark.parametrize("code", [0, 1, 6])
def test_the_exit_code_of_verify_is_that_of_the_step_and_an_output_of_the_action(code, tmp_path):
    assert ended("Verify", tmp_path, f"exit {code}", OUT="out") == (code, "", {"exit-code": str(code)})
    assert loaded(ACTION)["outputs"]["exit-code"]["value"] == "${{ steps.verify.outputs.exit-code }}"


def test_each_output_of_the_action_comes_from_an_existing_input_or_from_a_step_that_sets_it():
    steps = {step["id"]: step["run"] for step in loaded(ACTION)["runs"]["steps"] if "id" in step}
    for output in loaded(ACTION)["outputs"].values():
        for step, name in re.findall(r"steps\.(\w+)\.outputs\.([\w-]+)", output["value"]):
            assert f'echo "{name}=' in steps[step]
        assert set(re.findall(r"inputs\.(\w+)", output["value"])) <= set(loaded(ACTION)["inputs"])


def test_the_options_that_the_action_passes_are_options_of_verify():
    named = set(re.findall(r"(?<![\w-])--(out|families|tolerance|\w+)(?= \"\$)", ACTION.read_text(encoding="utf-8")))
    known = {name.removeprefix("--") for option in verify.params for name in option.opts}
    assert {"out", "families", "tolerance"} == named
    assert named <= known


@pytest.mark.parametrize(
    ("given", "what"),
    [
        ({"ACTION": "/an action"}, "/an action[report]"),
        ({"FROM": "dist/hypcheck-1.2.0-py3-none-any.whl"}, "dist/hypcheck-1.2.0-py3-none-any.whl[report]"),
        ({"FROM": "git+https://example.org/h.git@v1"}, "hypcheck[report] @ git+https://example.org/h.git@v1"),
    ],
)
def test_the_action_installs_its_own_source_or_the_named_requirement(tmp_path, given, what):
    lines = step_run("Install", tmp_path, **given)
    assert lines[:4] == ["python3", "-m", "venv", "--system-site-packages"]
    assert lines[5:8] == ["hypcheck/bin/python", "-m", "pip"]
    assert lines[-1] == what


def test_the_workflow_on_the_ci_page_uses_only_inputs_of_the_action(tmp_path):
    steps = YAML(typ="safe").load(snippet("- uses: OWNER/hypcheck"))
    assert set(steps[0]["with"]) <= set(loaded(ACTION)["inputs"])


@pytest.mark.skipif(shutil.which("actionlint") is None, reason="actionlint is not on the PATH")
def test_actionlint_passes_a_workflow_that_uses_the_action(tmp_path):
    workflow = tmp_path / ".github" / "workflows" / "gate.yml"
    workflow.parent.mkdir(parents=True)
    shutil.copy(ACTION, tmp_path)
    assert tool("git", "init", "-q", cwd=tmp_path)[0] == 0
    step = snippet("- uses: OWNER/hypcheck").replace("OWNER/hypcheck@COMMIT", "./")
    head = "on: push\njobs:\n  gate:\n    runs-on: ubuntu-latest\n    steps:\n      - uses: actions/checkout@v4\n"
    workflow.write_text(head + "".join(f"      {line}" for line in step.splitlines(keepends=True)), encoding="utf-8")
    assert tool("actionlint", cwd=tmp_path) == (0, "")


def test_the_gitlab_pipeline_on_the_ci_page_fits_the_published_schema(tmp_path):
    (tmp_path / ".gitlab-ci.yml").write_text(snippet("hypcheck:"), encoding="utf-8")
    assert schema_check("gitlab-ci", tmp_path / ".gitlab-ci.yml")[0] == 0


def test_pre_commit_accepts_the_configuration_on_the_ci_page(tmp_path):
    config = tmp_path / ".pre-commit-config.yaml"
    config.write_text(snippet("repos:"), encoding="utf-8")
    assert tool(TOOLS / "pre-commit", "validate-config", config)[0] == 0
    assert loaded(config)["repos"][0]["hooks"][0]["id"] == loaded(HOOKS)[0]["id"]
