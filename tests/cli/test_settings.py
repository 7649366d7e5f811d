"""hypcheck.toml: valid and invalid settings, their effect, and the precedence of the command line."""

from __future__ import annotations

import html
import json
from importlib import import_module
from pathlib import Path
from unittest import mock
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import UNSET

from hypcheck import toml
from hypcheck.cli.commands import COMMANDS as ALL_COMMANDS
from hypcheck.cli.main import main
from hypcheck.cli.settings import _KEYS, _UNSET, ABOUT_ONE, COMMANDS, FILE, in_effect, read_settings
from hypcheck.cli.verify import verify
from hypcheck.errors import InputError
from hypcheck.record import read
from hypcheck.record.fields import as_json

pytestmark = pytest.mark.usefixtures("text_reports")

ALL = """
specs = ["builtin:table-2-float64", "builtin:procedure-1-float64"]
out = "build/report"
families = ["tower-body", "forest-*"]
count = 3.0
seed = 7
tolerance = 16
precision = "float32"
question = "exterior"
domain = { regimes = ["c2>=a"], ratio = [1e-3, 1e3], magnitude = [1e-6, inf] }
max_abstained = 2
fail_on = "false-clear"
deterministic = true
known_failures = "known.toml"
startup_timeout = 5
timeout = 2.5
restarts = 3
memory = "512M"
isolate = "auto"
pass_env = ["ENGINE_DATA"]
see = ["/usr"]
"""


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A working directory with these settings."""
    monkeypatch.chdir(tmp_path)

    def write(text):
        Path(FILE).write_text(text, encoding="utf-8")
        return tmp_path

    return write


def options(folder="reports/latest"):
    return read(Path(folder) / "record.jsonl").header.options


def test_every_key_of_the_settings_file_reaches_the_options_of_the_run(project):
    project(ALL)
    Path("known.toml").write_text("", encoding="utf-8")
    assert main(["verify"]) == 0
    assert options("build/report") == {
        "specs": ["builtin:table-2-float64", "builtin:procedure-1-float64"],
        "families": ["tower-body", "forest-*"],
        "count": 3,
        "seed": 7,
        "fresh": None,
        "tolerance": 16.0,
        "max_abstained": 2,
        "fail_on": "false-clear",
        "deterministic": True,
        "known_failures": "known.toml",
        "precision": "float32",
        "question": "exterior",
        "domain": {"regimes": ["c2>=a"], "ratio": [1e-3, 1e3], "magnitude": [1e-6, "inf"], "settings": []},
        "limits": {
            "startup_timeout": 5.0,
            "timeout": 2.5,
            "restarts": 3,
            "memory": 512 << 20,
            "isolate": "auto",
            "pass_env": ["ENGINE_DATA"],
            "see": ["/usr"],
        },
        "workers": None,
        "cluster": None,
    }


def test_every_key_of_the_settings_file_is_an_option_of_the_commands_that_read_it(project):
    for name in COMMANDS:
        module, _, attribute = ALL_COMMANDS[name].partition(":")
        parameters = {each.name for each in getattr(import_module(module), attribute).params}
        assert (set(_KEYS) if name == "verify" else set(ABOUT_ONE)) <= parameters, name
    project(ALL)
    assert set(read_settings(Path(FILE)).options) | {"specs"} == set(_KEYS)


QUICK = ["--families", "tower-body", "--count", "1", "--judged", "1", "--oracles", "exact,nearest"]


@pytest.mark.parametrize(("ci", "words"), [("true", ["--self"]), ("false", []), ("0", []), ("", [])])
def test_verify_without_spec_says_first_that_it_verifies_hypcheck_itself(project, monkeypatch, capsys, ci, words):
    monkeypatch.setenv("CI", ci)
    project('specs = ["builtin:nothing"]\n' if words else "")
    assert main(["verify", *words, "--families", "nope"]) == 2  # which is found later
    assert capsys.readouterr().err.splitlines()[0] == "hypcheck: verifying hypcheck itself, no implementation"


WEAK = """
specs = ["builtin:table-2-float32"]
tolerance = 1e18
families = ["ring"]
fail_on = "false-clear"
max_abstained = 9
count = 2
"""


def test_settings_weaker_than_the_defaults_are_shown_in_the_summary_and_in_every_report(project, capsys):
    project(WEAK)
    assert main(["verify", "--count", "3", "--seed", "5", "--timeout", "60"]) == 0
    said = capsys.readouterr()
    (first,) = said.err.splitlines()
    assert first == "hypcheck: verifying builtin:table-2-float32, named by hypcheck.toml"
    told = (
        "settings are those of hypcheck.toml; weaker than the default: "
        "--families ring, not all but the extreme ones (hypcheck.toml); --count 3, not 400 (command line); "
        "--tolerance 1e+18, not 8 (hypcheck.toml); --max-abstained 9, not 0 (hypcheck.toml); "
        "--fail-on false-clear, not wrong (hypcheck.toml)"
    )
    assert said.out.splitlines()[1] == told
    folder = Path("reports/latest")
    settings = json.loads((folder / "summary.json").read_text())["settings"]
    assert settings == as_json(read(folder / "record.jsonl").header.settings)
    assert settings["file"] == FILE
    assert {"option": "--tolerance", "value": "1e+18", "default": "8", "source": FILE} in settings["weakened"]
    suites = ElementTree.parse(folder / "junit.xml").getroot()  # noqa: S314 - it was written a moment ago
    assert [each.get("value") for each in suites.iterfind("testsuite/properties/property")] == [told] * len(suites)
    assert f"S{told[1:]}." in html.unescape((folder / "report.md").read_text()).replace("\\", "")


@pytest.mark.thorough
def test_a_run_as_strict_as_the_defaults_shows_no_settings(project, capsys):
    project("")
    Path(FILE).unlink()
    assert main(["verify", "builtin:fast", "--seed", "3", "--count", "400", "--tolerance", "8", "--out", "out"]) == 0
    assert capsys.readouterr().err.splitlines() == ["hypcheck: verifying builtin:fast"]
    assert read(Path("out/record.jsonl")).header.settings is UNSET
    assert json.loads(Path("out/summary.json").read_text())["settings"] is None


@pytest.mark.parametrize(("families", "weaker"), [("*", False), ("*,ring", False), ("extreme", True), ("ring", True)])
def test_families_setting_counts_as_weaker_only_if_it_leaves_out_a_default_family(project, families, weaker):
    context = verify.make_context("verify", ["builtin:fast", "--families", families])
    with context:
        found = in_effect(context)
    assert [each.option for each in (found.weakened if found else [])] == ["--families"] * weaker


def test_the_assumed_default_of_max_slowdown_is_that_of_bench(project):
    from hypcheck.bench.plan import MAX_SLOWDOWN

    assert _UNSET["max_slowdown"] == MAX_SLOWDOWN


@pytest.mark.parametrize(("text", "memory"), [("536870912", "536870912"), ('"512M"', "512M")])
def test_memory_is_a_number_of_bytes_or_a_size(project, text, memory):
    project(f"memory = {text}\n")
    assert read_settings(Path(FILE)).options["memory"] == memory


def test_hunt_ignores_seed_and_out_of_the_settings_file(project):
    project(ALL)
    found = read_settings(Path(FILE)).default_map
    assert set(found["hunt"]) == set(found["minimise"]) == set(found["replay"]) == set(ABOUT_ONE)
    assert set(found["verify"]) == set(_KEYS) - {"specs"}


@given(
    st.dictionaries(
        st.sampled_from([*sorted(_KEYS), "other", "a b", "ключ"]),
        st.recursive(
            st.one_of(st.booleans(), st.integers(), st.floats(), st.text()),
            lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
            max_leaves=5,
        ),
        min_size=1,
        max_size=4,
    )
)
def test_any_toml_value_of_a_setting_is_accepted_or_refused_in_one_sentence(values):
    """Nothing that TOML can hold ends otherwise than in settings or in a sentence."""
    with (
        mock.patch.object(toml, "text_of", return_value=""),
        mock.patch.object(toml, "parsed", return_value=values),
    ):
        said, found = "", None
        try:
            found = read_settings(Path(FILE))
        except InputError as error:
            said = str(error)
    assert said.startswith(FILE) if found is None else set(found.options) | {"specs"} >= set(values)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ('specs = "builtin:fast"', 'a list of texts, such as ["command:./adapter"]'),
        ("families = 3", 'names and globs, such as ["ring", "tower-*"]'),
        ("pass_env = [3]", 'names of environment variables, such as ["LANG", "LD_LIBRARY_PATH"]'),
        ('see = "vendor"', 'a list of paths, such as ["vendor/lib"]'),
    ],
)
def test_setting_that_is_not_a_list_is_refused_with_an_example_for_its_key(project, capsys, text, wanted):
    project(text)
    assert main(["verify", "builtin:fast"]) == 2
    assert f"it must be {wanted}" in capsys.readouterr().err


@pytest.mark.parametrize("language", ["python", "c"])
def test_the_settings_file_that_init_writes_is_valid(tmp_path, monkeypatch, language):
    monkeypatch.chdir(tmp_path)
    assert main(["init", "--language", language]) == 0
    written = Path(FILE).read_text(encoding="utf-8")
    found = read_settings(Path(FILE))
    assert found.specs
    assert found.options["tolerance"] == 8
    lines = [
        line.removeprefix("# ") if " = " in line and line.startswith("# ") else line for line in written.splitlines()
    ]
    Path(FILE).write_text("\n".join(lines), encoding="utf-8")
    assert set(read_settings(Path(FILE)).options) >= {
        "tolerance",
        "question",
        "precision",
        "families",
        "known_failures",
    }


def test_verify_judges_the_python_project_of_init_by_its_settings_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", "")
    assert main(["init", "--language", "python"]) == 0
    assert main(["verify", "--families", "forest-type-1", "--count", "5"]) == 0
    assert main(["verify", "--families", "ring", "--count", "5"]) == 1
