"""A document in LaTeX, which every LaTeX engine compiles, with common packages.

Plain text with formulas, from the derivation and the ledger, becomes LaTeX: x_c² + y_c² is x_{c}^{2} + y_{c}^{2}. The
result is ASCII, so that every encoding works.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Iterator

from hypcheck.report import document
from hypcheck.report.text import broken, column_widths, matrix_of

_LETTERS = {"α": r"\alpha", "γ": r"\gamma", "λ": r"\lambda", "μ": r"\mu", "φ": r"\varphi", "ρ": r"\rho", "θ": r"\theta"}
_LETTERS |= {"π": r"\pi", "Δ": r"\Delta"}
_SIGNS = {
    "−": "-",
    "·": r"\,",
    "×": r"\times ",
    "÷": r"\div ",
    "≤": r"\leq ",
    "≥": r"\geq ",
    "≠": r"\neq ",
    "≈": r"\approx ",
    "±": r"\pm ",
    "⟺": r"\Longleftrightarrow ",
    "⟹": r"\Longrightarrow ",
    "⟸": r"\Longleftarrow ",
    "←": r"\leftarrow ",
    "∞": r"\infty ",
    "√": r"\surd ",
    "ᵀ": r"^{\mathrm{T}}",
    **{sign: sign for sign in "+=<>|/"},
}
_FUNCTIONS = {"cos": r"\cos", "det": r"\det", "diag": r"\mathrm{diag}"}
_OF_ROTORS = {"cosine": r"\cos g_{i}", "sine": r"\sin g_{i}"}
_PUNCTUATION = {
    "ó": r"\'o",
    "“": "``",
    "”": "''",
    "–": "--",
    "…": r"\ldots{}",
    "’": "'",
    "%": r"\%",
    "&": r"\&",
    "#": r"\#",
    "_": r"\_",
}
_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_LOWERED = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")

_TOKEN = re.compile(
    r"(?P<code>`[^`]*`)"
    r"|(?P<plain>\d+\.[ab\d]\b|i\.e\.)"
    r"|(?P<raised>[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+)"
    r"|(?P<lowered>[₀₁₂₃₄₅₆₇₈₉]+)"
    r"|(?P<root>√[A-Za-z\d]+)"
    r"|(?P<possessive>'s\b)"
    r"|(?P<word>[A-Za-zα-ωΑ-Ω]\u0304?[A-Za-zα-ωΑ-Ω\d_]*(?:'+(?![a-z]))?)"
    r"|(?P<number>(?<!\w)-\d+|\d+)"
    r"|(?P<other>.)",
    re.DOTALL,
)
_LETTER = re.compile(r"(?P<base>[A-Za-zαγλμφρθπΔ])(?P<bar>\u0304?)(?P<index>m|\d_?[a-z]?|_[a-z\d])?(?P<primes>'*)")
_PRODUCT = re.compile(r"[ABPQ]{2}|[αγ]t|λH")
_ARTICLE = re.compile(r"(?<![\d=<>≤≥+−/·])(?:(?<![=<>≤≥+−/·] )a|(?:^|(?<=\. ))A) [A-Za-z]{2}")


class UnknownCharacterError(ValueError):
    """A character without a LaTeX form in this module."""


def formula(text: str) -> str:
    """Return a formula for math mode; words in it are set as text. Raises UnknownCharacterError."""
    runs = _runs(_tokens(text), edge="math")
    return "".join(tex if kind == "math" else rf"\text{{{tex}}}" for tex, kind in runs)


def sentence(text: str) -> str:
    """Return a sentence with formulas in it, for text mode. Raises UnknownCharacterError."""
    runs = _runs(_tokens(text, articles=True), edge="text")
    return "".join(f"${tex}$" if kind == "math" else tex for tex, kind in runs)


Run = tuple[str, str]


def _runs(tokens: list[Run], edge: str) -> list[Run]:
    """Join tokens to runs of one mode. A space has the mode of its two sides if they are equal, else it is text."""
    kinds = ["text" if kind == "space" else kind for _, kind in tokens]
    for place, (_, kind) in enumerate(tokens):
        if kind == "mark":  # brackets and commas go with a formula that they touch
            touched = {tokens[beside][1] for beside in (place - 1, place + 1) if 0 <= beside < len(tokens)}
            kinds[place] = "math" if "math" in touched or edge == "math" else "text"
    for place, (_, kind) in enumerate(tokens):
        if kind == "space" and 0 < place < len(tokens) - 1 and kinds[place - 1] == kinds[place + 1] == "math":
            kinds[place] = "math"
    joined: list[Run] = []
    for (tex, _), kind in zip(tokens, kinds, strict=True):
        if joined and joined[-1][1] == kind:
            before = joined[-1][0]
            joined[-1] = (before + (tex.lstrip() if before.endswith(" ") else tex), kind)
        else:
            joined.append((tex, kind))
    return joined


def _tokens(text: str, *, articles: bool = False) -> list[Run]:
    """Divide a text into tokens. With `articles`, as in sentences, "a" before a word and "cosine" are text."""
    return [
        (match[0], "text")
        if articles and (match[0] in _OF_ROTORS or _ARTICLE.match(text, match.start()))
        else _token(match)
        for match in _TOKEN.finditer(text)
    ]


def _token(match: re.Match[str]) -> Run:
    """Return one token in LaTeX and its mode: "math", "text", "space", or "mark", which can be math or text."""
    text = match[0]
    if match["code"]:
        return rf"\texttt{{{plain(text.strip('`'))}}}", "text"
    if match["plain"]:
        return text, "text"
    if match["raised"]:
        return f"^{{{text.translate(_RAISED)}}}", "math"
    if match["lowered"]:
        return f"_{{{text.translate(_LOWERED)}}}", "math"
    if match["root"]:
        return rf"\sqrt{{{formula(text[1:])}}}", "math"
    if match["number"]:
        return text, "math"
    if match["word"]:
        return _word(text)
    if text.isspace():
        return " ", "space"
    if text in _SIGNS:
        return _SIGNS[text], "math"
    return plain(text), "mark" if text in "()[],.;:'!" else "text"


def _word(text: str) -> Run:
    if text in _FUNCTIONS or text in _OF_ROTORS:
        return {**_FUNCTIONS, **_OF_ROTORS}[text], "math"
    if _PRODUCT.fullmatch(text):
        return " ".join(_LETTERS.get(letter, letter) for letter in text), "math"
    letter = _LETTER.fullmatch(text)
    if letter is None:
        return plain(text), "text"
    base = _LETTERS.get(letter["base"], letter["base"])
    index = (letter["index"] or "").replace("_", "")
    named = (rf"\bar{{{base}}}" if letter["bar"] else base) + (f"_{{{','.join(index)}}}" if index else "")
    return named + letter["primes"], "math"


def plain(text: str) -> str:
    """Return words without formulas, with the characters that are special in LaTeX escaped.

    Raises UnknownCharacterError.
    """
    escaped = "".join(_PUNCTUATION.get(character, character) for character in text)
    if not escaped.isascii():
        raise UnknownCharacterError(f"there is no LaTeX here for a character of {text!r}")
    return escaped


_BEGIN = r"""\documentclass{article}
\usepackage{amsmath,amssymb,longtable}
\usepackage[a4paper,margin=25mm]{geometry}
\setlength{\parindent}{0pt}
\begin{document}"""

_ROOM = 88
"""Columns of plain text that fit on a line as a display."""


def lines(sections: Iterable[document.Section]) -> Iterator[str]:
    """Yield the whole document."""
    yield _BEGIN
    for section in sections:
        yield rf"\{'sub' * (section.level - 2)}section*{{{_inline(section.title)}}}"
        for block in section.blocks:
            yield from (*_block(block), "")
    yield r"\end{document}"


def _block(block: document.Block) -> Iterator[str]:
    """Yield the lines of a block; a document in LaTeX has no pictures and no folded blocks."""
    match block:
        case document.Paragraph(words):
            yield _text(words)
        case document.Bullets(items, numbered) if items:
            kind = "enumerate" if numbered else "description" if items[0].title else "itemize"
            yield rf"\begin{{{kind}}}"
            for item in items:
                yield rf"\item{f'[{{{_inline(item.title)}}}]' if item.title else ''} {_text(item.text)}"
                yield from (f"\n{_text(text)}" for text in item.below)
            yield rf"\end{{{kind}}}"
        case document.TableBlock():
            yield from _table(block)
        case document.Either(text=text):
            yield from _block(text)


def _table(block: document.TableBlock) -> Iterator[str]:
    """Yield a table that may be longer than a page; the columns of one that is too wide have fixed widths."""
    rows = [tuple(column.title for column in block.columns), *(tuple(cell.text for cell in row) for row in block.rows)]
    shown = [[document.plain(words) for words in row] for row in rows]
    natural, fitting = (column_widths(block, shown, room) for room in (sys.maxsize, _ROOM))
    kinds = [
        "r" if column.number else "l" if natural == fitting else rf"p{{{width / _ROOM:.2f}\linewidth}}"
        for column, width in zip(block.columns, fitting, strict=True)
    ]
    yield r"{\footnotesize\setlength{\tabcolsep}{3pt}"
    yield rf"\begin{{longtable}}{{{''.join(kinds)}}}"
    for number, row in enumerate(rows):
        yield " & ".join(map(_text, row)) + (r" \\" if number else r" \\ \hline \endhead")
    yield r"\end{longtable}}"


def _text(words: document.Text) -> str:
    """Return a text of its own: a formula is displayed. A bracket at its beginning would be read as an option."""
    if isinstance(words, document.ShownFormula):
        return _display(words)
    shown = _inline(words)
    return f"{{}}{shown}" if shown.startswith("[") else shown


def _inline(words: document.Text) -> str:
    match words:
        case str():
            return sentence(words)
        case document.Code(text):
            return rf"\texttt{{{plain(text)}}}"
        case document.Strong(text):
            return rf"\textbf{{{_inline(text)}}}"
        case document.Emphasis(text):
            return rf"\emph{{{_inline(text)}}}"
        case document.ShownFormula(text, remark):
            return f"${formula(text)}$ {remark}".rstrip()
        case _:
            return "".join(map(_inline, words))


def _display(shown: document.ShownFormula) -> str:
    """Return a formula on its own, with its remark as its tag; one that is too long in several lines."""
    if (named := matrix_of(shown.text)) is not None:
        name, cells = named
        rows = (" & ".join(map(formula, row)) for row in cells)
        body = formula(name) + r" = \begin{pmatrix} " + r" \\ ".join(rows) + r" \end{pmatrix}"
    else:
        first, *others = map(formula, broken(shown.text, _ROOM))
        further = "".join(rf" \\ & \quad {piece}" for piece in others)
        body = rf"\begin{{aligned}} & {first}{further} \end{{aligned}}" if others else first
    return rf"\begin{{equation*}} {body} \tag*{{{shown.remark}}} \end{{equation*}}"
