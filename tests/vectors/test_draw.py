"""The random primitives: ranges, rounding, and no operation that differs between machines."""

from __future__ import annotations

import ast
import hashlib
import math
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from hypcheck import vectors
from hypcheck.vectors.double_roots import big_integers, big_integers_of_any_length, in_metres, roots, to_rows, triples
from hypcheck.vectors.draw import Draw, circle_at, exponent, in_turn, ldexp, stepped, to_bits, turns

N = 5000
LABELLED = {
    "cancellation",
    "cases",
    "checking",
    "families",
    "family",
    "flags",
    "format",
    "freezing",
    "frozen",
    "invalid_rows",
    "labels",
    "showing",
}
"""Modules that list families, and that label, write, read and show cases; all others generate rows."""

MODULES = [path for path in sorted(Path(vectors.__file__).parent.glob("*.py")) if path.stem not in LABELLED]
ALLOWED = {
    *(
        "empty",
        "zeros",
        "full",
        "resize",
        "tile",
        "arange",
        "stack",
        "concatenate",
        "repeat",
        "where",
        "choose",
        "select",
        "flatnonzero",
        "all",
    ),
    *(
        "array",
        "asarray",
        "ascontiguousarray",
        "inf",
        "float64",
        "int64",
        "int8",
        "sort",
        "int32",
        "uint64",
        "bool_",
        "object_",
        "nextafter",
        "dtype",
        "ndarray",
        "errstate",
        "isnan",
    ),
    *(
        "add",
        "abs",
        "minimum",
        "maximum",
        "clip",
        "sqrt",
        "rint",
        "floor",
        "ldexp",
        "frexp",
        "gcd",
        "isqrt",
        "frompyfunc",
    ),
    *("random", "ones", "frombuffer", "isfinite"),  # random.Philox, of which draw.py takes raw words alone
}
"""Shapes, choices, types, and arithmetic that is exact or rounded once."""
FORBIDDEN_METHODS = {"sum", "cumsum", "prod", "mean", "std", "dot", "random_sample", "normal", "uniform", "choice"}


def test_random_streams_differ_for_each_part_of_their_name() -> None:
    words = [Draw(*name).words(4).tolist() for name in (("a", 1, 2), ("a", 1, 3), ("a", 2, 2), ("b", 1, 2), ("a", 12))]
    assert len({tuple(w) for w in words}) == len(words)
    assert words[0] == Draw("a", 1, 2).words(4).tolist()


def test_words_of_a_random_stream_equal_the_published_philox() -> None:
    """Philox 4×64 with ten rounds, written out: the stream does not rest on numpy's promise alone."""
    key = int.from_bytes(hashlib.sha256(b"some/1/0").digest()[:16], "little")
    assert Draw("some", 1, 0).words(12).tolist() == [word for block in (1, 2, 3) for word in _philox(key, block)]


def _philox(key: int, block: int) -> list[int]:
    mask = 2**64 - 1
    k0, k1 = key & mask, key >> 64
    x0, x1, x2, x3 = block, 0, 0, 0
    for _ in range(10):
        first, second = 0xD2E7470EE14C6C93 * x0, 0xCA5A826395121157 * x2
        x0, x1, x2, x3 = (second >> 64) ^ x1 ^ k0, second & mask, (first >> 64) ^ x3 ^ k1, first & mask
        k0, k1 = (k0 + 0x9E3779B97F4A7C15) & mask, (k1 + 0xBB67AE8584CAA73B) & mask
    return [x0, x1, x2, x3]


def test_random_blocks_drawn_together_equal_blocks_drawn_separately() -> None:
    names = [("side", number) for number in range(3)]
    together, alone = Draw.of_blocks(names), [Draw(*name) for name in names]
    for share in (4, 1, 7):
        expected = [word for draw in alone for word in draw.words(share).tolist()]
        assert together.words(3 * share).tolist() == expected
    assert together.places(6).tolist() == [0, 1, 0, 1, 0, 1]
    with pytest.raises(ValueError, match="4 words cannot be shared by 3 blocks"):
        together.words(4)


def test_random_numbers_lie_in_their_ranges_and_reach_both_ends() -> None:
    draw = Draw("ranges")
    integers = draw.integers(N, -3, 4)
    assert set(integers.tolist()) == set(range(-3, 5))
    unit = draw.unit(N)
    assert 0 <= unit.min() < 0.01
    assert 0.99 < unit.max() < 1
    between = draw.between(N, -2, np.full(N, 5.0))
    assert -2 <= between.min() < -1.9
    assert 4.9 < between.max() <= 5
    mantissas = draw.mantissas(N)
    assert 1 <= mantissas.min() < 1.01
    assert 1.99 < mantissas.max() < 2
    assert set(draw.signs(N).tolist()) == {1.0, -1.0}
    assert set(exponent(draw.log_uniform(N, -4, 3)).tolist()) == set(range(-4, 3))
    lengths = {int(value).bit_length() for value in big_integers_of_any_length(draw, N, 9)}
    assert lengths == set(range(1, 10))


def test_each_exponent_and_each_integer_is_drawn_equally_often() -> None:
    draw = Draw("evenness")
    for values in (draw.integers(N, 0, 9), exponent(draw.log_uniform(N, -5, 5)) + 5):
        counts = np.bincount(values, minlength=10)
        assert abs(counts - N / 10).max() < 6 * math.sqrt(N / 10)


def test_circle_points_lie_on_the_circle_in_every_quadrant_and_on_the_axes() -> None:
    cosine, sine = Draw("circle").circle(N)
    radius = np.abs(cosine * cosine + sine * sine - 1)
    assert radius.max() < 2**-50
    quadrants = set(zip(np.sign(cosine).tolist(), np.sign(sine).tolist(), strict=True))
    assert len(quadrants) == 8
    assert 0.2 < np.mean((cosine == 0) | (sine == 0)) < 0.3
    half = np.asarray([0.0, 0.5, 1.0])
    assert [value.tolist() for value in circle_at(half)] == [[1, 0.6, 0], [0, 0.8, 1]]


def test_stepped_moves_values_by_a_number_of_ulps() -> None:
    values = np.asarray([1.0, -1.0, 3e-310, 0.0, 1e300])
    up = [math.nextafter(value, math.inf if value > 0 else -math.inf) for value in values.tolist()]
    up[3] = 0.0
    assert stepped(values, np.ones(5, dtype=np.int64)).tolist() == up
    assert stepped(stepped(values, np.full(5, 1000)), np.full(5, -1000)).tolist() == values.tolist()


def test_rounding_to_bits_is_rounding_to_nearest_even() -> None:
    values = np.concatenate([Draw("bits").log_uniform(200, -30, 30), [0.0, 1 + 2.0**-11, 1 + 3 * 2.0**-11]])
    for value, rounded in zip(values.tolist(), to_bits(values, 11).tolist(), strict=True):
        unit = Fraction(2) ** (math.frexp(value)[1] - 11)
        assert Fraction(rounded) == round(Fraction(value) / unit) * unit
    assert to_bits(values[:200], 24).tolist() == values[:200].astype(np.float32).astype(np.float64).tolist()


def test_in_turn_returns_rows_of_its_makers_in_cyclic_order() -> None:
    makers = [lambda draw, n, value=value: np.full((n, 7), value) for value in (1.0, 2.0, 3.0)]
    assert in_turn(*makers)(Draw(), 8)[:, 3].tolist() == [1, 2, 3, 1, 2, 3, 1, 2]
    assert turns(5, 7, 9).tolist() == [7, 9, 7, 9, 7]
    assert ldexp(3, np.asarray([-1, 2])).tolist() == [1.5, 12]


def test_pythagorean_triples_and_integer_roots_are_exact() -> None:
    draw = Draw("triples")
    leg, other, hypotenuse = triples(draw, 500, 9)
    assert (leg * leg + other * other == hypotenuse * hypotenuse).all()
    assert (leg > 0).all()
    assert (other > 0).all()
    assert (leg > other).any()
    assert (leg < other).any()
    big = big_integers(draw, 500, 2**30, 2**31) ** 3
    assert ((roots(big) ** 2 <= big) & (big < (roots(big) + 1) ** 2)).all()


def test_to_rows_marks_rows_that_float64_cannot_hold() -> None:
    def column(*values: int) -> np.ndarray[tuple[int], np.dtype[np.object_]]:
        return np.asarray(values, dtype=object)

    radial = [column(3, 2**53 + 1, 6, 0), column(1, 1, 4, 1), column(0, 0, 10, 1), column(0, 0, 0, 1)]
    axial = [column(1, 1, 2**60, 1), column(1, 1, 2**61, 1), column(5, 5, 0, 1)]
    rows, exact = to_rows(radial, axial)
    assert exact.tolist() == [True, False, True, False]
    assert rows[2].tolist() == [3, 1, 2, 2, 5, 0, 0]


def test_change_of_units_keeps_all_ratios_of_lengths_exactly() -> None:
    rows, _ = to_rows(
        *([big_integers(Draw(name), 300, 1, 2**40) for _ in range(k)] for name, k in (("r", 4), ("a", 3)))
    )
    moved = in_metres(Draw("metres"), rows)
    assert not np.array_equal(moved, rows)
    for before, after in zip(rows.tolist(), moved.tolist(), strict=True):
        for columns in ((0, 2), (1, 3)):
            assert Fraction(before[columns[0]]) * Fraction(after[columns[1]]) == Fraction(
                before[columns[1]]
            ) * Fraction(after[columns[0]])
        ratio = Fraction(after[0]) / Fraction(before[0])
        assert ratio.numerator & (ratio.numerator - 1) == 0
        assert {abs(value) for value in after[4:6]} == {float(abs(value) * ratio) for value in before[4:6]}
    assert 2.0**-24 < np.abs(moved).min()
    assert np.abs(moved).max() < 2.0**24


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.stem)
def test_generators_use_only_correctly_rounded_operations(path: Path) -> None:
    """No exp, log, power, hypot or sin, whose last bits differ between instruction sets; no sums of arrays."""
    assert len(MODULES) > 7
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Attribute):
            module = node.value.id if isinstance(node.value, ast.Name) else None
            generator = module in {each.stem for each in MODULES}
            allowed = node.attr in ALLOWED if module in ("np", "math") else node.attr not in FORBIDDEN_METHODS
            assert generator or allowed, ast.unparse(node)
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow):
            # A power of arrays is exact in Python integers alone, and those are raised in double_roots.py.
            assert path.stem == "double_roots" or isinstance(node.left, ast.Constant), ast.unparse(node)
        else:
            assert not isinstance(node, ast.MatMult)
