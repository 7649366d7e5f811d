"""docs/evidence.md and the long lists beside it, printed from the kept figures."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator

from tests.tools.evidence.parts import PAGE, PARTS, TABLES, Figures, part

OPENING = """\
# Evidence about our own code

For those who change `hypcheck`, or ask how well its own code is tested. Afterwards you know which code no test runs,
and which faults no test finds.

Mutants, fuzzing, coverage and injected faults test our own code. This page has the results; long lists are tables in
docs/evidence/. `make evidence` measures every figure again and writes the page;
`python -m tests.tools.evidence PART --write` measures one part. Continuous integration runs short forms of them, and
fails if a figure falls below its floor (`tests/tools/evidence/floors.py`).
"""

MOST = 20
"""Lines of a list or a table on the page; a longer one is a file of its own."""

_LISTED = re.compile(r"(?:^(?:- |  - |\| ).*\n)+", re.MULTILINE)


def write_page(figures: dict[str, Figures]) -> None:
    """Write docs/evidence.md and the tables beside it."""
    text, tables = page(figures)
    PAGE.write_text(text, encoding="utf-8")
    TABLES.mkdir(exist_ok=True)
    for path in TABLES.glob("*.csv"):
        path.unlink()
    for name, table in tables.items():
        (TABLES / name).write_text(table, encoding="utf-8")


def page(figures: dict[str, Figures]) -> tuple[str, dict[str, str]]:
    """The text of docs/evidence.md, and the texts of the tables in docs/evidence/ by their names."""
    sections, tables = [OPENING], {}
    for name in PARTS:
        text = f"## {part(name).TITLE}\n\n{part(name).section(figures[name]).strip()}\n"
        shorter, own = _shortened(name, text)
        sections.append(shorter)
        tables |= own
    return "\n".join(sections), tables


def _shortened(name: str, text: str) -> tuple[str, dict[str, str]]:
    """The text without its long lists, and these as tables by the names of their files."""
    tables: dict[str, str] = {}

    def moved(found: re.Match[str]) -> str:
        lines = found.group().splitlines()
        if len(lines) <= MOST:
            return found.group()
        file = f"{name}{'' if not tables else f'-{len(tables) + 1}'}.csv"
        rows = list(_cells(lines) if lines[0].startswith("| ") else _items(lines))
        out = io.StringIO()
        csv.writer(out, lineterminator="\n").writerows(rows)
        tables[file] = out.getvalue()
        return f"{len(rows) - 1:,} rows: [evidence/{file}](evidence/{file})\n"

    return _LISTED.sub(moved, text), tables


def _cells(lines: list[str]) -> Iterator[list[str]]:
    """The rows of a table of Markdown, its heading first."""
    for line in (line for line in lines if not line.startswith("| ---")):
        yield [_plain(cell) for cell in re.split(r"(?<!\\) \| ", line.removeprefix("| ").removesuffix(" |"))]


def _items(lines: list[str]) -> Iterator[list[str]]:
    """The rows of a list: an item with the reason above it, or what stands before and behind a colon."""
    nested, above = any(line.startswith("  - ") for line in lines), ""
    yield ["what", "why"]
    for line in lines:
        if line.startswith("  - "):
            yield [_plain(line[4:]), above]
        elif nested:
            above = _plain(line[2:].removesuffix(":"))
        else:
            what, _, why = line[2:].partition("`: ")
            yield [_plain(what + "`" * bool(why)), _plain(why)]


def _plain(text: str) -> str:
    """The text without marks of code around the whole of it."""
    text = text.strip()
    return text[1:-1] if len(text) > 1 and text[0] == text[-1] == "`" and "`" not in text[1:-1] else text
