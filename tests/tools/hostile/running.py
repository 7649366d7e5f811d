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
from hypcheck.isolation.launch import Isolation, Means
from tests.support.inside import kernel_classify
from tests.tools.miniatures import stderr_of

PACKAGE = Path(hypcheck.__file__).parent
KNOWN_BY = Path(kernel_classify.__file__).relative_to(PACKAGE)
"""The module by which a copy of hypcheck is known."""
VECTORS = PACKAGE.parent / "cases" / "manifest.json"
LIMITS = {"timeout": 20.0, "restarts": 0, "memory": 200 << 20}


SECRETS = {
    **dict.fromkeys(("GHCR_PAT", "REGISTRY_PW", "NODE_AUTH_TOKEN", "PYTHON_KEYRING_PW", "CUDA_LICENSE"), "s3same-{}"),
    **dict.fromkeys(("GITHUB_TOKEN", "AWS_SECRET_ACCESS_KEY", "ROLLBAR_DSN", "RSA_PRIVATE", "GOOGLE_PIN"), "s3same.{}"),
    **dict.fromkeys(
        ("RUBYGEMS_PIN", "JAVA_KEYSTORE_PW", "PERL_DB_PW", "ERLANG_COOKIE", "R_STUDIO_CONNECT"), "s3same{}x"
    ),
    **dict.fromkeys(("REDIS_URL", "RABBITMQ_URL", "DATABASE_URL", "GOPROXY"), "redis://user:s3same-{}@example.org/1"),
    "CONDA_CHANNEL": "s3same,{}",
}
"""Secrets that an environment may hold: names, and what their values are like."""


@dataclass(frozen=True, slots=True)
class Fate:
    """What became of an attack: how its rows ended, what it said or was said of it, and what it damaged."""

    outcome: Outcome
    told: str
    damage: tuple[str, ...]


def command_fate(attack: str, means: Means, folder: Path) -> Fate:
    """Ask the hostile command, whose victim is a folder of reports below `folder`."""
    victim, home = folder / "reports", folder / "home"
    copy = folder / "copy" / "hypcheck"
    for each in (victim, home, copy / "kernel"):
        each.mkdir(exist_ok=True, parents=True)
    for name in ("__init__.py", "kernel/__init__.py", KNOWN_BY):
        (copy / name).write_text("")
    (victim / "summary.json").write_text("true")
    (home / ".netrc").write_text("machine example.org password secret")
    here = Path(__file__).with_name("command.py")
    vectors = next(VECTORS.parent.rglob("*.json")) if VECTORS.parent.is_dir() else VECTORS
    words = [
        sys.executable,
        "-I",
        "-S",
        str(here),
        attack,
        str(os.getpid()),
        str(victim),
        str(PACKAGE),
        str(vectors),
        str(copy.parent),
    ]
    limits = Limits(
        **LIMITS, isolation=Isolation("auto", hidden=(str(victim),), here=means, scratch_bytes=4 << 20, threads=310)
    )
    before = _state(victim)
    secrets = {name: text.format(name[::-1].lower()) for name, text in SECRETS.items()}
    environment = {**secrets, "HOME": str(home)}
    spec = "command:" + json.dumps(words)
    with patch.dict(os.environ, environment), open_implementation(spec, limits) as it:
        answered = it.classify(np.ones((1, 7)))
        said = stderr_of(it) if answered.answered.all() else ()
        it.classify(np.ones((3, 7)), batch=1)
    outcome = Outcome(int(answered.status[0]))
    told = next(iter(answered.reasons.values()), "") or " | ".join(said)
    damage = [] if _state(victim) == before else ["the reports were changed"]
    damage += [f"a report has the value of {name}" for name, value in secrets.items() if value[-9:] in told]
    return Fate(outcome, told, tuple(damage))


def _state(victim: Path) -> dict[str, tuple[object, ...]]:
    """What the files hold, with their modes, times and attributes."""
    files = (*sorted(victim.iterdir()), PACKAGE / "runs" / "judge.py")
    stats = {each: each.stat() for each in files}
    return {
        each.name: (each.read_text(), found.st_mode, found.st_mtime_ns, os.listxattr(each))
        for each, found in stats.items()
    }
