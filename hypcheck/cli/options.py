"""What options of several commands are read as."""

from __future__ import annotations

from hypcheck.errors import InputError

_SUFFIXES = {"K": 10, "M": 20, "G": 30, "T": 40}


def bytes_of(text: str) -> int:
    """A size such as 4G, 512M or 1000000 in bytes. Raises InputError."""
    known = text[-1:].upper() in _SUFFIXES
    number, exponent = (text[:-1], _SUFFIXES[text[-1].upper()]) if known else (text, 0)
    try:
        return int(float(number) * 2**exponent)
    except (ValueError, OverflowError):
        raise InputError(f"--memory is {text!r}; it must be a size such as 512M or 4G") from None
