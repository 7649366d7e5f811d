"""Scenes and forests in bench: wrong answers are found, lines fit the record's schema; what a plan's kernels save."""

from __future__ import annotations

import json
import shutil
from importlib import resources

import numpy as np
import pytest
from click.testing import CliRunner
from msgspec.structs import astuple

from hypcheck.bench import forest as contenders
from hypcheck.bench import scene as scene_kernel
from hypcheck.bench.plan import BenchPlan
from hypcheck.cli.bench import bench
from hypcheck.cli.main import main
from hypcheck.errors import NothingJudgedError
from hypcheck.implementations.meshes import FCL
from hypcheck.kernel.scene import Scene
from hypcheck.kernel.specialise.plan import plan_of
from hypcheck.record import SCHEMA, read
from hypcheck.record.fields import as_json
from hypcheck.record.measurements import ForestLine, SceneLine
from tests.support.records import violations
from tests.support.scenes import HILLS, PLAIN

pytestmark = pytest.mark.usefixtures("text_reports")

DEFINITIONS = json.loads(
    resources.files("hypcheck.report").joinpath("schemas", f"record-{SCHEMA}.json").read_text(encoding="utf-8")
)
COMPILER = pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")


def ended(folder, *options):
    """The exit code, the record and the report of a run."""
    result = CliRunner().invoke(bench, ["--out", str(folder), "--quick", *options], standalone_mode=False)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    record = read(folder / "record.jsonl")
    return record.footer.exit_code, record, (folder / "report.md").read_text(encoding="utf-8")


@pytest.fixture
def small(monkeypatch):
    """Few trees, few steps, few rows."""
    monkeypatch.setattr(contenders, "TREES", (10, 200))
    monkeypatch.setattr(contenders, "STEPS", 48)
    monkeypatch.setattr(contenders, "QUICK_ROUNDS", 2)
    monkeypatch.setattr(scene_kernel, "QUICK_ROUNDS", 2)
    monkeypatch.setattr(scene_kernel, "ROWS", 4096)


def test_bench_forest_records_the_time_of_a_step_in_each_forest(small, tmp_path):
    code, record, report = ended(tmp_path, "--forest")
    assert code == 0
    lines = record.of(ForestLine)
    assert {line.trees for line in lines} == {10, 200}
    for line in lines:
        assert not violations(as_json(line), DEFINITIONS, closed=True)
        assert line.step_ns > 0
    assert all(line.wrong == 0 and line.ratio == 1 for line in lines if line.method == contenders.OURS)
    assert "A step in a forest" in report
    assert "a walker's step timed in 2 forests of up to 200 trees" in report
    if FCL.trouble() is None:
        assert {line.method for line in lines} == set(contenders.WALKERS)


def test_bench_measures_scenes_and_forests_unasked_only_if_no_other_choice_is_made():
    whole = BenchPlan()
    assert whole.whole
    assert contenders.sizes(whole)[-1] == contenders.MOST < contenders.sizes(BenchPlan(forest=True))[-1]
    chosen = [{"quick": True}, {"specs": ("builtin:fast",)}, {"methods": ("fast",)}, {"workloads": ("uniform",)}]
    assert not any(BenchPlan(**each).whole for each in chosen)


def test_the_walk_of_bench_forest_touches_trees_and_its_truth_needs_no_grid():
    forest = contenders.forest_of(300, 5)
    scene = Scene(forest.model)
    way = contenders.walk(scene, forest, 400, 5)
    truth = [int(forest.clear(centre)) for centre in way]
    assert 0 < truth.count(0) < 200
    assert [scene.position(*centre) for centre in way] == truth
    assert len({contenders.KINDS[kind] for kind in forest.kinds.tolist()}) == len(contenders.KINDS)


@pytest.mark.skipif(FCL.trouble() is not None, reason="there is no FCL")
@pytest.mark.parametrize("name", [name for name in contenders.WALKERS if name != contenders.OURS])
def test_fcl_in_bench_forest_answers_as_the_truth_away_from_contact(name):
    """Away from contact a mesh and a cylinder answer as the truth does."""
    forest = contenders.forest_of(50, 2)
    clear = contenders.WALKERS[name].make(forest)
    for place in forest.places[:20].tolist():
        assert clear(place[0] + 0.45, place[1], 0.0) == int(forest.clear((place[0] + 0.45, place[1], 0.0)))
    draw = np.random.default_rng(1)
    centres = [(x, y, 0.0) for x, y in (forest.side * draw.random((100, 2))).tolist()]
    # Inside a wide trunk no surface is near: a mesh is no wall there.
    wrong = [centre for centre in centres if clear(*centre) != int(forest.clear(centre))]
    assert len(wrong) <= 5


def test_bench_forest_ends_with_1_if_an_exact_method_is_wrong(small, tmp_path, monkeypatch):
    walkers = {contenders.OURS: contenders.Walker("says clear everywhere", None, lambda _forest: lambda _x, _y, _z: 1)}
    monkeypatch.setattr(contenders, "WALKERS", walkers)
    code, record, report = ended(tmp_path, "--forest")
    assert code == 1
    assert any(line.wrong for line in record.of(ForestLine))
    assert "promises to be exact" in report


@COMPILER
def test_bench_scene_times_the_emitted_kernel_beside_the_full_formulas(small, tmp_path):
    code, record, report = ended(tmp_path, "--scene", "tower")
    (line,) = record.of(SceneLine)
    assert code == 0
    assert not violations(as_json(line), DEFINITIONS, closed=True)
    assert (line.scene, line.settings, line.wrong) == ("cooling tower", 2, 0)
    assert sum(astuple(line.shares)) == pytest.approx(1)
    for times in (line.batch, line.single):
        assert min(times.kernel_ns, times.printed_ns, times.certified_ns) > 0
        low, high = times.by_printed_ci95
        assert low <= times.by_printed <= high
    assert "What scenes leave out" in report


def test_stage_shares_of_a_scene_are_the_mean_over_its_pairs():
    found = scene_kernel.stage_shares(plan_of(PLAIN).settings)
    assert found == {"always": 0.0, "thresholds": 1.0, "lines": 0.0, "discriminant": 0.0, "search": 0.0}
    assert sum(scene_kernel.stage_shares(plan_of(HILLS).settings).values()) == pytest.approx(1)


@COMPILER
def test_bench_scene_ends_with_1_if_the_emitted_kernel_is_wrong(small, tmp_path, monkeypatch):
    right = scene_kernel.emitted

    def spoilt(plan, language, command):
        text = right(plan, language, command)
        start = text.index("intercept_1 = ") + len("intercept_1 = ")
        end = text.index(";", start)
        return text.replace(text[start:end], repr(float(text[start:end]) * 1.2))

    monkeypatch.setattr(scene_kernel, "emitted", spoilt)
    code, _, report = ended(tmp_path, "--scene", "tower")
    assert code == 1
    assert "the kernel of the scene answers" in report


def test_bench_scene_with_a_broken_compiler_raises_nothing_judged(tmp_path, monkeypatch):
    monkeypatch.setenv("CC", "false")
    with pytest.raises(NothingJudgedError, match=r"no scene was measured: .*false does not compile"):
        ended(tmp_path, "--scene", "tower")
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def few(monkeypatch):
    """Few rounds."""
    monkeypatch.setattr(scene_kernel, "KERNEL_ROUNDS", 2)


@COMPILER
def test_plan_measure_times_each_pair_of_sizes_in_batches_and_one_by_one(few, capsys):
    assert main(["plan", "tower", "--measure", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert [each["sizes"] for each in told["measured"]] == [each["sizes"] for each in told["settings"]]
    for each in told["measured"]:
        assert each["says"].startswith("In C, many by a call: ")
        for mode in ("batch", "single"):
            low, high = each[mode]["ratio_ci95"]
            assert low <= each[mode]["ratio"] <= high
            assert min(each[mode]["kernel_ns"], each[mode]["printed_ns"]) > 0


@COMPILER
def test_plan_measure_prints_one_sentence_for_each_setting_below_the_plan(few, capsys):
    assert main(["plan", "tower", "--precision", "float32", "--measure"]) == 0
    *plan, body, rotors = capsys.readouterr().out.splitlines()
    assert plan[0] == "cooling tower: interior or not, in float32"
    assert body.startswith("1. In C")
    assert rotors.startswith("2. In C")
