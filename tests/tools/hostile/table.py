"""The attacks of the hostile command, and what stops each, by the means of isolation that a machine has."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from hypcheck.implementations.session import Outcome
from hypcheck.isolation.launch import Means, available

HERE = available()

KINDS: Mapping[str, Means] = MappingProxyType(
    {
        "namespaces": HERE,
        "Landlock and seccomp": Means(False, HERE.landlock, HERE.seccomp, ("no namespaces: left out",)),
        "seccomp alone": Means(False, 0, HERE.seccomp, ("no namespaces: left out", "no Landlock: left out")),
        "nothing": Means(),
    }
)
"""Kinds of machines, as far as this one can be each of them."""


def is_here(kind: str) -> bool:
    """Whether this system has the means of a kind; Landlock of Linux 6.12, which keeps signals out."""
    needed = {"namespaces": HERE.whole, "Landlock and seccomp": HERE.landlock >= 6, "seccomp alone": HERE.seccomp}
    return needed.get(kind, True)


@dataclass(frozen=True, slots=True)
class Attack:
    """An attack, in words; what is told of it, as a regular expression, in the order of KINDS; how its rows end.

    None where that kind does not stop it; docs/security.md says so.
    """

    name: str
    what: str
    told: tuple[str | None, str | None, str | None, str | None]
    outcome: Outcome = Outcome.ANSWERED

    def by_kind(self) -> Mapping[str, str | None]:
        """What is told of it, by the kind."""
        return dict(zip(KINDS, self.told, strict=True))


REFUSED = r"PermissionError: \[Errno (1|13)\]"
UNSEEN = r"FileNotFoundError|No such file"

GONE = f"{REFUSED}|{UNSEEN}"
GREW = "memory: its processes grew to 0"
NOBODY = "ProcessLookupError"
DENIED = "Operation not permitted"

ATTACKS = (
    Attack("rewrite_judge", "rewrites the judge's code", (f"{UNSEEN}|Read-only", REFUSED, None, None)),
    Attack("forge_summary", "forges summary.json before the end", ("Read-only", REFUSED, None, None)),
    Attack("forge_summary_after_the_end", "forges summary.json after the end", ("left a",) * 3 + (None,)),
    Attack("daemon_without_environment", "leaves a daemon with a cleared environment", ("left a",) * 3 + (None,)),
    Attack("survive_by_forking", "leaves a daemon that forks and forks", ("left a",) * 3 + (None,)),
    Attack("blind_supervisor", "takes the descriptors of what would end it", ("left a", REFUSED, REFUSED, None)),
    Attack("read_vectors", "reads the frozen vectors", (UNSEEN, REFUSED, None, None)),
    Attack("import_hypcheck", "imports hypcheck for its answers", (*("Error: .*hypcheck",) * 2, None, None)),
    Attack("read_repository", "reads the judge's repository", (f"{UNSEEN}|NotADirectory", REFUSED, None, None)),
    Attack("import_built_copy", "reads what a build left", (UNSEEN, GONE, None, None)),
    Attack("import_second_copy", "imports a copy elsewhere", (*("Error: .*hypcheck",) * 2, None, None)),
    Attack("open_socket", "opens a socket", (REFUSED,) * 3 + (None,)),
    Attack("read_token", "reads tokens", (UNSEEN, REFUSED, None, None)),
    Attack("count_secrets", "finds secrets in its environment", ("^0 secrets",) * 3 + (None,)),
    Attack("tell_secrets", "tells secrets that it finds", ("^told: $|^told:$",) * 3 + (r"^told: \*\*\*",)),
    Attack("write_memory_of_judge", "writes to the judge's memory, as a file", (UNSEEN, REFUSED, None, None)),
    Attack("write_memory_by_call", "writes to the judge's memory", ("SIGSYS; isolation",) * 3 + (None,), Outcome.CRASH),
    Attack("stop_judge", "stops the judge", (NOBODY, REFUSED, REFUSED, None)),
    Attack("kill_judge", "kills the judge", (NOBODY, REFUSED, REFUSED, None)),
    Attack("kill_supervisor", "kills what would end it", (f"it ignored the signal|{REFUSED}", REFUSED, REFUSED, None)),
    Attack("limit_judge", "limits the judge", (NOBODY, REFUSED, REFUSED, None)),
    Attack("slow_judge", "lowers the judge's priority", (NOBODY, REFUSED, REFUSED, None)),
    Attack("slow_everybody", "lowers the priority of all", (REFUSED,) * 3 + (None,)),
    Attack("move_judge", "moves the judge to another processor", (NOBODY, REFUSED, REFUSED, None)),
    Attack("schedule_judge", "gives the judge another scheduler", (NOBODY, REFUSED, REFUSED, None)),
    Attack("slow_files_of_judge", "lowers the judge's priority of files", ("No such process", DENIED, DENIED, None)),
    Attack("chmod_report", "changes the mode of a report", (UNSEEN, REFUSED, REFUSED, None)),
    Attack("chmod_report_by_descriptor", "changes the mode of an open report", (UNSEEN, REFUSED, REFUSED, None)),
    Attack("touch_report", "changes the time of a report", (UNSEEN, REFUSED, REFUSED, None)),
    Attack("mark_report", "changes the attributes of a report", (UNSEEN, REFUSED, REFUSED, None)),
    Attack("open_devices", "opens devices", ("^opened 5: full null random urandom zero$",) * 2 + (None, None)),
    Attack("list_terminals", "lists the terminals", (UNSEEN, REFUSED, None, None)),
    Attack("call_what_nobody_knows", "makes system calls of later systems", ("errors .38, 38, 38, 38",) * 3 + (None,)),
    *(
        [Attack("make_calls_of_32_bits", "makes calls of 32 bits", (r"\[3, 0, 38\]", *(r"\[1, 1, 38\]",) * 2, None))]
        if platform.machine() == "x86_64"
        else []
    ),
    Attack(
        "fork_bomb",
        "starts processes without end",
        ("^started [23][0-9][0-9] processes, and then no more", None, None, None),
    ),
    Attack("fill_disk", "fills the disk", ("No space left on device", None, None, None)),
    Attack("memory_behind_setsid", "takes 800 MB in a daemon", (GREW,) * 4, Outcome.CRASH),
    Attack("memory_by_page_tables", "takes memory by page tables", (GREW,) * 4, Outcome.CRASH),
    Attack("memory_in_no_process", "takes memory that is in no process", ("Errno 38",) * 3 + (None,)),
    Attack("exhaust_descriptors", "opens files without end", ("Too many open files",) * 3 + (None,)),
    Attack("link_scratch", "replaces the scratch folder by a link", ("busy|Read-only", "Permission|busy", None, None)),
    Attack("abstract_socket", "listens at a name that is no file", (REFUSED,) * 3 + (None,)),
    Attack("count_descriptors", "finds descriptors of the judge", ("^0 inherited",) * 4),
    Attack("read_by_another_root", "reads vectors by the root of others", ("^read 0 files",) * 2 + (None, None)),
    Attack("replace_interpreter", "writes beside its interpreter", ("^wrote into 0 folders",) * 2 + (None, None)),
    Attack("flood_with_words", "floods its standard error", ("^[x |]{1,399}…$",) * 4),
    *(
        [Attack("call_what_exploits_like", "makes calls of exploits", ("^answered: $|^answered:$",) * 3 + (None,))]
        if platform.machine() == "x86_64"
        else []
    ),
    Attack("escape_to_new_namespace", "becomes the superuser of a namespace", (DENIED,) * 3 + (None,)),
    Attack("look_at_processes", "reads the environments of others", ("of 0 others",) * 2 + (None, None)),
)
"""Those that a library alone can make are in the tests of libraries: it writes into its rows, behind an array, sets
FTZ and leaves descriptors open. Who knows the frozen rows by heart is found by rows that no file holds."""
