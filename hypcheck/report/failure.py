"""One thing that fails a run, in the words of every report."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Failure:
    """One thing that fails a run.

    `subject` is "proof", "oracle", "implementation", "findings" or "measurement"; `name` says which, `group` the
    family, the quantity or the workload, and `kind` is one word for what happened. `case` is the first case to look at,
    if there is one, `place` where the record has it and `replay` the command that shows it; `count` is how many of its
    kind it stands for.
    """

    subject: str
    name: str
    group: str
    kind: str
    message: str
    case: str | None = None
    place: str | None = None
    replay: str | None = None
    count: int = 1
