"""Right implementations of many kinds, which the gate must pass."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np

from hypcheck import classify
from hypcheck.geometry.pair import Pair
from hypcheck.implementations.alternatives import dual
from hypcheck.implementations.method import on_rows
from tests.support.inside import integers_position, numpy_kernel_positions
from tests.tools.mutants import exactly
from tests.tools.mutants.exactly import position
from tests.tools.mutants.expectation import EXTREME, NO_TOLERANCE, right

BOTH_REGIMES = ("--domain", '{"regimes": ["a>=1", "c2>=a"]}')
BENT = ("--domain", '{"regimes": ["c2>=a"]}')
WIDE = ("--domain", '{"regimes": ["a>=1"]}')

_buffer = np.empty(1 << 20, dtype=np.int8)
_remembered: dict[bytes, int] = {}


@right(asked=(*NO_TOLERANCE, *EXTREME))
def whole_numbers_in_all_ranges(rows):
    """The formula that the mutants are made of, at the extremes."""
    return position(rows)


@right(asked=NO_TOLERANCE)
def whole_numbers(rows):
    """The formula that the mutants are made of."""
    return position(rows)


@right(asked=NO_TOLERANCE)
def hessian_with_exact_fallback(rows):
    """The fast path: a bounded Hessian discriminant in floats, integers where it cannot tell."""
    return numpy_kernel_positions(np.ascontiguousarray(rows))


@right(asked=(*NO_TOLERANCE, *EXTREME))
def hessian_with_exact_fallback_in_all_ranges(rows):
    """The same at the extremes."""
    return numpy_kernel_positions(np.ascontiguousarray(rows))


@right(asked=NO_TOLERANCE)
def last_stage(rows):
    """The fast path's last stage for every row."""
    return [int(integers_position(Pair.from_row(row).lengths)) for row in rows.tolist()]


@right()
def dual_form_in_float64(rows):
    """The dual form in float64, which stays within a unit; at the extremes it overflows, and is rejected there."""
    return on_rows(dual("float64"))(rows)


@right(claim=("--precision", "float32"))
def dual_form_in_float32(rows):
    """The dual form in float32, which stays within two units of it."""
    return on_rows(dual("float32"))(rows)


@right(claim=("--precision", "float16"))
def dual_form_claimed_for_float16(rows):
    """The dual form in float32, claimed for float16."""
    return on_rows(dual("float32"))(rows)


@right(claim=("--question", "exterior"), asked=NO_TOLERANCE)
def exterior_as_truth_values(rows):
    """One question, answered True or False."""
    return position(rows) == 1


@right(claim=("--question", "interior"), asked=NO_TOLERANCE)
def interior_as_a_list(rows):
    """One question, answered by a list of Python's integers."""
    return [int(answer) for answer in position(rows) == -1]


@right(claim=("--question", "contact"), asked=NO_TOLERANCE)
def contact_as_uint8(rows):
    """One question, answered in uint8."""
    return (position(rows) == 0).astype(np.uint8)


@right(asked=NO_TOLERANCE)
def wide_integers(rows):
    """Answers in int64."""
    return position(rows).astype(np.int64)


@right(asked=NO_TOLERANCE)
def every_other_byte(rows):
    """Answers in a view that is not contiguous."""
    wide = np.zeros((len(rows), 2), dtype=np.int8)
    wide[:, 0] = position(rows)
    return wide[:, 0]


@right(asked=NO_TOLERANCE)
def overwrites_its_rows(rows):
    """The rows are spoilt once they are answered."""
    answers = position(rows)
    if rows.flags.writeable:
        rows[:] = np.nan
    return answers


@right(asked=NO_TOLERANCE)
def sorted_inside(rows):
    """The rows are sorted for speed, and the answers put back in order."""
    order = np.lexsort(rows.T)
    answers = np.empty(len(rows), dtype=np.int8)
    answers[order] = classify(rows[order])
    return answers


@right(asked=NO_TOLERANCE)
def other_units(rows):
    """Radial and axial lengths are taken in units of their own, which changes no answer."""
    return position(rows * np.array([8.0, 0.25, 8.0, 0.25, 8.0, 8.0, 0.25]))


@right(claim=(*BENT, "--question", "exterior"), asked=NO_TOLERANCE)
def procedure_1_mended(rows):
    """Procedure 1 with the ring, claimed where its hypothesis holds."""

    def decide(t, k1, k2, delta):
        return ((delta > 0) & exactly.all_positive(k1, k2)) | exactly.ring(t, k1, k2)

    return position(rows, decide=decide)


@right(claim=(*WIDE, "--question", "interior"), asked=NO_TOLERANCE)
def procedure_2a_mended(rows):
    """Procedure 2.a's test with c1 = 0 and c2 = 0 let in, claimed where its hypothesis holds."""
    return position(rows, decide=lambda t, k1, k2, delta: (delta > 0) & ~exactly.all_positive(k1, k2))


@right(claim=BOTH_REGIMES, asked=NO_TOLERANCE)
def both_procedures_mended(rows):
    """Signs of Δ, c1 and c2 and the ring, claimed where both hypotheses hold."""

    def decide(t, k1, k2, delta):
        positive = exactly.all_positive(k1, k2)
        return exactly.signs((delta > 0) & positive | exactly.ring(t, k1, k2), (delta > 0) & ~positive)

    return position(rows, decide=decide)


@right(claim=("--domain", '{"magnitude": [1e-6, 1000]}'), asked=NO_TOLERANCE)
def within_a_kilometre(rows):
    """Right for lengths up to 1000, as it claims, and contact elsewhere."""
    return np.where((np.abs(rows) <= 1000).all(axis=1), position(rows), 0).astype(np.int8)


@right(claim=("--domain", '{"ratio": [0.001, 1000]}'), asked=NO_TOLERANCE)
def moderate_ratios(rows):
    """Right for α/b and γ/d from 1/1000 to 1000, as it claims, and contact elsewhere."""
    ratios = rows[:, :2] / rows[:, 2:4]
    return np.where(((ratios >= 0.001) & (ratios <= 1000)).all(axis=1), position(rows), 0).astype(np.int8)


@right(claim=("--domain", '{"ratio": [1e-8, 1e8], "magnitude": [1e-6, 1e6]}'), asked=("--families", "extreme,*"))
def dual_form_within_its_ranges(rows):
    """The dual form in float64, which declares the ordinary ranges and so is asked no more of the extreme families."""
    return on_rows(dual("float64"))(rows)


@right(asked=NO_TOLERANCE)
def early_exits(rows):
    """Clear where the ball about the spheroid is clear of the narrowest, or of the widest, cylinder that it reaches."""
    alpha, gamma, b, d, x, y, z = rows.T
    r, margin = np.hypot(x, y), 1 + 1e-12
    reach = alpha * np.hypot(1, (np.abs(z) + d) / gamma)
    outside, inside = r - b > reach * margin + r * 1e-12, (r + b) * margin < alpha
    return np.where(outside, 1, np.where(inside, -1, position(rows))).astype(np.int8)


@right(asked=NO_TOLERANCE)
def answers_in_a_kept_buffer(rows):
    """Answers are written into one buffer for all questions."""
    _buffer[: len(rows)] = position(rows)
    return _buffer[: len(rows)]


@right(asked=NO_TOLERANCE)
def remembers_rows(rows):
    """Answers are kept by the whole row, −0.0 and 0 being one."""
    keys = [row.tobytes() for row in rows + 0.0]
    new = [place for place, key in enumerate(keys) if key not in _remembered]
    _remembered.update((keys[place], answer) for place, answer in zip(new, position(rows[new]).tolist(), strict=True))
    return [_remembered[key] for key in keys]


@right(asked=NO_TOLERANCE)
def shared_by_threads(rows):
    """Four threads answer a quarter each."""
    with ThreadPoolExecutor(4) as pool:
        return np.concatenate(list(pool.map(position, np.array_split(rows, 4))))


@right(asked=NO_TOLERANCE)
def one_at_a_time(rows):
    """A tuple of Python's integers, each of a row that is looked at alone."""
    return tuple(int(classify(rows[place : place + 1])[0]) for place in range(len(rows)))


@right()
def contact_of_either_of_two(rows):
    """Contact where a spheroid grown by two units of rounding touches, or one shrunk by them does not clear."""
    grown, shrunk = np.array(rows), np.array(rows)
    grown[:, 2:4] *= 1 + 2.0**-52
    shrunk[:, 2:4] *= 1 - 2.0**-52
    first, second = position(grown), position(shrunk)
    return np.where(first == second, first, 0).astype(np.int8)
