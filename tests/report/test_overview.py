"""overview.md: one page about a run, made from the record alone, with the pictures beside it."""

from __future__ import annotations

from hypcheck.cli.main import main
from hypcheck.report import markdown
from hypcheck.report.drawings import ReportContext
from hypcheck.report.terminal import benchmark_facts, claim_facts
from tests.report import record_samples
from tests.report.bench_lines import bench_record
from tests.report.test_benchmark import REFUSED


def test_the_overview_of_a_verification_has_verdict_findings_and_picture():
    text = markdown.render_overview(record_samples.record(), ReportContext(["map.svg"])).decode()
    assert text.startswith(f"# hypcheck verify\n\n**{record_samples.HELD}**\n\n## Pictures\n")
    assert "- Equations of the paper: 1 of 2 hold; misprint: (12)." in text
    assert "](map.svg)" in text
    assert "](" not in markdown.render_overview(record_samples.record()).decode()


def test_the_overview_of_a_benchmark_has_advice_and_pictures():
    text = markdown.render_overview(bench_record(), ReportContext(["front.svg", "pareto.svg", "errors.svg"])).decode()
    order = [
        "## Which method to use when",
        "](front.svg)",
        "## What it shows",
        "## The paper's claims of cost",
        "](pareto.svg)",
        "](errors.svg)",
        "## The run",
    ]
    places = [text.index(each) for each in order]
    assert places == sorted(places)


def test_overview_of_a_benchmark_states_claims_targets_and_accuracy():
    found = [*claim_facts(bench_record()), *benchmark_facts(bench_record())]
    assert "claim holds, the tower: Procedure 2.b costs less than 2.a (§ 4)" in found
    assert "targets of the kernels: 2 of 2 met" in found
    # Of the ratios 0.1, 0.5, 1 of d/b 162, 90 and 0 of 200 are false contacts.
    assert "a bounding sphere in the spheroid's place, uniform: 42 % false contacts" in found
    best_and_worst = "table-2-c-float64, errors end at 9.1e-13; numpy-roots, errors end at 3.0e-8"
    assert f"the uniform rows, float64, the best and the worst: {best_and_worst}" in found
    assert "the uniform rows: at no distance reliable: table-2-numpy-float16" in found


def test_the_overview_shows_failures_first():
    text = markdown.render_overview(bench_record([*bench_record().lines, REFUSED], 1)).decode()
    assert text.index("## What failed") < text.index("## Which method to use when")


def test_report_writes_the_overview_as_the_readme_of_a_run(tmp_path, capsys):
    (tmp_path / "record.jsonl").write_text(record_samples.text_and_record()[0], encoding="utf-8")
    (tmp_path / "map.svg").write_text("<svg/>", encoding="utf-8")
    assert main(["report", str(tmp_path), "--format", "overview", "--out", str(tmp_path / "README.md")]) == 0
    assert "](map.svg)" in (tmp_path / "README.md").read_text(encoding="utf-8")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "map.svg").write_text("of another run", encoding="utf-8")
    assert main(["report", str(tmp_path), "--format", "overview", "--out", str(elsewhere / "README.md")]) == 0
    assert "](map.svg)" not in (elsewhere / "README.md").read_text(encoding="utf-8")
