"""What a foreign program starts and lets go of: a daemon in a session of its own is in no group that we could end.

It keeps the environment that its program was given, though, and there a mark tells whose it is. Only Linux shows us
environments; elsewhere what detaches itself outlives the run.
"""

from __future__ import annotations

import os
import secrets
import signal
from collections.abc import Iterator
from contextlib import suppress

GUARD = """
exec >&- 2>&-
(
    while sleep "$3"; do
        read -r line < /proc/$PPID/stat || exit
        set -- "$1" "$2" "$3" "$4" ${line##*) }
        if [ "$5" = T ] && [ "${54}" = "$4" ]; then
            [ "$seen" ] && kill -s CONT "$PPID"
            seen=1
        else
            seen=
        fi
    done
) &
read -r _
kill -s KILL -- "-$1"
grep -ls "$2" /proc/[0-9]*/environ | while IFS=/ read -r _ _ each _; do kill -s KILL "$each"; done
kill -s KILL 0
"""
"""For a shell that leads a group: it reads until its standard input ends, which only we hold open, and then kills the
group $1, whoever has the mark $2, and itself.

Meanwhile it looks at us every $3 seconds. If it finds us stopped by the signal number $4 twice in turn, it lets us go
on: the program may have sent it, and nobody else might ever undo it. The field `exit_code` of a `stat`, the 52nd, tells
which signal stopped a process, until its parent has taken note of that, as a shell does at a terminal, where somebody
can undo it (Linux 5.17 and later; earlier it is 0, and nothing is undone). Ctrl-Z is another signal.
"""

LOOK = 5
"""Seconds between two looks of a guard."""

_ROUNDS = 5
"""Looks for who was started while others were ended."""


def new_mark() -> str:
    """The name of a variable for an environment; with those of others it can stand in one."""
    return f"HYPCHECK_{secrets.token_hex(16)}"


def end_marked(mark: str) -> None:
    """Kill all processes that have the mark and that we may kill."""
    for _ in range(_ROUNDS):
        found = list(_marked(mark))
        for process in found:
            with suppress(OSError):
                os.kill(process, signal.SIGKILL)
        if not found:
            return


def is_marked(process: int, mark: str) -> bool:
    """Whether the environment of a process has the mark; never of another user's, or where the system does not tell."""
    try:
        with open(f"/proc/{process}/environ", "rb") as file:
            return f"{mark}=".encode() in file.read()
    except OSError:  # it ended meanwhile, or is another's
        return False


def _marked(mark: str) -> Iterator[int]:
    try:
        names = os.listdir("/proc")
    except OSError:
        return
    yield from (int(name) for name in names if name.isdigit() and is_marked(int(name), mark))
