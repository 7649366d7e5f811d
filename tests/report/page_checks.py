"""Checks of a report's page in a browser; each returns a list of sentences about faults."""

from __future__ import annotations

import io
from pathlib import Path

SCRIPT = Path(__file__).with_name("page_checks.js").read_text(encoding="utf-8")
"""The checks that look at many elements at once, as functions of an object."""

LEAST_CONTRAST = 4.5
"""Of text against its ground (WCAG 2.2, 1.4.3)."""

LEAST_VARIANCE = 5
"""Of the brightness of a plot's dots, from 0 to 255; that of white paper is 0."""


PAPER = 688
"""Pixels between the margins of an A4 sheet."""


def run(visit, name, argument=None):
    """What a function of SCRIPT finds on the page."""
    return visit.page.evaluate(f"(argument) => {SCRIPT.strip().rstrip(';')}.{name}(argument)", argument)


def quiet(visit):
    """Nothing on the console and nothing from the network; pictures within the page are no requests."""
    asked = [url for url in visit.requests if not url.startswith(("data:", "file:"))]
    files = [url for url in visit.requests if url.startswith("file:")]
    return [*visit.said, *(f"asked for {url[:80]}" for url in (*asked, *files[1:]))]


def overflowing(visit):
    """Nothing makes the page wider than the window, whatever is unfolded."""
    visit.unfold()
    wide = visit.page.evaluate("document.documentElement.scrollWidth - innerWidth")
    return [f"the page is {wide} px wider than the window"] if wide > 0 else []


def blank(visit):
    """Every plot shows something: the brightness of its dots varies."""
    from PIL import Image, ImageStat

    visit.unfold()
    boxes = run(visit, "plots")
    whole = Image.open(io.BytesIO(visit.page.screenshot(full_page=True))).convert("L")
    found = [] if boxes else ["there is no plot"]
    for name, *box in boxes:
        if ImageStat.Stat(whole.crop(box)).var[0] < LEAST_VARIANCE:
            found.append(f"{name} is blank")
    return found


def overlapping(visit):
    """No text of a plot covers another or leaves the plot, in the fonts of this browser."""
    visit.unfold()
    return run(visit, "overlapping")


def faint(visit):
    """All text has enough contrast."""
    visit.unfold()
    return run(visit, "faint", LEAST_CONTRAST)


def unsorted(visit):
    """Each column's button sorts by it, once more the other way round, and a third time restores the order."""
    visit.unfold()
    found = run(visit, "unsorted")
    button = visit.page.locator("thead button").first
    if button.count():
        for key, wanted in (("Enter", "ascending"), ("Space", "descending")):
            button.press(key)
            sorted_so = button.locator("xpath=..").get_attribute("aria-sort")
            if sorted_so != wanted:
                found.append(f"after {key} aria-sort is {sorted_so}")
    return found


def unfiltered(visit):
    """A word in a table's filter hides the rows without it, and the count says so; without the word all are back."""
    visit.unfold()
    found, tables = [], visit.page.locator(".table:has(tbody tr:nth-child(8))").all()
    for table in tables:
        name, line = table.get_attribute("aria-label"), table.locator("xpath=preceding-sibling::*[1]")
        if "filter" not in (line.get_attribute("class") or ""):
            found.append(f"{name}: no filter")
            continue
        texts = table.locator("tbody tr").evaluate_all("rows => rows.map(row => row.textContent.toLowerCase())")
        word = run(visit, "distinctive", texts)
        for words in (word, ""):
            line.get_by_label("Filter").fill(words)
            shown = table.locator("tbody tr:visible").evaluate_all(
                "rows => rows.map(row => row.textContent.toLowerCase())"
            )
            if shown != [text for text in texts if words in text]:
                found.append(f"{name}: {words!r} shows {len(shown)} of {len(texts)}")
            if f"{len(shown)} of {len(texts)} rows" != line.locator("output").inner_text():
                found.append(f"{name}: the count is {line.locator('output').inner_text()}")
    return found or ([] if tables else ["no table is long enough"])


def unreachable(visit):
    """The first tab stop leads to the report, focus is visible, and a key opens a fold."""
    visit.page.keyboard.press("Tab")
    first = visit.page.evaluate("document.activeElement.className")
    found = [] if first == "skip" else [f"the first tab stop is {first!r}"]
    if visit.page.evaluate("document.activeElement.getBoundingClientRect().left") < 0:
        found.append("the skip link is not seen when it has focus")
    visit.page.keyboard.press("Enter")
    if visit.page.evaluate("document.activeElement.id") != "main":
        found.append("the skip link does not lead to the report")
    for _ in range(3):
        visit.page.keyboard.press("Tab")
        if visit.page.evaluate("getComputedStyle(document.activeElement).outlineStyle") == "none":
            found.append(f"{visit.page.evaluate('document.activeElement.outerHTML')[:60]} does not show its focus")
    summary = visit.page.locator("summary").first
    if summary.count():
        summary.press("Enter")
        if not visit.page.locator("details").first.evaluate("each => each.open"):
            found.append("a fold does not open by a key")
    return found


def folded_on_paper(visit):
    """On paper nothing is folded away or wider than the sheet, and nothing is there that only a screen can use."""
    visit.page.emulate_media(media="print")
    visit.page.set_viewport_size({"width": PAPER, "height": 900})
    visit.page.evaluate("dispatchEvent(new Event('beforeprint'))")
    found = []
    if visit.page.locator("details:not([open])").count():
        found.append("something stays folded")
    wide = visit.page.evaluate("document.documentElement.scrollWidth")
    if wide > PAPER:
        found.append(f"the page is {wide} px wide, the sheet {PAPER}")
    hidden = (".skip", "nav", ".filter")
    found += [f"{each} is printed" for each in hidden if visit.page.locator(f"{each}:visible").count()]
    visit.page.evaluate("dispatchEvent(new Event('afterprint'))")
    if visit.page.locator("details[open]").count():
        found.append("what was unfolded for paper stays unfolded")
    visit.page.emulate_media(media="screen")
    visit.page.set_viewport_size({"width": 1280, "height": 900})
    return found


def untold(visit):
    """Every plot has a title and a description; hovering over a mark shows its text below the plot."""
    visit.unfold()
    found = []
    for plot in visit.page.locator("svg.plot").all():
        names = (plot.get_attribute("aria-labelledby") or "").split()
        texts = plot.evaluate("(plot, names) => names.map(name => document.getElementById(name)?.textContent)", names)
        if len(texts) != 2 or not all(texts):
            found.append(f"{names} are {texts}")
    mark = visit.page.locator("svg.plot g > :is(use, path):has(> title)").first
    if mark.count():
        mark.dispatch_event("pointerover")
        figure = mark.locator("xpath=ancestor::*[local-name()='figure']")
        if figure.locator(".tip").inner_text() != mark.evaluate("each => each.querySelector('title').textContent"):
            found.append("a tooltip is not told below its plot")
    else:
        found.append("no mark has a tooltip")
    return found
