"""The page in a real browser: quiet, readable on a telephone and in the dark, sorted, filtered, printed, by keyboard.

Each check is also shown to fail on a page that is broken in the way it looks for.
"""

from __future__ import annotations

import math
import re

import pytest

from hypcheck.geometry.pair import COLUMNS
from hypcheck.report.html import explorer_page
from tests.report import browser, page_checks
from tests.report.pages import RECORDS, page_of


@pytest.fixture(scope="module")
def chromium():
    with browser.opened() as window:
        yield window


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pages")
    found = {name: folder / f"{name}.html" for name in RECORDS}
    for name, path in found.items():
        path.write_bytes(page_of(name))
    found["explorer"] = folder / "explorer.html"
    found["explorer"].write_bytes(explorer_page())
    return found


@pytest.mark.parametrize("name", RECORDS)
def test_the_page_passes_every_check_in_all_sizes_and_schemes(chromium, files, name):
    """On a desk, then on a telephone, in the light and in the dark."""
    visit = chromium.visit(files[name])
    assert page_checks.unreachable(visit) == []
    assert page_checks.unsorted(visit) == []
    assert page_checks.untold(visit) == []
    assert page_checks.blank(visit) == []
    assert page_checks.overlapping(visit) == []
    visit.page.set_viewport_size({"width": 360, "height": 800})
    assert page_checks.overflowing(visit) == []
    for scheme in ("light", "dark"):
        visit.page.emulate_media(color_scheme=scheme)
        assert page_checks.faint(visit) == []
    assert page_checks.quiet(visit) == []


@pytest.mark.parametrize("name", ["small", "bench"])
def test_report_tables_can_be_filtered_and_are_printed_in_full(chromium, files, name):
    visit = chromium.visit(files[name])
    assert page_checks.folded_on_paper(visit) == []
    assert page_checks.unfiltered(visit) == []


def test_page_is_dark_in_the_dark_scheme_and_white_on_paper(chromium, files):
    visit = chromium.visit(files["small"])
    ground = "getComputedStyle(document.body).backgroundColor"
    visit.page.emulate_media(color_scheme="dark")
    assert visit.page.evaluate(ground) == "rgb(20, 24, 29)"
    visit.page.emulate_media(media="print")
    assert visit.page.evaluate(ground) == "rgb(255, 255, 255)"


@pytest.fixture
def visit(chromium, files):
    """The explorer as a page of its own."""
    return chromium.visit(files["explorer"])


def said(visit):
    return visit.page.locator(".said").inner_text()


def numbers(visit):
    return [float(visit.page.locator(f"#explorer-{name}").input_value()) for name in COLUMNS]


def test_explorer_has_no_errors_and_is_readable_and_labelled_for_a_screen_reader(visit):
    assert "Exact answer: exterior. Clearance: 0.5 spheroid radii. On the ring" in said(visit)
    unnamed = "all => all.filter(each => !each.labels.length && !each.ariaLabel).map(each => each.outerHTML)"
    assert visit.page.locator("input").evaluate_all(unnamed) == []
    assert visit.page.locator("input").count() == 14
    assert visit.page.get_by_role("application", name="The two bodies in the half plane (r, z)").count() == 1
    assert visit.page.locator(".said").get_attribute("aria-live") == "polite"
    assert page_checks.unreachable(visit) == []
    for scheme in ("light", "dark"):
        visit.page.emulate_media(color_scheme=scheme)
        assert page_checks.faint(visit) == []
    visit.page.set_viewport_size({"width": 360, "height": 800})
    assert page_checks.overflowing(visit) == []
    assert page_checks.quiet(visit) == []


def test_keys_sliders_and_buttons_of_the_explorer_move_the_bodies(visit):
    picture = visit.page.locator(".half-plane")
    for key, place, change in (("ArrowRight", 4, 1), ("ArrowLeft", 4, -1), ("ArrowUp", 6, 1), ("ArrowDown", 6, -1)):
        before = numbers(visit)[place]
        picture.press(key)
        moved = numbers(visit)[place] - before
        assert moved * change > 0, key
        picture.press(f"Shift+{key}")
        assert 0 < (numbers(visit)[place] - before - moved) / moved < 0.02, key
    visit.page.get_by_label("α, radius of the waist, slider").fill("0.3")
    assert numbers(visit)[0] == 2.0
    assert "contact" in said(visit)
    visit.page.get_by_label("γ, height where the radius is α√2", exact=True).fill("8")
    visit.page.get_by_role("button", name="Go to the ring").click()
    assert numbers(visit)[4:] == [pytest.approx(math.sqrt(65 * (4 + 64) / 64)), 0, 0]
    assert "Exact answer: exterior" in said(visit)
    visit.page.get_by_label("γ, height where the radius is α√2", exact=True).fill("1")
    assert visit.page.get_by_role("button", name="Go to the ring").is_disabled()


def test_a_pointer_drags_the_centre_of_the_explorer(visit):
    box = visit.page.locator(".half-plane").bounding_box()
    visit.page.mouse.move(box["x"] + box["width"] * 0.6, box["y"] + box["height"] * 0.5)
    visit.page.mouse.down()
    visit.page.mouse.move(box["x"] + box["width"] * 0.3, box["y"] + box["height"] * 0.3, steps=3)
    visit.page.mouse.up()
    moved = numbers(visit)
    assert "Exact answer: contact" in said(visit)
    assert moved[6] > 0.5
    visit.page.mouse.move(box["x"] + box["width"] * 0.9, box["y"] + box["height"] * 0.5)
    assert numbers(visit) == moved
    ellipse, edge = (visit.page.locator(f".half-plane {name}").bounding_box() for name in ("ellipse", ".center"))
    assert ellipse["x"] + ellipse["width"] / 2 == pytest.approx(edge["x"] + edge["width"] / 2, abs=1)


def test_explorer_draws_and_answers_where_the_hyperboloid_ends(visit):
    """A drone above the top of a tree: exterior, in contact with the rim from just above it; solid, with the disc."""
    for name, value in zip(COLUMNS, (0.2, 1, 0.3, 0.2, 0.45, 0, 2.01), strict=True):
        visit.page.locator(f"#explorer-{name}").fill(str(value))
    assert "Exact answer: contact" in said(visit)
    low, high = (visit.page.locator(f"#explorer-{name}") for name in ("z_min", "z_max"))
    high.fill("2")
    low.fill("-1")
    assert "Exact answer: contact. Clearance: not computed beside ends." in said(visit)
    assert "The formulas know no ends; without these it is contact." in said(visit)
    assert visit.page.locator(".half-plane .end").count() == 2
    high.fill("1.5")
    assert "Exact answer: exterior" in said(visit)
    visit.page.locator("#explorer-x").fill("0")
    visit.page.locator("#explorer-z").fill("1.45")
    assert "Exact answer: interior" in said(visit)
    visit.page.locator("#explorer-z").fill("1.65")
    assert "Exact answer: exterior" in said(visit)
    visit.page.get_by_label("flat ends belong to it (solid)").check()
    assert "Exact answer: contact" in said(visit)
    assert visit.page.locator(".half-plane .end.solid").count() == 2
    high.fill("-2")
    assert "z_min must be less than z_max" in said(visit)
    assert high.get_attribute("aria-invalid") == "true"
    high.fill("")
    low.fill("")
    assert visit.page.locator(".half-plane .end").count() == 0
    assert page_checks.quiet(visit) == []


def test_a_pointer_drags_an_end_of_the_explorer_by_its_handle(visit):
    visit.page.get_by_role("button", name="Ends, or none").click()
    before = numbers(visit)
    ends = [visit.page.locator(f"#explorer-{name}") for name in ("z_min", "z_max")]
    low, high = (float(end.input_value()) for end in ends)
    assert low < high == 0
    grip = visit.page.locator(".half-plane .grip").last.bounding_box()
    x, y = grip["x"] + grip["width"] / 2, grip["y"] + grip["height"] / 2
    visit.page.mouse.move(x, y)
    visit.page.mouse.down()
    visit.page.mouse.move(x, y - 60, steps=3)
    visit.page.mouse.up()
    assert numbers(visit) == before
    assert float(ends[0].input_value()) == low
    assert float(ends[1].input_value()) > 0.2
    moved = visit.page.locator(".half-plane .grip").last.bounding_box()
    assert moved["y"] == pytest.approx(grip["y"] - 60, abs=2)
    visit.page.get_by_role("button", name="Ends, or none").click()
    assert [end.input_value() for end in ends] == ["", ""]
    assert page_checks.quiet(visit) == []


def test_explorer_refuses_an_invalid_size_in_one_sentence(visit):
    field = visit.page.get_by_label("b, semi-axis across", exact=True)
    field.fill("-1")
    assert "b, semi-axis across must be a number greater than 0 of float64." in said(visit)
    assert field.get_attribute("aria-invalid") == "true"
    field.fill("1e-160")
    assert field.get_attribute("aria-invalid") is None
    assert "Exact answer: exterior" in said(visit)
    assert page_checks.quiet(visit) == []


def test_a_case_of_a_report_has_its_picture_and_opens_in_the_explorer(chromium, files):
    visit = chromium.visit(files["small"])
    visit.unfold()
    cases = visit.page.locator("code[data-row]")
    assert cases.count() == visit.page.locator("svg.bodies").count() == visit.page.locator("button.open").count() > 2
    code = cases.last
    code.locator("xpath=following-sibling::button").click()
    assert visit.page.locator(".explorer [data-is=origin]").inner_text() == f"Case {code.inner_text()}."
    assert numbers(visit) == [float(each) for each in code.get_attribute("data-row").split()]
    assert visit.page.evaluate("document.activeElement.dataset.is") == "picture"
    assert page_checks.quiet(visit) == []


def without(pattern, replacement=""):
    return lambda page: re.sub(pattern, replacement, page, count=1, flags=re.DOTALL)


def loosened(page):
    """The page with a policy that allows a changed style or script, so that a check can find the fault itself."""
    return re.sub(r"'sha256-[^']+'", "'unsafe-inline'", page)


BROKEN = {
    "a script that is not ours": (page_checks.quiet, without("</main>", "<script>let x</script></main>")),
    "a style that is not ours": (page_checks.quiet, without("<main", '<main style="color:red"')),
    "a picture from elsewhere": (page_checks.quiet, without("</main>", '<img src="https://example.org/a.png"></main>')),
    "an error in the script": (
        page_checks.quiet,
        lambda page: loosened(page).replace("function tipped(", "broken(); ("),
    ),
    "a long word": (page_checks.overflowing, without("</main>", f"<p><nobr>{'x' * 300}</nobr></main>")),
    "a wide table": (page_checks.overflowing, without(r"\.table\{overflow-x:auto;", ".table{")),
    "an empty plot": (page_checks.blank, without(r'(<svg[^>]*class="plot".*?</desc>).*?</svg>', r"\1</svg>")),
    "no plots": (page_checks.blank, lambda page: re.sub(r'<svg[^>]*class="plot".*?</svg>', "", page, flags=re.DOTALL)),
    "a label on another": (
        page_checks.overlapping,
        without(r'(<text x=")[\d.]+(" y=")[\d.]+(.*?<text x=")[\d.]+(" y=")[\d.]+', r"\g<1>99\g<2>99\g<3>99\g<4>99"),
    ),
    "a label outside": (page_checks.overlapping, without(r'<text x="[\d.]+"', '<text x="2000"')),
    "faint text": (page_checks.faint, lambda page: page.replace("--soft:#57606b", "--soft:#c0c8d0")),
    "text in a plot's ground": (
        page_checks.faint,
        lambda page: page.replace(".f-ink{fill:var(--ink)}", ".f-ink{fill:#eee}"),
    ),
    "no sorting": (page_checks.unsorted, lambda page: page.replace("  sortable(table);\n", "")),
    "numbers as words": (
        page_checks.unsorted,
        lambda page: page.replace("return a - b;", "return `${a}` < `${b}` ? -1 : 1;"),
    ),
    "one direction": (
        page_checks.unsorted,
        lambda page: page.replace("? -1 : 1;\n  const rows", "? 1 : 1;\n  const rows"),
    ),
    "no order to come back to": (
        page_checks.unsorted,
        lambda page: page.replace(
            '"none", "ascending", "descending"]', '"none", "ascending", "descending", "other"]'
        ).replace("% 3]", "% 3 || 1]"),
    ),
    "a filter that hides nothing": (
        page_checks.unfiltered,
        lambda page: page.replace("row.hidden = !", "row.unseen = !"),
    ),
    "a filter that counts wrongly": (page_checks.unfiltered, lambda page: page.replace("row.hidden ? 0 : 1", "1")),
    "no skip link": (page_checks.unreachable, without(r'<a class="skip".*?</a>')),
    "no focus to be seen": (page_checks.unreachable, without(r"outline:3px solid var\(--link\)", "outline:none")),
    "folds that stay on paper": (
        page_checks.folded_on_paper,
        lambda page: page.replace("each.open = true", "each.open = false"),
    ),
    "a table wider than paper": (
        page_checks.folded_on_paper,
        lambda page: page.replace(".n{white-space:normal}", ".n{min-width:20rem}"),
    ),
    "a printed menu": (page_checks.folded_on_paper, without(r"\.skip,nav,\.filter,\.tip\{display:none\}")),
    "a plot without a title": (page_checks.untold, without(r'(class="plot".*?)<title id=.*?</title>', r"\1")),
    "tooltips that are not told": (
        page_checks.untold,
        lambda page: page.replace("tip.textContent = title", "tip.unseen = title"),
    ),
}


@pytest.mark.parametrize("fault", BROKEN)
def test_every_page_check_detects_a_broken_page(chromium, files, tmp_path, fault):
    check, break_it = BROKEN[fault]
    page = files["small"].read_text(encoding="utf-8")
    page = page if check is page_checks.quiet else loosened(page)
    broken = break_it(page)
    assert broken != page
    path = tmp_path / "broken.html"
    path.write_text(broken, encoding="utf-8")
    width = 360 if check is page_checks.overflowing else 1280
    visit = chromium.visit(path, width=width)
    assert check(visit) != []
