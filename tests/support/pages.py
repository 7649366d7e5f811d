"""Pages as whoever types them reads them: the files to write and the commands to type, in their order.

A page writes a file where a block of code between ``` begins with a comment that is a name: `# mine.py`, `// mine.js`,
`/* mine.c */`. A command stands in an indented block behind `$ `; the lines below it are what it prints. A command with
`# ends with N` behind it ends with that exit code, every other with 0. Where output is shown, all of it is
compared: … stands for anything within a line, and a line that is only … for any lines. So a page leaves open times and
facts about a machine.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PATTERNS = (
    "*.md",
    "docs/*.md",
    "cases/*.md",
    "reports/README.md",
    "reports/engines/README.md",
    "reports/reference/**/README.md",
)
PAGES = sorted(path for pattern in PATTERNS for path in ROOT.glob(pattern))
"""Every page; the reports that a run prints are none."""

PARTS = re.compile(
    r"^```\w+\n(?P<file>(?:#|//|/\*) (?P<name>[\w-]+\.\w+)(?: \*/)?\n[\s\S]*?)^```"
    r"|^```[\s\S]*?^```"
    r"|^    \$ (?P<command>.*(?:\\\n.*)*)\n(?P<shown>(?:    (?!\$ ).*\n|\n(?=    (?!\$ )))*)",
    re.MULTILINE,
)


@dataclass(frozen=True)
class Written:
    """A file to write."""

    name: str
    text: str


@dataclass(frozen=True)
class Typed:
    """A command to type, with its exit code and the lines that the page shows of its output."""

    command: str
    code: int
    shown: tuple[str, ...]

    @property
    def words(self) -> str:
        """The command without the comment behind it."""
        return re.sub(r"\s+#\s.*$", "", self.command)


def parts(text: str) -> Iterator[Written | Typed]:
    """What a page says to write and to type."""
    for found in PARTS.finditer(text):
        if found["name"]:
            yield Written(found["name"], found["file"])
        elif found["command"]:
            code = re.search(r"# ends with (\d+)$", found["command"])
            shown = tuple(line.removeprefix("    ") for line in found["shown"].splitlines())
            yield Typed(found["command"], int(code[1]) if code else 0, shown)


def prints(output: str, shown: tuple[str, ...]) -> bool:
    """Whether a command printed what is shown of it."""
    lines = ["(?:.*\n)*?" if line == "…" else ".*?".join(map(re.escape, line.split("…"))) + "\n" for line in shown]
    return not shown or re.fullmatch("".join(lines), output.rstrip("\n") + "\n") is not None


def prose(text: str) -> str:
    """The page without its blocks of code."""
    return re.sub(r"^```[\s\S]*?^```$|^    .*$", "", text, flags=re.MULTILINE)


def commands_in_prose(text: str) -> list[str]:
    """The commands of hypcheck that stand between backquotes within sentences."""
    return [
        found.replace("\n", " ") for found in re.findall(r"`(?:[A-Z_]+=\S+ )?(hypcheck\s[^`]+)`", prose(text)) if found
    ]
