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


def test_the_command_line_takes_precedence_over_the_settings_file(project):
    project('specs = ["builtin:hessian-float64"]\nfamilies = "ring"\ncount = 3\nseed = 4\n')
    assert main(["verify", "builtin:fast", "--families", "tower-body", "--seed", "5", "--out", "here"]) == 0
    said = options("here")
    assert (said["specs"], said["families"], said["count"], said["seed"]) == (["builtin:fast"], ["tower-body"], 3, 5)


def test_no_settings_option_ignores_an_invalid_settings_file(project):
    project("count = 'many'")
    assert main(["verify", "builtin:fast", "--families", "tower-body", "--count", "2"]) == 2
    assert main(["--no-settings", "verify", "builtin:fast", "--families", "tower-body", "--count", "2"]) == 0


@pytest.mark.parametrize(
    "words", [["--help"], ["verify", "--help"], ["replay", "-h"], ["cases", "list"], ["--version"]]
)
def test_commands_without_settings_do_not_read_an_invalid_settings_file(project, words):
    project("nonsense")
    assert main(words) == 0


def test_specs_of_the_settings_file_are_read_by_verify_alone(project, capsys):
    project('specs = ["builtin:table-2-float64"]')
    assert main(["replay", "ring-0001"]) == 2
    assert "SPEC" in capsys.readouterr().err
    assert main(["verify", "--oracles", "exact"]) == 2
    assert "--self ignores it" in capsys.readouterr().err


@pytest.mark.parametrize("value", ["true", "1", "yes"])
def test_verify_without_spec_ends_2_in_ci(project, monkeypatch, capsys, value):
    monkeypatch.setenv("CI", value)
    project("tolerance = 4\n")
    assert main(["verify"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "no implementation is named" in line
    assert line.endswith("hypcheck verify --self")
    assert not Path("reports").exists()


def test_verify_with_self_and_spec_ends_2(project, capsys):
    project("")
    assert main(["verify", "--self", "builtin:fast"]) == 2
    assert "--self verifies hypcheck itself and takes no SPEC; builtin:fast is one" in capsys.readouterr().err


QUICK = ["--families", "tower-body", "--count", "1", "--judged", "1", "--oracles", "exact,nearest"]


@pytest.mark.parametrize(("ci", "words"), [("true", ["--self"]), ("false", []), ("0", []), ("", [])])
def test_verify_without_spec_says_first_that_it_verifies_hypcheck_itself(project, monkeypatch, capsys, ci, words):
    monkeypatch.setenv("CI", ci)
    monkeypatch.setattr("hypcheck.runs.self_check.stages", lambda *_: ())  # what it does is tested where it is done
    project('specs = ["builtin:nothing"]\n' if words else "")
    assert main(["verify", *words, *QUICK]) == 0
    assert capsys.readouterr().err.splitlines()[0] == "hypcheck: verifying hypcheck itself, no implementation"


WEAK = """
specs = ["builtin:table-2-float32"]
tolerance = 1e18
families = ["ring"]
fail_on = "false-clear"
max_abstained = 9
count = 2
"""


def test_settings_weaker_than_the_defaults_are_shown_at_the_start_and_in_every_report(project, capsys):
    project(WEAK)
    assert main(["verify", "--count", "3", "--seed", "5", "--timeout", "60"]) == 0
    said = capsys.readouterr()
    first, second = said.err.splitlines()[:2]
    assert first == "hypcheck: verifying builtin:table-2-float32, named by hypcheck.toml"
    told = (
        "settings are those of hypcheck.toml; weaker than the default: "
        "--families ring, not all but the extreme ones (hypcheck.toml); --count 3, not 400 (command line); "
        "--tolerance 1e+18, not 8 (hypcheck.toml); --max-abstained 9, not 0 (hypcheck.toml); "
        "--fail-on false-clear, not wrong (hypcheck.toml)"
    )
    assert second == f"hypcheck: {told}"
    assert said.out.splitlines()[1].startswith(told[:100])
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


def test_replay_shows_the_settings_that_are_weaker_than_the_defaults(project, capsys):
    project("tolerance = 1e9\n")
    main(["replay", "ring-0001", "builtin:fast", "--question", "exterior"])
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("hypcheck: settings are those of hypcheck.toml; weaker than the default: ")
    assert line.endswith(": --tolerance 1000000000, not 8 (hypcheck.toml)")


def test_the_assumed_default_of_max_slowdown_is_that_of_bench(project):
    from hypcheck.bench.plan import MAX_SLOWDOWN

    assert _UNSET["max_slowdown"] == MAX_SLOWDOWN


def test_replay_takes_precision_and_tolerance_from_the_settings_file_as_verify_does(project, capsys):
    project(
        'precision = "float32"\nquestion = "exterior"\ntolerance = 3\nspecs = ["builtin:nothing"]\nout = "x"\nseed = 3'
    )
    main(["replay", "ring-0001", "builtin:table-2-float64", "--json"])
    found = json.loads(capsys.readouterr().out)
    assert (found["used"]["precision"], found["tolerance_u"]) == ("float32", 3)
    main(["replay", "ring-0001", "builtin:table-2-float64", "--json", "--precision", "float64"])
    assert json.loads(capsys.readouterr().out)["used"]["precision"] == "float64"


def test_hunt_ignores_seed_and_out_of_the_settings_file(project):
    project(ALL)
    found = read_settings(Path(FILE)).default_map
    assert set(found["hunt"]) == set(found["minimise"]) == set(found["replay"]) == set(ABOUT_ONE)
    assert set(found["verify"]) == set(_KEYS) - {"specs"}


def test_verify_without_a_settings_file_uses_the_defaults(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert read_settings(Path(FILE)) is None
    assert main(["verify", "builtin:fast", "--families", "tower-body", "--count", "2"]) == 0
    assert options()["seed"] == 1


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "count = 3\nmax-abstained = 1",
            "hypcheck.toml, line 2: there is no setting 'max-abstained'; did you mean max_abst",
        ),
        ("toleranse = 1", "did you mean tolerance?"),
        ("[verify]\ncount = 1", "line 1: there is no setting 'verify'; there are specs, out,"),
        ("\n\ncount = -1", "line 3: count is -1; it must be a whole number, at least 0"),
        ("count = 2.5", "count is 2.5; it must be a whole number, at least 0 and at most 1e15"),
        ("count = true", "count is true; it must be a whole number"),
        ('count = "3"', 'count is "3"; it must be a whole number'),
        ("seed = 9223372036854775808", "at most 9223372036854775807"),
        ("tolerance = nan", "tolerance is NaN; it must be a number, 0 or more"),
        ("tolerance = inf", "it must be a number, 0 or more"),
        ("tolerance = '8'", "it must be a number"),
        ("timeout = 0", "it must be a number above 0"),
        ("specs = 'builtin:fast'", "it must be a list of texts"),
        ("specs = []", "it must be a list of texts"),
        ("specs = ['builtin:fast', 3]", "it must be a list of texts"),
        ("families = 3", "it must be names and globs"),
        ("families = ['']", "it must be names and globs"),
        ("precision = 'float8'", 'precision is "float8"; it must be one of float16, bfloat16,'),
        ("question = ['position']", "it must be one of position, exterior"),
        ("fail_on = 'never'", "it must be one of wrong, false-clear"),
        ("deterministic = 1", "it must be true or false"),
        ("domain = '{}'", "it must be a table such as"),
        ("domain = { regimes = ['a>1'] }", "line 1: the domain names the regime 'a>1'"),
        ("[domain]\nratios = [1, 2]", "line 1: the domain has the key 'ratios'"),
        ("memory = '4 G'", "it must be a size such as"),
        ("memory = 0", "it must be a size such as"),
        ("memory = 1.5", "it must be a size such as"),
        ("out = ''", "it must be the text of a path"),
        ("known_failures = 1979-05-27", "it must be the text of a path"),
        ("restarts = -1", "it must be a whole number, at least 0"),
        ("count = 1\ncount = 2", "is no TOML"),
        ("count", "is no TOML"),
        ("a = " + "[" * 100_000, "cannot be read as TOML: it is nested too deeply"),
    ],
)
def test_an_invalid_settings_file_is_refused_with_the_line_and_key(project, capsys, text, message):
    project(text)
    assert main(["verify", "builtin:fast", "--families", "tower-body", "--count", "2"]) == 2
    said = capsys.readouterr().err
    assert message in said
    assert said.startswith("hypcheck: error: hypcheck.toml")
    assert len(said.splitlines()) == 1


def test_a_settings_file_that_cannot_be_read_is_refused(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path(FILE).write_bytes(b"out = '\xff'")
    assert main(["verify", "builtin:fast"]) == 2
    assert "is not UTF-8 text" in capsys.readouterr().err
    Path(FILE).unlink()
    Path(FILE).mkdir()
    assert main(["verify", "builtin:fast"]) == 2
    assert "cannot read hypcheck.toml: " in capsys.readouterr().err


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
