"""A second language in one repository: settings, workflow and .gitignore gate both, and keep what a user wrote."""

from __future__ import annotations

import sys
from itertools import permutations

import pytest
import yaml

from hypcheck.cli.main import main
from hypcheck.scaffold.project import LANGUAGES

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

WORKFLOW = ".github/workflows/hypcheck.yml"


@pytest.fixture
def init(tmp_path):
    """`hypcheck init` in one folder."""

    def run(language: str, *arguments: str) -> int:
        return main(["init", "--language", language, "--directory", str(tmp_path), *arguments])

    return run


def steps(folder) -> dict[str, str]:
    """The command lines of a workflow by the names of their steps."""
    (job,) = yaml.safe_load((folder / WORKFLOW).read_text())["jobs"].values()
    return {step["name"]: step["run"].strip() for step in job["steps"] if "run" in step}


def specs(folder) -> list[str]:
    return tomllib.loads((folder / "hypcheck.toml").read_text())["specs"]


@pytest.mark.parametrize("names", [*permutations(["c", "go"]), list(LANGUAGES)], ids="-".join)
def test_workflow_verifies_every_language_that_init_added(names, init, tmp_path, capsys):
    for name in names:
        assert init(name, "--from", "hypcheck==1.2.0") == 0
    assert specs(tmp_path) == [LANGUAGES[name].spec for name in names]
    found = steps(tmp_path)
    assert found.pop("Install hypcheck") == "python -m pip install hypcheck==1.2.0"
    expected = {}
    for name in names:
        expected[f"Build hypcheck-{name}"] = LANGUAGES[name].build
        spec = LANGUAGES[name].spec
        shown = f"'{spec}'" if " " in spec else spec
        expected[f"Verify hypcheck-{name}"] = f"hypcheck verify {shown} --out hypcheck-report/{name}"
    assert list(found.items()) == list(expected.items())
    assert "hypcheck.toml   existed: added to" in capsys.readouterr().out


def test_a_second_language_changes_no_file_of_the_first(init, tmp_path):
    assert init("c") == 0
    before = {path: path.read_bytes() for path in (tmp_path / "hypcheck-c").rglob("*") if path.is_file()}
    ignored = (tmp_path / ".gitignore").read_bytes()
    assert init("go") == 0
    assert {path: path.read_bytes() for path in before} == before
    assert (tmp_path / ".gitignore").read_bytes() == ignored


def test_init_refuses_a_language_that_exists_and_with_force_lists_it_only_once(init, tmp_path, capsys):
    assert init("c") == init("go") == 0
    before = (tmp_path / WORKFLOW).read_text(), (tmp_path / "hypcheck.toml").read_text()
    assert init("go") == 2
    assert "hypcheck-go/predicate.go exists" in capsys.readouterr().err
    assert init("go", "--force") == 0
    assert ((tmp_path / WORKFLOW).read_text(), (tmp_path / "hypcheck.toml").read_text()) == before


@pytest.mark.parametrize(
    "text",
    [
        'specs = ["command:./mine"]\ntolerance = 2\n',
        'specs = ["command:./mine",]  # ours\ntolerance = 2\n',
        'tolerance = 2\nspecs = [\n  "command:./mine" ,\n]\n',
        'specs=[\n  "command:./mine"\n]\ntolerance = 2\n[domain]\nregimes = ["a>=1"]\n',
        'specs = [\'command:["./mine", "--fast"]\']\ntolerance = 2\n',
        "# nothing\n",
        "[domain]\nratio = [1e-3, 1e3]\n",
    ],
)
def test_a_spec_is_added_to_settings_that_a_user_wrote_and_the_rest_stays(text, init, tmp_path):
    (tmp_path / "hypcheck.toml").write_text(text)
    before = tomllib.loads(text)
    assert init("c") == 0
    after = tomllib.loads((tmp_path / "hypcheck.toml").read_text())
    assert after == {**before, "specs": [*before.get("specs", []), "command:hypcheck-c/adapter"]}
    assert "# ours" not in text or "# ours" in (tmp_path / "hypcheck.toml").read_text()


@pytest.mark.parametrize(
    "text", ['specs = [\n  "command:./mine" # ours\n]\n', 'specs = ["a",\n  "b"]\n', "specs = 1\n"]
)
def test_settings_that_init_cannot_extend_stay_unchanged_and_the_missing_spec_is_reported(text, init, tmp_path, capsys):
    (tmp_path / "hypcheck.toml").write_text(text)
    assert init("c") == 0
    assert (tmp_path / "hypcheck.toml").read_text() == text
    assert 'hypcheck.toml was not changed: add "command:hypcheck-c/adapter" to its specs' in capsys.readouterr().out


def test_init_adds_steps_to_a_workflow_that_a_user_changed(init, tmp_path):
    assert init("c", "--from", "1.2.0") == 0
    path = tmp_path / WORKFLOW
    path.write_text(path.read_text().replace("ubuntu-latest", "ubuntu-22.04").replace("-O2", "-O3"))
    assert init("python") == 0
    assert "runs-on: ubuntu-22.04" in path.read_text()
    assert "-O3" in steps(tmp_path)["Build hypcheck-c"]
    assert list(steps(tmp_path))[-2:] == ["Build hypcheck-python", "Verify hypcheck-python"]


def test_source_given_with_the_second_language_fills_the_empty_install_step(init, tmp_path, capsys):
    assert init("c") == 0
    assert init("go", "--from", "1.2.0") == 0
    assert steps(tmp_path)["Install hypcheck"] == "python -m pip install hypcheck==1.2.0"
    assert "nothing to install" not in capsys.readouterr().out.partition("hypcheck-go")[2]
    assert init("rust", "--from", "1.3.0") == 0
    assert steps(tmp_path)["Install hypcheck"] == "python -m pip install hypcheck==1.2.0"
    assert "still installs something other than --from" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("*.o", "*.o\n# What hypcheck writes.\n/reports/\n/hypcheck-report/\n"),
        ("reports/\n", "reports/\n# What hypcheck writes.\n/hypcheck-report/\n"),
        ("/reports\nhypcheck-report\n", "/reports\nhypcheck-report\n"),
    ],
)
def test_init_adds_files_of_runs_to_gitignore_even_if_forced(before, after, init, tmp_path):
    (tmp_path / ".gitignore").write_text(before)
    assert init("c", "--force") == 0
    assert (tmp_path / ".gitignore").read_text() == after
