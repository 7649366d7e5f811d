"""Files by name: binary input and output, UTF-8 text by lines. Every error names the file.

An output file is written beside its target and takes the target's place when it is complete. After an error nothing is
left behind, and the target is as before. Devices and pipes cannot be replaced and are written directly. A pipe closed
by its reader is no error of hypcheck: BrokenPipeError passes through. Text is read by blocks, for speed, and errors
still name the line.
"""

from __future__ import annotations

import io
import os
import secrets
import select
import stat
import sys
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import BinaryIO, TextIO

from hypcheck.errors import InputError, system_reason
from hypcheck.tables import STREAM


class Reader:
    """A binary input that names itself in every error."""

    def __init__(self, file: BinaryIO, name: str) -> None:
        self._file = file
        self.name = name
        self.taken = 0
        """How many bytes have been read."""

    def read(self, size: int = -1) -> bytes:
        """Read the next `size` bytes, fewer only at the end. Raises InputError."""
        with _errors_name("read", self.name):
            data = self._file.read(size)
        self.taken += len(data)
        return data

    def read_at(self, offset: int, size: int) -> bytes:
        """Read `size` bytes from a place in a regular file. Raises InputError."""
        with _errors_name("read", self.name):
            self._file.seek(offset)
        return self.read(size)

    def line(self, most: int) -> bytes:
        """Read the next line with its end, or the first `most` bytes of it; b"" at the end. Raises InputError."""
        with _errors_name("read", self.name):
            data = self._file.readline(most)
        self.taken += len(data)
        return data

    def size(self) -> int | None:
        """Return the length of a regular file, or of an unpacked one, in bytes; None for a stream."""
        if isinstance(self._file, io.BytesIO):
            return self._file.getbuffer().nbytes
        with _errors_name("read", self.name):
            status = os.fstat(self._file.fileno())
        return status.st_size if stat.S_ISREG(status.st_mode) else None


class Writer:
    """A binary output that names itself in every error."""

    def __init__(self, file: BinaryIO, name: str) -> None:
        self._file = file
        self.name = name

    def write(self, data: bytes) -> None:
        """Write all of `data`. Raises InputError."""
        with _errors_name("write", self.name):
            self._file.write(data)

    def flush(self, *, to_disk: bool = False) -> None:
        """Write the buffered data; with `to_disk`, wait until they are on the disk. Raises InputError."""
        with _errors_name("write", self.name):
            self._file.flush()
            if to_disk:
                os.fsync(self._file.fileno())

    def close(self) -> None:
        """Close the file. Raises InputError."""
        with _errors_name("write", self.name):
            self._file.close()


@contextmanager
def open_input(path: str, *, patient: bool = False) -> Iterator[Reader]:
    """Open the file at `path`, or standard input for "-". Raises InputError if it cannot be opened.

    A file whose name ends in .xz is unpacked, as the frozen vectors of a wheel are. A pipe to which nothing is written
    within PIPE_S seconds is refused. With `patient` there is no such limit, since another program may take long to make
    the rows of a table.
    """
    if path == STREAM:
        yield Reader(_binary(sys.stdin, "standard input"), "standard input")
        return
    with _errors_name("read", path):
        # Only errors of opening name the path, not those of the caller's block.
        file = open(path, "rb") if patient else open(_promptly_opened(path), "rb")  # noqa: SIM115
    with file:
        yield Reader(_unpacked(file, path) if path.endswith(PACKED) else file, path)


PACKED = ".xz"
"""The end of the name of a packed file."""


UNPACKED = 64 << 20
"""The number of bytes that a packed file may hold."""


def _unpacked(file: BinaryIO, path: str) -> BinaryIO:
    """Unpack a file in memory. Raises InputError if it is damaged or too large."""
    try:
        import lzma  # noqa: PLC0415 - a part of Python that some builds of it lack, and few runs need
    except ImportError as error:
        raise InputError(f"cannot read {path}: this Python was built without lzma") from error
    unpacking = lzma.LZMADecompressor()
    try:
        data = unpacking.decompress(file.read(), UNPACKED)
    except lzma.LZMAError as error:
        raise InputError(f"cannot read {path}: {str(error).lower()}") from error
    if not unpacking.eof:
        raise InputError(f"cannot read {path}: it is cut off, or holds more than {UNPACKED >> 20} MiB")
    return io.BytesIO(data)


PIPE_S = 10
"""Seconds within which a pipe must have something to read, or its writer must have closed it."""


def _promptly_opened(path: str) -> int:
    """Open a file for reading and return its descriptor. Raises InputError for a pipe to which nothing is written."""
    if not hasattr(os, "O_NONBLOCK"):
        return os.open(path, os.O_RDONLY | getattr(os, "O_BINARY", 0))
    opened = os.open(path, os.O_RDONLY | os.O_NONBLOCK)  # to open a pipe would wait for a writer
    try:
        if stat.S_ISFIFO(os.fstat(opened).st_mode):
            _require_writer(path, opened)
        os.set_blocking(opened, True)
    except BaseException:
        os.close(opened)
        raise
    return opened


def _require_writer(path: str, opened: int) -> None:
    """Raise InputError if nothing is written to the pipe within PIPE_S seconds."""
    there = select.poll()
    there.register(opened, select.POLLIN)
    if not there.poll(PIPE_S * 1000):
        raise InputError(f"cannot read {path}: it is a pipe, and nothing was written to it within {PIPE_S} s")


def remove_file(path: Path) -> None:
    """Remove a file, if there is one. Raises InputError if the system refuses."""
    with _errors_name("remove", str(path)):
        path.unlink(missing_ok=True)


@contextmanager
def replace_output(path: str, *, follow: bool = True) -> Iterator[Writer]:
    """Open a new file that takes the place of `path` when the block ends well; standard output for "-".

    Raises InputError if it cannot be written. A link is followed, and a device or pipe written directly, unless
    `follow` is false: then the name is one that hypcheck chose, and the new file replaces what is there. The mode of an
    existing file is kept.
    """
    if path == STREAM:
        writer = Writer(_binary(sys.stdout, "standard output"), "standard output")
        yield writer
        writer.flush()
        return
    with _errors_name("write", path):
        mode = _mode(path) if follow else _mode_to_replace(path)
    if mode is not None and not stat.S_ISREG(mode):
        with _errors_name("write", path):
            device = open(path, "wb")  # noqa: SIM115 - as above
        with _closed(Writer(device, path)) as writer:
            yield writer
            writer.flush()
        return
    with _replacing(path, os.path.realpath(path) if follow else path, mode) as writer:
        yield writer


def write_files(contents: Mapping[str, bytes], *, follow: bool = True) -> None:
    """Write all of these files, by path, or none. Raises InputError if one cannot be written.

    `follow` is as for `replace_output`.
    """
    with ExitStack() as stack:
        writers = [stack.enter_context(replace_output(path, follow=follow)) for path in contents]
        for writer, content in zip(writers, contents.values(), strict=True):
            writer.write(content)
        for writer in writers:  # before the first takes its place
            writer.flush()


@contextmanager
def made_folder(path: Path) -> Iterator[None]:
    """Make the folder and those above it for a block; if the block fails, the new folders that are empty are removed.

    Raises InputError if it cannot be made.
    """
    made = [folder for folder in (path, *path.parents) if not os.path.lexists(folder)]
    try:
        path.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        reason = system_reason(error) if isinstance(error, OSError) else str(error)
        raise InputError(f"cannot make the folder {path}: {reason}") from error
    try:
        yield
    except BaseException:
        for folder in made:
            with suppress(OSError):
                folder.rmdir()
        raise


def same_file(first: str, second: str) -> bool:
    """Decide whether two paths lead to the same existing regular file."""
    try:
        return os.path.isfile(first) and os.path.samefile(first, second)
    except (OSError, ValueError):  # opening the file reports what is wrong with its name
        return False


def _binary(stream: TextIO | None, name: str) -> BinaryIO:
    """Return the binary stream below a text stream. Raises InputError if it is closed."""
    if stream is None:  # Python does this if the descriptor is closed
        raise InputError(f"{name} is closed")
    return stream.buffer


@contextmanager
def _replacing(path: str, target: str, mode: int | None) -> Iterator[Writer]:
    """Write a file beside `target`, and put it in the place of `target` when the block ends well."""
    beside = os.path.join(os.path.dirname(target), f".hypcheck-{secrets.token_hex(8)}")
    with _errors_name("write", path):
        handle = os.open(beside, os.O_CREAT | os.O_EXCL | os.O_WRONLY | getattr(os, "O_BINARY", 0), 0o666)
    try:
        with _closed(Writer(os.fdopen(handle, "wb"), path)) as writer:
            yield writer
            writer.flush(to_disk=True)
        with _errors_name("write", path):
            if mode is not None:
                os.chmod(beside, stat.S_IMODE(mode))
            os.replace(beside, target)
    except BaseException:
        with suppress(OSError):
            os.unlink(beside)
        raise


@contextmanager
def _closed(writer: Writer) -> Iterator[Writer]:
    """Close the writer when the block ends; if an error ends the block, an error of closing does not replace it."""
    try:
        yield writer
    except BaseException:
        with suppress(InputError):
            writer.close()
        raise
    writer.close()


def _mode(path: str) -> int | None:
    """Return the mode of the file at `path`, None if there is none. Raises OSError if it may not be written."""
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
    """Return the mode of a regular file at `path`, None if a link, a device or nothing is there. Raises OSError."""
    linked = os.path.islink(path) or not (os.path.isfile(path) or os.path.isdir(path))
    return None if linked else _mode(path)


@contextmanager
def _errors_name(verb: str, name: str) -> Iterator[None]:
    """Turn an error of the system into a sentence about the file `name`."""
    try:
        yield
    except BrokenPipeError:
        raise
    except OSError as error:
        reason = system_reason(error)
        raise InputError(f"cannot {verb} {name}: {reason}") from error
    except ValueError as error:  # a NUL in a path, a closed standard stream
        raise InputError(f"cannot {verb} {name}: {error}") from error


BLOCK = 1 << 20
LONGEST = 1 << 20
"""The number of bytes of a line, at most: a row of a table is shorter, and memory stays flat."""

BYTE_ORDER_MARK = "\ufeff"

_LONGEST_PLAIN = 1 << 16


@dataclass(frozen=True, slots=True)
class TextBlock:
    """Some whole lines of a text; `first` is the number of the first one."""

    first: int
    data: bytes

    @property
    def count(self) -> int:
        """The number of lines; the last of a text may have no end."""
        return self.data.count(b"\n") + (not self.data.endswith(b"\n"))

    def is_plain(self, avoiding: bytes) -> bool:
        """Decide whether every line is short, ASCII, does not begin with a blank, and has none of these bytes."""
        data = self.data
        if not data.isascii() or b"\0" in data or (avoiding and avoiding in data):
            return False
        if b"\r" in data and data.count(b"\r") != data.count(b"\r\n"):
            return False
        lines = data.removesuffix(b"\n").split(b"\n")
        return max(map(len, lines)) <= _LONGEST_PLAIN and all(line[:1] > b" " for line in lines)

    def plain_lines(self) -> list[str]:
        """Return the lines of a plain block without their ends."""
        text = self.data.decode("ascii").replace("\r\n", "\n")
        return text.removesuffix("\n").split("\n")


class TextLines:
    """The lines of a text. Read them one after the other, or where a plain block begins, the whole block."""

    def __init__(self, reader: Reader) -> None:
        self._name = reader.name
        self._blocks = _blocks(reader)
        self._ahead: TextBlock | None = None
        self._given = 0
        self.each: Iterator[str] = chain.from_iterable(self._opened())
        """The lines, each with its end (LF or CRLF); a byte order mark stays at the start of the first.

        Raises InputError, naming the line, on bytes that are not UTF-8, on NUL and on a line beyond LONGEST.
        """

    def at_block(self, taken: int) -> bool:
        """Decide whether a block begins, or the text ends, after the first `taken` lines."""
        return taken == self._given

    def block(self, taken: int, avoiding: bytes = b"") -> TextBlock | None:
        """Return the next block if it begins after `taken` lines and is plain; else None. Raises InputError."""
        if not self.at_block(taken):
            return None
        if self._ahead is None:
            self._ahead = next(self._blocks, None)
        if self._ahead is None or not self._ahead.is_plain(avoiding):
            return None
        block, self._ahead = self._ahead, None
        self._given += block.count
        return block

    def _opened(self) -> Iterator[list[str]]:
        """Yield the lines of each block that is not handed out as a whole."""
        while (block := self._ahead or next(self._blocks, None)) is not None:
            self._ahead = None
            self._given += block.count
            yield _lines(block.data, self._name, block.first)


def _blocks(reader: Reader) -> Iterator[TextBlock]:
    """Yield the text of a reader in blocks of whole lines. Raises InputError about a line that is too long."""
    number, rest = 1, b""
    while data := reader.read(BLOCK):
        data = rest + data
        cut = data.rfind(b"\n") + 1
        rest = data[cut:]
        if len(rest) > LONGEST:
            line = number + data.count(b"\n", 0, cut)
            where = f"{reader.name}, line {line}"
            raise InputError(f"{where}: longer than {LONGEST} bytes; a row, or a case, is one short line")
        if cut:
            block = TextBlock(number, data[:cut])
            number += block.count
            yield block
    if rest:
        yield TextBlock(number, rest)


def _lines(block: bytes, name: str, first: int) -> list[str]:
    """Decode a block into lines with their ends. Raises InputError about a byte that is no text."""
    try:
        text = block.decode("utf-8")
    except UnicodeDecodeError as error:
        line = first + block.count(b"\n", 0, error.start)
        byte = block[error.start]
        raise InputError(f"{name}, line {line}: byte 0x{byte:02x} is not UTF-8; it must be UTF-8 text") from None
    if "\0" in text:
        line = first + text.count("\n", 0, text.index("\0"))
        raise InputError(f"{name}, line {line}: a NUL byte; it must be UTF-8 text")
    return list(io.StringIO(text, newline="\n"))
