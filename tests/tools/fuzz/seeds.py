"""Short real input for every reader, from which mutations start."""

from __future__ import annotations

import io
import json
from functools import cache

import numpy as np

from hypcheck.implementations import frames
from hypcheck.record.fields import as_json
from hypcheck.scene.reading import shipped_scenes, shipped_text
from hypcheck.tables import FORMATS as TABLES
from hypcheck.vectors import frozen
from tests.report import bench_lines, record_samples
from tests.support.records import resealed

ROWS = (
    (1.0, 2.0, 1.0, 1.0, 2.5, 0.0, -0.0),
    (2.0, 17.8, 0.25, 0.15, 0.5, -1.25, 3.0),
    (4.0, 4.0, 1e-300, 1.0, 4.0, 0.1, 1e10),
)
COLUMNS = ("alpha", "gamma", "b", "d", "x", "y", "z")
AXES = ((3.0, 4.0, 12.0), (0.0, 0.0, -1e-300), (-1.0, 0.5, 0.0))
TILTED_ROWS = tuple((*row, *axis) for row, axis in zip(ROWS, AXES, strict=True))
TILTED_COLUMNS = (*COLUMNS, "axis_x", "axis_y", "axis_z")

SEPARATOR = b"\x1e\x1e"
"""Between what an implementation says to one question and to the next."""


def case_file(name: str, wanted: int) -> bytes:
    """A shipped file of vectors with the first few of its cases alone."""
    head, cases, body = frozen.path_of(name).read_bytes().partition(b'"cases": [\n')
    lines = [line.rstrip(b",") for line in body.splitlines()[:wanted]]
    count = len(json.loads(head + cases + body)["cases"])
    return head.replace(b'"count": %d' % count, b'"count": %d' % wanted) + cases + b",\n".join(lines) + b"\n]}\n"


@cache
def case_files() -> tuple[bytes, ...]:
    return tuple(case_file(name, 2) for name in ("ring", "tangent", "uniform", "extreme-float64", "tilted-twins"))


@cache
def proved_files() -> tuple[bytes, ...]:
    return tuple(case_file(name, 1) for name in ("ring", "tangent", "small-integers", "tilted-tangent"))


@cache
def refusal_files() -> tuple[bytes, ...]:
    return case_file("invalid", 4), case_file("tilted-invalid", 4), case_file("tilted-way-invalid", 4)


@cache
def records() -> tuple[bytes, ...]:
    """Short ones: of this version, of an older one, cut off."""
    header, *lines = _lines(record_samples.text_and_record()[0])
    kept = [header, *(line for line in lines if line["type"] in ("drift", "group"))][:4]
    footer = {"type": "footer", "lines": len(kept) + 1, "exit_code": 0, "seconds": 1.5}
    older = [{**kept[0], "schema": "1.0.0"}, *kept[1:], footer]
    bare = [{"type": "header", "schema": "1.2.0"}, {"type": "footer", "lines": 2}]
    return (resealed([*kept, footer]), resealed(kept), b"".join(map(_written, older)), resealed(bare))


@cache
def report_records() -> tuple[bytes, ...]:
    """Those of which reports are made: of a whole run, of an interrupted one, of a benchmark."""
    texts = (record_samples.text_and_record()[0], record_samples.text_and_record(exit_code=None)[0])
    bench = bench_lines.bench_record()
    return (*(text.encode() for text in texts), resealed(map(as_json, [bench.header, *bench.lines])))


def _lines(text: str) -> list[dict]:
    return [{name: value for name, value in json.loads(line).items() if name != "crc32"} for line in text.splitlines()]


def _written(line: dict) -> bytes:
    return json.dumps(line).encode() + b"\n"


@cache
def scenes() -> tuple[bytes, ...]:
    return (*(shipped_text(name).encode()[:4000] for name in shipped_scenes()), SCENE, LEANING)


SCENE = b"""\
name = "two trees"
question = "exterior"
[[hyperboloid]]
name = "a"
alpha = 2.0
gamma = 17.8
center = [0, 0, 0]
height = [-17.8, 17.8]
[[hyperboloid]]
alpha = 0.5
gamma = 1e1
center = [7.0, -1, 0.5]
[mover]
b = 0.25
d = 0.15
[[mover.part]]
b = 0.1
d = 0.05
arm = 0.135
angle = 45.0
[region]
x = [-1, 1]
z = 0.0
"""

LEANING = b"""\
name = "a leaning pole"
question = "position"
[[hyperboloid]]
name = "pole"
alpha = 0.5
gamma = 10.0
center = [0, 0, 0]
axis = [0, 1, 8]
[mover]
b = 0.25
d = 0.15
axis = [1, 0, 2.5]
"""

KNOWN_FAILURES = b"""\
[[known_failure]]
case = "ring-0007"
max_u = 1e6
reason = "the ring; fixed in 2.0"

[[known_failure]]
family = "tangent"
reason = 'not explained yet'
"""

SETTINGS = b"""\
specs = ["builtin:table-2-float64", "command:./adapter --fast"]
out = "build/report"
families = ["tower-body", "forest-*"]
count = 3
seed = 7
tolerance = 16
precision = "float32"
question = "exterior"
domain = { regimes = ["c2>=a"], ratio = [1e-3, 1e3], magnitude = [1e-6, inf] }
max_abstained = 2
fail_on = "false-clear"
deterministic = true
known_failures = "known.toml"
startup_timeout = 5
timeout = 2.5
restarts = 3
memory = "512M"
"""

_DESCRIPTION = (
    b'{"protocol":1,"name":"mine","version":"1.0","language":"c","precision":"float64","question":"position",'
    b'"domain":{"regimes":["a>=1","c2>=a"],"ratio":[1e-3,1e3],"magnitude":[1e-6,1e6]},"refuses":true,"binary":false,"tilt":true}'
)
DESCRIPTIONS = (_DESCRIPTION, b'{"protocol":1,"name":"brief"}')
SETTINGS_DOMAIN = b'{"settings":[{"sizes":[2.0,17.8,0.25,0.15],"z":[-17.8,17.8]},{"sizes":[1,2,1e-3,1],"x":[0,0]}]}'
DOMAINS = (SETTINGS_DOMAIN, b'{"regimes":["a>=1","c2>=a"],"ratio":[1e-3,1e3],"magnitude":[0,1e6]}', b"{}")

COMMANDS = tuple(
    SEPARATOR.join(parts)
    for parts in (
        (DESCRIPTIONS[0] + b"\n", b"1 3\n1\n-1\n0\n", b"2 1\n 1 \r\n", b"3 1\n127\n"),
        (
            b'{"protocol":1,"name":"b","binary":true,"time":true}\n',
            b"1 3\n\x01\xff\x00",
            b"2 3\n\x02\x01\x01",
            b"3 12345 -1\n",
        ),
        (DESCRIPTIONS[1] + b"\n", b"error no such row\n", b"2 1\n1\n", b"3 1\n1\n"),
    )
)


def _frame(what: bytes, width: int, body: bytes) -> bytes:
    return frames.REPLY.pack(what, width, len(body), 0) + body


WORKERS = tuple(
    SEPARATOR.join(parts)
    for parts in (
        (
            _frame(frames.READY, 1, b"1" + DESCRIPTIONS[0].replace(b'"protocol":1,', b"")),
            _frame(frames.ANSWERS, 1, b"\x01\xff\x00"),
            _frame(frames.ANSWERS, 8, np.array([127]).tobytes()),
            _frame(frames.TIMED, 8, frames.TIMES.pack(12345, 0)),
        ),
        (
            _frame(frames.READY, 1, b"0"),
            _frame(frames.ERROR, 1, b"it raised ValueError"),
            _frame(frames.PROTOCOL, 1, b"no array"),
        ),
        (_frame(frames.ERROR, 1, b"it cannot be loaded"),),
    )
)


def _csv(columns=COLUMNS, rows=ROWS) -> bytes:
    lines = [",".join((*columns, "note")), *(",".join((*map(repr, row), '"a, b"')) for row in rows)]
    return "\n".join(lines).encode() + b"\n"


def _jsonl(columns=COLUMNS, rows=ROWS) -> bytes:
    objects = [{**dict(zip(columns, row, strict=True)), "note": 'α "'} for row in rows]
    return b"".join(json.dumps(each).encode() + b"\n" for each in objects)


def _npy(version: tuple[int, int], order: str, rows=ROWS) -> bytes:
    file = io.BytesIO()
    np.lib.format.write_array(file, np.array(rows, order=order), version=version)
    return file.getvalue()


TABLE_FILES = {
    "csv": (_csv(), _csv().replace(b"\n", b"\r\n"), b"\xef\xbb\xbf" + _csv(), _csv(TILTED_COLUMNS, TILTED_ROWS)),
    "jsonl": (_jsonl(), b"\xef\xbb\xbf" + _jsonl(), _jsonl(TILTED_COLUMNS, TILTED_ROWS)),
    "npy": (_npy((1, 0), "C"), _npy((1, 0), "F"), _npy((2, 0), "C"), _npy((1, 0), "C", TILTED_ROWS)),
}
assert set(TABLE_FILES) == set(TABLES)

NUMBERS = (b"2.5", b"-1e-3", b"0x1.8p+1", b"4G", b"512M", b" 1 ", b"1e308")
SPECS = (
    b"builtin:table-2-float64",
    b"python:package.module:function",
    b"python:dir/file.py:function",
    b"library:./libcollide.so.1",
    b'command:./adapter --fast "a b"',
    b'command:["java", "-jar", "a b.jar"]',
)
CASES = (
    b"ring-0007",
    b"invalid-0003",
    b"ring/1/42/7",
    b"razor@2.0,17.8,0.25,0.15,z=-17.8:17.8/1/1/7",
    b"tower-body/1/0/17",
    b"2,5,1,1,3,0,0",
    b"2,5,1,0.5,2.5,0,0,1,0,0x1p-3",
    b"tilted-invalid-0003",
    b"tilted-ring/1/1/7",
    b"0x1p+1,5,1,1,0x1.8p+1,-0.0,0",
    b"record.jsonl:2",
    b"tower-*,ring",
)
ARGUMENTS = (
    b"classify\n--alpha\n1\n--gamma\n2\n--b\n1\n--d\n1\n--center\n2.5\n0\n0",
    b"classify\n--alpha\n1\n--gamma\n2\n--b\n1\n--d\n1\n--center\n2.5\n0\n0\n--json",
    b"replay\n2,5,1,1,3,0,0\nbuiltin:table-2-float64\n--tolerance\n8\n--memory\n4G\n--timeout\n10\n--restarts\n2",
    b'replay\nring-0007\nbuiltin:table-2-float32\n--domain\n{"ratio":[0.1,10]}\n--question\nposition\n--startup-timeout\n3',
    b"classify\n--alpha\n1\n--gamma\n2\n--b\n1\n--d\n1\n--center\n2.5\n0\n0\n--axis\n1\n0\n-2",
    b"cases\nshow\nring-0007\n--json",
    b"cases\nshow\ntilted-twins-0003\n--json",
    b"record\ncheck\nrecord.jsonl",
)
