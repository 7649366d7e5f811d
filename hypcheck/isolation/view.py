"""What an isolated program sees: which folders and files, which environment variables."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]

PRIVATE = ("/tmp", "/var/tmp", "/run")  # noqa: S108 - the program gets an empty folder in their place
"""Folders of the whole system that hold sockets and files of other programs; an empty one stands in their place."""

SHARED_MEMORY = "/dev/shm"  # noqa: S108 - as above

_SECRETS = (
    *(".ssh", ".gnupg", ".aws", ".azure", ".config/gcloud", ".config/gh", ".config/hub", ".docker", ".kube"),
    *(".netrc", ".git-credentials", ".config/git/credentials", ".pypirc", ".npmrc", ".yarnrc.yml", ".m2/settings.xml"),
    *(".cargo/credentials", ".cargo/credentials.toml", ".gem/credentials", ".composer/auth.json", ".pgpass", ".my.cnf"),
    *(".password-store", ".local/share/keyrings", ".mozilla", ".config/google-chrome", ".config/chromium"),
    *(".bash_history", ".zsh_history", ".python_history", ".vault-token", ".terraform.d", ".config/rclone"),
)
"""Files and folders below the home folder that hold keys and tokens, as their programs document them."""

_ALLOWED = re.compile(
    r"PATH|HOME|USER|LOGNAME|SHELL|PWD|LANG|LANGUAGE|LC_\w+|TZ|TERM|LD_LIBRARY_PATH|LD_PRELOAD|CLASSPATH|VIRTUAL_ENV"
    r"|(?:HYPCHECK|PYTHON|CONDA|JAVA|JDK|GO|RUST|CARGO|NODE|NPM_CONFIG|JULIA|OCAML|DOTNET|NUMBA|NUMEXPR|OMP|GOMP|KMP"
    r"|MKL|BLIS|OPENBLAS|VECLIB|RAYON|TBB|OPAM|GHC|ERL|LUA|PERL|RUBY|R|ASAN|LSAN|UBSAN|TSAN|MSAN|MALLOC|GLIBC|JAX|XLA"
    r"|CUDA)_?\w*",
    re.ASCII,
)
"""Names of environment variables that runtimes read."""

_SECRET = re.compile(r"TOKEN|SECRET|PASSW|CREDENTIAL|AUTH|PRIVATE|_KEY|APIKEY", re.IGNORECASE)

_PATHS = ("PATH", "PYTHONPATH", "LD_LIBRARY_PATH", "CLASSPATH", "VIRTUAL_ENV", "CONDA_PREFIX", "JAVA_HOME")


def environment_of(environment: Mapping[str, str], scratch: str, passed: Sequence[str] = ()) -> dict[str, str]:
    """The variables that the program sees: those of runtimes and those of `passed`; temporary files go to `scratch`."""
    kept = {
        name: value
        for name, value in environment.items()
        if name in passed or (_ALLOWED.fullmatch(name) and not _SECRET.search(name))
    }
    return {**kept, "TMPDIR": scratch, "XDG_CACHE_HOME": scratch, "DOTNET_EnableDiagnostics": "0"}


def needed_paths(words: Sequence[str], environment: Mapping[str, str]) -> tuple[str, ...]:
    """What the program needs to see, although it may be in a private folder: outer folders first, none twice.

    These are the working directory, the folders of the files that its words name, and those of PATH and the like.
    """
    found = [os.getcwd(), "/run/current-system", sys.prefix, sys.base_prefix]
    found += [_folder_of(os.path.abspath(word)) for word in words if word and os.path.exists(word)]
    listed = (each for name in _PATHS for each in environment.get(name, "").split(os.pathsep))
    found += [os.path.abspath(each) for each in listed if each]
    needed: list[str] = []
    for path in sorted({os.path.realpath(each) for each in found} | set(found)):
        if os.path.exists(path) and not any(within(path, outer) for outer in needed):
            needed.append(path)
    return tuple(needed)


def _folder_of(path: str) -> str:
    """The folder of a file, or the file alone where that folder is one for everybody's files; a folder itself."""
    folder = path if os.path.isdir(path) else os.path.dirname(path)
    return path if folder in (*PRIVATE, "/") else folder


def private_folders(needed: Iterable[str]) -> tuple[str, ...]:
    """Those of PRIVATE that are folders of this system and not needed as a whole, as the working directory may be."""
    needed = set(needed)
    return tuple(
        each for each in PRIVATE if os.path.isdir(each) and not os.path.islink(each) and not {each, "/"} & needed
    )


def hidden_paths(also: Iterable[str]) -> tuple[str, ...]:
    """What is seen empty: this package with its vectors, `also`, and files with keys and tokens.

    A folder in which the working directory or this Python is cannot be.
    """
    places = (os.getcwd(), sys.prefix, sys.base_prefix)
    home = os.path.expanduser("~")
    found = [os.path.join(home, each) for each in _SECRETS]
    found += [os.path.join(folder, ".git", "config") for folder in _upwards(os.getcwd())]
    found += [str(PACKAGE), str(PACKAGE.parent / "cases"), *also]
    real = sorted({os.path.realpath(each) for each in found if os.path.exists(each)})
    return tuple(path for path in real if not any(within(each, path) for each in places))


def _upwards(folder: str) -> Iterator[str]:
    yield folder
    while (parent := os.path.dirname(folder)) != folder:
        folder = parent
        yield folder


def within(path: str, folder: str) -> bool:
    """Whether a path is a folder or below it."""
    return path == folder or path.startswith(folder.rstrip("/") + "/")


def readable_paths(hidden: Sequence[str], private: Sequence[str], needed: Sequence[str]) -> tuple[list[str], list[str]]:
    """Without a view of its own: the paths that the program may read, and the folders that it may only list.

    Together they are everything but what is hidden, and of the private folders only what is needed. A folder with
    something hidden in it is listed, and its other entries are read.
    """
    read, listed = [], []
    waiting = _entries("/") + [path for path in needed if any(within(path, folder) for folder in private)]
    while waiting:
        path = waiting.pop()
        if path in hidden or path in private:
            continue
        if any(within(each, path) for each in (*hidden, *private)):
            listed.append(path)
            waiting += _entries(path)
        else:
            read.append(path)
    return read, listed


def _entries(folder: str) -> list[str]:
    """The entries of a folder but symbolic links, whose targets are entries of another."""
    try:
        with os.scandir(folder) as entries:
            return [entry.path for entry in entries if not entry.is_symlink()]
    except OSError:
        return []
