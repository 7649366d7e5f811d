"""The attacks of the hostile command, and what stops each: with namespaces, and by Landlock and seccomp alone."""

from __future__ import annotations

from dataclasses import dataclass

from hypcheck.implementations.session import Outcome


@dataclass(frozen=True, slots=True)
class Attack:
    """An attack, in words; what is told of it with namespaces and without, as regular expressions; how its rows end.

    `alone` is None where the means without namespaces do not stop it; docs/security.md says so.
    """

    name: str
    what: str
    told: str
    alone: str | None
    outcome: Outcome = Outcome.ANSWERED


REFUSED = r"PermissionError: \[Errno (1|13)\]"
UNSEEN = r"FileNotFoundError|No such file"

ATTACKS = (
    Attack("rewrite_judge", "rewrites the judge's code", f"{UNSEEN}|Read-only", REFUSED),
    Attack("forge_summary", "forges summary.json before the end", "Read-only", REFUSED),
    Attack("forge_summary_after_the_end", "forges summary.json after the end", "left a daemon", "left a daemon"),
    Attack("daemon_without_environment", "leaves a daemon with a cleared environment", "left a", "left a"),
    Attack("read_vectors", "reads the frozen vectors", UNSEEN, REFUSED),
    Attack("import_hypcheck", "imports hypcheck for its answers", "Error: .*hypcheck", "Error: .*hypcheck"),
    Attack("open_socket", "opens a socket", REFUSED, REFUSED),
    Attack("read_token", "reads tokens", UNSEEN, REFUSED),
    Attack("write_memory_of_judge", "writes to the judge's memory, as a file", UNSEEN, REFUSED),
    Attack("write_memory_by_call", "writes to the judge's memory", "SIGSYS; isolation", "SIGSYS; iso", Outcome.CRASH),
    Attack("stop_judge", "stops the judge", "ProcessLookupError", REFUSED),
    Attack("kill_judge", "kills the judge", "ProcessLookupError", REFUSED),
    Attack("kill_supervisor", "kills what would end it", f"it ignored the signal|{REFUSED}", REFUSED),
    Attack("fork_bomb", "starts processes without end", "^started [23][0-9][0-9] processes, and then no more", None),
    Attack("fill_disk", "fills the disk", "No space left on device", None),
    Attack(
        "memory_behind_setsid",
        "takes 800 MB in a daemon",
        "memory: its processes grew to 0",
        "memory: its processes grew to 0",
        Outcome.CRASH,
    ),
    Attack("memory_in_no_process", "takes memory that is in no process", "Errno 38", "Errno 38"),
    Attack("exhaust_descriptors", "opens files without end", "Too many open files", "Too many open files"),
    Attack("link_scratch", "puts a link in place of the scratch folder", "busy|Read-only", "Permission|busy"),
    Attack("escape_to_new_namespace", "becomes the superuser of a namespace", "not permitted", "not permitted"),
    Attack("look_at_processes", "reads the environments of others", "of 0 others", "of 0 others"),
)
"""Those that a library alone can make are in the tests of libraries: it writes into its rows, behind an array, sets
FTZ and leaves descriptors open. Who knows the frozen rows by heart is found by rows that no file holds."""
