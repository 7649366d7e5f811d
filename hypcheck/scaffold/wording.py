"""What a user gives to `hypcheck init`, made safe for every file it is written into: a name, and what to install.

Both end up in JSON within five languages' string literals, in TOML, in YAML and in a shell's command line, so only
characters that mean nothing in any of these pass.
"""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass

from hypcheck.errors import InputError

LONGEST_NAME = 64

_VERSION = re.compile(r"\d+(\.\d+)*((a|b|rc)\d+)?(\.post\d+)?(\.dev\d+)?", re.ASCII)
_REF = r"(?P<ref>@\w[\w./+-]*)?"
_PART = r"[\w~][\w.~+-]*"
_URL = re.compile(
    rf"(git\+)?(?P<scheme>https|ssh)://((?P<user>[^/\s]*)@)?(?P<place>\w[\w.-]*(:\d+)?(/{_PART})+)/?{_REF}", re.ASCII
)
_SCP = re.compile(rf"(?P<user>\w[\w.-]*)@(?P<host>\w[\w.-]*):(?P<path>{_PART}(/{_PART})*){_REF}", re.ASCII)
_USER = re.compile(r"\w[\w.-]*", re.ASCII)
_LONGEST = 300
_RIGHT = "a version such as 1.2.0, or a git URL such as https://host/owner/hypcheck.git@v1.2.0"


@dataclass(frozen=True, slots=True)
class Requirement:
    """What pip is to install, as pip reads it, and whether that is the same thing for ever."""

    text: str
    pinned: bool


def safe_name(text: str) -> str:
    """The name in letters, digits and . _ - alone, at most LONGEST_NAME of them; empty where nothing is left."""
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
    return re.sub(r"[^A-Za-z0-9._]+", "-", plain).strip("-._")[:LONGEST_NAME].rstrip("-._")


def requirement(source: str) -> Requirement:
    """What `--from` asks for: a version, or the repository that a git URL names, with @ and a tag or commit if pinned.

    Raises InputError about anything else, and about a URL that holds a password, which must not stand in a workflow.
    """
    if len(source) > _LONGEST:
        raise InputError(f"--from is longer than {_LONGEST} characters; it must be {_RIGHT}")
    if _VERSION.fullmatch(source):
        return Requirement(f"hypcheck=={source}", pinned=True)
    if short := _SCP.fullmatch(source):
        return _of_git(f"ssh://{short['user']}@{short['host']}/{short['path']}", short["ref"])
    url = _URL.fullmatch(source)
    if not url:
        raise InputError(f"--from is {source!r}; it must be {_RIGHT}")
    if url["user"] is None:
        return _of_git(f"{url['scheme']}://{url['place']}", url["ref"])
    if url["scheme"] == "https" or not _USER.fullmatch(url["user"]):
        raise InputError(
            "--from holds what may be a secret before its @, and the workflow is for all to read; "
            "it must be https://host/… without a user, or ssh://user@host/…"
        )
    return _of_git(f"ssh://{url['user']}@{url['place']}", url["ref"])


def _of_git(url: str, ref: str | None) -> Requirement:
    return Requirement(f"hypcheck @ git+{url}{ref or ''}", pinned=ref is not None)
