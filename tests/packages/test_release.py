"""What is published: archives that are checked, one version, and workflows whose commands exist."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner
from ruamel.yaml import YAML

from hypcheck.version import VERSION
from packages import checks, python, sbom, trials, version
from packages.__main__ import main
from packages.archives import archive
from tests.packages.archives import ROOT, packed, quietly
from tests.test_action import TAGS, schema_check

WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
OTHERS = {"sudo", "mkdir", "mv", "tar", "pipx", "cargo", "npm", "gh", ".ci/run"}
"""Programs of the runner, and the script of continuous integration."""


def printed(*arguments):
    done = CliRunner().invoke(main, list(map(str, arguments)))
    return done.exit_code, done.output


@pytest.fixture(scope="module")
def dist(tmp_path_factory):
    folder = tmp_path_factory.mktemp("dist")
    packed(folder, "c")
    return folder


def test_an_archive_is_built_with_a_document_and_may_be_published(dist):
    assert printed("check", "--out", dist) == (0, f"1 archives of version {VERSION} may be published\n")


@pytest.mark.parametrize(
    "name", ["hypcheck-c-1.2.3.tar.gz", "hypcheck-rust-1.2.3.tar.gz", "hypcheck-1.2.3-py3-none-any.whl"]
)
def test_the_document_of_an_archive_fits_the_schema_of_cyclonedx(name, tmp_path):
    from cyclonedx.schema import SchemaVersion
    from cyclonedx.validation.json import JsonStrictValidator  # loads jsonschema, which takes seconds

    (tmp_path / name).write_bytes(b"an archive")
    text = sbom.write(tmp_path / name).read_text(encoding="utf-8")
    assert JsonStrictValidator(SchemaVersion.V1_6).validate_str(text) is None
    broken = json.loads(text) | {"components": [{"name": "without a type"}]}
    assert JsonStrictValidator(SchemaVersion.V1_6).validate_str(json.dumps(broken)) is not None


def test_the_document_of_a_wheel_names_its_bundled_and_its_required_packages(tmp_path):
    wheel = tmp_path / f"hypcheck-{VERSION}-py3-none-any.whl"
    wheel.write_bytes(b"a wheel")
    parts = {part["name"]: part for part in sbom.document(wheel)["components"]}
    assert parts["three"]["licenses"] == [{"expression": "MIT"}]
    assert parts["cases"]["licenses"] == [{"expression": "CC0-1.0"}]
    assert {name for name, part in parts.items() if part.get("scope") == "required"} == {
        *("click", "mpmath", "msgspec", "numpy", "python-fcl", "sympy", "tomli"),
    }


def test_check_names_an_archive_that_was_changed_that_lacks_a_licence_or_is_of_another_version(dist, tmp_path):
    assert printed("check", "--out", tmp_path)[0] == 1
    good = next(dist.glob("*.tar.gz"))
    for changed in (good, good.with_name(good.name + sbom.SUFFIX)):
        shutil.copy(changed, tmp_path)
    (tmp_path / good.name).write_bytes(archive("hypcheck", {"hypcheck.h": b""}))
    sbom.write(shutil.copy(good, tmp_path / "hypcheck-c-99.0.0.tar.gz"))
    code, text = printed("check", "--out", tmp_path)
    assert code == 1
    assert f"{good.name} lacks the text of LICENSE\n" in text
    assert f"{good.name} is not the archive that {good.name}.cdx.json describes\n" in text
    assert f"hypcheck-c-99.0.0.tar.gz is of version 99.0.0; the tree is of {VERSION}\n" in text


def test_check_names_a_wheel_that_is_too_large_and_has_no_document(tmp_path):
    (tmp_path / f"hypcheck-{VERSION}.tar.gz").write_bytes(archive("hypcheck", {}))
    wrong = checks.faults(tmp_path)
    assert (
        f"hypcheck-{VERSION}.tar.gz has no hypcheck-{VERSION}.tar.gz.cdx.json beside it, which says what it is made of"
        in wrong
    )
    assert any(line.startswith("twine: ") for line in wrong)


def test_a_trial_without_its_archive_is_refused(dist):
    code, text = printed("try", "rust", "--out", dist)
    assert (code, "0 archives hypcheck-rust-*.tar.gz; it must have one" in text) == (1, True)


def test_a_trial_fails_that_prints_something_else_or_ends_with_an_error(dist, monkeypatch):
    for lines, part in (([("echo yes", "no")], "it must print 'no'"), ([("false", "")], "its last line ended with 1")):
        monkeypatch.setitem(trials.TRIALS, "c", trials.Trial("hypcheck-c-*.tar.gz", lines))
        code, text = printed("try", "c", "--out", dist)
        assert code == 1
        assert part in text


@pytest.mark.thorough
def test_two_builds_of_the_packages_for_python_have_the_same_bytes_and_each_installs_afresh(tmp_path):
    for kind in python.KINDS:
        first, second = (tmp_path / name for name in ("first", "second"))
        for folder in (first, second):
            quietly(sys.executable, "-m", "packages", "build", kind, "--out", folder, cwd=ROOT)
        for made in checks.archives(first):
            assert made.read_bytes() == (second / made.name).read_bytes()
    assert checks.faults(first) == []
    assert printed("try", "python", "pure", "sdist", "--out", first)[0] == 0


def test_all_files_say_one_version():
    said = version.versions(ROOT)
    assert said.pop(version.SYMBOLS) == VERSION.partition(".")[0]
    assert set(said.values()) == {VERSION}


@pytest.fixture
def copied(tmp_path):
    shutil.copytree(ROOT / "hypcheck", tmp_path / "hypcheck", ignore=shutil.ignore_patterns("__pycache__", "*.so"))
    for name in ("CITATION.cff", version.SYMBOLS):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    return tmp_path


def test_a_version_is_raised_in_all_files_at_once(copied):
    version.raise_to(copied, "12.3.40")
    assert version.versions(copied) == dict.fromkeys(version.PLACES, "12.3.40") | {version.SYMBOLS: "12"}
    texts = {name: [(root / name).read_text(encoding="utf-8") for root in (ROOT, copied)] for name in version.PLACES}
    editions = [re.findall(r"HC_EDITION_(\w{16})", text) for text in texts[version.PRINTED]]
    assert [len(set(each)) for each in editions] == [1, 1]
    assert editions[0] != editions[1]  # a checksum of the text, by which a file that includes itself knows itself
    for before, after in texts.values():
        assert before.replace(VERSION, "12.3.40").replace(editions[0][0], editions[1][0]) == after


@pytest.mark.parametrize(
    ("new", "reason"),
    [
        *((text, "is not a version") for text in ("1.0", "v1.0.0", "1.0.0rc1", "01.0.0", "1.0.0\n", "")),
        *((text, "is not above") for text in (VERSION, "0.0.9")),
    ],
)
def test_an_invalid_or_lower_version_is_refused(new, reason, copied):
    before = version.versions(copied)
    with pytest.raises(Exception, match=reason):
        version.raise_to(copied, new)
    assert version.versions(copied) == before


def jobs():
    for path in WORKFLOWS:
        for name, job in YAML(typ="safe").load(path)["jobs"].items():
            yield path.stem, name, job


def commands():
    """The command lines of the workflows, word by word."""
    for _, _, job in jobs():
        for step in job["steps"]:
            for line in re.split(r"\n|&&", step.get("run", "")):
                if line.strip():
                    yield shlex.split(line)


def test_every_command_of_the_workflows_exists():
    targets = set(re.findall(r"^([\w./$()-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    found = list(commands())
    assert len(found) > 10
    for words in found:
        program, *rest = words
        if program == "make":
            assert rest[0].replace(".venv", "$(VENV)") in targets, words
        elif rest[:2] == ["-m", "packages"]:
            with main.commands[rest[2]].make_context(rest[2], rest[3:]):
                pass
        else:
            assert program in OTHERS, words


def test_release_builds_and_tests_every_package():
    (built,) = [words[4:-2] for words in commands() if words[1:4] == ["-m", "packages", "build"]]
    assert {*built, "wheel"} == set(main.commands["build"].params[0].type.choices)
    (tried,) = [words[4:] for words in commands() if words[1:4] == ["-m", "packages", "try"]]
    assert tried == ["--out", "dist"]


def test_only_a_tag_publishes_and_only_what_was_tried():
    release = {name: job for stem, name, job in jobs() if stem == "release"}
    assert release["attest"]["if"] == "startsWith(github.ref, 'refs/tags/v')"
    needs = {name: job.get("needs", []) for name, job in release.items()}
    for name in ("pypi", "crates-io", "npm"):
        assert needs[name] == "attest"
        assert release[name]["permissions"] == {"id-token": "write"}
    assert needs["attest"] == "archives"
    assert "secrets." not in WORKFLOWS[-1].read_text(encoding="utf-8")


def test_the_workflows_fit_their_schema_and_pass_the_security_audit(tmp_path):
    tools = Path(sys.executable).parent
    assert schema_check("github-workflows", *WORKFLOWS)[0] == 0
    folder = tmp_path / ".github" / "workflows"
    shutil.copytree(WORKFLOWS[0].parent, folder)
    (tmp_path / "zizmor.yml").write_text(TAGS, encoding="utf-8")
    command = [tools / "zizmor", "--offline", "--no-progress", "--config", "zizmor.yml", "."]
    quietly(*command, cwd=tmp_path)
    text = (folder / "release.yml").read_text(encoding="utf-8")
    (folder / "release.yml").write_text(text.replace("- run: make docs", "- run: echo ${{ github.ref_name }}"))
    assert subprocess.run(command, cwd=tmp_path, capture_output=True, check=False).returncode != 0
