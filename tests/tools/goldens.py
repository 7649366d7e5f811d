"""The goldens of reports: what each format says of recorded runs, committed beside their records.

`python -m tests.tools.goldens` makes them anew from the records (`make goldens`), and the diff shows what changed in
what readers see. `--records` makes the records anew first, by the commands below, which takes some minutes. A record
may be written again only where the lines of records themselves have changed.

A golden is the file as `hypcheck report` writes it, byte for byte, but for what is no content of the record: the style
and the script of the page, its formulas, its version, and plots, which depend on the version of matplotlib. Of a plot
its title, its description and its tooltips are kept, a line each.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest.mock import patch
from xml.etree import ElementTree as Xml

from hypcheck.cli.main import main as hypcheck
from hypcheck.report import REPORTS
from hypcheck.report.write import FOR_PROGRAMS
from tests.report.record_samples import every_line

FOLDER = Path(__file__).resolve().parents[1] / "report" / "goldens"
RECORD = "record.jsonl"
CHANGES = "changes"
"""The folder of the reports that compare a run with another. They are made as where matplotlib is missing."""


@dataclass(frozen=True)
class GoldenRun:
    """A recorded run: the command that records it, and with which other it is compared.

    `before` records the baseline of the command first. A run without a command has lines that no right program writes:
    those of tests/report/samples/.
    """

    command: str = ""
    before: str = ""
    against: str = ""


_GATED = "ring,small-integers,out-of-regime,tower-body"
_MEASURED = "fast,table-2-float64,table-2-float32,numpy-roots,bounding-sphere,fcl-sphere-1000,coal-sphere-10000"
_QUICK = "bench python:mine.py:position --quick --processes 2 --rounds 2"

RUNS: Mapping[str, GoldenRun] = {
    "held": GoldenRun(
        f"verify python:mine.py:position --isolate off --families {_GATED},whole-domain,tilted-uniform,tilted-ring"
        " --count 3 --fresh 9",
        against="wrong",
    ),
    "wrong": GoldenRun(
        f"verify python:mine.py:position --families {_GATED},one-number-changed --count 3 --fresh 9 --tolerance 16"
        " --known-failures known.toml --restarts 40 --timeout 20"
    ),
    "ways": GoldenRun(
        "verify python:mine.py:passage library:missing.so --isolate off --count 0"
        " --families way-uniform,way-tunnelling,way-grazing,tilted-way-uniform,tilted-way-ring"
    ),
    "self": GoldenRun("verify --self --families ring,out-of-regime --count 20 --judged 20 --roots 10 --meshes 10"),
    "bench": GoldenRun(
        f"{_QUICK} --methods {_MEASURED} --workloads uniform,near-contact --baseline before",
        before=f"{_QUICK} --methods table-2-float64,fast --workloads uniform --seed 2",
        against="every-line",
    ),
    "bench-ways": GoldenRun(
        "bench --question passage --quick --processes 2 --rounds 2 --workloads tower,tunnelling"
        " --methods passage-exact,passage-certified,passage-sampled-4"
    ),
    "every-line": GoldenRun(),
}


def _golden(file: str) -> str:
    return f"{file}.txt" if file.endswith(".svg") else file


_OTHERS = ("", ".py", ".pyc", ".toml", ".jsonl")
"""Ends of names in the folder of a run that are no goldens: folders, the code under test, its settings, the record."""


def kept(run: str) -> dict[str, str]:
    """The goldens of a run by their names."""
    paths = [path for path in sorted((FOLDER / run).rglob("*")) if path.suffix not in _OTHERS]
    return {path.relative_to(FOLDER / run).as_posix(): path.read_bytes().decode("utf-8") for path in paths}


def made(run: str) -> tuple[dict[str, str], str]:
    """What `hypcheck report` writes of a run's record, by the names of the goldens, and the page without a mask."""
    found = _written(run, [], [*REPORTS])
    page = found.pop(_WHOLE_PAGE)
    return found | _compared(run), page


def undrawn(run: str) -> dict[str, str]:
    """Those of them that programs read and that compare, which have no plots."""
    return _written(run, [], [*FOR_PROGRAMS]) | _compared(run)


_WHOLE_PAGE = "the page without a mask"


def _compared(run: str) -> dict[str, str]:
    if not RUNS[run].against:
        return {}
    with patch.dict(sys.modules, {"matplotlib": None}):
        words = ["--against", str(FOLDER / RUNS[run].against)]
        texts = _written(run, words, [name for name, report in REPORTS.items() if report.compares])
    return {f"{CHANGES}/{name}": text for name, text in texts.items() if name != _WHOLE_PAGE}


def _written(run: str, words: list[str], formats: list[str]) -> dict[str, str]:
    with TemporaryDirectory() as out, _working_in(FOLDER / run):
        chosen = [word for name in formats for word in ("--format", name)]
        with redirect_stdout(StringIO()):
            code = hypcheck(["report", RECORD, *words, *chosen, "--out", out])
        if code:
            raise RuntimeError(f"hypcheck report ends with {code} for {run}")
        texts = {_golden(path.name): masked(path) for path in sorted(Path(out).iterdir())}
        if "html" in formats:
            texts[_WHOLE_PAGE] = Path(out, REPORTS["html"].file).read_text("utf-8")
        return texts


@contextmanager
def _working_in(folder: Path) -> Iterator[None]:
    """Within the block the process works in the folder: reports look there for the code under test."""
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


_PLOT = re.compile(r'<svg[^>]* class="plot".*?</svg>', re.DOTALL)

_MASKS = (
    (re.compile(r"(<style>).*?(</style>)", re.DOTALL), r"\1…\2"),
    (re.compile(r"(<script>).*?(</script>)", re.DOTALL), r"\1…\2"),
    (re.compile(r"'sha256-[^']*'"), "'sha256-…'"),
    (re.compile(r'(data-formulas=")[^"]*'), r"\1…"),
    (re.compile(r"(Made by hypcheck )[\w.+]+"), r"\1…"),
)
"""What the page holds beside the content of the record."""


def masked(path: Path) -> str:
    """The text of a report, line ends as they are, without what is no content of the record."""
    text = path.read_bytes().decode("utf-8")
    if path.suffix == ".svg":
        return words_of_plot(text)
    if path.suffix == ".html":
        text = _PLOT.sub(lambda found: f"\n{words_of_plot(found[0])}", text)
        for pattern, mark in _MASKS:
            text = pattern.sub(mark, text)
    return text


def words_of_plot(svg: str) -> str:
    """The title, the description and the tooltips of a plot, in order, a line each; likewise of plots within it."""
    elements = Xml.fromstring(svg).iter()  # noqa: S314 - just written
    named = [(each.tag.rpartition("}")[2], " ".join("".join(each.itertext()).split())) for each in elements]
    return "".join(f"{tag}: {words}\n" for tag, words in named if tag in ("title", "desc"))


def record(run: str, folder: Path) -> None:
    """Make the record of a run anew."""
    if not RUNS[run].command:
        (folder / RECORD).write_bytes(every_line())
        return
    with TemporaryDirectory() as scratch:
        here = Path(scratch)
        for path in [*folder.glob("*.py"), *folder.glob("*.toml")]:
            shutil.copy(path, here)
        for command, out in ((RUNS[run].before, "before"), (RUNS[run].command, "after")):
            if command:
                words = [sys.executable, "-m", "hypcheck", *command.split(), "--out", out]
                environment = {name: value for name, value in os.environ.items() if name != "CI"}
                subprocess.run(words, cwd=here, check=False, env=environment)  # it may fail: that is recorded
        shutil.copy(here / "after" / RECORD, folder)


def write(run: str) -> None:
    """Write the goldens of a run, and remove those of formats that are not written any more."""
    texts, _ = made(run)
    for name in kept(run).keys() - texts:
        (FOLDER / run / name).unlink()
    for name, text in texts.items():
        path = FOLDER / run / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(text.encode("utf-8"))


def main() -> None:
    """Make the records anew if asked to, then all goldens. Names of runs as further words choose them."""
    words = [word for word in sys.argv[1:] if word != "--records"]
    for run in words or RUNS:
        if "--records" in sys.argv[1:]:
            record(run, FOLDER / run)
        write(run)


if __name__ == "__main__":
    main()
