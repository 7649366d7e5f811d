"""What holds for every right answer, asked of every decider: one table of properties, one of deciders.

A property changes questions into others of which the answers are known from the first. Changes are exact: a question
whose numbers would be rounded is left as it is.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

import hypcheck
from hypcheck.geometry.pair import Pair
from tests.support import fractions_truth, tilted_fractions
from tests.support.corpus import Questions
from tests.support.deciders import ALL, CANNOT_SAY, DECIDERS, Decider, answers_of
from tests.support.inside import heights_position, least_position
from tests.support.strategies import rows_of

Draw = Callable[..., object]


@dataclass(frozen=True)
class Property:
    """A change of questions, and how each answer to those before it belongs to the answer to those after it.

    `change` returns the questions before and after. `needs` are groups that the questions have, `lacks` those that they
    do not have. `of_arrays` says that it is about how arrays are laid out, for deciders that take any.
    """

    name: str
    change: Callable[[Questions, Draw], tuple[Questions, Questions]]
    holds: Callable[[int, int], bool] = operator.eq
    needs: str = ""
    lacks: str = ""
    of_arrays: bool = False

    def __str__(self) -> str:
        return self.name

    def fits(self, decider: Decider, groups: str) -> bool:
        """Whether questions with these groups can be changed so, for this decider."""
        having = set(groups.split())
        fitting = set(self.needs.split()) <= having and not set(self.lacks.split()) & having
        return fitting and (decider.takes_any_array or not self.of_arrays)


def changed(change: Callable[[Questions, Draw], Questions]) -> Callable[[Questions, Draw], tuple[Questions, Questions]]:
    """Questions as they are, and after a change."""
    return lambda questions, draw: (questions, change(questions, draw))


def on_parts(questions: Questions, names: Sequence[str], change: Callable[[str, np.ndarray], np.ndarray]) -> Questions:
    """The questions with a change of these columns, where they have them."""
    parts = {name: getattr(questions, name) for name in names}
    return replace(questions, **{name: part if part is None else change(name, part) for name, part in parts.items()})


def turned(questions: Questions, matrix: Sequence[Sequence[int]]) -> Questions:
    """Centres, ends and axes multiplied by a matrix of 0, 1 and −1."""
    parts = {name: getattr(questions, name) for name in ("center", "end", "axis")}
    heights = questions.heights
    if heights is not None and matrix[2][2] < 0:
        heights = np.stack([-heights[:, 1], -heights[:, 0], heights[:, 2]], axis=1)
    return replace(
        questions,
        heights=heights,
        **{name: part if part is None else part @ np.transpose(matrix) for name, part in parts.items()},
    )


def mirrored(questions: Questions, draw: Draw) -> Questions:
    signs = draw(st.tuples(*[st.sampled_from([1.0, -1.0])] * 3))
    return turned(questions, np.diag(signs))


def spun(questions: Questions, draw: Draw) -> Questions:
    return turned(
        questions, draw(st.sampled_from([((0, -1, 0), (1, 0, 0), (0, 0, 1)), ((0, 1, 0), (1, 0, 0), (0, 0, 1))]))
    )


def multiplied(questions: Questions, radial: Fraction, axial: Fraction) -> Questions:
    """Lengths across the axis times one factor, lengths along it times another, where nothing is rounded."""
    across, along = (np.array(factors) for factors in ((1, 0, 1, 0), (0, 1, 0, 1)))
    with np.errstate(over="ignore"):
        sizes = questions.sizes * (float(radial) * across + float(axial) * along)
        factor = np.array([float(radial), float(radial), float(axial)])
        center, end = questions.center * factor, None if questions.end is None else questions.end * factor
        heights = None if questions.heights is None else questions.heights * [float(axial), float(axial), 1]
    after = replace(questions, sizes=sizes, center=center, end=end, heights=heights)
    exact = np.array(
        [
            all(
                old == new
                or (np.isfinite(new) and Fraction(new) == Fraction(old) * (radial if column in RADIAL else axial))
                for column, (old, new) in enumerate(zip(before, now, strict=True))
                if old or new
            )
            for before, now in zip(lengths_of(questions), lengths_of(after), strict=True)
        ],
        dtype=bool,
    )[:, None]
    return on_parts(
        questions, ("sizes", "center", "end", "heights"), lambda name, part: np.where(exact, getattr(after, name), part)
    )


RADIAL = {0, 2, 4, 5, 7, 8}
"""The columns of lengths across the axis: alpha, b, x, y, and x, y of the end; in their place stands `solid` twice."""


def lengths_of(questions: Questions) -> list[list[float]]:
    rows = replace(questions, axis=None, heights=None, layout=np.ascontiguousarray).rows
    return (rows if questions.heights is None else np.hstack([rows, questions.heights[:, [2, 2, 0, 1]]])).tolist()


factors = st.integers(-40, 40).map(lambda power: Fraction(2) ** power) | st.sampled_from([Fraction(3), Fraction(5, 4)])


def scaled(questions: Questions, draw: Draw) -> Questions:
    factor = draw(factors)
    return multiplied(questions, factor, factor)


def stretched(questions: Questions, draw: Draw) -> Questions:
    return multiplied(questions, draw(factors), draw(factors))


def with_axis_of_another_length(questions: Questions, draw: Draw) -> Questions:
    power, sign = draw(st.integers(-300, 300)), draw(st.sampled_from([1.0, -1.0]))
    with np.errstate(all="ignore"):
        axis = np.ldexp(questions.axis, power)
        exact = np.isfinite(axis).all(axis=1) & (np.ldexp(axis, -power) == questions.axis).all(axis=1)
    return replace(questions, axis=sign * np.where(exact[:, None], axis, questions.axis))


def upright(questions: Questions, draw: Draw) -> tuple[Questions, Questions]:
    """An axis along the hyperboloid's, and no axis."""
    length = draw(st.sampled_from([1.0, -1.0, 3.0, 5e-324, 1.7e308]))
    along = np.tile([0.0, -0.0, length], (len(questions), 1))
    return replace(questions, axis=along), replace(questions, axis=None)


def of_spheres(questions: Questions, draw: Draw) -> tuple[Questions, Questions]:
    """Spheres with an axis, and without one."""
    spheres = replace(questions, sizes=questions.sizes[:, [0, 1, 2, 2]])
    return spheres, replace(spheres, axis=None)


def backwards(questions: Questions, draw: Draw) -> Questions:
    return replace(questions, center=questions.end, end=questions.center)


def enlarged(questions: Questions, draw: Draw) -> Questions:
    """Spheroids that contain the others: neither b nor d is less."""
    more = [1 + draw(st.sampled_from([0.0, 2.0**-52, 2.0**-20, 1.0])) for _ in range(2)]
    with np.errstate(over="ignore"):
        sizes = questions.sizes * np.array([1.0, 1.0, *more])
    return replace(questions, sizes=np.where(np.isfinite(sizes), sizes, questions.sizes))


def longer(questions: Questions, draw: Draw) -> Questions:
    """Open walls that contain the others."""
    more = draw(st.sampled_from([0.0, 2.0**-40, 1.0, np.inf]))
    heights = questions.heights * [1, 1, 0]
    heights[:, 0] -= more
    heights[:, 1] += more
    return replace(questions, heights=heights)


def opened(questions: Questions, draw: Draw) -> tuple[Questions, Questions]:
    open_walls = replace(questions, heights=questions.heights * [1, 1, 0])
    return open_walls, longer(open_walls, draw)


def endless(questions: Questions, draw: Draw) -> tuple[Questions, Questions]:
    """Ends at infinity, open or solid, and no ends."""
    ends = np.tile([-np.inf, np.inf, draw(st.sampled_from([0.0, 1.0]))], (len(questions), 1))
    return replace(questions, heights=ends), replace(questions, heights=None)


def never_clear_again(before: int, after: int) -> bool:
    return before != 0 or after == 0


def not_missed_again(before: int, after: int) -> bool:
    return before != 1 or after == 1


LAYOUTS = (
    np.asfortranarray,
    lambda rows: rows.tolist(),
    lambda rows: np.repeat(rows, 2, axis=0)[::2],
    lambda rows: np.repeat(rows, 3, axis=1)[:, ::3],
    lambda rows: rows.astype(rows.dtype.newbyteorder(">")),
    lambda rows: rows[::-1].copy()[::-1],
    lambda rows: rows.astype(np.longdouble),
)
"""Arrays of the same numbers: in another order of memory, strided, of another type, or lists."""


def laid_out(questions: Questions, draw: Draw) -> Questions:
    return replace(questions, layout=draw(st.sampled_from(LAYOUTS)))


def of_whole_numbers(questions: Questions, draw: Draw) -> Questions:
    """Whole numbers as integers, wherever all are whole."""
    small = np.abs(questions.rows) < 2**30
    whole = small.all() and (questions.rows == np.rint(questions.rows)).all()
    return replace(questions, layout=lambda rows: rows.astype(np.int64)) if whole else questions


PROPERTIES = (
    Property("mirrored", changed(mirrored)),
    Property("spun about the axis", changed(spun)),
    Property("in another unit of length", changed(scaled)),
    Property("with other units across and along", changed(stretched), lacks="axis"),
    Property("with an axis of another length", changed(with_axis_of_another_length), needs="axis"),
    Property("with an upright axis", upright, needs="axis", lacks="heights"),
    Property("of spheres with an axis", of_spheres, needs="axis", lacks="heights"),
    Property("with a longer wall", opened, never_clear_again, needs="heights"),
    Property("with ends at infinity", endless, needs="heights"),
    Property("in the other direction", changed(backwards), needs="end"),
    Property("with a larger spheroid", changed(enlarged), never_clear_again, lacks="end"),
    Property("with a larger spheroid on its way", changed(enlarged), not_missed_again, needs="end"),
    Property("in another layout", changed(laid_out), of_arrays=True),
    Property("as integers", changed(of_whole_numbers), of_arrays=True),
)


EXAMPLES = 3
"""The examples of a property, each of two to six rows, of which every decider is asked."""
SLOW = 2
"""Of deciders that `make test` asks fewer frozen cases than each so many-th, the first two rows are asked."""


def asked(groups, check, fits=lambda decider: True):
    """Run a check of each decider of such rows with the same drawn questions."""
    deciders = [decider for decider in DECIDERS if decider.drawn and groups in decider.takes and fits(decider)]
    present = [decider for decider in deciders if not decider.lacks()]  # tests/test_corpus.py says which lack something

    @settings(max_examples=EXAMPLES, phases=[Phase.generate])  # to shrink a failure, all would be asked for minutes
    @given(st.data())
    def run(data):
        questions = Questions.of(data.draw(st.lists(rows_of(groups), min_size=2, max_size=6)), groups)
        check([each for each in present if each.every <= SLOW], questions, data.draw)
        check([each for each in present if each.every > SLOW], questions[:2], data.draw)

    run()


def named(*parts):
    """A row of a table of tests, with its name."""
    return pytest.param(*parts, id=": ".join(str(part) or "upright" for part in parts))


DRAWN = [groups for groups in ALL if any(decider.drawn and groups in decider.takes for decider in DECIDERS)]


@pytest.mark.parametrize(
    ("groups", "known"),
    [
        named(groups, known)
        for groups in DRAWN
        for known in PROPERTIES
        if any(decider.drawn and groups in decider.takes and known.fits(decider, groups) for decider in DECIDERS)
    ],
)
def test_answers_of_every_decider_have_every_property(groups, known):
    def check(deciders, questions, draw):
        before, after = known.change(questions, draw)
        rows = before.rows.tolist()
        for decider in deciders:
            for row, first, second in zip(rows, answers_of(decider, before), answers_of(decider, after), strict=True):
                assert CANNOT_SAY in (first, second) or known.holds(first, second), (decider.name, row)

    asked(groups, check, lambda decider: known.fits(decider, groups))


@pytest.mark.parametrize("groups", [named(groups) for groups in DRAWN])
def test_answers_of_every_decider_do_not_depend_on_order_or_batches(groups):
    def check(deciders, questions, draw):
        order = draw(st.permutations(range(len(questions))))
        cut = draw(st.integers(1, len(questions)))
        parts = [questions[part] for part in (order[:cut], order[cut:]) if part]
        for decider in deciders:
            together = answers_of(decider, questions)
            apart = [answer for part in parts for answer in answers_of(decider, part)]
            assert apart == [together[index] for index in order], decider.name

    asked(groups, check)


@pytest.mark.parametrize("groups", [named(groups) for groups in DRAWN])
def test_every_decider_answers_drawn_questions_as_decisions_in_fractions(groups):
    def check(deciders, questions, draw):
        truth = [truth_of(tuple(row), groups) for row in questions.rows.tolist()]
        for decider in deciders:
            for row, true, answer in zip(questions.rows.tolist(), truth, answers_of(decider, questions), strict=True):
                assert answer == true or (decider.abstains and answer == CANNOT_SAY), (decider.name, row)

    asked(groups, check)


def truth_of(row, groups):
    """The answer to a row, by decisions in fractions; about a way, at nine times, and then by hypcheck.passage."""
    position = tilted_fractions.exact_position if "axis" in groups else fractions_truth.exact_position
    if "heights" in groups:
        pair = Pair.from_row(row)
        found = least_position(pair)
        return int(heights_position(pair) if found is None else found)
    if "end" not in groups:
        return position(row)
    sizes, start, end, axis = row[:4], row[4:7], row[7:10], row[10:]
    for time in (Fraction(eighths, 8) for eighths in range(9)):
        place = [Fraction(a) + time * (Fraction(b) - Fraction(a)) for a, b in zip(start, end, strict=True)]
        if position((*sizes, *place, *axis)) == 0:
            return 1
    return int(hypcheck.passage(sizes, start, end, axis or None).hit)


@pytest.mark.parametrize("groups", [named(groups) for groups in DRAWN if "end" in groups])
def test_a_sweep_without_length_is_answered_as_the_position(groups):
    position = tilted_fractions.exact_position if "axis" in groups else fractions_truth.exact_position

    def check(deciders, questions, draw):
        still = replace(questions, end=questions.center)
        rows = replace(still, end=None).rows.tolist()
        truth = [int(position(row) == 0) for row in rows]
        for decider in deciders:
            for row, true, answer in zip(rows, truth, answers_of(decider, still), strict=True):
                assert answer in (true, CANNOT_SAY), (decider.name, row)

    asked(groups, check)
