"""The files that an isolated program sees: the system's, its own, and those of its interpreter and packages.

It does not see the rest: other people's folders, caches, and the files that contain the answers by which it is judged.
These are this package and its vectors, its checkout with the build folders, its repository, and other copies of the
package.
"""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from glob import glob
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]

SHARED_MEMORY = "/dev/shm"  # noqa: S108 - the program gets an empty folder in its place

TEMPORARY = ("/tmp", "/var/tmp", "/run")  # noqa: S108 - as above
"""Folders of the whole system that hold sockets and files of other programs."""

_SYSTEM = (
    *("bin", "dev", "etc", "gnu", "lib", "lib32", "lib64", "libx32", "nix", "opt", "proc", "sbin", "snap", "sys"),
    *("usr", "var"),
)
"""Folders of the root with programs, libraries and their settings. Of other folders only needed parts are visible."""

_SECRETS = (
    *(".ssh", ".gnupg", ".aws", ".azure", ".config/gcloud", ".config/gh", ".config/hub", ".docker", ".kube"),
    *(".netrc", ".git-credentials", ".config/git/credentials", ".pypirc", ".npmrc", ".yarnrc.yml", ".m2/settings.xml"),
    *(".cargo/credentials", ".cargo/credentials.toml", ".gem/credentials", ".composer/auth.json", ".pgpass", ".my.cnf"),
    *(".password-store", ".local/share/keyrings", ".mozilla", ".config/google-chrome", ".config/chromium"),
    *(".bash_history", ".zsh_history", ".python_history", ".vault-token", ".terraform.d", ".config/rclone"),
)
"""Files and folders below the home folder that hold keys and tokens, as their programs document them."""

_TOOLS = (
    *(".julia", ".juliaup", ".pyenv", ".nvm", ".volta", ".sdkman", ".opam", ".asdf", ".dotnet", ".nuget/packages"),
    *(".m2/repository", ".gem", ".rbenv", ".rvm", ".luarocks", ".cabal", ".ghcup", ".deno", ".bun", "R", "perl5"),
    *("node_modules", ".node_modules", ".local/lib", ".local/share/mise", ".local/share/uv", ".local/share/pnpm"),
    ".cache/uv/archive-v0",
)
"""Folders below the home folder where languages keep themselves and their packages."""

_PATHS = (
    *("PATH", "PYTHONPATH", "PYTHONUSERBASE", "VIRTUAL_ENV", "CONDA_PREFIX", "PYENV_ROOT", "LD_LIBRARY_PATH"),
    *("LD_PRELOAD", "CLASSPATH", "JAVA_HOME", "JDK_HOME", "JRE_HOME", "GOROOT", "NODE_PATH", "NVM_DIR"),
    *("JULIA_DEPOT_PATH", "JULIA_LOAD_PATH", "OPAMROOT", "OPAM_SWITCH_PREFIX", "OCAMLPATH", "OCAMLLIB"),
    *("CAML_LD_LIBRARY_PATH", "DOTNET_ROOT", "PERL5LIB", "RUBYLIB", "GEM_HOME", "GEM_PATH", "R_HOME", "R_LIBS"),
    *("R_LIBS_SITE", "R_LIBS_USER", "ERL_LIBS", "GHC_PACKAGE_PATH", "CUDA_HOME", "CUDA_PATH"),
)
"""Variables that name files and folders of interpreters, libraries and packages."""


_IN_CHECKOUT = (".git", "build", "dist", "cases")
"""Folders with answers in a checkout of this package, beside the package itself."""


def needed_paths(words: Sequence[str], environment: Mapping[str, str], also: Iterable[str] = ()) -> tuple[str, ...]:
    """Return the folders and files that the program of these words needs: outer folders first, none twice.

    These are the working directory with the repository that it is in, the folders of the files that its words name,
    those of its interpreter and of this Python with their packages, those of PATH and the like, and `also`.
    """
    paths = [os.getcwd(), _project(os.getcwd()), "/run/current-system", sys.prefix, sys.base_prefix, *also]
    program = shutil.which(words[0], path=environment.get("PATH")) if words else None
    for path in (*words, *([program] if program else ())):
        if path and os.path.exists(path):
            paths += _of_file(os.path.abspath(path), environment)
    left_out = {*TEMPORARY, "/", _home(), *([str(PACKAGE.parent)] if _is_checkout() else ())}
    packages = [os.path.abspath(path) for path in sys.path if path and os.path.realpath(path) not in left_out]
    paths += [*packages, *(link for path in packages for link in _links(path))]
    for name in _PATHS:
        folders = [os.path.abspath(path) for path in environment.get(name, "").split(os.pathsep) if path]
        paths += [shown for path in folders for shown in _installation(path)]
    paths += [os.path.join(_home(), path) for path in _TOOLS]
    needed: list[str] = []
    for path in sorted({os.path.realpath(path) for path in paths} | set(paths)):
        if os.path.exists(path) and not any(within(path, outer) for outer in needed):
            needed.append(path)
    return tuple(needed)


def _project(folder: str) -> str:
    """Return the top folder of a folder's repository; the folder itself if it has none, or if that is a whole home."""
    tops = (outer for outer in _upwards(folder) if os.path.exists(os.path.join(outer, ".git")))
    top = next(tops, folder)
    return folder if top in {*TEMPORARY, "/", _home()} else top


def _links(folder: str) -> Iterator[str]:
    """Yield the targets of the links in a folder: packages may be installed once, and linked into each environment."""
    try:
        with os.scandir(folder) as entries:
            yield from (os.path.realpath(entry.path) for entry in entries if entry.is_symlink())
    except OSError:  # it is an archive, or not there
        return


def _of_file(path: str, environment: Mapping[str, str]) -> Iterator[str]:
    """Yield the folders of a file, of the target if it is a link, and of the interpreter that its first line names."""
    for place in (path, os.path.realpath(path)):
        yield from _installation(_folder_of(place))
    interpreter = _interpreter(path, environment)
    if interpreter:
        yield from _installation(_folder_of(interpreter))
        yield from _installation(_folder_of(os.path.realpath(interpreter)))


def _folder_of(path: str) -> str:
    """Return the folder of a file, or only the file if many users share that folder.

    For a folder, return the folder itself.
    """
    folder = path if os.path.isdir(path) else os.path.dirname(path)
    return path if folder in (*TEMPORARY, "/", _home()) else folder


def _installation(folder: str) -> tuple[str, ...]:
    """Return the folders of an installation: the folder or, if it is named bin, its parent with the libraries."""
    outer = os.path.dirname(folder)
    if os.path.basename(folder) not in {"bin", "sbin", "shims"}:
        return (folder,)
    shared = outer in {"/", _home(), os.path.join(_home(), ".local")}
    return (folder, os.path.join(outer, "lib")) if shared else (outer,)


def _interpreter(path: str, environment: Mapping[str, str]) -> str | None:
    """Return the program that the first line of a script names; None of another file."""
    try:
        with open(path, "rb") as file:
            line = file.readline(256)
    except OSError:
        return None
    words = os.fsdecode(line[2:]).split() if line.startswith(b"#!") else []
    if len(words) > 1 and os.path.basename(words[0]) == "env":
        return shutil.which(words[1], path=environment.get("PATH"))
    return words[0] if words and os.path.isabs(words[0]) else None


def private_folders(needed: Iterable[str]) -> tuple[str, ...]:
    """Return folders of which only the needed parts are visible; TEMPORARY first, none within another.

    They are the folders of the root that do not belong to the system, and the home folder. A folder that is needed as a
    whole, as the working directory may be, is not among them.
    """
    needed = set(needed)
    folders = [*TEMPORARY, *(path for path in sorted(_entries("/")) if os.path.basename(path) not in _SYSTEM)]
    if any(within(_home(), outer) for outer in ("/var/", "/opt/")):
        folders.append(_home())
    return tuple(
        path
        for path in dict.fromkeys(folders)
        if os.path.isdir(path) and not os.path.islink(path) and not {path, "/"} & needed
    )


def hidden_paths(also: Iterable[str], needed: Sequence[str] = (), seen: Sequence[str] = ()) -> tuple[str, ...]:
    """Return files and folders that appear empty, although they are in a visible folder.

    These are this package with its vectors, and `also`; and, except for what is in `seen`, repositories, copies of this
    package and what was built of them, the checkout of the action of GitHub, and files with keys and tokens. A folder
    that contains the working directory or this Python cannot be hidden.
    """
    places = (os.getcwd(), sys.prefix, sys.base_prefix)
    hidden = [os.path.join(_home(), path) for path in _SECRETS]
    roots = (os.getcwd(), *needed)
    hidden += [os.path.join(folder, ".git") for folder in {outer for root in roots for outer in _upwards(root)}]
    hidden += [os.environ.get("GITHUB_ACTION_PATH", ""), *_copies(roots)]
    hidden = [path for path in hidden if path and not any(within(path, folder) for folder in seen)]
    hidden += [str(PACKAGE), str(PACKAGE.parent / "cases"), *also]
    real = sorted({os.path.realpath(path) for path in hidden if os.path.exists(path)})
    return tuple(path for path in real if not any(within(place, path) for place in places))


@lru_cache(maxsize=8)
def _copies(roots: Sequence[str]) -> tuple[str, ...]:
    """Return the folders of this package and of its copies, followed by the folders with answers in their checkouts.

    Copies are looked for in Python's usual folders, in the folders `roots`, and one level below these.
    """
    packages = "lib/python3*/[ds]*-packages/hypcheck"
    patterns = [f"{outer}/{packages}" for outer in ("/usr", "/usr/local", "/opt/*", "/opt/hostedtoolcache/*/*/*")]
    for root in roots:
        patterns += [f"{root}/{inner}{packages}" for inner in ("", "*/", ".*/", "versions/*/", "envs/*/")]
        patterns += [f"{root}/hypcheck", f"{root}/*/hypcheck"]
    patterns += [f"{path}/hypcheck" for path in sys.path if path]
    paths = {str(PACKAGE), *(path for pattern in patterns for path in glob(pattern))}
    copies = [path for path in sorted(paths) if os.path.isfile(os.path.join(path, "kernel", "classify.py"))]
    checkouts = [
        outer for outer in map(os.path.dirname, copies) if os.path.isfile(os.path.join(outer, "pyproject.toml"))
    ]
    return (*copies, *(os.path.join(outer, name) for outer in checkouts for name in _IN_CHECKOUT))


def _is_checkout() -> bool:
    """Whether this package lies in its sources, and not among the packages of a Python."""
    return (PACKAGE.parent / "pyproject.toml").is_file()


def _home() -> str:
    """Return the home folder, with links resolved."""
    return os.path.realpath(os.path.expanduser("~"))


def _upwards(folder: str) -> Iterator[str]:
    """Yield the folder, then each folder that contains it, up to the root."""
    yield folder
    while (parent := os.path.dirname(folder)) != folder:
        folder = parent
        yield folder


def within(path: str, folder: str) -> bool:
    """Whether a path is a folder or below it."""
    return path == folder or path.startswith(folder.rstrip("/") + "/")


def readable_paths(hidden: Sequence[str], private: Sequence[str], needed: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return the paths that a program without a view of its own may read, and folders that it may only list.

    Together they are everything but what is hidden, and of the private folders only what is needed. A folder with
    something hidden in it is listed, and its other entries are read.
    """
    read, listed = [], []
    waiting = _entries("/") + [path for path in needed if any(within(path, folder) for folder in private)]
    while waiting:
        path = waiting.pop()
        if path in hidden or path in private:
            continue
        if any(within(inner, path) for inner in (*hidden, *private)):
            listed.append(path)
            waiting += _entries(path)
        else:
            read.append(path)
    return read, listed


def _entries(folder: str) -> list[str]:
    """Return the entries of a folder but symbolic links, whose targets are entries of another."""
    try:
        with os.scandir(folder) as entries:
            return [entry.path for entry in entries if not entry.is_symlink()]
    except OSError:
        return []
