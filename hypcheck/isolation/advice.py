"""The advice about a program that fails because of isolation, recognised by its error text.

A failure that also happens without isolation must not be attributed to it. So a sign in the text is not enough: it is
compared with this system, of which this process sees everything. A file must exist, a module must belong to this
package, and this account must be allowed to write to the folder. If this cannot be known, as for a refused system call,
the sentence says "which may be why".
"""

from __future__ import annotations

import os
import re
import resource
import shutil
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from glob import glob
from importlib.machinery import PathFinder

from hypcheck.isolation.launch import SCRATCH_BYTES, THREADS, Isolation, environment_of
from hypcheck.isolation.view import PACKAGE, SHARED_MEMORY, hidden_paths, needed_paths, private_folders, within

_TRUST = "--isolate off runs code that you trust without"
_OWN = (
    "and does not see hypcheck; 'hypcheck emit --method exact --language python' writes a file that needs nothing "
    f"else, and {_TRUST}"
)
_DEVICES = ("/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom", "/dev/fd", "/dev/std")
_CARDS = ("/dev/nvidia*", "/dev/dri/*", "/dev/kfd")
"""Files in /dev of drivers of graphics cards, on Linux."""


def isolation_advice(text: str, words: Sequence[str], isolation: Isolation) -> str:
    """Return the advice if isolation made the program of these words fail with this text: the end of a sentence.

    Empty if nothing isolates, and if the program would fail without isolation too.
    """
    return _advice(text, tuple(words), isolation, os.getcwd()) if isolation.means.names else ""


@lru_cache(maxsize=256)  # thousands of rows may fail alike
def _advice(text: str, words: tuple[str, ...], isolation: Isolation, folder: str) -> str:
    """Return the advice of the first cause that has one; empty without."""
    view = _View(words, isolation, folder)
    word = isolation.means.word
    return next((f"; it runs {word}, {sentence}" for cause in _CAUSES if (sentence := cause(text, view))), "")


@dataclass(frozen=True, eq=False)
class _View:
    """The files and variables that the program of these words sees, if it is started in this folder."""

    words: tuple[str, ...]
    isolation: Isolation
    folder: str

    @cached_property
    def _needed(self) -> tuple[str, ...]:
        """The paths that the program needs."""
        return needed_paths(self.words, os.environ, self.isolation.seen)

    @cached_property
    def _closed(self) -> tuple[str, ...]:
        """The paths that appear empty to it."""
        return hidden_paths(self.isolation.hidden, self._needed, self.isolation.seen)

    @cached_property
    def _private(self) -> tuple[str, ...]:
        """The folders of which it sees only needed parts."""
        return (*private_folders(self._needed), SHARED_MEMORY)

    def hides(self, path: str) -> bool:
        """Whether there is something at a path that the program does not see."""
        path = os.path.realpath(path)
        if not os.path.exists(path):
            return False
        if any(within(path, folder) for folder in self._closed):
            return True
        if within(path, "/dev") and not path.startswith(_DEVICES):
            return True
        inside = any(within(path, folder) for folder in self._private)
        return inside and not any(within(path, needed) or within(needed, path) for needed in self._needed)

    def paths(self, text: str) -> Iterator[str]:
        """Yield the paths that a text names in quotes, or from the root on.

        Relative ones begin where the program does.
        """
        for quoted, plain in re.findall(r"""['"`]([^'"`]{1,300})['"`]|(?<![\w.])(/[^\s:;,'"`()]+)""", text):
            yield os.path.join(self.folder, quoted or plain)

    @property
    def withheld(self) -> set[str]:
        """The names of the environment variables that the program does not see."""
        return set(os.environ) - set(environment_of(os.environ, "", self.isolation.variables))

    @property
    def ours(self) -> bool:
        """Whether the program is the Python that runs here, which has this package."""
        program = shutil.which(self.words[0]) or self.words[0]
        return within(os.path.abspath(program), sys.prefix)


def _hypcheck(text: str, view: _View) -> str:
    """Return the advice if the program lacks a module or name of this package that exists."""
    module = re.search(r"No module named '?(hypcheck[\w.]*)", text)
    name = re.search(r"cannot import name '(\w+)' from '(hypcheck[\w.]*)'", text)
    attribute = re.search(r"module '(hypcheck[\w.]*)' has no attribute '(\w+)'", text)
    if module:
        there = view.ours if module[1] == "hypcheck" else _is_ours(module[1])
    elif name or attribute:
        home, wanted = (name[2], name[1]) if name else (attribute[1], attribute[2]) if attribute else ("", "")
        public = getattr(sys.modules["hypcheck"], "__all__", ())
        there = wanted in public if home == "hypcheck" and not _is_ours(f"{home}.{wanted}") else _is_ours(home)
    else:
        return ""
    return _OWN if there else ""


def _is_ours(module: str) -> bool:
    """Whether there is a module of this package with that name; nothing is imported."""
    folder = PACKAGE.parent.joinpath(*module.split(".")[:-1])
    return PathFinder.find_spec(module, [str(folder)]) is not None


def _variable(text: str, view: _View) -> str:
    """Return the advice if the program lacks an environment variable that isolation removed."""
    about = re.search(r"KeyError|environ|variable|not set|unset|undefined|getenv", text)
    words = set(re.findall(r"\w{2,}", text)) if about else set()
    name = min(words & view.withheld, default="")
    return f"and does not see the environment variable {name}; --pass-env {name} shows it" if name else ""


_ABSENT = re.compile(
    r"no such file|not found|not there|cannot (?:open|find)|can't open|(?:failed|unable) to open|could not open|"
    r"does not exist|permission denied|ENOENT|EACCES|NotFound",
    re.IGNORECASE,
)
_DENIED = re.compile(r"permission denied|EACCES|PermissionDenied", re.IGNORECASE)
_READ_ONLY = re.compile(r"read-?only file ?system|EROFS", re.IGNORECASE)


def _file(text: str, view: _View) -> str:
    """Return the advice if isolation hides a file that the program names, or the folder where it would create it."""
    named = list(view.paths(text)) if _ABSENT.search(text) else []
    hidden = next((path for path in named if view.hides(path)), "")
    if not hidden:
        folder = next((folder for path in named if view.hides(folder := os.path.dirname(path))), "")
        return f"and does not see the folder {folder!r}, which may be why; {_TRUST}" if folder else ""
    if within(os.path.realpath(hidden), str(PACKAGE)):
        return _OWN
    shown = "put it into the working directory or beside the program, or show it by --see"
    return f"and does not see {hidden!r}; {shown}; {_TRUST}"


def _library(text: str, _: _View) -> str:
    """Return the advice if the system's loader did not find a library; its message names no folder."""
    match = re.search(r"(\S+): cannot open shared object file", text)
    shown = "show the folder by --see"
    return (
        f"and does not see every folder that may have {match[1]}, which may be why; {shown}; {_TRUST}" if match else ""
    )


def _write(text: str, view: _View) -> str:
    """Return the advice if the program wrote to a folder that this account may write to, and isolation prevented it.

    Without namespaces the program's error is that permission was denied.
    """
    if _READ_ONLY.search(text):
        named = list(view.paths(text)) or [os.path.join(view.folder, "file")]
    elif _DENIED.search(text) and not view.isolation.means.namespaces:
        named = [path for path in view.paths(text) if path in text or f"enied: '{os.path.basename(path)}'" in text]
    else:
        return ""
    if not any(os.access(os.path.dirname(path), os.W_OK) for path in named if not os.path.isdir(path)):
        return ""
    return f"and can write only to its scratch folder, which TMPDIR names; {_TRUST}"


def _rights(text: str, view: _View) -> str:
    """Return the advice if the program needs a file that only the superuser can open."""
    if os.geteuid() != 0 or not _DENIED.search(text):
        return ""
    statuses = [os.stat(path) for path in view.paths(text) if os.path.exists(path)]
    closed = any(status.st_uid and not status.st_mode & 0o004 for status in statuses)
    return f"and has none of the superuser's rights; {_TRUST}" if closed else ""


def _network(text: str, _: _View) -> str:
    """Return the advice if the program needed a network or a socket, which isolation forbids."""
    sign = (
        r"name resolution|Name or service not known|getaddrinfo|gaierror|\b(?:EAI_AGAIN|ENETUNREACH|ENOTFOUND)\b|"
        r"urlopen error|Network is (?:unreachable|down)|[Cc]ould not resolve host|failed to lookup address|"
        r"no such host|UnknownHost|\bsocket\b.*(?:not permitted|EPERM)"
    )
    return f"without a network and without sockets; {_TRUST}" if re.search(sign, text) else ""


def _space(text: str, view: _View) -> str:
    """Return the advice if the program filled the scratch folder, unless a limit of this system is as narrow."""
    full = view.isolation.means.namespaces and re.search(r"No space left|ENOSPC|StorageFull", text)
    long = re.search(r"File too large|EFBIG|FileTooLarge", text) and _unlimited(resource.RLIMIT_FSIZE, SCRATCH_BYTES)
    return f"and its scratch folder has {SCRATCH_BYTES >> 20} MiB; {_TRUST}" if full or long else ""


def _processes(text: str, view: _View) -> str:
    """Return the advice if the program needed more processes than isolation allows and this system allows more."""
    sign = re.search(r"Resource temporarily unavailable|EAGAIN|can't start new thread|WouldBlock", text)
    if not (sign and view.isolation.means.namespaces and _unlimited(resource.RLIMIT_NPROC, THREADS)):
        return ""
    return f"with {THREADS:,} processes and threads at most, which may be why; {_TRUST}"


def _unlimited(limit: int, most: int) -> bool:
    """Whether this system's limit is above `most`, the limit that isolation sets."""
    here, _ = resource.getrlimit(limit)
    return here == resource.RLIM_INFINITY or here > most


def _card(text: str, _: _View) -> str:
    """Return the advice if the program did not find a graphics card that this machine has."""
    sign = re.search(r"CUDA|cudaError|\bhip[A-Z]|OpenCL|Vulkan|NVIDIA|\bGPU\b", text)
    return f"and sees no graphics card; {_TRUST}" if sign and any(glob(pattern) for pattern in _CARDS) else ""


def _call(text: str, _: _View) -> str:
    """Return the advice if a system call was refused.

    The text does not name it; it may be refused without isolation.
    """
    if not re.search(r"Operation not permitted|EPERM|Function not implemented|ENOSYS", text):
        return ""
    return f"which refuses sockets, memory in no file and some other system calls, and may be why; {_TRUST}"


_CAUSES: tuple[Callable[[str, _View], str], ...] = (
    *(_hypcheck, _variable, _file, _library, _rights, _write, _network, _space, _processes, _card, _call),
)
"""Things that isolation takes away; each function gives the end of a sentence, or an empty text. The first sentence is
shown."""
