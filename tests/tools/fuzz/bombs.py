"""Inputs of an eighth of a megabyte that take very long or gigabytes unless reading is about linear."""

from __future__ import annotations

from tests.tools.fuzz import seeds

N = 1 << 17

_TOML = {
    "key of many parts": b"a" + b".a" * (N // 2) + b" = 1\n",
    "table of many parts": b"[a" + b".a" * (N // 2) + b"]\n",
    "keys of many parts on many lines": (b"a" + b".a" * 999 + b" = 1\n") * (N // 2000),
    "deep array": b"a = " + b"[" * N,
    "deep inline table": b"a = " + b"{a=" * (N // 3),
    "integer": b"seed = " + b"9" * N,
    "hexadecimal integer": b"seed = 0x" + b"f" * N,
    "integer with underscores": b"seed = " + b"1_" * (N // 2) + b"1",
    "text of escapes": b'a = "' + b"\\n" * (N // 2) + b'"',
    "long text": b"a = '''" + b"a\n" * (N // 2) + b"'''",
    "long array": b"a = [" + b"1," * (N // 2) + b"]",
    "long key": b'"' + b"a" * N + b'" = 1',
    "many tables": b"[[a]]\n" * (N // 6),
    "many keys": b"".join(b"k%d = 1\n" % number for number in range(N // 10)),
    "comments": b"#\n" * (N // 2),
    "carriage returns": b"a = 1\r" * (N // 6),
}
_JSON = {
    "deep array": b"[" * N,
    "deep object": b'{"a":' * (N // 5),
    "deep array as a value": b'{"a": ' + b"[" * N,
    "integer": b'{"a": ' + b"9" * N + b"}",
    "decimal": b'{"a": 0.' + b"0" * N + b"1}",
    "exponent": b'{"a": 1e' + b"9" * N + b"}",
    "text": b'{"a": "' + b"a" * N + b'"}',
    "text of escapes": b'{"a": "' + b"\\u0000" * (N // 6) + b'"}',
    "many keys": b"{" + b",".join(b'"k%d": 1' % number for number in range(N // 10)) + b"}",
    "one key often": b"{" + b",".join([b'"a": 1'] * (N // 7)) + b"}",
    "blank": b" " * N,
    "lines": b"\n" * N,
}
_WORDS = {
    "digits and a letter": b"9" * (N // 2 - 1) + b"x",
    "digits": b"9" * (N // 2),
    "brackets": b"[" * (N // 2),
    "stars": b"*a" * (N // 4),
    "commas": b"," * (N // 2),
    "colons": b":1" * (N // 4),
    "slashes": b"/1" * (N // 4),
    "quotes": b"'" * (N // 2 - 1),
    "backslashes": b"\\" * (N // 2 - 1),
    "escapes": b"\x1b[31m" * (N // 10),
    "a suffix of digits": b"library:a.so" + b".1" * (N // 5) + b"x",
}


def _cell(text: bytes) -> bytes:
    lines = seeds.TABLE_FILES["csv"][0].split(b"\n")
    return b"\n".join([lines[0], lines[1].replace(b"1.0", text, 1), *lines[2:]])


def _field(text: bytes) -> bytes:
    return seeds.TABLE_FILES["jsonl"][0].replace(b"1.0", text, 1)


def _certificate(text: bytes) -> bytes:
    start, _, end = seeds.proved_files()[0].partition(b'"multiplier":"')
    return start + b'"multiplier":"' + text + end[end.index(b'"') :]


def _record(text: bytes) -> bytes:
    return b'{"type": "header", "schema": "1.0.0"}\n' + text + b"\n"


def bombs() -> dict[str, tuple[str, bytes]]:
    """By what each is: the reader that is to survive it, and the bytes."""
    found = {}
    for reader in ("scene", "settings", "known-failures"):
        found |= {f"{reader}: {name}": (reader, data) for name, data in _TOML.items()}
    for reader in ("vectors", "refusals", "description", "domain", "command", "jsonl"):
        found |= {f"{reader}: {name}": (reader, data) for name, data in _JSON.items()}
    found |= {f"record: {name}": ("record", _record(data)) for name, data in _JSON.items()}
    for reader in ("number", "spec", "case"):
        found |= {f"{reader}: {name}": (reader, data) for name, data in _WORDS.items()}
    for name, data in _WORDS.items():
        found[f"csv: {name}"] = ("csv", _cell(data[:131_000]))
        found[f"jsonl: {name} as a value"] = ("jsonl", _field(data))
        found[f"proofs: {name}"] = ("proofs", _certificate(data))
        found[f"spec: python:{name}"] = ("spec", b"python:" + data)
        found[f"spec: command:{name}"] = ("spec", b"command:" + data)
        found[f"case: ring/1/1/{name}"] = ("case", b"ring/1/1/" + data)
    found["csv: many columns"] = ("csv", b",".join(b"c%d" % number for number in range(N // 7)) + b"\n")
    found["csv: long names"] = ("csv", b",".join([b"a" * 65_000, b"alph" * 16_000]) + b"\n")
    found["csv: an open quote"] = ("csv", seeds.TABLE_FILES["csv"][0] + b'"' + b"a\n" * (N // 2))
    found["npy: a header of brackets"] = (
        "npy",
        b"\x93NUMPY\x02\x00" + (N // 2).to_bytes(4, "little") + b"(" * (N // 2),
    )
    found["npy: a huge header"] = ("npy", b"\x93NUMPY\x02\x00" + b"\xff\xff\xff\xff" + b" " * 100)
    found["npy: a huge count"] = (
        "npy", seeds.TABLE_FILES["npy"][0].replace(b"(3, 7)", b"(%d, 7)" % 10**17).ljust(8192, b" ")
    )  # fmt: skip
    return found
