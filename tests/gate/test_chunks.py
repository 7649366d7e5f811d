"""Chunks: which cases they name, that these are new ones, and that each is found again by its id."""

from __future__ import annotations

import numpy as np
import pytest

from hypcheck import judge
from hypcheck.casebook import vectors
from hypcheck.casebook.families import FAMILIES, row_of
from hypcheck.gate import chunks
from hypcheck.gate.chunks import OCTAVES_OF, SIZE, Chunk, cases, first_unfrozen, found_by_search
from hypcheck.pairs import Pair
from hypcheck.truth import batch


@pytest.mark.parametrize("name", FAMILIES)
def test_generated_rows_begin_where_the_frozen_ones_end(name):
    family = FAMILIES[name]
    frozen = {row.tobytes() for row in vectors.frozen_rows(name).rows}
    assert first_unfrozen(family, 2) == 0
    start = first_unfrozen(family, 1)
    rows = family.rows(1, start + 1)
    assert start >= 60
    assert [row.tobytes() in frozen for row in rows] == [True] * start + [False]


def test_the_chunks_of_a_family_are_all_of_its_cases_once():
    family = FAMILIES["tower-body"]
    frozen, *generated = chunks.chunks(family, 1, 2 * SIZE)
    start = first_unfrozen(family, 1)
    assert (frozen.seed, len(frozen)) == (None, 120)
    assert [(each.start, each.stop) for each in generated] == [
        (start, SIZE),
        (SIZE, 2 * SIZE),
        (2 * SIZE, 2 * SIZE + start),
    ]
    assert [each.measured for each in (frozen, *generated)] == [120, OCTAVES_OF - 120, 0, 0]
    assert [len(each) for each in chunks.chunks(family, 1, 0)] == [120]
    assert {each.family for each in found_by_search()} == {"worst-cancellation"}


@pytest.mark.parametrize("chunk", [Chunk("flight", 1, 122, 400), Chunk("ring", None, 3, 90), Chunk("axis", 7, 0, 50)])
def test_a_case_is_found_by_its_id_and_is_what_the_id_says(chunk):
    made = cases(chunk)
    assert made.positions.tolist() == batch.positions(made.rows).tolist()
    assert (made.by_column == made.rows).all()
    for index in (0, 7, len(chunk) - 1):
        name = chunk.name(index)
        assert chunk.find(name) == index
        if chunk.seed is not None:
            assert row_of(name) == Pair.from_row(made.rows[index].tolist())
    assert chunk.find(f"{chunk.family}/1/1/{chunk.stop}") is None
    assert chunk.find(f"other/1/{chunk.seed}/{chunk.start}") is None
    assert chunk.find("ring-0999") is None


def test_a_part_of_a_chunk_names_the_same_cases():
    chunk = Chunk("flight", 1, 128, 528, measured=100)
    part = chunk.between(90, 300)
    assert [part.name(i) for i in range(len(part))] == [chunk.name(90 + i) for i in range(210)]
    assert [part.place(i) for i in (0, 209)] == [chunk.place(90), chunk.place(299)]
    assert (part.measured, chunk.between(100, 101).measured, chunk.between(0, 5).measured) == (10, 0, 5)
    assert (cases(part).rows == cases(chunk).rows[90:300]).all()


@pytest.mark.parametrize("name", ["tangent", "extreme-hair", "extreme-subnormal", "small-integers", "stiff-axial"])
def test_frozen_vectors_say_how_near_they_are_to_another_position(name):
    chunk = next(iter(chunks.chunks(FAMILIES[name], 1, 0)))
    made = cases(chunk)
    some = np.arange(0, len(chunk), 3)
    assert chunks.octaves(made, some).tolist() == judge.flip_octaves(made.rows[some]).tolist()
