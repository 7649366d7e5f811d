"""Asks a hostile command or library while it is isolated, and finds out what became of it and of its victims."""

from __future__ import annotations

import json
import os
import sys
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

import numpy as np

import hypcheck
from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.session import Limits, Outcome
from hypcheck.isolation.launch import Isolation
from hypcheck.isolation.means import Means
from tests.tools.miniatures import stderr_of

PACKAGE = Path(hypcheck.__file__).parent
VECTORS = PACKAGE.parent / "cases" / "manifest.json"
LIMITS = {"timeout": 20.0, "restarts": 0, "memory": 200 << 20}


@dataclass(frozen=True, slots=True)
class Fate:
    """What became of an attack: how its rows ended, what it said or was said of it, and what it damaged."""

    outcome: Outcome
    told: str
    damage: tuple[str, ...]


def command_fate(attack: str, means: Means, folder: Path) -> Fate:
    """Ask the hostile command, whose victim is a folder of reports below `folder`."""
    victim, home = folder / "reports", folder / "home"
    for each in (victim, home):
        each.mkdir(exist_ok=True)
    (victim / "summary.json").write_text("true")
    (home / ".netrc").write_text("machine example.org password secret")
    here = Path(__file__).with_name("command.py")
    vectors = next(VECTORS.parent.rglob("*.json")) if VECTORS.parent.is_dir() else VECTORS
    words = [sys.executable, "-I", "-S", str(here), attack, str(os.getpid()), str(victim), str(PACKAGE), str(vectors)]
    limits = Limits(
        **LIMITS, isolation=Isolation("auto", hidden=(str(victim),), here=means, scratch_bytes=4 << 20, threads=310)
    )
    before = _state(victim)
    secrets = {"GITHUB_TOKEN": "secret", "HOME": str(home)}
    spec = "command:" + json.dumps(words)
    with patch.dict(os.environ, secrets), open_implementation(spec, limits) as it:
        answered = it.classify(np.ones((1, 7)))
        said = stderr_of(it) if answered.answered.all() else ()
        it.classify(np.ones((3, 7)), batch=1)
    outcome = Outcome(int(answered.status[0]))
    told = next(iter(answered.reasons.values()), "") or " | ".join(said)
    damage = [] if _state(victim) == before else ["the reports were changed"]
    return Fate(outcome, told, tuple(damage))


def _state(victim: Path) -> dict[str, str]:
    judge = PACKAGE / "runs" / "judge.py"
    return {each.name: each.read_text() for each in (*sorted(victim.iterdir()), judge)}
