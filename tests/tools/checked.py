"""Runs a long check where what it reads has changed since it last passed: `python -m tests.tools.checked NAME`.

CHECKS has the files that each check reads. When a check passes, a digest of their names and contents is written to
`.ci/checked.json`, to be committed. While the tree has that digest, the check would read the same: it is not run, and
that is said. `--again` runs it anyway, `--list` says of each whether it would run. Only Python and git are needed,
so that this can be asked before anything is installed.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STAMPS = ".ci/checked.json"


@dataclass(frozen=True)
class Check:
    """The module that checks, its arguments, and the files and folders that it reads, as git names them."""

    module: str
    arguments: tuple[str, ...]
    sources: tuple[str, ...]


CHECKS = {
    "proofs": Check(
        "hypcheck.proofs",
        (),
        ("hypcheck/proofs", "hypcheck/kernel/core/hypcheck.h", "hypcheck/errors.py", "hypcheck/toml.py", "cases"),
    ),
    # What the programs are compiled from, asked, and compared with. The truth about rows that are drawn is computed by
    # the oracles here, on this processor: other tests hold them.
    "processors": Check(
        "tests.tools.processors",
        ("s390x", "i686", "--rows", "3000", "--jobs", "1"),
        ("hypcheck/kernel/core/hypcheck.h", "tests/tools/processors", "tests/tools/attack", "cases"),
    ),
}


def files(sources: tuple[str, ...], root: Path = ROOT) -> list[str]:
    """The tracked files of these names and folders that are in the tree, sorted."""
    command = ["git", "ls-files", "-z", *sources]
    listed = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True).stdout
    return sorted(name for name in listed.split("\0") if name and (root / name).is_file())


def digest(sources: tuple[str, ...], root: Path = ROOT) -> str:
    """A digest of the names and contents of the files of these names and folders, as they are in the tree."""
    total = hashlib.sha256()
    for name in files(sources, root):
        total.update(f"{name} {hashlib.sha256((root / name).read_bytes()).hexdigest()}\n".encode())
    return total.hexdigest()[:16]


def stamps() -> dict[str, str]:
    """The digest with which each check last passed."""
    path = ROOT / STAMPS
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def is_unchanged(name: str) -> bool:
    """Whether a check would read what it read when it last passed."""
    return stamps().get(name) == digest(CHECKS[name].sources)


def run(name: str, further: list[str]) -> int:
    """Run a check and, if it passes and its files did not change meanwhile, write its digest; return its exit code."""
    check = CHECKS[name]
    begun = digest(check.sources)
    code = subprocess.run([sys.executable, "-m", check.module, *check.arguments, *further], cwd=ROOT, check=False)
    if code.returncode == 0 and digest(check.sources) == begun:
        text = json.dumps(stamps() | {name: begun}, indent=1, sort_keys=True)
        (ROOT / STAMPS).write_text(text + "\n", encoding="utf-8")
        print(f"{name}: checked; {STAMPS} has the digest {begun}")  # noqa: T201
    return code.returncode


def main(words: list[str] | None = None) -> int:
    """Run one check, or list all. Returns its exit code; of the list, 1 where one would run."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("name", nargs="?", choices=CHECKS)
    parser.add_argument("--again", action="store_true", help="run it whether or not something has changed")
    parser.add_argument("--list", action="store_true", help="say what would run, and run nothing")
    given, further = parser.parse_known_args(words)
    names = [given.name] if given.name else list(CHECKS)
    unchanged = [name for name in names if is_unchanged(name) and not given.again]
    for name in unchanged:
        print(f"{name}: unchanged since they were checked (digest {stamps()[name]})", flush=True)  # noqa: T201
    if given.list or not given.name:
        for name in set(names).difference(unchanged):
            print(f"{name}: to be checked", flush=True)  # noqa: T201
        return int(unchanged != names)
    return 0 if unchanged else run(given.name, further)


if __name__ == "__main__":
    sys.exit(main())
