"""Scenes and forests in bench: wrong answers are found, lines fit the record's schema; what a plan's kernels save."""

from __future__ import annotations

import json
import shutil
from importlib import resources

import numpy as np
import pytest
from click.testing import CliRunner
from msgspec import structs

from hypcheck.bench import forest as contenders
from hypcheck.bench import scene as scene_kernel
from hypcheck.bench.loaded import prepared
from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.run import codes_of
from hypcheck.cli.bench import bench
from hypcheck.cli.main import main
from hypcheck.errors import Exit, NothingJudgedError
from hypcheck.implementations.meshes import FCL
from hypcheck.record import SCHEMA, read
from hypcheck.record.fields import as_json
from tests.support.inside import Scene, plan_of
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


class Recorder:
    """Keeps lines."""

    def __init__(self):
        self.lines = []

    def add(self, line):
        """Keep the line."""
        self.lines.append(line)


def forest_lines(**options):
    """The lines of small forests, walked for a few steps."""
    recorder = Recorder()
    contenders.run(recorder, lambda _: None, 1, (10, 200), rounds=2, steps=48, **options)
    return recorder.lines


def test_bench_forest_records_the_time_of_a_step_in_each_forest():
    lines = forest_lines()
    assert {line.trees for line in lines} == {10, 200}
    for line in lines:
        assert not violations(as_json(line), DEFINITIONS, closed=True)
        assert line.step_ns > 0
    assert all(line.wrong == 0 and line.ratio == 1 for line in lines if line.method == contenders.OURS)
    assert codes_of(lines) == set()
    if FCL.trouble() is None:
        assert {line.method for line in lines} == set(contenders.WALKERS)


def test_bench_measures_scenes_and_forests_by_default_only_if_no_other_choice_is_made():
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


def test_bench_forest_ends_with_1_if_an_exact_method_is_wrong():
    says_clear = contenders.Walker("says clear everywhere", None, lambda _forest: lambda _x, _y, _z: 1)
    lines = forest_lines(walkers={contenders.OURS: says_clear})
    assert any(line.wrong for line in lines)
    assert codes_of(lines) == {Exit.WRONG}
    assert codes_of(structs.replace(line, exact=False) for line in lines) == set()


def scene_line(folder, **options):
    """The line of the tower, asked about few rows."""
    recorder = Recorder()
    plans = scene_kernel.plans_of(["tower"])
    scene_kernel.run_scenes(plans, recorder, lambda _: None, folder, rounds=2, count=4096, **options)
    (line,) = recorder.lines
    return line


@COMPILER
def test_bench_scene_times_the_emitted_kernel_beside_the_full_formulas(tmp_path):
    line = scene_line(tmp_path)
    assert codes_of([line]) == set()
    assert not violations(as_json(line), DEFINITIONS, closed=True)
    assert (line.scene, line.settings, line.wrong) == ("cooling tower", 2, 0)
    assert sum(structs.astuple(line.shares)) == pytest.approx(1)
    for times in (line.batch, line.single):
        assert min(times.kernel_ns, times.printed_ns, times.certified_ns) > 0
        low, high = times.by_printed_ci95
        assert low <= times.by_printed <= high


def test_stage_shares_of_a_scene_are_the_mean_over_its_pairs():
    found = scene_kernel.stage_shares(plan_of(PLAIN).settings)
    assert found == {"always": 0.0, "thresholds": 1.0, "lines": 0.0, "discriminant": 0.0, "search": 0.0}
    assert sum(scene_kernel.stage_shares(plan_of(HILLS).settings).values()) == pytest.approx(1)


@COMPILER
def test_bench_scene_ends_with_1_if_the_emitted_kernel_is_wrong(tmp_path):
    class SaysYes:
        @staticmethod
        def batch(rows):
            return prepared(len(rows), lambda: np.ones(len(rows), np.int8))

        single = batch

    line = scene_line(tmp_path, kernel_of=lambda _plan, _folder: SaysYes())
    assert line.wrong > 0
    assert codes_of([line]) == {Exit.WRONG}


def test_bench_scene_raises_nothing_judged_error_if_the_compiler_does_not_work(tmp_path, monkeypatch):
    monkeypatch.setenv("CC", "false")
    with pytest.raises(NothingJudgedError, match=r"no scene was measured: .*false does not compile"):
        ended(tmp_path, "--scene", "tower")
    assert list(tmp_path.iterdir()) == []


@COMPILER
def test_plan_measure_times_each_pair_of_sizes_in_batches_and_one_by_one(capsys):
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
def test_plan_measure_prints_one_sentence_for_each_setting_below_the_plan(capsys):
    assert main(["plan", "tower", "--precision", "float32", "--measure"]) == 0
    *plan, body, rotors = capsys.readouterr().out.splitlines()
    assert plan[0] == "cooling tower: interior or not, in float32"
    assert body.startswith("1. In C")
    assert rotors.startswith("2. In C")


@COMPILER
@pytest.mark.parametrize(
    ("words", "title"), [(["--scene", "tower"], "What scenes leave out"), (["--forest"], "A step in a forest")]
)
def test_bench_command_for_a_scene_or_forests_writes_a_record_and_a_report_of_it(words, title, tmp_path):
    code, record, report = ended(tmp_path, *words)
    assert code == 0
    assert title in report
    assert any(line.type in ("scene", "forest") for line in record.lines)
