"""Certificates of findings: right ones prove, changed ones do not; the committed reproductions run."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest
from msgspec.structs import replace

from hypcheck.engines.drawings import drawing
from hypcheck.engines.engine import ENGINES, command, is_installed
from hypcheck.engines.findings import Finding, proved, read_findings, reproduction
from hypcheck.engines.report import write_findings, write_page
from tests.engines.test_adapters import CACHE

REPORTS = Path(__file__).parents[2] / "reports" / "engines"
COMMITTED = read_findings(REPORTS)

ABOVE = [[-1.0, -1.0, 0.5], [1.0, -1.0, 0.5], [0.0, 1.0, 0.5]]
"""A triangle half a unit above the origin; the spheroid of b = 1 and d = 1/4 is a quarter below it."""


def finding(kind, reported=None, error=0.25, **changes):
    made = Finding(
        "python-fcl", "0", kind, 1.0, 0.25, ABOVE, reported, [0.0, 0.0, 1.0], [0.25, 0.25, 0.5], error, 1.0,
        "said", "proved", "", "",
    )  # fmt: skip
    return replace(made, **changes)


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        (finding("false contact"), finding("false contact", error=0.3)),
        (finding("false contact"), finding("false contact", direction=[0.0, 0.0, -1.0])),
        (finding("too near", reported=0.0), finding("too near", reported=0.1)),
        (finding("too near", reported=-0.75, d=1.0), finding("too near", reported=-0.7, d=1.0)),
        (finding("too far", reported=0.5), finding("too far", reported=0.4)),
        (finding("too far", reported=0.5), finding("too far", reported=0.5, shares=[0.5, 0.5, 0.5])),
        (finding("missed contact", d=1.0), finding("missed contact", d=0.6)),
        (finding("missed contact", d=1.0), finding("missed contact", d=1.0, shares=[0.0, 0.0, 1.0])),
        (finding("missed contact", d=1.0), finding("missed contact", d=1.0, shares=[-0.5, 1.0, 0.5])),
    ],
)
def test_a_finding_is_proved_by_its_certificate_and_not_by_a_changed_one(right, wrong):
    assert proved(right)
    assert not proved(wrong)


@pytest.mark.parametrize("name", ENGINES)
def test_the_reproduction_program_of_each_engine_has_its_certificate_and_numbers(name, tmp_path):
    one = finding("false contact", engine=name)
    text = reproduction(one)
    assert "$" not in text.replace("${", "")
    assert "Certificate: with n = (0.0, 0.0, 1.0)" in text
    assert repr(ABOVE) in text
    assert "hypcheck" not in text
    assert drawing(one).count("<ellipse") == 1
    (written,) = write_findings(tmp_path, [one])
    assert (tmp_path / written.file).read_text() == text
    assert read_findings(tmp_path) == [written]


@pytest.mark.parametrize(
    ("kind", "says"),
    [
        ("missed contact", ["shares 0.25, 0.25, 0.5 of the corners, has (x² + y²)/b² + z²/d² = 0.25 < 1."]),
        (
            "too far",
            ["shares 0.25, 0.25, 0.5 of the corners, is so near to the spheroid's point", "n = (0.0, 0.0, 1.0)."],
        ),
    ],
)
def test_the_certificate_of_a_reproduction_names_the_triangles_point_if_a_point_proves_it(kind, says):
    text = reproduction(finding(kind, reported=0.5, d=1.0))
    assert all(words in text for words in ["Certificate: the point p = (0, 0, 0.5) of the triangle", *says])


def test_drawing_magnifies_the_triangles_point_for_a_missed_contact_and_else_the_spheroids():
    """The nearest point of the triangle is at z = 0.5, and the point of the unit ball that faces it at z = 1."""
    for kind, height in (("missed contact", 50), ("false contact", 100)):
        assert f"M0.00,-{height}.00 L170,0" in drawing(finding(kind, error=0.001, d=1.0))


def test_the_drawing_of_a_triangle_that_is_a_point_in_its_plane_shows_the_point():
    point = drawing(finding("false contact", error=0.001, corners=[[0.0, 0.0, 0.5]] * 3))
    assert '<line x1="0.00" y1="-50.00" x2="0.00" y2="-50.00"' in point
    assert "nan" not in point


def run_reproduction(found, folder):
    """Run a finding's file beside the installed engine; its exit code: 1 while the engine is wrong."""
    home = (CACHE / found.engine).absolute()
    if ENGINES[found.engine].manager == "cargo":
        (home / "examples").mkdir(exist_ok=True)
        shutil.copyfile(folder / found.file, home / "examples" / "finding.rs")
        build = ("--release", "--quiet", "--manifest-path", str(home / "Cargo.toml"))
        words = ("cargo", "run", *build, "--example", "finding")
    else:
        place = home / f"finding{Path(found.file).suffix}"
        shutil.copyfile(folder / found.file, place)
        words = (command(ENGINES[found.engine], CACHE, folder)[0], str(place))
    return subprocess.run(words, capture_output=True, check=False, timeout=600).returncode


@pytest.mark.skipif(not is_installed(ENGINES["python-fcl"], CACHE), reason="python-fcl is not installed")
def test_a_reproduction_ends_with_0_if_the_engine_answers_rightly(tmp_path):
    right = write_findings(tmp_path, [finding("false contact"), finding("too near", reported=0.0)])
    assert [run_reproduction(each, tmp_path) for each in right] == [0, 0]


def test_the_page_lists_findings_of_a_self_contradicting_engine_first_and_has_no_digit_slash_digit():
    page = (REPORTS / "README.md").read_text()
    table = page.split("## Findings")[1].split("*of the body*")[0]
    said = [line.split(" | ")[1] for line in table.splitlines() if line.startswith("| ")][2:]
    contradicting = [one for one in COMMITTED if one.contradicts]
    assert len(said) == len(COMMITTED)
    assert said[: len(contradicting)] == [words for words in said if words.startswith("contact, and")]
    assert {one.said for one in contradicting} == set(said[: len(contradicting)])
    assert re.search(r"\| [^|(\[]*\d/\d", page) is None


def test_the_committed_page_table_badges_and_charts_are_those_of_the_committed_records_and_findings(tmp_path):
    made = tmp_path / "engines"
    shutil.copytree(REPORTS, made)
    names = [
        path.name for path in REPORTS.iterdir() if path.suffix in {".md", ".svg", ".csv"} or ".badge." in path.name
    ]
    assert len(names) == 2 + 2 * len([path for path in REPORTS.glob("*.json") if ".badge." not in path.name])
    for name in names:
        (made / name).unlink()
    write_page(made)
    assert [name for name in names if (made / name).read_text() != (REPORTS / name).read_text()] == []


@pytest.mark.parametrize("one", COMMITTED, ids=lambda one: one.file)
def test_each_committed_finding_states_what_the_engine_says_at_its_other_settings(one):
    assert bool(one.at_other) == ENGINES[one.engine].adjustable


@pytest.mark.parametrize("one", COMMITTED, ids=lambda one: one.file)
def test_each_committed_finding_is_proved_and_its_files_equal_newly_generated_ones(one):
    assert proved(one)
    assert (REPORTS / one.file).read_text() == reproduction(one)
    assert (REPORTS / one.picture).read_text() == drawing(one)


@pytest.mark.parametrize("one", COMMITTED, ids=lambda one: one.file)
def test_each_committed_reproduction_ends_with_1_if_its_engine_is_installed(one):
    if not is_installed(ENGINES[one.engine], CACHE):
        pytest.skip(f"{one.engine} is not installed; hypcheck engines install {one.engine}")
    assert run_reproduction(one, REPORTS) == 1
