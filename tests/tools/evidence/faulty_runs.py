"""Runs of `hypcheck verify` whose folder is on a disk that fails; each in a process that is forked when all is loaded.

`python -m tests.tools.evidence.faulty_runs FOLDER [NUMBER...]`, with faulty_disk preloaded, performs a run whose n-th
call to the system fails, for the given n or for all, in each of the ways of FAULTS. It prints what was not right.
"""

from __future__ import annotations

import ctypes
import json
import os
import shutil
import sys
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

from hypcheck.cli.main import main
from hypcheck.errors import HypcheckError
from hypcheck.record.integrity import check
from hypcheck.record.reader import FILE, GROWING
from hypcheck.runs import fingerprint
from tests.runs.interruption import came_to, in_small_steps
from tests.support.without_drawing import draw_nothing

SPECS = ("builtin:hessian-float32", "builtin:fast")
WORDS = ("--families", "axis", "--count", "10", "--precision", "float32", "--fresh", "0")
CODE = 1
"""How an unbroken run ends: the first implementation is wrong beyond the tolerance."""

FAULTS = ("once-full", "once-broken", "full", "dead", "killed", "short")
"""The ways to fail, in the order of faulty_disk.c."""

NOT_FROM_DISK = -9
"""How a process ends that the system killed."""


@dataclass(frozen=True)
class Performed:
    """What a run did: how it ended, what it said, and a letter for each of its calls to the system."""

    code: int
    said: str
    calls: str


@dataclass(frozen=True)
class Case:
    """The n-th call fails; `after` says whether an earlier run has left its record in the folder."""

    fault: str
    number: int
    after: bool


def perform(out: Path, fault: str, number: int, *more: str) -> Performed:
    """Run `verify` into `out`; its n-th call fails, none if `number` is negative."""
    beside = out.with_name(f"{out.name}-said")
    process = os.fork()
    if process == 0:
        _be_the_run(out, beside, fault, number, more)
    code = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
    calls = beside.with_suffix(".calls")
    return Performed(code, beside.read_text(encoding="utf-8"), calls.read_text("ascii") if calls.exists() else "")


def _be_the_run(out: Path, beside: Path, fault: str, number: int, more: tuple[str, ...]) -> None:
    disk = ctypes.CDLL(None)
    disk.calls_so_far.restype = ctypes.c_char_p
    file = os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    os.dup2(file, 1)
    os.dup2(file, 2)
    disk.fail_from(os.fsencode(out), ctypes.c_long(number), FAULTS.index(fault))
    code = main(["verify", *SPECS, *WORDS, "--out", str(out), *more])
    disk.fail_from(b"", ctypes.c_long(-1), 0) if number >= 0 else None
    beside.with_suffix(".calls").write_bytes(disk.calls_so_far())
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


def wrong(case: Case, out: Path, whole: list[bytes], before: bytes) -> str:
    """What is not as it must be after a fault, and after the run was made again; empty if all is well."""
    done = perform(out, case.fault, case.number)
    if case.fault != "killed":
        said = wrong_ending(case, done, out, whole)
        if said:
            return said
    for name in (FILE, GROWING):
        if (out / name).exists() and (said := _unreadable(out / name)):
            return said
    if case.after and not (out / FILE).exists():
        return "the record of the earlier run has gone, and there is none in its place"
    return _wrong_going_on(case, done, out, whole, before)


def wrong_ending(case: Case, done: Performed, out: Path, whole: list[bytes]) -> str:
    """What is not as it must be in the way that a run ended; empty if all is well."""
    if done.code == CODE:
        return "" if came_to(out) == whole else "it ended as if nothing had happened, with another result"
    if case.fault == "short":
        return f"it ended with {done.code}, as if a short write were an error: {done.said[-300:]}"
    errors = [line for line in done.said.splitlines() if line.startswith("hypcheck: ") and "error: " in line]
    if done.code != 2 or len(errors) != 1 or "Traceback" in done.said:
        return f"it ended with {done.code}: {done.said[-600:]}"
    reasons = ("no space left on device", "input/output error")
    if not errors[0].startswith("hypcheck: error: ") or not any(reason in errors[0] for reason in reasons):
        return f"its sentence gives no reason: {errors[0]}"
    return "" if str(out) in errors[0] else f"its sentence names no place: {errors[0]}"


def _unreadable(file: Path) -> str:
    """Why a record is not one that ends well, or is cut off within its last line."""
    try:
        found = check(file)
    except HypcheckError as error:
        return f"{file.name} cannot be read: {error}" if file.stat().st_size else ""
    return f"{file.name} lost {found.lost_lines} lines" if found.lost_lines > 1 else ""


def _wrong_going_on(case: Case, done: Performed, out: Path, whole: list[bytes], before: bytes) -> str:
    """Whether the run, resumed if something of it was kept, comes to what an unbroken run comes to."""
    kept = (out / GROWING).exists() or ((out / FILE).exists() and (out / FILE).read_bytes() != before)
    if f"with --resume {out} continues" in done.said and not kept:
        return "it said that it can be resumed, and kept nothing"
    again = perform(out, case.fault, -1, *(("--resume", str(out)) if kept else ()))
    if again.code == 2 and kept:
        if "with --resume" in done.said:
            return f"it cannot be resumed, as it said: {again.said[-600:]}"
        again = perform(out, case.fault, -1)
    if again.code != CODE:
        return f"made again, it ended with {again.code}: {again.said[-600:]}"
    left = {each.name for each in out.iterdir()} - {each.name for each in (out.parent / "whole").iterdir()}
    if left and case.fault.startswith("once"):
        return f"it left {', '.join(sorted(left))} behind"
    return "" if came_to(out) == whole else "made again, it came to another result"


def findings(folder: Path, chosen: list[int]) -> dict[str, object]:
    """How many calls and cases there were, and a sentence for each that was not as it must be."""
    main(["verify", *SPECS, *WORDS, "--out", str(folder / "loaded")])  # what it loads and caches, each fork has
    earlier = folder / "earlier"
    perform(earlier, "once-full", -1, "--seed", "7")
    before = (earlier / FILE).read_bytes()
    unbroken = perform(folder / "whole", "once-full", -1)
    whole = came_to(folder / "whole")
    found, number = [], 0
    for case in cases(unbroken.calls, chosen):
        out = folder / "run"
        shutil.rmtree(out, ignore_errors=True)
        if case.after:
            shutil.copytree(earlier, out)
        said = wrong(case, out, whole, before)
        number += 1
        if said:
            found.append({**asdict(case), "call": unbroken.calls[case.number], "said": said})
            print(found[-1], file=sys.stderr, flush=True)  # noqa: T201 - for whoever watches
    return {"calls": unbroken.calls, "cases": number, "findings": found}


def cases(calls: str, chosen: list[int]) -> Iterator[Case]:
    """Each way to fail at each chosen call; all but the last of them in the folder of an earlier run, by turns."""
    for number in chosen or range(len(calls)):
        once = FAULTS[number % 2]
        for place, fault in enumerate((once, "full", "dead", "killed", *["short"] * (calls[number] == "w"))):
            yield Case(fault, number, (number // 2 + place) % 2 == 0)


if __name__ == "__main__":
    os.environ.pop("LD_PRELOAD", None)
    draw_nothing(type("Patch", (), {"setitem": staticmethod(lambda table, name, value: table.update({name: value}))}))
    in_small_steps(setattr, single_rows=10)
    ours = fingerprint._own_files()  # reading them again would be a fourth of a run
    fingerprint._own_files = lambda: ours
    os.environ["HYPCHECK_ISOLATE"] = "off"
    print(json.dumps(findings(Path(sys.argv[1]), [int(word) for word in sys.argv[2:]])))  # noqa: T201
