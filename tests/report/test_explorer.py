"""The explorer's exact answers, formulas, clearance and roots, by node; test_browser.py has its page.

HYPCHECK_EXPLORER is the number of rows; 10000 take a minute.
"""

from __future__ import annotations

import json
import math
import os
import random
import re
import shutil
import subprocess
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import hypcheck
from hypcheck.derivation.formulas import FORMULAS, REPAIRED
from hypcheck.geometry.pair import COLUMNS, Pair
from hypcheck.implementations.method import by_rows
from hypcheck.report import html, sections
from hypcheck.report.document import Code
from hypcheck.vectors import frozen
from hypcheck.vectors.families import FAMILIES
from tests.support import inside
from tests.support.inside import Kind, nearest

FEW = 400
ROWS = int(os.environ.get("HYPCHECK_EXPLORER", FEW))
ROOM = Path(html.__file__).parent
ANSWERS = Path(__file__).with_name("explorer_answers.mjs")


def everyday(draw):
    sizes = [10 ** draw.uniform(-1.5, 1.5) for _ in range(4)]
    return (*sizes, *(draw.uniform(-3, 3) * max(sizes[0], sizes[2]) for _ in range(2)), draw.uniform(-40, 40))


def extreme(draw):
    """Any exponent that float64 has, subnormal numbers and zeros included."""
    sizes = [math.ldexp(draw.uniform(0.5, 1), draw.randint(-1073, 1024)) for _ in range(4)]
    center = [draw.choice((0.0, -1, 1)) * math.ldexp(draw.uniform(0.5, 1), draw.randint(-1073, 1024)) for _ in range(3)]
    return (*sizes, *center)


def rows():
    """A quarter each: everyday numbers, extreme ones, frozen vectors, and frozen vectors with one number an ulp off."""
    draw = random.Random(20)  # noqa: S311 - any rows will do
    families = FAMILIES if ROWS > FEW else ("ring", "tangent", "osculation", "extreme-subnormal", "stiff-both")
    every = [tuple(row) for name in families for row in frozen.load(name).rows.tolist()]
    chosen = [draw.choice(every) for _ in range(ROWS // 2)]
    for place, row in enumerate(chosen[: ROWS // 4]):
        column = draw.randrange(len(COLUMNS))
        chosen[place] = tuple(math.nextafter(x, math.inf) if at == column else x for at, x in enumerate(row))
    return [*chosen, *(everyday(draw) for _ in range(ROWS // 4)), *(extreme(draw) for _ in range(ROWS // 4))]


def asked_of_node(asked, tmp_path_factory):
    """What the script finds about each row, with the row; behind its seven numbers it may have z_min, z_max, solid."""
    node = shutil.which("node")
    if node is None:
        pytest.skip("node is not installed")
    formulas = tmp_path_factory.mktemp("explorer") / "formulas.json"
    formulas.write_text(html.formulas_as_json(), encoding="utf-8")
    text = json.dumps([[NAMES.get(number, repr(number)) for number in row] for row in asked])
    scripts = [str(ROOM / "templates" / name) for name in ("explorer.js", "ends.js")]
    command = [node, str(ANSWERS), scripts[0], str(formulas), scripts[1]]
    done = subprocess.run(command, input=text, capture_output=True, check=False, text=True)
    assert done.returncode == 0, done.stderr
    return list(zip(asked, json.loads(done.stdout), strict=True))


NAMES = {math.inf: "Infinity", -math.inf: "-Infinity"}


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    return asked_of_node(rows(), tmp_path_factory)


def ended_rows():
    """Frozen vectors of upright spheroids beside hyperboloids that end, and random rows with an end within reach."""
    draw = random.Random(8)  # noqa: S311 - any rows will do
    frozen_rows = [row for name in frozen.ENDED_NAMES for row in frozen.load(name).rows.tolist()]
    upright = [(*row[:7], *row[10:]) for row in frozen_rows if row[7] == row[8] == 0 or row[2] == row[3]]
    for row in (everyday(draw) for _ in range(ROWS // 2)):
        end = row[6] + draw.uniform(-1.5, 1.5) * row[3]
        other = end - draw.choice((math.inf, row[3], 40))
        upright.append((*row, *draw.choice(((other, end), (end, end + 10 ** draw.uniform(-3, 2)))), draw.randrange(2)))
    return upright


def test_explorer_of_a_hyperboloid_with_ends_gives_the_exact_position_unless_it_gives_no_answer(tmp_path_factory):
    answered = asked_of_node(ended_rows(), tmp_path_factory)
    seen = set()
    for row, each in answered:
        position = inside.position(Pair.from_row((*row[:7], 0.0, 0.0, 1.0, *row[7:])).lengths)
        assert each["ended"] in (None, position), row
        seen.add((each["position"], each["ended"], row[9]))
    assert len({case for case in seen if case[1] is not None}) >= 12
    assert sum(each["ended"] is None for _, each in answered) <= len(answered) / 50


@pytest.mark.slow
def test_exact_answers_of_the_explorer_equal_those_of_classify(found):
    truth = hypcheck.classify([row for row, _ in found])
    wrong = [row for (row, each), position in zip(found, truth.tolist(), strict=True) if each["position"] != position]
    assert wrong == []
    assert set(truth.tolist()) == {-1, 0, 1}


def test_explorer_agrees_with_the_exact_decision_on_tangencies_and_the_ring(found):
    seen = set()
    for row, each in found:
        decision = inside.decide(Pair.from_row(row).lengths)
        assert (each["tangent"], each["ring"]) == (decision.tangent, decision.kind is Kind.EXTERIOR_RING), row
        seen.add((each["tangent"], each["ring"]))
    assert len(seen) == 3


def test_every_formula_of_the_explorer_answers_as_it_does_in_numpy(found):
    asked = np.array([row for row, _ in found])
    formulas = [each for each in (*FORMULAS.values(), *REPAIRED.values()) if each.classifies_pairs]
    columns = [by_rows(each, precision)(asked) for each in formulas for precision in ("float64", "float32")]
    answers = np.array([each["answers"] for _, each in found])
    assert answers.shape[1] == len(columns) == 18
    for place, column in enumerate(columns):
        assert np.flatnonzero(answers[:, place] != column).tolist() == [], formulas[place // 2].name


def test_bounds_of_the_squared_distance_in_the_explorer_hold_that_of_the_nearest_oracle(found):
    measured = [(row, each["gap"]) for row, each in found if each["gap"]]
    assert len(measured) >= ROWS // 16
    for row, bounds in measured:
        lower, upper = map(float, bounds)
        clearance = nearest(Pair.from_row(row)).clearance
        squared = clearance * (2 + clearance)
        slack = 1e-12 * abs(squared) if math.isfinite(squared) else 0.0
        assert lower - slack <= squared <= upper + slack or squared == lower == math.inf, row


def coefficients(row):
    """A, B, c2, c1 and c0, exact."""
    alpha, gamma, b, d, x, y, z = map(Fraction, row)
    A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / (b * b), (z / d) ** 2
    return A - B + 1 - P - Q, -A * B + A - B + B * P - A * Q, -A * B


def test_roots_shown_by_the_explorer_are_those_of_the_cubic(found):
    for row, each in found[len(found) // 2 : 3 * len(found) // 4]:
        c2, c1, c0 = coefficients(row)
        discriminant = c1 * c1 * (c2 * c2 - 4 * c1) + c0 * (c2 * (18 * c1 - 4 * c2 * c2) - 27 * c0)
        assert len(each["roots"]) == (1 if discriminant < 0 else 3), row
        wanted = np.roots([1, *map(float, (c2, c1, c0))])
        for root in map(float, each["roots"]):
            assert np.abs(wanted - root).min() <= 1e-6 * np.abs(wanted).max(), row


def test_reports_draw_only_valid_rows_of_upright_spheroids_at_rest():
    upright = sections.ON_THE_RING
    for row, drawn in ((upright, True), ((*upright, 0.0, 0.0, 1.0), False), ((math.nan, *upright[1:]), False)):
        text = html.html_text(Code("ring-0001", row))
        assert ('<svg class="bodies"' in text, 'data-row="1.0 2.0 1.0 1.0 2.5 0.0 0.0"' in text) == (drawn, drawn)


def test_small_picture_has_finite_coordinates_and_draws_thin_bodies_wide_enough_to_be_seen():
    for row in [*rows()[-100:], (1e300, 1e-300, 1e-320, 1e300, 1e308, 1e308, -1e308), (5e-324,) * 7]:
        drawn = html.small_picture(row)
        places = re.findall(r'(?:points|rx|ry)="([^"]*)"', drawn)
        assert all(math.isfinite(float(place)) for place in re.split("[ ,]", " ".join(places))), row
    thin = html.small_picture((0.052, 4.4, 0.17, 9.6, 0.03, 0.0, -10.5))
    assert 'rx="24" ry="16"' in thin
    assert 'rx="16" ry="16"' in html.small_picture(sections.ON_THE_RING)


def test_small_picture_shows_the_wall_however_far_or_small_the_spheroid_is():
    far = [(1.0, 2.0, 0.1, 0.1, 50.0, 0.0, 0.0), (9.0, 2.0, 0.1, 0.3, 0.0, 0.0, 0.0), sections.ON_THE_RING]
    tiny = [(4e-308, 3e-308, 4e-308, 1e-307, -3e-307, 0.0, 0.0), (4e-315, 4.0, 3e-315, 0.9, -1e-314, 6e-315, -6.0)]
    for row in [*far, *tiny]:
        drawn = html.small_picture(row)
        wall = re.search(r'<polyline class="wall" points="([^"]*)"', drawn)[1]
        across = [float(place.split(",")[0]) for place in wall.split(" ")]
        assert any(0 < place < html.WIDTH for place in across), row
        centre, half = (float(re.search(rf'{name}="([^"]*)"', drawn)[1]) for name in ("cx", "rx"))
        assert 0 < centre < html.WIDTH, row
        assert half >= 1.5, row
