"""Several files written as one: none over what is there unless that is wanted, and none half."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from hypcheck.errors import InputError, system_reason
from hypcheck.tables.streams import writing
from hypcheck.visible import counted


def write_all(root: Path, texts: Mapping[str, str], *, force: bool, replaced: Collection[str] = ()) -> None:
    """Write each text to its path below `root`, which is made where it is not there.

    Files that are there are replaced only by `force`, or where their path is one of `replaced`.

    Every text is on the disk, beside its place, before the first takes its place; an error leaves nothing new behind.
    Raises InputError naming a path that is in the way or that the system refuses.
    """
    targets = {root / path: text for path, text in texts.items()}
    there = [root / path for path in texts if os.path.lexists(root / path) and path not in replaced]
    _refuse(there, force=force)
    with ExitStack() as stack:
        for target in targets:
            stack.enter_context(_folder(target.parent))
            stack.enter_context(_new(target))
        for target, text in targets.items():
            writer = stack.enter_context(writing(str(target)))
            writer.write(text.encode())
            writer.flush(to_disk=True)


def _refuse(there: list[Path], *, force: bool) -> None:
    """Raise InputError where one of the paths that are there must stay."""
    for path in there:
        if path.exists() and not path.is_file():
            raise InputError(f"{path} is in the way; it must be a file, or not there")
    if there and not force:
        more = len(there) - 1
        others = f", and so {'does' if more == 1 else 'do'} {counted(more, 'other file')} of init's" if more else ""
        raise InputError(f"{there[0]} exists{others}; nothing was written; --force replaces what is there")


@contextmanager
def _folder(path: Path) -> Iterator[None]:
    """A folder, made with those above it; after an error those that were made are gone."""
    made = [each for each in (path, *path.parents) if not os.path.lexists(each)]
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot make the folder {path}: {system_reason(error)}") from error
    try:
        yield
    except BaseException:
        for each in made:
            with suppress(OSError):
                each.rmdir()
        raise


@contextmanager
def _new(path: Path) -> Iterator[None]:
    """A file that, if it was not there before, is not there after an error either."""
    there = os.path.lexists(path)
    try:
        yield
    except BaseException:
        if not there:
            path.unlink(missing_ok=True)
        raise
