"""What this system offers to isolate a program, and the answer to `--isolate`: auto, on or off.

The launcher (launcher.c) is a C program that is compiled with the package: it runs between the start of a process and
that of the program, and Python would take five times as long there. No library on the package index does all of this;
bubblewrap, the most similar program, is on few machines, and supports neither Landlock nor a filter of its own.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from hypcheck.errors import Exit, HypcheckError

MODES = ("auto", "on", "off")

LAUNCHER = Path(__file__).with_name("launcher")


class NotIsolatedError(HypcheckError):
    """`--isolate on` where the system cannot isolate a program; the sentence says what is missing."""

    exit_code = Exit.NOT_STARTED


@dataclass(frozen=True, slots=True)
class Means:
    """The means that isolate programs here, and those that are missing.

    namespaces: user, PID, network, IPC, host name and mount namespaces.
    landlock: the version of Landlock, 0 where there is none.
    seccomp: the filter of system calls.
    missing: why a means is missing, each as the part of a sentence.
    """

    namespaces: bool = False
    landlock: int = 0
    seccomp: bool = False
    missing: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """The means that are there."""
        landlock = f"Landlock {self.landlock}"
        named = {"namespaces": self.namespaces, landlock: bool(self.landlock), "seccomp": self.seccomp}
        return tuple(name for name, there in named.items() if there)

    @property
    def whole(self) -> bool:
        """Whether nothing that `--isolate on` promises is missing; namespaces do all that Landlock does."""
        return self.namespaces and self.seccomp

    @property
    def word(self) -> str:
        """How a program here runs: "isolated", "partly isolated" or "not isolated"."""
        return isolation_word(self.names)


def isolation_word(means: Sequence[str]) -> str:
    """How a program runs with these means: "isolated", "partly isolated" or "not isolated"."""
    return "isolated" if {"namespaces", "seccomp"} <= {*means} else "partly isolated" if means else "not isolated"


def isolation_text(means: Sequence[str], missing: Sequence[str]) -> str:
    """The end of "it is": isolated or partly isolated, by these means, and why others are missing.

    If a program is only partly isolated, the missing means come first.
    """
    word, reasons = isolation_word(means), "; ".join(missing)
    by = f"by {', '.join(means[:-1])}{' and ' if means[1:] else ''}{means[-1]}" if means else ""
    if word == "partly isolated":
        return f"{word}: {'; '.join(filter(None, (reasons, by)))}"
    return f"{word} {by}".strip() + (f" ({reasons})" if reasons else "")


OFF = Means(missing=("--isolate is off",))


def means_of(mode: str, here: Means | None = None) -> Means:
    """What isolates programs in this mode, of the means that are here; None: those that this system has.

    Raises NotIsolatedError if the mode is "on" and something is missing.
    """
    if mode == "off":
        return OFF
    available_here = available() if here is None else here
    if mode == "on" and not available_here.whole:
        raise NotIsolatedError(
            f"--isolate is on, and this system cannot isolate a program: {'; '.join(available_here.missing)}; "
            "--isolate auto uses what there is"
        )
    return available_here


@lru_cache
def available() -> Means:
    """The means that this system allows; tried once, since only a trial shows whether a system call is allowed."""
    if sys.platform != "linux":
        return Means(missing=(f"{sys.platform} has no namespaces, no Landlock and no seccomp",))
    if not os.access(LAUNCHER, os.X_OK):
        return Means(missing=("the launcher was not compiled: hypcheck was installed without a C compiler",))
    try:
        text = subprocess.run((LAUNCHER, "--probe"), capture_output=True, check=True, timeout=20).stdout.decode()  # noqa: S603
    except (OSError, subprocess.SubprocessError) as error:
        return Means(missing=(f"the launcher does not run here: {error}",))
    probed = dict(line.partition(" ")[::2] for line in text.splitlines())
    failed = tuple(f"no {name}: {probed[name]}" for name in ("namespaces", "landlock", "seccomp") if probed.get(name))
    return Means(
        namespaces=not probed.get("namespaces", "?"),
        landlock=int(probed.get("abi", "0")),
        seccomp=not probed.get("seccomp", "?"),
        missing=failed,
    )
