"""The requirement that the workflow of `hypcheck init` installs: `--from` as pip reads it, pinned to one state.

No package index is known to have hypcheck, and anyone may take a free name there. So only what was named is installed,
and it is pinned: a git repository by a commit, a file by its SHA-256, a release by its version. The text is written
into YAML and a shell's command line, so only characters without a meaning in either pass.
"""

from __future__ import annotations

import hashlib
import os
import re
import subprocess
from dataclasses import dataclass, replace
from pathlib import Path
from urllib.parse import quote, unquote

from hypcheck.errors import InputError, system_reason

_LONGEST = 300
_SAFE = re.compile(r"[\w.~][\w .:/@+~=,%#!\[\]-]*", re.ASCII)
_NAME = r"[A-Za-z0-9](?:[\w.-]*[A-Za-z0-9])?(?:\[[\w.,-]+\])?"
_NUMBER = r"(?:\d+!)?\d+(?:\.\d+)*(?:(?:a|b|rc)\d+)?(?:\.post\d+)?(?:\.dev\d+)?(?:\+[\w.]+)?"
_VERSION = re.compile(_NUMBER, re.ASCII)
_RELEASE = re.compile(rf"({_NAME}) ?={{2,3}} ?({_NUMBER})", re.ASCII)
_DIRECT = re.compile(rf"(?P<project>{_NAME}) ?@ ?(?P<url>[\w+]+://.*)", re.ASCII)
_URL = re.compile(
    r"(?P<git>git\+)?(?P<scheme>[\w+]+)://((?P<user>[^/\s]*)@)?(?P<place>[^@#]*)(?P<end>[@#].*)?", re.ASCII
)
_PART = r"[\w~%][\w.~+%-]*"
_PLACE = re.compile(rf"\w[\w.-]*(:\d+)?(/{_PART})+", re.ASCII)
_FILE = re.compile(r"(/[\w.~+%-]+)+", re.ASCII)
_SCP = re.compile(rf"(?P<user>\w[\w.-]*)@(?P<host>\w[\w.-]*):(?P<path>{_PART}(/{_PART})*)(?P<end>@.*)?", re.ASCII)
_USER = re.compile(r"\w[\w.-]*", re.ASCII)
_REF = re.compile(r"@(?P<ref>\w[\w./+-]*)", re.ASCII)
_COMMIT = re.compile(r"[0-9a-f]{40}")
_ABBREVIATED = re.compile(r"[0-9a-f]{7,39}")
_DIGEST = re.compile(r"#sha256=[0-9a-f]{64}")
_ARCHIVES = (".whl", ".tar.gz", ".zip")
_SECONDS = 15.0
"""The seconds within which a repository must answer with the commit of a name."""

RIGHT = (
    "a git URL such as https://HOST/OWNER/hypcheck.git@COMMIT, a wheel or sdist (a path, or a URL), "
    "or one version on a package index, such as hypcheck==VERSION"
)


@dataclass(frozen=True, slots=True)
class Requirement:
    """The requirement by which the workflow installs hypcheck.

    text: as pip reads it.
    says: sentences about it, for the user and for the workflow.
    repository, ref: the git repository and its branch or tag, as long as the commit is not known.
    """

    text: str
    says: tuple[str, ...] = ()
    repository: str = ""
    ref: str = ""


def requirement(source: str, directory: Path) -> Requirement:
    """Return the requirement of `--from`, for a workflow of the repository in `directory`. It does not run git.

    Raises InputError unless `source` is RIGHT, and for a URL with a password, which must not get into a workflow.
    """
    if len(source) > _LONGEST:
        raise InputError(f"--from is longer than {_LONGEST} characters; it must be {RIGHT}")
    if os.path.exists(source) and ("/" in source or source.endswith(_ARCHIVES)):
        return _of_path(Path(source), directory)
    if not _SAFE.fullmatch(source):
        raise _wrong(source)
    if _VERSION.fullmatch(source):
        return _of_index("hypcheck", source)
    if release := _RELEASE.fullmatch(source):
        return _of_index(release[1], release[2])
    if short := _SCP.fullmatch(source):
        return _of_git("hypcheck", f"ssh://{short['user']}@{short['host']}/{short['path']}", short["end"], source)
    direct = _DIRECT.fullmatch(source)
    return _of_url(direct["project"], direct["url"], source) if direct else _of_url("hypcheck", source, source)


def pinned(wanted: Requirement) -> Requirement:
    """Pin the requirement to the current commit of its branch or tag, and add a sentence about it.

    If a remote repository cannot be asked, a sentence says so. Raises InputError if a local one cannot be read, or has
    no such branch or tag.
    """
    if not wanted.repository or _COMMIT.fullmatch(wanted.ref):
        return wanted
    named = wanted.ref or "HEAD"
    refs = _refs(wanted.repository)
    if isinstance(refs, str):
        if wanted.repository.startswith("file:"):
            raise InputError(f"--from: git cannot read {wanted.repository}: {refs}")
        fault = f"{wanted.repository} could not be queried for the commit of {named} ({refs}); name one by @COMMIT"
        return replace(wanted, says=(*wanted.says, f"not pinned: {fault}"))
    commit = next((refs[name] for name in _names(named) if name in refs), None)
    if commit is None and _ABBREVIATED.fullmatch(named):
        return wanted
    if commit is None:
        raise InputError(f"--from: {wanted.repository} has no branch or tag {named!r}")
    text = f"{wanted.text.removesuffix('@' + wanted.ref) if wanted.ref else wanted.text}@{commit}"
    return replace(
        wanted,
        text=text,
        says=(*wanted.says, f"pinned to the commit that {named} of {wanted.repository} was on when init ran"),
    )


def _names(ref: str) -> tuple[str, ...]:
    """Return the refs that a name may mean, in pip's order: a branch before a tag, of an annotated tag its commit."""
    return (ref, f"refs/heads/{ref}", f"refs/tags/{ref}^{{}}", f"refs/tags/{ref}")


def _refs(repository: str) -> dict[str, str] | str:
    """Ask a repository for the commit of each ref; return them, or the reason why they are not known."""
    quiet = {"GIT_TERMINAL_PROMPT": "0", "GIT_SSH_COMMAND": "ssh -o BatchMode=yes"}
    words = ["git", "ls-remote", "--", repository]
    try:
        result = subprocess.run(  # noqa: S603 - git of the PATH, and a URL whose characters were checked
            words, env=quiet | os.environ, stdin=subprocess.DEVNULL, capture_output=True, timeout=_SECONDS, check=False
        )
    except OSError as error:
        return f"git cannot be started: {system_reason(error)}"
    except subprocess.TimeoutExpired:
        return f"no answer within {_SECONDS:g} s"
    if result.returncode:
        messages = result.stderr.decode(errors="replace").strip().splitlines()
        return messages[0].removeprefix("fatal: ").strip() if messages else f"git ends with {result.returncode}"
    lines = (line.partition("\t") for line in result.stdout.decode(errors="replace").splitlines())
    return {name: commit for commit, _, name in lines if _COMMIT.fullmatch(commit)}


def _of_index(project: str, version: str) -> Requirement:
    """Return the requirement of one version on a package index."""
    where = (
        f"pip takes {project} {version} from the package index of the machine that runs the workflow, by default PyPI"
    )
    return Requirement(f"{project}=={version}", (f"{where}: make sure that this is the project you mean",))


def _of_url(project: str, url: str, source: str) -> Requirement:
    """Return the requirement of a repository or an archive at a URL. Raises InputError."""
    match = _URL.fullmatch(url)
    if not match:
        raise _wrong(source)
    scheme, place, user = match["scheme"], match["place"].rstrip("/"), match["user"]
    local = scheme == "file" and not user and _FILE.fullmatch(place)
    if not local and not (scheme in {"https", "ssh"} and _PLACE.fullmatch(place)):
        raise _wrong(source)
    if user is not None and (scheme == "https" or not _USER.fullmatch(user)):
        raise InputError(
            "--from may hold a secret before its @, and everybody can read the workflow; "
            "it must be https://host/… without a user, or ssh://user@host/…"
        )
    if place.endswith(_ARCHIVES) and not match["git"] and scheme != "ssh":
        return _of_archive(project, f"{scheme}://{place}", match["end"] or "", source)
    return _of_git(project, f"{scheme}://{user + '@' if user else ''}{place}", match["end"], source)


def _of_git(project: str, url: str, end: str | None, source: str) -> Requirement:
    """Return the requirement of a git repository at a URL with an end such as @REF. Raises InputError."""
    ref = _REF.fullmatch(end or "")
    if end and not ref:
        raise _wrong(source)
    local = url.startswith("file:")
    # pip before 24.1 reads `NAME @ git+file:///…` as a path, and the URL without a name correctly.
    text = f"git+{url}" if local and project == "hypcheck" else f"{project} @ git+{url}"
    return Requirement(f"{text}{end or ''}", (_here(url),) if local else (), url, ref["ref"] if ref else "")


def _of_archive(project: str, url: str, end: str, source: str) -> Requirement:
    """Return the requirement of a wheel or sdist at a URL, pinned by its digest if it is known."""
    if end and not _DIGEST.fullmatch(end):
        raise _wrong(source)
    if url.startswith("file:"):
        path = Path(unquote(url.removeprefix("file://")))
        return Requirement(f"{project} @ {url}{end or _digest(path)}", (_here(url),))
    loose = "not pinned: add #sha256=DIGEST to its end, or another file with this name may be installed one day"
    return Requirement(f"{project} @ {url}{end}", () if end else (loose,))


def _of_path(path: Path, directory: Path) -> Requirement:
    """Return the requirement of a file or folder of this machine.

    If it is in the repository, the repository pins it; else its digest or commit does. Raises InputError.
    """
    whole = path.resolve()
    if not (whole.is_dir() or whole.name.endswith(_ARCHIVES)):
        raise InputError(f"--from is {str(path)!r}, which is neither a folder nor a wheel or sdist; it must be {RIGHT}")
    if whole.is_relative_to(directory.resolve()) and whole != directory.resolve():
        text = f"./{whole.relative_to(directory.resolve())}"
        if not _SAFE.fullmatch(text):
            raise InputError(f"--from is {str(path)!r}; its path must consist of letters, digits and . _ - /")
        return Requirement(text, (f"{text} must be in the repository when the workflow runs",))
    return _of_url("hypcheck", f"{'git+' if whole.is_dir() else ''}file://{quote(str(whole))}", str(path))


def _digest(path: Path) -> str:
    """Return the end of a URL that pins a file by its SHA-256. Raises InputError."""
    try:
        with path.open("rb") as file:
            digest = hashlib.sha256()
            while part := file.read(1 << 20):
                digest.update(part)
    except OSError as error:
        raise InputError(f"--from: cannot read {path}: {system_reason(error)}") from None
    return f"#sha256={digest.hexdigest()}"


def _here(url: str) -> str:
    """Say that the machine of the workflow must have the file of this URL."""
    return f"the machine that runs the workflow must have {url} too"


def _wrong(source: str) -> InputError:
    """Make the error that `source` is not RIGHT."""
    path = "://" not in source and (source.startswith((".", "/", "~")) or source.endswith(_ARCHIVES))
    return InputError(f"--from is {source!r}{', which does not exist' if path else ''}; it must be {RIGHT}")
