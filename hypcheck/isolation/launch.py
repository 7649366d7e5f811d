"""Starts a foreign program, isolated as far as this system allows, and ends it with everything that it started.

Isolated, it sees only some folders and files, and some environment variables.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field

from hypcheck.errors import InputError, limit_reached
from hypcheck.isolation.environment import environment_of
from hypcheck.isolation.means import LAUNCHER, MODES, Means, means_of
from hypcheck.isolation.view import (
    PACKAGE,
    SHARED_MEMORY,
    TEMPORARY,
    hidden_paths,
    needed_paths,
    private_folders,
    readable_paths,
    within,
)

THREADS = 1024
"""Processes and threads of a program: the Java machine starts one for each processor, twice."""

DESCRIPTORS = 4096

SCRATCH_BYTES = 256 << 20
"""Bytes of the scratch folder, or, where it is no folder of its own in memory, of a file in it."""

_END_S = 2.0

VARIABLE = "HYPCHECK_ISOLATE"
"""The environment variable that holds the mode where `--isolate` is not given."""


def usual_mode() -> str:
    """The mode where none is given."""
    return os.environ.get(VARIABLE) or "auto"


class IsolationError(Exception):
    """The launcher could not isolate the program; the text says which step failed."""


@dataclass(frozen=True, slots=True)
class Isolation:
    """How foreign programs are isolated.

    mode: one of MODES. hidden: paths that they must not see. variables: names of environment variables that they see
    beyond those of runtimes. seen: paths that they see beyond what they need. here: the means of this system; None:
    those that it has. threads and scratch_bytes: limits of a program.
    """

    mode: str = field(default_factory=usual_mode)
    hidden: tuple[str, ...] = ()
    variables: tuple[str, ...] = ()
    seen: tuple[str, ...] = ()
    here: Means | None = None
    threads: int = THREADS
    scratch_bytes: int = SCRATCH_BYTES

    def __post_init__(self) -> None:
        if self.mode not in MODES:
            raise InputError(f"--isolate, or {VARIABLE}, is {self.mode!r}; it must be one of {', '.join(MODES)}")

    @property
    def means(self) -> Means:
        """What isolates them here. Raises NotIsolatedError if the mode is "on" and something is missing."""
        return means_of(self.mode, self.here)


class Launched:
    """A program that was started, and the pipe whose end ends it. Raises OSError if the system cannot run it.

    Raises IsolationError and NotIsolatedError too. `isolated` is false where nothing isolates here. `revealed` are the
    files of this package that it needs to see.
    """

    def __init__(
        self, words: Sequence[str], environment: Mapping[str, str], isolation: Isolation, revealed: Sequence[str] = ()
    ) -> None:
        means = isolation.means
        self.isolated = bool(means.names)
        self._scratch: str | None = None
        self._life = -1
        if not self.isolated:
            self.process = _started(words, environment)
            return
        if not means.namespaces:
            self._scratch = tempfile.mkdtemp(prefix="hypcheck-scratch-")
        try:
            self._launch(words, environment, isolation, revealed)
        except BaseException:
            self._remove_scratch()
            raise

    def _launch(
        self,
        words: Sequence[str],
        environment: Mapping[str, str],
        isolation: Isolation,
        revealed: Sequence[str],
    ) -> None:
        needed = needed_paths(words, environment, isolation.seen)
        private = private_folders(needed)
        scratch = self._scratch or next((path for path in TEMPORARY if path in private), SHARED_MEMORY)
        hidden = hidden_paths(isolation.hidden, needed, isolation.seen)
        options = _options(isolation, scratch, needed, private, hidden, revealed)
        seen = environment_of(environment, scratch, isolation.variables)
        life, self._life = os.pipe()
        report, told = os.pipe()
        try:
            own = (LAUNCHER, *options, f"--life={life}", f"--report={told}", "--", *words)
            self.process = _started(own, seen, (life, told))
        except BaseException:
            os.close(report)
            self._end_life()
            raise
        finally:
            os.close(life)
            os.close(told)
        self._require_start(report)

    def _require_start(self, report: int) -> None:
        """Raise the error that the launcher reports, unless the program runs."""
        with open(report, "rb") as file:
            said = file.read().decode("utf-8", "replace")
        if not said:
            return
        self.end()
        self.process.communicate()
        number, _, text = said.partition(" ")
        error = OSError(int(number), os.strerror(int(number)))
        if text.startswith("exec "):
            raise error
        raise limit_reached(error) or IsolationError(text)

    def end(self) -> None:
        """End the program with everything that it started, if it is isolated."""
        self._end_life()
        if self.isolated:
            with suppress(subprocess.TimeoutExpired):
                self.process.wait(_END_S)
        self._remove_scratch()

    def _end_life(self) -> None:
        if self._life >= 0:
            os.close(self._life)
            self._life = -1

    def _remove_scratch(self) -> None:
        if self._scratch is not None:
            shutil.rmtree(self._scratch, ignore_errors=True)
            self._scratch = None


def _started(
    words: Sequence[object], environment: Mapping[str, str], descriptors: tuple[int, ...] = ()
) -> subprocess.Popen[bytes]:
    return subprocess.Popen(  # noqa: S603 - what the user asked to run
        [os.fspath(word) for word in words],  # type: ignore[call-overload]
        bufsize=0,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
        env=environment,
        pass_fds=descriptors,
    )


def _options(
    isolation: Isolation,
    scratch: str,
    needed: Sequence[str],
    private: Sequence[str],
    hidden: Sequence[str],
    revealed: Sequence[str],
) -> list[str]:
    """The options of the launcher, as launcher.c explains them."""
    means = isolation.means
    options = [f"--threads={isolation.threads}", f"--descriptors={DESCRIPTORS}", f"--bytes={isolation.scratch_bytes}"]
    options += ["--seccomp"] * means.seccomp + ["--landlock"] * bool(means.landlock)
    if means.namespaces:
        others = [folder for folder in private if folder != scratch]
        shown = [path for path in needed if any(within(path, folder) for folder in private)]
        options += ["--namespaces", f"--scratch={scratch}", "--read=/"]
        options += [f"--private={folder}" for folder in others] + [f"--show={path}" for path in shown]
        options += [f"--hide={path}" for path in hidden] + [f"--reveal={path}" for path in revealed]
        return options + [f"--write={folder}" for folder in (scratch, SHARED_MEMORY)]
    read, listed = readable_paths(
        hidden, (*private, "/dev"), needed
    )  # the launcher opens the devices that hold nothing
    read += revealed
    listed += [str(PACKAGE.parent)] if revealed else []  # Python lists it, to find this package there
    options += [f"--judge={os.getpid()}", f"--write={scratch}"]
    return options + [f"--read={path}" for path in read] + [f"--list={path}" for path in listed]
