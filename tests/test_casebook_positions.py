"""What the families promise, asked of the exact decision: positions, kinds, regimes and exact coincidences."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.casebook import borders, double_roots, extremes
from hypcheck.casebook.draw import Draw
from hypcheck.casebook.exactly import gather
from hypcheck.casebook.families import FAMILIES
from hypcheck.casebook.scenes import ARM, FLIGHT_STEPS
from hypcheck.pairs import Lengths, Pair, Position
from hypcheck.rows import Rows
from hypcheck.truth import batch, exact
from hypcheck.truth.kinds import Kind

COUNT = 1500
EXTERIOR, CONTACT, INTERIOR = Position
LIMITED = {
    # in contact by construction
    "tangent": {CONTACT},
    "degenerate-crossing": {CONTACT},
    "degenerate-neighbourhood": {CONTACT},
    "on-surface": {CONTACT},
    # clear by construction
    "ring": {EXTERIOR},
    "ring-neighbourhood": {EXTERIOR},
    # one side of the surface alone
    "near-tangent-outside": {EXTERIOR, CONTACT},
    "near-tangent-inside": {CONTACT, INTERIOR},
    "osculation": {EXTERIOR, CONTACT},
    "near-axis": {CONTACT, INTERIOR},
    "axis": {CONTACT, INTERIOR},
    "coefficient-zero": {CONTACT, INTERIOR},
}
"""Families that the geometry keeps from some position; all others show all three."""


def lengths_of(rows: Rows) -> list[Lengths]:
    return [Pair.from_row(row.tolist()).lengths for row in rows]


def kinds(rows: Rows) -> Counter[Kind]:
    return Counter(exact.decide(lengths).kind for lengths in lengths_of(rows))


def fractions(rows: Rows) -> list[tuple[Fraction, ...]]:
    return [tuple(map(Fraction, row)) for row in rows.tolist()]


def ratios(rows: Rows) -> list[tuple[Fraction, Fraction]]:
    """Exact a and c."""
    return [(alpha / b, gamma / d) for alpha, gamma, b, d, *_ in fractions(rows)]


@pytest.mark.parametrize("name", FAMILIES)
def test_each_position_that_the_geometry_allows_is_met(name: str) -> None:
    found = Counter(batch.positions(FAMILIES[name].rows(5, COUNT)).tolist())
    expected = LIMITED.get(name, set(Position))
    assert set(found) == {int(position) for position in expected}
    assert all(count >= 0.1 * COUNT for count in found.values()), found


def test_tangencies_are_tangent_and_of_every_kind() -> None:
    found = kinds(FAMILIES["tangent"].rows(0, 400))
    assert set(found) == {kind for kind in Kind if kind.tangent}
    assert min(found.values()) >= 40


def test_degenerate_crossings_are_of_every_kind_with_a_double_root_and_no_tangency() -> None:
    found = kinds(FAMILIES["degenerate-crossing"].rows(0, 400))
    assert set(found) == {
        Kind.CROSSING_THROAT_NODE,
        Kind.CROSSING_GROOVE_NODE,
        Kind.CROSSING_GROOVE_ISOLATED_POINT,
        Kind.CROSSING_GROOVE_CUSP,
    }
    assert min(found.values()) >= 40


def test_beside_a_degenerate_crossing_the_discriminant_has_both_signs() -> None:
    rows = FAMILIES["degenerate-neighbourhood"].rows(0, 400)
    found = kinds(rows)
    assert {Kind.CROSSING_ONE_CURVE, Kind.CROSSING_GROOVE_TWO_CURVES, Kind.CROSSING_THROAT_TWO_CURVES} <= set(found)


@pytest.mark.parametrize("construct", [double_roots.by_ratios, double_roots.by_angle])
def test_a_construction_knows_what_it_made(construct: type) -> None:
    found = construct(Draw("construction"), 600)
    usable = found.usable
    assert usable.mean() > 0.5
    for row, outer, tangent in zip(found.rows[usable], found.outer[usable], found.tangent[usable], strict=True):
        decision = exact.decide(Pair.from_row(row.tolist()).lengths)
        assert decision.tangent == tangent
        if tangent:
            assert decision.kind.limit_of is (EXTERIOR if outer else INTERIOR)
        else:
            assert (decision.kind is Kind.CROSSING_THROAT_NODE) != outer


@pytest.mark.parametrize("construct", [double_roots.by_ratios, double_roots.by_angle])
def test_the_sine_is_the_normal_s(construct: type) -> None:
    """a² cos² − c² sin² = m², with the double root m taken from the exact cubic."""
    found = construct(Draw("sine"), 300)
    for row, sine in zip(found.rows[found.usable], found.sine[found.usable].tolist(), strict=True):
        g = exact.cubic(Pair.from_row(row.tolist()).lengths)
        m = Fraction(9 * g.n3 * g.n0 - g.n1 * g.n2, 2 * (g.n2 * g.n2 - 3 * g.n3 * g.n1))
        A, B = Fraction(g.p, g.q), Fraction(g.s, g.t)
        exact_square = (A - m * m) / (A + B)
        assert abs(Fraction(sine) ** 2 - exact_square) <= exact_square * Fraction(1, 2**50)


def test_the_ring_is_clear_with_a_vanishing_discriminant() -> None:
    assert set(kinds(FAMILIES["ring"].rows(0, 600))) == {Kind.EXTERIOR_RING}


def test_the_ring_s_neighbourhood_reaches_from_1e_12_to_1e_2_radii() -> None:
    rows = FAMILIES["ring-neighbourhood"].rows(0, 2000)
    distances = []
    for alpha, gamma, b, d, x, y, z in fractions(rows):
        A, B = (alpha / b) ** 2, (gamma / d) ** 2
        on_ring = (B + 1) * (A + B) / B
        square = (x * x + y * y) / (b * b)
        radial = float((square - on_ring) / (2 * on_ring)) * float(on_ring) ** 0.5
        distances.append(max(abs(radial), abs(float(z / d))))
        assert B * B > A, "c² > a, or the root is a tangency"
    assert np.max(distances) < 0.04
    octaves = np.floor(np.log2(np.maximum(distances, 1e-13)))
    assert set(range(-38, -5)) <= set(octaves.astype(int).tolist())
    assert np.mean(rows[:, 6] == 0) > 0.5
    assert any(abs(float(a) - 8) < 1e-12 and abs(float(c) - 356 / 3) < 1e-9 for a, c in ratios(rows))


def test_forests_keep_to_the_paper_s_conditions() -> None:
    for name, wide in (("forest-type-1", True), ("forest-type-2", False)):
        rows = FAMILIES[name].rows(0, COUNT)
        for a, c in ratios(rows):
            assert c * c >= a
            assert (a >= 1) == wide
        alpha, gamma, b, d, x, y, z = np.abs(rows).T
        assert 0.2 <= b.min() <= b.max() <= 0.5, "a person is 40 cm to 1 m across"
        assert 0.6 <= d.min() <= d.max() <= 1.1, "and 1.2 m to 2.2 m tall"
        assert 0.04 <= alpha.min() <= alpha.max() <= 3, "a trunk is 10 cm to 6 m across"
        assert gamma.max() <= 15
        assert max(x.max(), y.max(), z.max()) < 50


def test_the_tower_has_the_paper_s_sizes() -> None:
    for name, sizes in (
        ("tower-body", (2, 17.8, 0.25, 0.15)),
        ("flight", (2, 17.8, 0.25, 0.15)),
        ("tower-rotors", (2, 17.8, 0.1, 0.05)),
    ):
        assert np.array_equal(np.unique(FAMILIES[name].rows(0, 100)[:, :4], axis=0), [sizes])
    box = np.abs(FAMILIES["tower-body"].rows(0, 4000)[:, 4:])
    assert (box <= [4, 4, 17.8]).all()
    assert (box.max(axis=0) > [3.98, 3.98, 17.7]).all()


def test_rotors_stand_in_a_square_about_their_body() -> None:
    quads = FAMILIES["tower-rotors"].rows(0, 400)[:, 4:].reshape(100, 4, 3)
    body = (quads[:, 0] + quads[:, 2]) / 2
    assert np.allclose((quads[:, 1] + quads[:, 3]) / 2, body, atol=1e-12)
    arms = quads - body[:, None]
    assert np.allclose(np.sqrt((arms**2).sum(axis=2)), ARM, atol=1e-12)
    assert np.allclose((arms[:, 0] * arms[:, 1]).sum(axis=1), 0, atol=1e-12)
    assert (quads[:, :, 2] == quads[:, :1, 2]).all()


def test_flights_are_coherent_and_end_within_the_tower_s_height() -> None:
    rows = FAMILIES["flight"].rows(0, 64 * FLIGHT_STEPS)
    flights = rows[:, 4:].reshape(64, FLIGHT_STEPS, 3)
    assert np.abs(flights[:, :, 2]).max() <= 17.8
    strides = np.sqrt((np.diff(flights, axis=1) ** 2).sum(axis=2))
    assert strides.max() <= 6 + 1e-9, "a refused move of 3 m and the one after it"
    vertical = (np.diff(flights[:, :, :2], axis=1) == 0).all(axis=2).mean()
    assert 0.1 < vertical < 0.4


def test_uniform_visits_the_four_regimes_evenly() -> None:
    regimes = Counter((a >= 1, c * c >= a) for a, c in ratios(FAMILIES["uniform"].rows(0, COUNT)))
    assert len(regimes) == 4
    assert min(regimes.values()) > 0.2 * COUNT


def test_near_misses_are_near() -> None:
    """A change of every length by a relative 2⁻⁸ is enough to turn each into the other position."""
    for name, clear in (("near-tangent-outside", EXTERIOR), ("near-tangent-inside", INTERIOR)):
        for lengths in lengths_of(FAMILIES[name].rows(0, 300)):
            spheroids = [
                Lengths(
                    **{
                        **{key: getattr(lengths, key) * 256 for key in Lengths.__slots__},
                        "b": lengths.b * k,
                        "d": lengths.d * k,
                    }
                )
                for k in (246, 266)
            ]
            assert [exact.position(changed) for changed in spheroids] == [clear, CONTACT]


def test_near_misses_reach_down_to_one_ulp() -> None:
    """Among the rows moved by ulps a few are tangent again when one length is moved back by one ulp."""
    steps = Counter()
    for name in ("near-tangent-outside", "near-tangent-inside"):
        for row in FAMILIES[name].rows(0, 400).tolist():
            for column in range(7):
                for toward in (np.inf, -np.inf):
                    back = [*row]
                    back[column] = float(np.nextafter(row[column], toward))
                    if back[column] and row[column] and exact.decide(Pair.from_row(back).lengths).tangent:
                        steps[name] += 1
    assert min(steps.values()) >= 3
    assert len(steps) == 2


def test_coefficients_vanish_exactly() -> None:
    for construct, vanishing in (
        (borders.second_coefficient_zero, {"n2"}),
        (borders.first_coefficient_zero, {"n1"}),
        (borders.first_coefficient_zero_for_any_waist, {"n1"}),
        (borders.both_coefficients_zero, {"n1", "n2"}),
    ):
        rows = gather(Draw("zero"), 200, construct)
        cubics = [exact.cubic(lengths) for lengths in lengths_of(rows)]
        assert all(getattr(g, name) == 0 for g in cubics for name in vanishing)
    whole = [exact.cubic(lengths) for lengths in lengths_of(FAMILIES["coefficient-zero"].rows(0, 400))]
    assert all(g.n1 == 0 or g.n2 == 0 for g in whole)


def test_interior_positions_with_a_vanishing_coefficient_and_a_waist_above_one_occur() -> None:
    """What Proposition 5 as printed leaves out: Δ > 0, a > 1, interior, c2 = 0 or c1 = 0."""
    left_out = Counter()
    rows = FAMILIES["coefficient-zero"].rows(0, 400)
    for lengths, (a, _) in zip(lengths_of(rows), ratios(rows), strict=True):
        g = exact.cubic(lengths)
        if a > 1 and exact.position(lengths) is INTERIOR:
            left_out["c2" if g.n2 == 0 else "c1"] += 1
    assert min(left_out["c1"], left_out["c2"]) > 20


def test_axis_waist_and_surface_are_met_exactly() -> None:
    assert (FAMILIES["axis"].rows(0, COUNT)[:, 4:6] == 0).all()
    assert (FAMILIES["axis"].rows(0, COUNT)[:, 6] == 0).any()
    assert (FAMILIES["waist"].rows(0, COUNT)[:, 6] == 0).all()
    for alpha, gamma, _, _, x, y, z in fractions(FAMILIES["on-surface"].rows(0, 300)):
        assert (x * x + y * y) / (alpha * alpha) - (z / gamma) ** 2 == 1


def test_borders_are_met_exactly_and_left_by_one_ulp() -> None:
    sides = {"a = 1": Counter(), "c² = a": Counter()}
    for a, c in ratios(FAMILIES["regime-borders"].rows(0, 600)):
        offset, border = min((abs(a - 1), a - 1, "a = 1"), (abs(c * c / a - 1), c * c / a - 1, "c² = a"))[1:]
        assert abs(offset) < Fraction(1, 2**50)
        sides[border][(offset > 0) - (offset < 0)] += 1
    for counts in sides.values():
        assert min(counts[-1], counts[0], counts[1]) > 60


def test_two_curve_crossings_are_common_outside_the_regimes() -> None:
    rows = FAMILIES["out-of-regime"].rows(0, 600)
    assert all(a < 1 or c * c < a for a, c in ratios(rows))
    found = kinds(rows)
    assert found[Kind.CROSSING_GROOVE_TWO_CURVES] > 60
    assert found[Kind.CROSSING_THROAT_TWO_CURVES] > 60


def test_osculations_and_throats_close_in_on_their_borders() -> None:
    for name, gap in (("osculation", lambda a, c: c * c / a - 1), ("near-axis", lambda a, c: a - 1)):
        gaps = [gap(a, c) for a, c in ratios(FAMILIES[name].rows(0, 800))]
        assert max(map(abs, gaps)) < Fraction(1, 4)
        assert sum(0 < abs(value) < Fraction(1, 2**40) for value in gaps) > 80
        assert min(sum(value > 0 for value in gaps), sum(value < 0 for value in gaps)) > 200


@pytest.mark.parametrize(
    ("name", "stiff_columns", "plain_columns"),
    [("stiff-radial", [(0, 2)], [(1, 3)]), ("stiff-axial", [(1, 3)], [(0, 2)]), ("stiff-both", [(0, 2), (1, 3)], [])],
)
def test_stiff_ratios_are_spread_over_both_sides_of_1e8(
    name: str, stiff_columns: list[tuple[int, int]], plain_columns: list[tuple[int, int]]
) -> None:
    rows = FAMILIES[name].rows(0, COUNT)
    for top, bottom in stiff_columns:
        decades = Counter(np.floor(np.log10(rows[:, top] / rows[:, bottom])).astype(int).tolist())
        assert set(decades) == set(range(3, 13))
        assert min(decades[decade] for decade in range(3, 12)) > 0.07 * COUNT
    for top, bottom in plain_columns:
        ratio = rows[:, top] / rows[:, bottom]
        assert 0.24 < ratio.min() <= ratio.max() < 65
    within = np.abs(rows[:, :4])
    assert 4e-7 < within.min() <= within.max() < 4e6


def test_giant_tiny_and_far_are_so() -> None:
    for name, low, high in (("giant-spheroids", 2.0**-17, 0.26), ("tiny-spheroids", 1000, 2.0**21)):
        rows = FAMILIES[name].rows(0, COUNT)
        for top, bottom in ((0, 2), (1, 3)):
            ratio = rows[:, top] / rows[:, bottom]
            assert low < ratio.min() <= ratio.max() < high
    _, _, b, d, x, y, z = FAMILIES["far-centers"].rows(0, COUNT).T
    far = np.sqrt(((x * x + y * y) / (b * b)) + (z / d) ** 2)
    assert far.min() > 8
    assert np.median(far) > 1e3
    assert far.max() > 1e7


def test_rows_for_short_formats_are_exact_in_them() -> None:
    for name, dtype in (("float32-exact", np.float32), ("float16-exact", np.float16)):
        rows = FAMILIES[name].rows(0, COUNT)
        assert np.array_equal(rows.astype(dtype).astype(np.float64), rows)
        nonzero = np.abs(rows[rows != 0])
        assert nonzero.min() >= np.finfo(dtype).tiny
    wide = FAMILIES["float32-exact"].rows(0, COUNT)
    assert np.mean(wide.astype(np.float16) != wide) > 0.5, "24 bits are used"


def test_images_of_one_pair_have_one_answer() -> None:
    rows = FAMILIES["symmetric-images"].rows(0, 960)
    answers = batch.positions(rows).reshape(-1, 16)
    assert (answers == answers[:, :1]).all()
    assert len(np.unique(rows[:16].view(np.uint64), axis=0)) == 16
    assert (np.signbit(rows[:, 4:]) & (rows[:, 4:] == 0)).any(), "−0.0 is among them"


TABLE_2 = (
    "A",
    "B",
    "c0",
    "P",
    "Q",
    "c1",
    "c2",
    "b²",
    "x²",
    "z²",
    "c2³",
    "c2³ c0",
    "(c2 c1)²",
    "c2 c1 c0",
    "c1³",
    "c0²",
)


def table_2(rows: Rows) -> dict[str, np.ndarray[tuple[int], np.dtype[np.floating]]]:
    """Every intermediate of the paper's Table 2 in the rows' own precision."""
    alpha, gamma, b, d, x, y, z = rows.T
    A, B = (alpha / b) * (alpha / b), (gamma / d) * (gamma / d)
    P, Q = (x * x + y * y) / (b * b), (z / d) * (z / d)
    c0 = -(A * B)
    c1, c2 = c0 + A - B + B * P - A * Q, A - B + 1 - P - Q
    cube = c2 * c2 * c2
    values = (A, B, c0, P, Q, c1, c2, b * b, x * x, z * z, cube, cube * c0, c2 * c1 * (c2 * c1), c2 * c1 * c0)
    return dict(zip(TABLE_2, (*values, c1 * c1 * c1, c0 * c0), strict=True))


@pytest.mark.parametrize(("name", "dtype"), [("float16", np.float16), ("float32", np.float32), ("float64", np.float64)])
def test_each_intermediate_of_table_2_overflows_and_underflows(name: str, dtype: type[np.floating]) -> None:
    rows = FAMILIES[f"extreme-{name}"].rows(0, 4000)
    limits = np.finfo(dtype)
    own = rows.astype(dtype)
    assert np.array_equal(own.astype(np.float64), rows)
    nonzero = np.abs(rows[rows != 0])
    assert nonzero.min() >= limits.tiny
    with np.errstate(all="ignore"):
        found = table_2(own)
        finite = {key: np.isfinite(own).all(axis=1) & ~np.isnan(value) for key, value in found.items()}
    for key, value in found.items():
        assert np.isinf(value[finite[key]]).sum() >= 20, key
        if key not in ("c2", "c2³"):  # c2 is small by cancellation alone, for it contains 1 − P − Q
            zero = {"P": own[:, 4:6], "x²": own[:, 4:5], "Q": own[:, 6:], "z²": own[:, 6:]}.get(key, own[:, :1])
            assert (np.abs(value[(zero != 0).any(axis=1)]) < limits.tiny).sum() >= 20, key


@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64])
def test_subnormal_lengths_are_subnormal_in_each_format(dtype: type[np.floating]) -> None:
    form = list(extremes.FORMATS).index(np.dtype(dtype).name)
    rows = FAMILIES["extreme-subnormal"].rows(0, 900)[form::3]
    b, d = rows[:, 2], rows[:, 3]
    limits = np.finfo(dtype)
    low = {
        name: (values >= float(limits.smallest_subnormal)) & (values < float(limits.tiny))
        for name, values in (("b", b), ("d", d))
    }
    assert (low["b"] | low["d"]).all()
    assert min(low["b"].mean(), low["d"].mean()) > 0.5
    assert (low["b"] & low["d"]).any()


def test_magnitudes_go_beyond_1e150_both_ways_in_all_combinations() -> None:
    sizes = FAMILIES["extreme-magnitude"].rows(0, 400)[:, [2, 3]]
    assert ((sizes > 1e149) | (sizes < 1e-149)).all()
    assert len(np.unique(sizes > 1, axis=0)) == 4


def test_a_hair_is_what_parts_a_row_from_tangency() -> None:
    for row in FAMILIES["extreme-hair"].rows(0, 200).tolist():
        assert not exact.decide(Pair.from_row(row).lengths).tangent
        without = [0.0 if 0 < abs(value) < 1e-59 else value for value in row]
        assert exact.decide(Pair.from_row(without).lengths).tangent
