"""Transcripts of the command line: what a person types, what is printed on either stream, and the exit code.

A transcript is a text file, tests/transcripts/COMMAND/SCENE.txt. A line at the margin is a remark. Behind an indented
`$ ` stands a command for bash, with its further lines behind `> `. Below it stand the lines that it printed, those of
standard error behind `2> `, then its exit code in brackets unless it is 0:

    An option that does not exist.

      $ hypcheck classify --aplha 1
      2> hypcheck: error: there is no option '--aplha'; did you mean --alpha?
      2> hypcheck: 'hypcheck classify --help' shows what is possible
      [2]

All commands of a transcript run in one folder, which is empty at first, in the environment of a user without the
libraries that draw. `each` gives hypcheck many lines in one process. MASKS lists what is no part of a transcript.
`make transcripts` writes all anew, and a person reads the difference. A remark that begins with `Thorough` makes the
test of its transcript one of `make thorough`.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

from hypcheck.version import VERSION

ROOT = Path(__file__).resolve().parents[2]
TRANSCRIPTS = ROOT / "tests" / "transcripts"
OWN = ("HYPCHECK_", "PYTHON", "PYTEST", "CI", "GITHUB_", "XDG_", "LC_", "LANG", "COLUMNS")
"""How variables begin that a stranger does not have, or that change what is printed."""
UNDRAWN = """
import sys
class Absent:
    @staticmethod
    def find_spec(name, *_):
        if name in ("matplotlib", "jinja2", "markupsafe"):
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
sys.meta_path.insert(0, Absent)
"""
"""Drawing takes most of a small run; tests/report is about it."""

MASKS = [
    (rf"(?<!schema\": \")\b{re.escape(VERSION)}\b", "VERSION"),
    (re.escape(str(ROOT)), "CLONE"),
    (r"\b(in|took|of|after|over) \d+(\.\d+)? s\b", r"\1 N s"),
    (r"(checksum is|must be) [0-9a-f]{8}\b", r"\1 CRC"),
    (r'("seconds": )\d[\d.e-]*', r"\1N"),
    (r"partly isolated: [^\n]*?; by [^;\n]*", "isolated by MEANS"),
    (r"(not )?isolated (by [^;\n]*|\((?!--isolate is off)[^;\n]*\))", "isolated by MEANS"),
]
"""Patterns, in their order, with what is shown in place of what they match: versions, paths, times."""


def paths() -> list[Path]:
    """The files of all transcripts."""
    return sorted(TRANSCRIPTS.glob("*/*.txt"))


def name_of(path: Path) -> str:
    """The command and the scene of a transcript."""
    return path.relative_to(TRANSCRIPTS).with_suffix("").as_posix()


def is_thorough(path: Path) -> bool:
    """Whether the transcript is left out of `make test`."""
    return re.search(r"^Thorough", path.read_text(encoding="utf-8"), re.MULTILINE) is not None


def renewed(path: Path) -> str:
    """The text of the transcript as its commands print it now."""
    text, home = path.read_text(encoding="utf-8"), TemporaryDirectory(prefix="hypcheck-")
    with home:
        folder = Path(home.name, "work")
        folder.mkdir()
        Path(home.name, "sitecustomize.py").write_text(UNDRAWN, encoding="utf-8")
        parts = _parts(text)
        new = "\n".join(part + (_output(_command(part), folder) if part.startswith("  ") else "") for part in parts)
    if _parts(new) != parts:
        raise ValueError(f"{path}: a line of an output looks like one of a command")
    return new


def _parts(text: str) -> list[str]:
    """The remarks and commands of a transcript, without what is printed."""
    parts: list[str] = []
    before = ""  # the kind of the line before: remark, command or output
    for line in text.splitlines(keepends=True):
        if line.startswith("  $ "):
            kind = "command"
            parts.append(line)
        elif before == "command" and line.startswith(("  > ", "  >\n")):
            kind = "command"
            parts[-1] += line
        elif line.startswith("  ") or not line.strip():
            kind = "output"
        else:
            kind = "remark"
            if before == "remark":
                parts[-1] += line
            else:
                parts.append(line)
        before = kind
    return parts


def _command(part: str) -> str:
    """The lines for bash."""
    return "\n".join(line[4:] for line in part.splitlines())


def _output(command: str, folder: Path) -> str:
    """The lines of a transcript that say how a command ended."""
    done = subprocess.run(
        ["/bin/bash", "-c", command],
        cwd=folder,
        env=_environment(folder.parent),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        timeout=300,
        check=False,
    )
    streams = [(done.stdout, "  "), (done.stderr, "  2> ")]
    lines = [begin + line for data, begin in streams for line in _masked(data, folder).splitlines()]
    return "".join(
        f"{line.rstrip(' ')}\n" for line in [*lines, *([f"  [{done.returncode}]"] if done.returncode else [])]
    )


def _environment(home: Path) -> dict[str, str]:
    """The variables of a user."""
    kept = {name: text for name, text in os.environ.items() if not name.startswith(OWN) or name == "HYPCHECK_COVERAGE"}
    path = os.pathsep.join([str(Path(sys.executable).parent), str(TRANSCRIPTS), os.environ["PATH"]])
    return kept | {"PATH": path, "HOME": str(home), "TMPDIR": str(home), "LANG": "C.UTF-8", "PYTHONPATH": str(home)}


def _masked(data: bytes, folder: Path) -> str:
    """The text of a stream without what differs between machines and runs; bytes that are no text as escapes."""
    text = data.decode("utf-8", "backslashreplace").replace(str(folder), "FOLDER").replace(str(folder.parent), "HOME")
    for pattern, mask in MASKS:
        text = re.sub(pattern, mask, text, flags=re.MULTILINE)
    return text.replace("\r", "\\r").replace("\x1b", "\\x1b")


def main(names: list[str]) -> None:
    """Write transcripts anew, all or those whose names begin so, and say which changed."""
    chosen = [path for path in paths() if not names or name_of(path).startswith(tuple(names))]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for path, new in zip(chosen, pool.map(renewed, chosen), strict=True):
            if new != path.read_text(encoding="utf-8"):
                path.write_text(new, encoding="utf-8")
                print(f"changed: {path.relative_to(ROOT)}")  # noqa: T201 - for the person who reads the difference


if __name__ == "__main__":
    main(sys.argv[1:])
