"""Chunks name all cases of a family once, beginning after the frozen ones, and find each by its id."""

from __future__ import annotations

import numpy as np
import pytest

from hypcheck.runs import cases as chunks
from hypcheck.runs.cases import CHUNK_ROWS, EXPONENTS_OF, CaseChunk, cases_of_chunk, first_unfrozen, searched_chunks
from hypcheck.vectors import frozen as vectors
from hypcheck.vectors.families import FAMILIES, parse_case_id
from tests.support import inside
from tests.support.inside import flip_exponents


@pytest.mark.parametrize("name", [name for name, family in FAMILIES.items() if family.frozen])
def test_generated_rows_of_a_family_begin_after_its_frozen_rows(name):
    family = FAMILIES[name]
    frozen = {row.tobytes() for row in vectors.load(name).rows}
    assert first_unfrozen(family, 2) == 0
    start = first_unfrozen(family, 1)
    rows = family.rows(1, start + 1)
    assert start >= 60
    assert [row.tobytes() in frozen for row in rows] == [True] * start + [False]


def test_chunks_of_a_family_contain_each_of_its_cases_once():
    family = FAMILIES["tower-body"]
    frozen, *generated = chunks.family_chunks(family, 1, 2 * CHUNK_ROWS)
    start = first_unfrozen(family, 1)
    assert (frozen.seed, len(frozen)) == (None, 120)
    assert [(each.start, each.stop) for each in generated] == [
        (start, CHUNK_ROWS),
        (CHUNK_ROWS, 2 * CHUNK_ROWS),
        (2 * CHUNK_ROWS, 2 * CHUNK_ROWS + start),
    ]
    assert [each.measured for each in (frozen, *generated)] == [120, EXPONENTS_OF - 120, 0, 0]
    assert [len(each) for each in chunks.family_chunks(family, 1, 0)] == [120]
    assert {each.family for each in searched_chunks()} == {"worst-cancellation"}


@pytest.mark.parametrize(
    "chunk", [CaseChunk("flight", 1, 122, 400), CaseChunk("ring", None, 3, 90), CaseChunk("axis", 7, 0, 50)]
)
def test_case_id_leads_to_the_case_that_it_names(chunk):
    made = cases_of_chunk(chunk)
    assert made.positions.tolist() == inside.positions(made.rows).tolist()
    assert (made.by_column == made.rows).all()
    for index in (0, 7, len(chunk) - 1):
        name = chunk.name(index)
        assert chunk.find(name) == index
        if chunk.seed is not None:
            case = parse_case_id(name)
            assert case.family.row(case.seed, case.index) == tuple(made.rows[index].tolist())
    assert chunk.find(f"{chunk.family}/1/1/{chunk.stop}") is None
    assert chunk.find(f"other/1/{chunk.seed}/{chunk.start}") is None
    assert chunk.find("ring-0999") is None


def test_part_of_a_chunk_has_the_same_case_names_and_rows():
    chunk = CaseChunk("flight", 1, 128, 528, measured=100)
    part = chunk.between(90, 300)
    assert [part.name(i) for i in range(len(part))] == [chunk.name(90 + i) for i in range(210)]
    assert [part.place(i) for i in (0, 209)] == [chunk.place(90), chunk.place(299)]
    assert (part.measured, chunk.between(100, 101).measured, chunk.between(0, 5).measured) == (10, 0, 5)
    assert (cases_of_chunk(part).rows == cases_of_chunk(chunk).rows[90:300]).all()


@pytest.mark.parametrize("name", ["tangent", "extreme-hair", "extreme-subnormal", "small-integers", "stiff-axial"])
def test_stored_flip_exponents_of_frozen_vectors_equal_computed_ones(name):
    chunk = next(iter(chunks.family_chunks(FAMILIES[name], 1, 0)))
    made = cases_of_chunk(chunk)
    some = np.arange(0, len(chunk), 3)
    assert chunks.flip_exponents_of(made, some).tolist() == flip_exponents(made.rows[some]).tolist()


@pytest.mark.parametrize("name", ["ring", "tilted-uniform", "way-still", "ended-rim", "ended-way-disc", "invalid"])
def test_number_of_frozen_vectors_is_known_without_reading_them(name):
    """One name of each kind: none can be read whose number is another."""
    assert chunks.frozen_count(name) == len(vectors.load(name).cases)
