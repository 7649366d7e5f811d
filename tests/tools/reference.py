"""Makes every generated figure and page anew: `make reference`, resumable, some hours.

A part is done by its make target and then stamped in reports/made.json: from which commit, on which machine, when, and
a digest of the files that it describes. A part whose digest is that of today is left as it is, so that what was
interrupted goes on where it stopped. `--list` says what is fresh; `--check`, which a release asks, ends with 1 where
something is not.
"""

from __future__ import annotations

import json
import os
import platform
import re
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import click

from tests.tools import checked
from tests.tools.evidence.parts import PARTS as MEASURES

ROOT = Path(__file__).resolve().parents[2]
PAGE = "reports/README.md"
STAMPS = "reports/made.json"


@dataclass(frozen=True)
class Part:
    """What one make target makes: the page, and the files that the page describes, as git names them.

    A star of git crosses folders.
    """

    target: str
    page: str
    sources: tuple[str, ...]


ANSWERS = tuple(f"hypcheck/{name}" for name in ("derivation", "geometry", "kernel", "scene", "truth"))
VECTORS = ("cases", "hypcheck/vectors")
GATE = (*ANSWERS, *VECTORS, "hypcheck/implementations", "hypcheck/runs")
HEADER = "hypcheck/kernel/core"
MUTATED = tuple(f"hypcheck/{name}/*.py" for name in ("truth", "kernel", "record", "geometry", "runs"))
COMMANDS = tuple(f"hypcheck/{name}" for name in ("cli", "implementations", "isolation", "record", "report", "runs"))


def _evidence(name: str, *sources: str) -> Part:
    """A part of the evidence, which can take an hour: all are on one page, and each has its own stamp."""
    return Part(f"evidence-{name}", "docs/evidence.md", (*sources, f"tests/tools/evidence/{MEASURES[name]}.py"))


PARTS = (
    Part("paper", "docs/paper.md", ("hypcheck/derivation", "hypcheck/paper", "hypcheck/truth")),
    Part("figures", "docs/figures.md", ("hypcheck/paper", "hypcheck/pictures", "tests/tools/figures")),
    Part("deep", "reports/reference/report.md", GATE),
    Part("reference-bench", "reports/reference/bench/README.md", (*GATE, "hypcheck/bench")),
    Part("mutants", "tests/tools/mutants/README.md", (*GATE, "tests/tools/mutants/*.py")),
    Part("processors", "docs/processors.md", (HEADER, "cases", "tests/tools/processors")),
    Part("engines", "reports/engines/README.md", (*GATE, "hypcheck/engines")),
    _evidence("fuzz", HEADER, "tests/tools/evidence/fuzzing/*.[ch]"),
    _evidence("faults", *COMMANDS, "tests/tools/evidence/faulty_*"),
    _evidence("python-coverage", "hypcheck/*.py"),
    _evidence("python-mutants", *MUTATED, "tests/tools/evidence/mutations.py"),
    _evidence("coverage", HEADER, "tests/tools/evidence/battery"),
    _evidence("emitted", "hypcheck/kernel", "tests/tools/evidence/emitted_*.py"),
    _evidence("kernel-mutants", HEADER, "tests/tools/evidence/battery", "tests/tools/evidence/c_sites.py"),
    _evidence("constants", HEADER, "hypcheck/kernel/programs"),
)
"""In the order in which they are made: mutants of Python are judged by the tests that coverage met."""


def _git(*words: str) -> str:
    done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False)  # noqa: S607
    if done.returncode:
        raise click.ClickException(f"git {words[0]} fails: {done.stderr.strip()}")
    return done.stdout


def digest(part: Part) -> str:
    """A digest of the names and contents of the files that a part describes, as they are in the tree."""
    return checked.digest(part.sources, ROOT)


def machine() -> str:
    """The processor, how many of it there are, and the system."""
    try:
        facts = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        facts = ""
    found = re.search(r"^model name\s*: (.*)$", facts, re.MULTILINE)
    return f"{os.cpu_count()} × {found[1] if found else platform.machine()}, {platform.system()}"


def stamps() -> dict[str, dict[str, str]]:
    """The stamp of each part that has one."""
    path = ROOT / STAMPS
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def state(part: Part) -> str:
    """Whether a part is fresh, older than what it describes, or was made before there were stamps."""
    stamp = stamps().get(part.target)
    if stamp is None:
        return "not stamped"
    return "fresh" if stamp["sources"] == digest(part) else "stale"


def table() -> str:
    """The stamps as they stand in reports/README.md."""
    lines = ["| made by | page | from commit | on | date |", "| --- | --- | --- | --- | --- |"]
    for part in PARTS:
        stamp = stamps().get(part.target, {})
        cells = (stamp.get(key, "not stamped yet" if key == "commit" else "") for key in ("commit", "machine", "date"))
        lines.append(f"| `make {part.target}` | [{part.page}](../{part.page}) | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def write_table() -> None:
    """Put the table of today into reports/README.md, where the one of before stands."""
    text = (ROOT / PAGE).read_text(encoding="utf-8")
    head, _, _ = text.partition("| made by |")
    (ROOT / PAGE).write_text(head + table(), encoding="utf-8")


def stamp(part: Part) -> None:
    """Say from which commit a part was made, and on which machine."""
    made = {"commit": _git("rev-parse", "--short=8", "HEAD").strip(), "machine": machine()}
    made |= {"date": time.strftime("%Y-%m-%d", time.gmtime()), "sources": digest(part)}
    text = json.dumps(stamps() | {part.target: made}, indent=1, sort_keys=True, ensure_ascii=False)
    (ROOT / STAMPS).write_text(text + "\n", encoding="utf-8")
    write_table()


def _make(part: Part) -> bool:
    """Make a part and stamp it. False: its target failed. Raises ClickException for sources that no commit has."""
    changed = _git("status", "--porcelain", "--", *part.sources).strip()
    if changed:
        raise click.ClickException(f"make {part.target}: commit first what it describes:\n{changed}")
    click.echo(f"make {part.target}", err=True)
    begun = digest(part)
    if subprocess.run(["make", "--no-print-directory", part.target], cwd=ROOT, check=False).returncode:  # noqa: S607
        return False
    if digest(part) != begun:
        raise click.ClickException(f"make {part.target}: what it describes was changed meanwhile; make it again")
    stamp(part)
    return True


@click.command()
@click.argument("targets", nargs=-1)
@click.option("--list", "listed", is_flag=True, help="Say of each part which page it makes, its stamp, and its state.")
@click.option("--check", is_flag=True, help="End with 1 where a part is not fresh.")
def main(targets: tuple[str, ...], listed: bool, check: bool) -> None:
    """Make these parts, or all, of those that are not fresh."""
    names = [part.target for part in PARTS]
    if unknown := set(targets).difference(names):
        raise click.UsageError(f"no part {', '.join(sorted(unknown))}; there are {', '.join(names)}")
    wanted = [part for part in PARTS if part.target in (targets or names)]
    if listed or check:
        for part in wanted:
            made = stamps().get(part.target, {})
            click.echo(
                f"{part.target:24} {state(part):12} {made.get('commit', '-'):9} {made.get('date', '-'):11} {part.page}"
            )
        sys.exit(int(check and any(state(part) != "fresh" for part in wanted)))
    failed = [part.target for part in wanted if state(part) != "fresh" and not _make(part)]
    if failed:
        raise click.ClickException(f"these failed: {', '.join(failed)}; the others are stamped")


if __name__ == "__main__":
    main()
