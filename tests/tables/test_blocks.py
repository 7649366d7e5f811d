"""Tables read by blocks have the same answers and errors as those read line by line."""

from __future__ import annotations

import io
import json

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from hypcheck.answers import classify_table
from hypcheck.errors import HypcheckError
from hypcheck.geometry.pair import COLUMNS
from hypcheck.tables import Route, streams
from hypcheck.tables.streams import Reader, TextBlock, TextLines

GOOD = ("1.0", "2.0", "0.25", "0.5", "2.5", "-1", "1e-3")
CELLS = st.sampled_from(
    (*GOOD, "", " 2", "-0.5", "nan", "1_0", '"1"', '"1\n"', "ü", "1\r", "\x00", "\x1c", "x" * 70_000)
)


def changed(change):
    """A good row with one of its cells replaced."""
    place, cell = change
    return (*GOOD[:place], cell, *GOOD[place + 1 :])


ROWS = st.one_of(
    st.just(GOOD),
    st.just(GOOD),
    st.tuples(st.integers(0, 6), CELLS).map(changed),
    st.lists(CELLS, max_size=8).map(tuple),
)
ENDS = st.sampled_from(("\n", "\n", "\r\n", "\n\n", "\n \n", "\r"))


def outcome(folder, data, kind, mark):
    """The bytes of the answers, or the sentence."""
    source, target = folder / f"rows.{kind}", folder / f"answers.{kind}"
    source.write_bytes(data)
    try:
        classify_table(Route(str(source), kind, str(target), kind), mark=mark)
    except HypcheckError as error:
        return str(error)
    return target.read_bytes()


def both(folder, data, kind, mark):
    """The outcome by small blocks, and the outcome if no block is plain."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(streams, "BLOCK", 64)
        by_block = outcome(folder, data, kind, mark)
        patch.setattr(TextBlock, "is_plain", lambda _self, _avoiding: False)
        return by_block, outcome(folder, data, kind, mark)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("tables")


@pytest.mark.thorough
@settings(max_examples=400)
@example([(GOOD, "\n")] * 9, False)
@example([*[(GOOD, "\n")] * 5, (("1",) * 6, "\n"), *[(GOOD, "\n")] * 5], False)
@example([*[(GOOD, "\n")] * 5, (("-1",) * 7, "\n"), (("1",) * 6, "\n"), (GOOD, "")], True)
@given(st.lists(st.tuples(ROWS, ENDS), max_size=12), st.booleans())
def test_csv_read_by_blocks_has_the_answers_and_errors_of_csv_read_by_lines(folder, rows, mark):
    text = ",".join(COLUMNS) + "\n" + "".join(",".join(cells) + end for cells, end in rows)
    by_block, by_line = both(folder, text.encode(), "csv", mark)
    assert by_block == by_line


@pytest.mark.thorough
@settings(max_examples=400)
@example([(GOOD, "\n")] * 9, False)
@given(st.lists(st.tuples(ROWS, ENDS), max_size=12), st.booleans())
def test_jsonl_read_by_blocks_has_the_answers_and_errors_of_jsonl_read_by_lines(folder, rows, mark):
    objects = ("{" + ", ".join(f'"{n}": {c}' for n, c in zip(COLUMNS, cells, strict=False)) + "}" for cells, _ in rows)
    text = "".join(line + end for line, (_, end) in zip(objects, rows, strict=True))
    by_block, by_line = both(folder, text.encode(), "jsonl", mark)
    assert by_block == by_line


def test_plain_csv_lines_are_read_by_blocks_and_lines_with_other_characters_one_by_one():
    """To read by lines takes longer, and gives the same answers, so that nothing else shows it."""
    plain = ",".join(GOOD).encode() + b"\n"
    lines = TextLines(Reader(io.BytesIO(plain * 300), "it"))
    block = lines.block(0, b'"')
    assert (block.first, block.count, block.plain_lines()[299]) == (1, 300, ",".join(GOOD))
    assert lines.block(300) is None
    for other in ("ü", '"1"', "1\r2", "\x00", " 2", "\n\n", "x" * 70_000):
        text = TextLines(Reader(io.BytesIO(plain + other.encode() + b"\n"), "it"))
        assert text.block(0, b'"') is None, other
        if other != "\x00":
            assert next(text.each) == plain.decode()


def test_first_of_two_bad_csv_rows_is_reported(folder):
    bad, short = ",".join(("-1", *GOOD[1:])), ",".join(GOOD[1:])
    head, good = ",".join(COLUMNS), ",".join(GOOD)
    for quoted in ("", '"a",' * 7):
        text = "\n".join([head, good, bad, short, good, quoted])
        assert "row 2 (line 3): alpha is -1" in outcome(folder, text.encode(), "csv", mark=False)
        assert "row 3 (line 4): 6 cells" in outcome(folder, text.encode(), "csv", mark=True)
    lines_ = [json.dumps(dict(zip(COLUMNS, row, strict=True))) for row in ([1.0] * 7, [-1.0] * 7)]
    said = outcome(folder, "\n".join([*lines_, "{", ""]).encode(), "jsonl", mark=False)
    assert isinstance(said, str)
    assert "row 2 (line 2): alpha is -1" in said
