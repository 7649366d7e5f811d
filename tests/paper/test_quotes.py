"""Words in curly quotation marks on our pages, and in quotation marks in the erratum, are the paper's own.

The paper's text cannot be kept here. Where shared/paper.txt lies beside the repository each phrase is looked up in it;
everywhere its digest must be among those in quoted_phrases.txt, which hold only phrases that were found there.
To renew that file beside the paper's text: `python -m tests.paper.test_quotes`.
"""

from __future__ import annotations

import hashlib
import re
from html import unescape
from pathlib import Path

import pytest

from hypcheck.paper.derive import erratum
from hypcheck.paper.derive.content import Selection
from tests.support.pages import PAGES, ROOT

PAPER = ROOT.parent / "shared" / "paper.txt"
DIGESTS = Path(__file__).with_name("quoted_phrases.txt")

NAMES = {"alpha": "α", "beta": "β", "gamma": "γ", "lambda": "λ", "Delta": "Δ", "leq": "≤", "le": "≤", "geq": "≥"}
NAMES |= {"ge": "≥", "neq": "≠", "pi": "π"}


def normalised(text: str) -> str:
    """The text without spaces and the marks of LaTeX, so that formulas in LaTeX and in Unicode are the same."""
    text = re.sub(r"\\frac\s*\{(.*?)\}\{(.*?)\}", r"\1/\2", text)
    text = re.sub(r"\\(?:left|right|mathcal|mathrm|overline|bar|,|;|\\)(?![a-z])", "", text)
    text = re.sub(r"\\([A-Za-z]+)", lambda found: NAMES.get(found[1], ""), text)
    return re.sub(r"[\s$_{}~\\]", "", text)


def quoted() -> set[str]:
    """Every quoted phrase of the pages and of the erratum, normalised."""
    pages = unescape("\n".join(page.read_text(encoding="utf-8") for page in PAGES))
    note = "\n".join(erratum.lines(Selection(())))
    phrases = re.findall(r"“(.*?)”", pages, re.DOTALL) + re.findall(r"``(.*?)''", note, re.DOTALL)
    return {normalised(phrase) for phrase in phrases}


def digest(phrase: str) -> str:
    return hashlib.sha256(phrase.encode()).hexdigest()


def invented(phrases: set[str], paper: str) -> list[str]:
    """The phrases that the paper does not have."""
    text = normalised(paper)
    return sorted(phrase for phrase in phrases if phrase not in text)


def test_the_digest_of_every_quoted_phrase_is_committed_and_no_other():
    phrases = quoted()
    assert len(phrases) >= 15
    assert {digest(phrase) for phrase in phrases} == set(DIGESTS.read_text(encoding="utf-8").split())


@pytest.mark.skipif(
    not PAPER.exists(), reason="the paper's text is not beside the repository; its digests are compared"
)
def test_every_quoted_phrase_occurs_in_the_text_of_the_paper():
    assert invented(quoted(), PAPER.read_text(encoding="utf-8")) == []


def test_a_phrase_that_the_paper_does_not_have_is_found_and_one_in_latex_is_not():
    paper = r"detects contact, i.e. $\Delta \leq 0$, under $\left(\frac{a}{b}\right) \geq 1$"
    phrases = {normalised(each) for each in ("contact, i.e. Δ ≤ 0", "(a/b) ≥ 1", r"contact, i.e.\ $\Delta\le0$")}
    assert invented(phrases, paper) == []
    assert invented({normalised(r"Contact, i.e.\ $\Delta\le0$")}, paper) == ["Contact,i.e.Δ≤0"]
    assert invented({normalised("contact means Δ ≤ 0")}, paper) == ["contactmeansΔ≤0"]


if __name__ == "__main__":
    found = quoted()
    wrong = invented(found, PAPER.read_text(encoding="utf-8"))
    if wrong:
        raise SystemExit(f"not in the paper: {wrong}")
    DIGESTS.write_text("".join(f"{each}\n" for each in sorted(map(digest, found))), encoding="utf-8")
