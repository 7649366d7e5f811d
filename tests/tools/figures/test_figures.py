"""The figures of docs/figures.md are fresh, are not cut off, and show what their captions say."""

from __future__ import annotations

import math
import re
from xml.etree import ElementTree

import pytest

from hypcheck.geometry.pair import Position
from hypcheck.report.colours import ROLES
from tests.support.fractions_truth import exact_position
from tests.tools.figures import bodies, paper
from tests.tools.figures.__main__ import DOCS, DRAWN_WITH, bodies_pictures, pictures, versions

PAGE = (DOCS / "figures.md").read_text(encoding="utf-8")


@pytest.mark.thorough
def test_each_picture_of_the_paper_page_exists_and_each_drawn_one_is_on_the_page():
    shown = set(re.findall(r"\]\((\w+/[\w-]+\.svg)\)", PAGE))
    assert all((DOCS / name).is_file() for name in shown)
    assert shown == {*(name for name in pictures() if name.endswith(".svg")), "simulate/tower-table-5.svg"}


@pytest.mark.thorough
@pytest.mark.skipif(
    DRAWN_WITH.read_text(encoding="utf-8") != versions(),
    reason=f"drawn with {DRAWN_WITH.read_text(encoding='utf-8').strip()}; here is {versions().strip()}",
)
@pytest.mark.parametrize("kind", ["svg", "pdf"])
@pytest.mark.parametrize("name", ["figure-1", "figure-2", "figure-3"])
def test_figure_of_the_paper_page_equals_a_newly_drawn_one(name, kind):
    """`make figures` draws it anew."""
    assert (DOCS / "figures" / f"{name}.{kind}").read_bytes() == pictures()[f"figures/{name}.{kind}"]


@pytest.mark.skipif(
    DRAWN_WITH.read_text(encoding="utf-8") != versions(),
    reason=f"drawn with {DRAWN_WITH.read_text(encoding='utf-8').strip()}; here is {versions().strip()}",
)
@pytest.mark.thorough
@pytest.mark.parametrize("kind", ["svg", "pdf"])
@pytest.mark.parametrize("name", ["forest-space", "forest-walk", "tower-flights"])
def test_picture_of_a_simulation_equals_a_newly_drawn_one(name, kind):
    """`make figures` draws it anew."""
    assert (DOCS / "simulate" / f"{name}.{kind}").read_bytes() == pictures()[f"simulate/{name}.{kind}"]


@pytest.mark.skipif(
    DRAWN_WITH.read_text(encoding="utf-8") != versions(),
    reason=f"drawn with {DRAWN_WITH.read_text(encoding='utf-8').strip()}; here is {versions().strip()}",
)
def test_pictures_of_the_two_bodies_and_of_the_landing_equal_newly_drawn_ones():
    """`make figures` draws it anew."""
    for name, content in bodies_pictures().items():
        assert (DOCS / name).read_bytes() == content, name


def test_the_picture_of_the_two_bodies_is_the_first_of_the_readme_and_names_sizes_and_positions():
    readme = (DOCS.parent / "README.md").read_text(encoding="utf-8")
    assert re.findall(r"\]\(([\w/-]+\.svg)\)", readme)[0] == "docs/figures/bodies.svg"
    texts = {"".join(each.itertext()).strip() for each in ElementTree.parse(DOCS / "figures" / "bodies.svg").iter()}  # noqa: S314
    rows = [(bodies.ALPHA, bodies.GAMMA, bodies.B, bodies.D, x, 0.0, z) for x, z in bodies.CENTRES]
    assert {exact_position(row) for row in rows} == {1, 0, -1}
    assert {"α", "γ", "b", "d", "waist, z = 0", *(each.label for each in Position)} <= texts
    assert "z_max, where it may end" in texts
    assert bodies.Z_MAX > max(z + bodies.D for _, z in bodies.CENTRES)  # so it is right of them without an end


def test_the_picture_of_the_landing_shows_the_height_of_the_first_contact_and_the_answer_at_the_end():
    """The top is at z = 2 and the drone reaches 0.2 down: it touches first at z = 2.2, its centre above the rim."""
    root = ElementTree.parse(DOCS / "figures" / "landing.svg").getroot()  # noqa: S314 - our own
    texts = {"".join(element.itertext()).strip() for element in root.iter()}
    assert {"first contact, z = 2.20", "z = 2.01: contact", "z = 3.2: exterior", "z_max = 2", "low tree"} <= texts
    assert "(figures/landing.svg)" in (DOCS / "scenes.md").read_text(encoding="utf-8")


COMMITTED = sorted([*(DOCS / "figures").glob("*.svg"), *(DOCS / "simulate").glob("*.svg")])


@pytest.mark.parametrize("path", COMMITTED, ids=lambda path: path.stem)
def test_picture_in_docs_has_its_light_colours_without_a_style_sheet(path):
    """Viewers outside a browser know no variables of style sheets: there a mark has the colours of its attributes."""
    root = ElementTree.parse(path).getroot()  # noqa: S314 - our own
    assert "var(" not in path.read_text(encoding="utf-8")
    painted = [element for element in root.iter() if "-" in (element.get("class") or "")]
    assert painted
    for element in painted:
        for name in element.get("class").split():
            letter, _, role = name.partition("-")
            assert element.get({"f": "fill", "s": "stroke"}[letter]) == ROLES[role][0], element.attrib
    assert all(element.get("fill") for element in root.iter("{http://www.w3.org/2000/svg}text"))


def test_each_picture_of_the_paper_page_has_a_title_and_a_description():
    for name in set(re.findall(r"\]\((\w+/[\w-]+\.svg)\)", PAGE)):
        root = ElementTree.fromstring((DOCS / name).read_bytes())  # noqa: S314 - our own
        texts = {element.tag.rpartition("}")[2]: element.text for element in root}
        assert texts["title"]
        assert len(texts["desc"]) > 40


def test_drawn_overlap_of_two_discs_is_a_lens_or_empty():
    apart = 0.1415 * math.sqrt(2)
    assert paper._lens((0, 0), (apart, 0), 0.1) == []
    lens = paper._lens((0, 0), (0.19, 0), 0.1)
    assert all(math.hypot(x, y) <= 0.1 + 1e-12 and math.hypot(x - 0.19, y) <= 0.1 + 1e-12 for x, y in lens)
    assert min(x for x, _ in lens) == pytest.approx(0.09)
    assert max(x for x, _ in lens) == pytest.approx(0.1)
