"""hypcheck engines: what is listed, what installs, and one sentence where something is missing."""

import json
import shutil

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.engines import engine as installing
from hypcheck.engines import measure as measuring
from hypcheck.engines.engine import ENGINES
from hypcheck.engines.measure import read_records, record_of, write_record
from hypcheck.engines.placing import FAMILIES, placed
from hypcheck.engines.report import write_page
from hypcheck.errors import InputError, UnavailableError
from hypcheck.implementations.session import TimingError
from tests.engines.test_adapters import CACHE


def test_engines_install_names_a_missing_program_and_writes_nothing(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    for name, program in (("cannon-es", "node"), ("parry3d", "cargo")):
        with pytest.raises(UnavailableError, match=f"{name} needs the program {program}, which is not installed"):
            installing.install(ENGINES[name], tmp_path / "cache")
    assert not (tmp_path / "cache").exists()


def test_engines_install_quotes_a_package_manager_that_fails_and_leaves_nothing(monkeypatch, tmp_path):
    for program in ("node", "npm"):
        (tmp_path / program).write_text("#!/bin/sh\necho 'no network' >&2\nexit 1\n")
        (tmp_path / program).chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    with pytest.raises(UnavailableError, match="cannon-es could not be installed: npm ended with: no network"):
        installing.install(ENGINES["cannon-es"], tmp_path / "cache")
    assert not (tmp_path / "cache" / "cannon-es").exists()


def test_the_engines_cache_is_the_folder_in_the_environment_variable_or_else_in_the_users_cache(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv(installing.VARIABLE, raising=False)
    assert installing.cache_folder() == tmp_path / "hypcheck" / "engines"
    monkeypatch.setenv(installing.VARIABLE, str(tmp_path / "own"))
    assert installing.cache_folder() == tmp_path / "own"


@pytest.mark.skipif(not installing.is_installed(ENGINES["python-fcl"], CACHE), reason="python-fcl is not installed")
def test_a_record_of_an_engine_is_written_read_and_shown_as_page_and_badge(tmp_path):
    families = ("ball", "kilometres")
    record = record_of(ENGINES["python-fcl"], CACHE, count=2, meshes=(500,), families=families)
    write_record(tmp_path, record)
    assert read_records(tmp_path) == [record]
    assert len(record.tightest) == len(record.default)
    assert record.best == record.default  # its other solver is no tighter one
    ball, far = record.best
    assert ball.own == 0
    assert ball.false_clears + ball.false_contacts == ball.mesh_wrong > 0
    assert ball.distance.own_worst_mm < 1e-9
    assert far.own > 0  # its tolerance is an absolute length: a kilometre as the unit makes it a millimetre
    assert sum(each.clear + each.contacts for each in far.decades) == far.rows
    write_page(tmp_path)
    page = (tmp_path / "README.md").read_text()
    assert "| [python-fcl](#python-fcl-07011) |" in page
    assert (tmp_path / "python-fcl.svg").read_text().count("<circle") == 4
    assert all(f"*{name}*: {FAMILIES[name].text}" in page for name in FAMILIES)
    assert json.loads((tmp_path / "python-fcl.badge.json").read_text())["label"] == "python-fcl"


def program(folder, name, script):
    folder.mkdir(exist_ok=True)
    (folder / name).write_text(f"#!/bin/sh\n{script}\n")
    (folder / name).chmod(0o755)


def test_an_engine_counts_as_installed_until_its_adapter_changes(monkeypatch, tmp_path, capsys):
    bin_, cache = tmp_path / "bin", tmp_path / "cache"
    for name in ("node", "npm"):
        program(bin_, name, f'echo "$@" >> {tmp_path}/{name}.said')
    monkeypatch.setenv("PATH", f"{bin_}:/bin:/usr/bin")
    assert main(["engines", "install", "cannon-es", "--cache", str(cache)]) == 0
    assert capsys.readouterr().out == "installed cannon-es 0.20.0\n"
    assert (tmp_path / "npm.said").read_text().split()[-1] == "cannon-es@0.20.0"
    engine = ENGINES["cannon-es"]
    assert installing.is_installed(engine, cache)
    assert installing.command(engine, cache, tmp_path)[-1] == str(tmp_path)
    (cache / engine.name / "ready").write_text("of another adapter")
    with pytest.raises(InputError, match="cannon-es is not installed"):
        installing.command(engine, cache, tmp_path)


def test_each_manager_installs_the_pinned_version_into_the_engines_own_folder(monkeypatch, tmp_path):
    (built,) = installing._steps(ENGINES["parry3d"], tmp_path)
    assert built[:2] == ["cargo", "build"]
    assert built[-1] == str(tmp_path / "Cargo.toml")
    packages = tmp_path / "packages"
    monkeypatch.syspath_prepend(packages)

    def have(version):
        folder = packages / f"coal-{version}.dist-info"
        folder.mkdir(parents=True)
        (folder / "METADATA").write_text(f"Metadata-Version: 2.1\nName: coal\nVersion: {version}\n")

    assert len(installing._steps(ENGINES["mujoco"], tmp_path)) == 2  # the extra `peers` installs coal itself
    have("3.0.2")
    made, installed = installing._steps(ENGINES["coal"], tmp_path)
    assert made[1:] == ["-m", "venv", str(tmp_path / "venv")]
    assert installed[0] == str(tmp_path / "venv" / "bin" / "python")
    assert installed[-2:] == ["coal==3.0.3", "numpy"]
    shutil.rmtree(packages)
    have("3.0.3")
    assert installing._steps(ENGINES["coal"], tmp_path) == []


def test_record_of_an_engine_skips_families_that_it_cannot_answer_with_the_reason(monkeypatch, tmp_path):
    for name in ("node", "npm"):
        program(tmp_path / "bin", name, "exit 0")
    monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}:/bin:/usr/bin")
    assert main(["engines", "install", "cannon-es", "--cache", str(tmp_path)]) == 0
    program(tmp_path / "bin", "node", "echo 'no memory' >&2; exit 3")
    found = record_of(ENGINES["cannon-es"], tmp_path, families=("leaning", "ball"), meshes=(500, 5000))
    assert found.skipped == {"leaning": "no spheroid leans", "ball": "no memory"}


def test_a_json_file_that_is_no_record_of_an_engine_raises_an_input_error(tmp_path):
    (tmp_path / "coal.json").write_text("{}")
    with pytest.raises(InputError, match=r"coal\.json is not a record of an engine: .*schema"):
        read_records(tmp_path)


def test_an_adapter_that_hangs_or_has_no_clock_gets_neither_distances_nor_a_time():
    rows = placed(FAMILIES["ball"], 1).rows

    class Untimed:
        def time(self, rows, repeat):
            raise TimingError("it has no clock")

    assert np.isnan(measuring.reported_distances(["sleep", "60"], rows, patience_s=0.1)).all()
    assert measuring._microseconds(Untimed(), rows) is None


def test_the_distance_error_of_an_engine_that_reports_no_distances_is_none():
    found = placed(FAMILIES["ball"], 1)
    none = np.full(len(found.rows), np.nan)
    reported = measuring._reported(none, found, none, found.contact, found.contact)
    assert (reported.rows, reported.missing, reported.worst_mm) == (0, found.contact.sum(), None)
