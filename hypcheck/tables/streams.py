"""Binary input and output with a name: whatever the system refuses becomes one sentence that says which file it was.

An output file is written beside its target and takes the target's place only when everything is in it: after an error
nothing is left behind, and what stood there before stands there still. Devices and pipes cannot be replaced and are
written as they are. A pipe closed by its reader is no error of ours: BrokenPipeError passes through.
"""

from __future__ import annotations

import os
import secrets
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import BinaryIO, TextIO

from hypcheck.errors import InputError, system_reason
from hypcheck.tables.route import STREAM


class Reader:
    """A binary input that names itself in every error."""

    def __init__(self, file: BinaryIO, name: str) -> None:
        self._file = file
        self.name = name
        self.taken = 0
        """How many bytes have been read."""

    def read(self, size: int = -1) -> bytes:
        """Up to `size` bytes, fewer at the end alone. Raises InputError."""
        with _blamed("read", self.name):
            data = self._file.read(size)
        self.taken += len(data)
        return data

    def read_at(self, offset: int, size: int) -> bytes:
        """`size` bytes from a place in a file (see `size`). Raises InputError."""
        with _blamed("read", self.name):
            self._file.seek(offset)
        return self.read(size)

    def line(self, most: int) -> bytes:
        """The next line with its end, or the first `most` bytes of it; nothing at the end. Raises InputError."""
        with _blamed("read", self.name):
            data = self._file.readline(most)
        self.taken += len(data)
        return data

    def size(self) -> int | None:
        """The length of a regular file in bytes; None for a stream."""
        with _blamed("read", self.name):
            status = os.fstat(self._file.fileno())
        return status.st_size if stat.S_ISREG(status.st_mode) else None


class Writer:
    """A binary output that names itself in every error."""

    def __init__(self, file: BinaryIO, name: str) -> None:
        self._file = file
        self.name = name

    def write(self, data: bytes) -> None:
        """Write all of `data`. Raises InputError."""
        with _blamed("write", self.name):
            self._file.write(data)

    def flush(self, *, to_disk: bool = False) -> None:
        """Hand over what is buffered, to the disk itself where asked for. Raises InputError."""
        with _blamed("write", self.name):
            self._file.flush()
            if to_disk:
                os.fsync(self._file.fileno())


@contextmanager
def reading(path: str) -> Iterator[Reader]:
    """The file at `path`, or standard input for "-". Raises InputError where it cannot be opened."""
    if path == STREAM:
        yield Reader(_binary(sys.stdin, "standard input"), "standard input")
        return
    with _blamed("read", path):
        file = open(path, "rb")  # noqa: SIM115 - opening alone is blamed on the path, not what the caller does with it
    with file:
        yield Reader(file, path)


@contextmanager
def writing(path: str, *, follow: bool = True) -> Iterator[Writer]:
    """A new file that takes the place of `path` when the block ends well; standard output for "-".

    Raises InputError where it cannot be written. A link is followed, and a device or pipe written as it is, unless
    `follow` is false: such a name is ours and not the user's, and the new file takes its place. An existing file's mode
    is kept.
    """
    if path == STREAM:
        writer = Writer(_binary(sys.stdout, "standard output"), "standard output")
        yield writer
        writer.flush()
        return
    with _blamed("write", path):
        mode = _mode(path) if follow else _mode_to_replace(path)
    if mode is not None and not stat.S_ISREG(mode):
        with _blamed("write", path):
            device = open(path, "wb")  # noqa: SIM115 - as above
        with device:
            writer = Writer(device, path)
            yield writer
            writer.flush()
        return
    with _replacing(path, os.path.realpath(path) if follow else path, mode) as writer:
        yield writer


def same_file(first: str, second: str) -> bool:
    """Whether two paths lead to one existing regular file."""
    try:
        return os.path.isfile(first) and os.path.samefile(first, second)
    except (OSError, ValueError):  # what is wrong with the name is said where it is opened
        return False


def _binary(stream: TextIO | None, name: str) -> BinaryIO:
    if stream is None:  # as Python has it where the descriptor is closed
        raise InputError(f"{name} is closed")
    return stream.buffer


@contextmanager
def _replacing(path: str, target: str, mode: int | None) -> Iterator[Writer]:
    beside = os.path.join(os.path.dirname(target), f".hypcheck-{secrets.token_hex(8)}")
    with _blamed("write", path):
        handle = os.open(beside, os.O_CREAT | os.O_EXCL | os.O_WRONLY | getattr(os, "O_BINARY", 0), 0o666)
    try:
        with os.fdopen(handle, "wb") as file:
            writer = Writer(file, path)
            yield writer
            writer.flush(to_disk=True)
        with _blamed("write", path):
            if mode is not None:
                os.chmod(beside, stat.S_IMODE(mode))
            os.replace(beside, target)
    except BaseException:
        with suppress(OSError):
            os.unlink(beside)
        raise


def _mode(path: str) -> int | None:
    """The mode of what is at `path`, None where nothing is. Raises OSError where it may not be written."""
    try:
        mode = os.stat(path).st_mode
    except FileNotFoundError:
        return None
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(None, "it is a folder")
    if not os.access(path, os.W_OK):
        raise PermissionError(None, "permission denied")
    return mode


def _mode_to_replace(path: str) -> int | None:
    """The mode of a regular file at `path`, None where nothing is or what a new file replaces. Raises OSError."""
    try:
        linked = os.path.islink(path) or not (os.path.isfile(path) or os.path.isdir(path))
    except ValueError:  # what is wrong with the name is said where it is opened
        return None
    return None if linked else _mode(path)


@contextmanager
def _blamed(verb: str, name: str) -> Iterator[None]:
    """Turn what the system refuses into a sentence about the file `name`."""
    try:
        yield
    except BrokenPipeError:
        raise
    except OSError as error:
        reason = system_reason(error)
        raise InputError(f"cannot {verb} {name}: {reason}") from error
    except ValueError as error:  # a NUL in a path, a closed standard stream
        raise InputError(f"cannot {verb} {name}: {error}") from error
