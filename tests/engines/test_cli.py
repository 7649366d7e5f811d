"""hypcheck engines: what is listed, what installs, and one sentence where something is missing."""

import json

import pytest

from hypcheck.cli.main import main
from hypcheck.engines import install as installing
from hypcheck.engines.placing import FAMILIES
from hypcheck.engines.report import write_page
from hypcheck.engines.run import read_records, record_of, write_record
from hypcheck.engines.table import ENGINES
from hypcheck.errors import UnavailableError
from tests.engines.test_adapters import CACHE


def test_the_list_names_every_engine_and_says_which_are_installed(capsys, tmp_path):
    assert main(["engines", "list", "--cache", str(tmp_path)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(ENGINES)
    assert all("installed" in line for line in lines)


@pytest.mark.parametrize("words", [["verify", "coal"], ["verify"], ["bench"]])
def test_an_engine_that_is_not_installed_is_a_sentence(capsys, tmp_path, words):
    assert main(["engines", *words, "--cache", str(tmp_path), "--out", str(tmp_path / "out")]) == 2
    assert "installed; type: hypcheck engines install" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_an_unknown_engine_is_a_sentence_with_a_suggestion(capsys):
    assert main(["engines", "install", "cole"]) == 2
    assert "there is no engine 'cole'; did you mean" in capsys.readouterr().err


def test_a_missing_program_is_named_and_nothing_is_written(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    for name, program in (("cannon-es", "node"), ("parry3d", "cargo")):
        with pytest.raises(UnavailableError, match=f"{name} needs the program {program}, which is not installed"):
            installing.install(ENGINES[name], tmp_path / "cache")
    assert not (tmp_path / "cache").exists()


def test_a_package_manager_that_fails_is_quoted_and_nothing_is_left(monkeypatch, tmp_path):
    for program in ("node", "npm"):
        (tmp_path / program).write_text("#!/bin/sh\necho 'no network' >&2\nexit 1\n")
        (tmp_path / program).chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    with pytest.raises(UnavailableError, match="cannon-es could not be installed: npm ended with: no network"):
        installing.install(ENGINES["cannon-es"], tmp_path / "cache")
    assert not (tmp_path / "cache" / "cannon-es").exists()


def test_the_cache_is_where_a_variable_says_or_in_the_users_cache(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv(installing.VARIABLE, raising=False)
    assert installing.cache_folder() == tmp_path / "hypcheck" / "engines"
    monkeypatch.setenv(installing.VARIABLE, str(tmp_path / "own"))
    assert installing.cache_folder() == tmp_path / "own"


@pytest.mark.skipif(not installing.is_installed(ENGINES["python-fcl"], CACHE), reason="python-fcl is not installed")
def test_a_small_record_of_an_engine_makes_the_page_and_a_badge(tmp_path):
    families = ("ball", "kilometres")
    record = record_of(ENGINES["python-fcl"], CACHE, each=2, meshes=(500,), families=families)
    write_record(tmp_path, record)
    assert read_records(tmp_path) == [record]
    ball, far = record.measured
    assert ball.own == 0
    assert ball.false_clears + ball.false_contacts == ball.mesh_wrong > 0
    assert ball.distance.own_worst_mm < 1e-9
    assert far.own > 0  # its tolerance is an absolute length: a kilometre as the unit makes it a millimetre
    assert sum(each.clear + each.contacts for each in far.decades) == far.rows
    write_page(tmp_path)
    page = (tmp_path / "README.md").read_text()
    assert "| [python-fcl](#python-fcl-07011) 0.7.0.11 |" in page
    assert all(f"*{name}*: {FAMILIES[name].text}" in page for name in FAMILIES)
    assert json.loads((tmp_path / "python-fcl.badge.json").read_text())["label"] == "python-fcl"
