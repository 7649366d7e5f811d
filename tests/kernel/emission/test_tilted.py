"""Kernels for a tilted mover, along one axis or along any: their answers, their text, and what is refused."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from fractions import Fraction
from functools import partial

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.errors import InputError
from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.implementations.description import Description, described_by_json, domain_of
from hypcheck.kernel.specialise.tilted import FRAME_NAMES
from hypcheck.runs import judge
from hypcheck.scene.model import FREE, Hyperboloid, Mover, MoverPart, Region, SceneModel, Span
from hypcheck.vectors import families, fixed_sizes
from tests.kernel.emission.building import (
    COMMAND,
    answers,
    answers_by_scene,
    asking,
    built,
    built_of,
    load_module,
    needs,
    skip_without,
    worst_error,
)
from tests.kernel.emission.test_conformance import gated
from tests.support.inside import EMITTED_LANGUAGES, description, emitted, plan_of, tilted_search
from tests.support.judging import wrong_cases

PITCHED = (0.3, 0.1, 1.0)
TREES = (
    Hyperboloid("oak", 0.61, 6.0, (5.0, -3.25, 0.375), Span(-0.9, 5.0)),
    Hyperboloid("elm", 0.14, 10.0, (-4.5, 2.0, 0.0)),
)


def tower(axis, question="position"):
    hyperboloid, region = Hyperboloid("tower", 2.0, 17.8), Region(z=Span(-17.8, 17.8))
    return SceneModel("a tower", question, (hyperboloid,), Mover(0.25, 0.15, axis=axis), region)


SCENES = {
    "the tower, one axis": tower(PITCHED),
    "the tower, any axis": tower(FREE),
    "two trees, one axis": SceneModel("trees", "exterior", TREES, Mover(0.3, 0.9, axis=(1.0, -2.0, 0.5))),
    "two trees, any axis": SceneModel("trees", "position", TREES, Mover(0.3, 0.9, axis=FREE)),
}
ROTORS = (MoverPart(0.1, 0.05, 0.135, 45.0), MoverPart(0.08, 0.08, 0.2, 180.0))


@pytest.mark.parametrize("language", EMITTED_LANGUAGES)
@pytest.mark.parametrize("name", ["the tower, one axis", "two trees, any axis"])
def test_a_kernel_for_a_tilted_mover_is_within_its_error_bound_and_always_answers(name, language, tmp_path):
    skip_without(language)
    plan = plan_of(SCENES[name])
    kernel = asking(built(tmp_path, SCENES[name], language), language)

    def answered(rows):
        found = kernel(rows)
        assert (found != CANNOT_SAY).all()
        return found

    worst, asked = worst_error(answered, plan, 32)
    assert asked > 100
    assert worst <= plan.bound_u


@pytest.mark.parametrize("mover", [Mover(0.25, 0.15, ROTORS, PITCHED), Mover(0.2, 0.2, ROTORS, FREE)])
@needs("c")
def test_a_kernel_for_a_tilted_mover_tests_its_parts_with_the_axis_of_the_mover(mover, tmp_path):
    """A ball has no axis of its own, but its parts may be tilted. An arm points up or down as far as it is long."""
    scene = replace(tower(PITCHED), mover=mover, region=Region(z=Span(-1.0, 2.0)))
    plan = plan_of(scene)
    assert [stages.setting.sizes[2:] for stages in plan.settings] == [(mover.b, mover.d), (0.1, 0.05), (0.08, 0.08)]
    assert all(stages.setting.axis == mover.axis for stages in plan.settings)
    for stages, arm in zip(plan.settings, (0, 0.135, 0.2), strict=True):
        low, high = stages.setting.box.z.ends
        assert -1 - arm - 1e-9 < low <= -1 - arm
        assert 2 + arm <= high < 2 + arm + 1e-9
    worst, asked = worst_error(asking(built(tmp_path, scene, "c"), "c"), plan, 64)
    assert asked > 300
    assert worst <= plan.bound_u


@pytest.mark.parametrize("question", ["exterior", "interior", "contact"])
@needs("c")
def test_a_kernel_for_a_tilted_mover_answers_each_question_within_its_error_bound(question, tmp_path):
    chosen = tower(FREE, question)
    worst, asked = worst_error(asking(built(tmp_path, chosen, "c"), "c"), plan_of(chosen), 64)
    assert asked > 100
    assert worst <= plan_of(chosen).bound_u


@needs("c")
def test_a_kernel_for_a_tilted_mover_compiled_with_fma_has_no_false_clear(tmp_path):
    """An FMA where a product is taken apart would lose its lower half; some of the answers +1 and -1 are wrong then."""
    options = ("-O3", "-march=native", "-ffp-contract=fast")
    library = built(tmp_path, tower(FREE), "c", "float64", *options)
    (setting,) = domain_of(description(plan_of(tower(FREE)), "c")["domain"]).settings
    beside = next(family for family in fixed_sizes.families_for((setting,)) if family.name.startswith("leaning-beside"))
    rows = beside.rows(0, 3000)
    truth, found = judge.exact_positions(rows), answers(library, rows)
    assert (found[found != 0] == truth[found != 0]).all()
    assert ((found == 0) & (truth != 0)).sum() < 10


@needs("c")
def test_a_kernel_for_one_axis_answers_cannot_say_for_another_axis(tmp_path):
    library = built(tmp_path, tower(PITCHED), "c")
    rows = np.array([[2.0, 17.8, 0.25, 0.15, 0.0, 0.0, 0.0, *axis] for axis in (PITCHED, (0.3, 0.1, 1.1), (0, 0, 1))])
    assert answers(library, rows).tolist() == [-1, CANNOT_SAY, CANNOT_SAY]


@pytest.mark.parametrize("language", EMITTED_LANGUAGES)
def test_a_kernel_for_any_axis_answers_cannot_say_if_the_axis_has_no_direction(language, tmp_path):
    skip_without(language)
    kernel = asking(built(tmp_path, tower(FREE), language), language)
    rows = [[2.0, 17.8, 0.25, 0.15, 2.2, 0.0, 0.0, *axis] for axis in ((0, 0, 0), (np.nan, 0, 1), (0, -np.inf, 1))]
    beside = [2.0, 17.8, 0.25, 0.15, 2.2, 0.0, 0.0]  # contact where it is upright, exterior where it lies on its side
    rows += [[*beside, 0.0, 0.0, -5e-324], [*beside, 1e308, 0.0, 0.0]]
    found = (
        kernel(np.array(rows)) if language not in {"c", "cpp", "rust"} else answers(_library(kernel), np.array(rows))
    )
    assert found.tolist() == [CANNOT_SAY, CANNOT_SAY, CANNOT_SAY, 0, 1]


@pytest.mark.parametrize("language", EMITTED_LANGUAGES)
def test_a_kernel_for_any_axis_answers_cannot_say_for_the_axis_0_even_where_the_axis_does_not_matter(
    language, tmp_path
):
    """Deep inside and far out no stage needs the axis, and the elm, far from its region, is exterior unseen."""
    skip_without(language)
    nowhere = SceneModel("an elm", "position", TREES[1:], Mover(0.3, 0.9, axis=FREE), Region(x=Span(90.0, 99.0)))
    nowhere = replace(nowhere, region=replace(nowhere.region, z=Span(-1.0, 1.0)))
    assert [stages.last for stages in plan_of(nowhere).settings] == [Position.EXTERIOR]
    places = [
        (tower(FREE), [2.0, 17.8, 0.25, 0.15], ((0.0, -1), (9.0, 1))),
        (nowhere, [0.14, 10, 0.3, 0.9], ((95, 1),)),
    ]
    for number, (scene, sizes, centres) in enumerate(places):
        folder = tmp_path / str(number)
        folder.mkdir()
        kernel = asking(built(folder, scene, language), language)
        for x, right in centres:
            axes = np.array([(0, 0, 1), (0, 0, 0), (0.0, -0.0, 0), (np.nan, 0, 1), (0, np.inf, 1), (1, 0, -np.inf)])
            rows = np.column_stack([np.tile(np.array([*sizes, x, 0, 0], float), (len(axes), 1)), axes])
            entries = [kernel]
            if language in {"c", "cpp", "rust"}:
                entries = [partial(answers, _library(kernel)), partial(answers_by_scene, _library(kernel))]
            for entry in entries:
                assert [int(entry(row[None])[0]) for row in rows] == [right, *[CANNOT_SAY] * 5]


@pytest.mark.parametrize("question", ["exterior", "interior", "contact"])
@pytest.mark.parametrize("language", EMITTED_LANGUAGES)
def test_a_kernel_of_each_question_answers_cannot_say_if_the_axis_has_no_direction(language, question, tmp_path):
    skip_without(language)
    kernel = asking(built(tmp_path, tower(FREE, question), language), language)
    ask = (lambda rows: answers(_library(kernel), rows)) if language in {"c", "cpp", "rust"} else kernel
    beside = [2.0, 17.8, 0.25, 0.15, 1.8 if question == "interior" else 2.2, 0.0, 0.0]  # contact or clear, by the axis
    rows = np.array([[*beside, *axis] for axis in ((0, 0, 0), (np.nan, 0, 1), (0, -np.inf, 1))])
    assert ask(rows).tolist() == [CANNOT_SAY] * 3


@pytest.mark.parametrize("axis", [PITCHED, FREE], ids=["one axis", "any axis"])
@pytest.mark.parametrize("question", ["position", "exterior", "interior", "contact"])
@needs("c")
def test_a_kernel_of_each_question_answers_cannot_say_if_its_last_stage_does_not_decide(question, axis, tmp_path):
    """2 from the last stage is an answer to no question: compared with 0, it would be exterior."""
    settled, chosen = "nearly_phi, inside);\n    return found;", tower(axis, question)
    text = emitted(plan_of(chosen), "c", COMMAND)
    assert text.count(settled) == 1
    text = text.replace(settled, "nearly_phi, inside);\n    (void)found; return CANNOT_SAY;")
    rows = np.array([[2.0, 17.8, 0.25, 0.15, 1.8 if question == "interior" else 2.2, 0.0, 0.0, *PITCHED]])
    assert asking(built_of(tmp_path, text, "c"), "c")(rows).tolist() == [CANNOT_SAY]


def _library(kernel):
    return kernel.__closure__[0].cell_contents


@pytest.fixture(scope="module")
def last_stage(tmp_path_factory):
    """The kernel's last stage in Python, for any sizes: what its other stages leave, asked of all rows."""
    kernel = load_module(built(tmp_path_factory.mktemp("tilted"), tower(FREE), "python"))

    def ask(row, *, free):
        axis = tuple(row[7:])
        search = tilted_search(tuple(row[:4]), None if free else axis)
        table = (*search.constants.values(), search.most, search.omega)
        return kernel.tilted_search_free(*row[4:7], *axis, *table) if free else kernel.tilted_search(*row[4:7], *table)

    return ask


@pytest.mark.parametrize("free", [False, True])
@pytest.mark.parametrize("name", [name for name in families.TILTED_FAMILIES if not name.startswith("extreme")])
def test_the_last_stage_for_a_tilted_mover_is_right_within_1_u_on_every_tilted_family(name, free, last_stage):
    rows = families.TILTED_FAMILIES[name].rows(11, 24)
    p, s, t = ((rows[:, [0, 1, 3]] / rows[:, [2]]) ** 2).T
    rows = rows[(abs(np.log2(p)) < 39) & (abs(np.log2(s)) < 39) & (abs(np.log2(t)) < 23)]
    truth = judge.exact_positions(rows)
    found = np.array([last_stage(row, free=free) for row in rows.tolist()], np.int8)
    asked = found != CANNOT_SAY
    assert asked.mean() > 0.9
    assert (found[found == 1] == truth[found == 1]).all()
    assert (found[found == -1] == truth[found == -1]).all()
    criterion = judge.Criterion("position", "float64", Fraction(1))
    wrong = wrong_cases(rows, truth, found, criterion)
    assert all(judge.measured(case, "position") <= criterion.unit for case in wrong)


@pytest.mark.parametrize(
    ("sizes", "place", "limits"),
    [
        ((1.0, 1.0, 1.0, 1.0), 0, (2.0**-20, 2.0**20)),
        ((1.0, 1.0, 1.0, 1.0), 1, (2.0**-20, 2.0**20)),
        ((1.0, 1.0, 1.0, 1.0), 3, (2.0**-12, 2.0**12)),
        ((2.0**-60, 2.0**-60, None, 2.0**-60), 2, (2.0**-60, 2.0**-48)),
        ((2.0**60, 2.0**60, None, 2.0**60), 2, (2.0**48, 2.0**60)),
    ],
)
def test_the_last_stage_for_a_tilted_mover_exists_up_to_its_size_limits_and_is_refused_beyond_them(
    sizes, place, limits
):
    for limit, beyond in zip(limits, (0.0, math.inf), strict=True):
        kept = tuple(limit if k == place else size for k, size in enumerate(sizes))
        assert tilted_search(kept, None).free
        with pytest.raises(OverflowError, match=r"alpha/b and gamma/b must be from 2\^-20 to 2\^20"):
            tilted_search(tuple(math.nextafter(limit, beyond) if k == place else s for k, s in enumerate(sizes)), None)


def test_the_frame_constants_of_a_tilted_kernel_make_both_matrices_diagonal():
    """Its rows make both matrices diagonal: M is the sum of their squares, D that of their squares over the poles."""
    alpha, gamma, b, d = 2.0, 17.8, 0.25, 0.15
    search = tilted_search((alpha, gamma, b, d), PITCHED)
    of = {name: sum(map(Fraction, search.constants[name])) for name in FRAME_NAMES}
    rows = [(of["r1x"], of["r1y"], 0), (of["r2x"], of["r2y"], of["r2z"]), (of["r3x"], of["r3y"], of["r3z"])]
    axis = [Fraction(part) for part in PITCHED]
    length = sum(part * part for part in axis)
    inverse_b, inverse_d = 1 / Fraction(b) ** 2, 1 / Fraction(d) ** 2
    hyperboloid = (1 / Fraction(alpha) ** 2, 1 / Fraction(alpha) ** 2, -1 / Fraction(gamma) ** 2)
    for i in range(3):
        for j in range(3):
            spheroid = (inverse_b if i == j else 0) + (inverse_d - inverse_b) * axis[i] * axis[j] / length
            squares = [row[i] * row[j] for row in rows]
            assert abs(sum(squares) - spheroid) < Fraction(1, 2**90)
            found = squares[0] / of["A1"] + squares[1] / of["A2"] - squares[2] / of["B"]
            assert abs(found - (hyperboloid[i] if i == j else 0)) < Fraction(1, 2**90)


@needs("c")
def test_a_kernel_for_a_tilted_mover_passes_the_conformance_run(tmp_path, capsys):
    for name, scene in (("fixed", tower(PITCHED)), ("free", tower(FREE))):
        folder = tmp_path / name
        folder.mkdir()
        ended, found = gated(folder, f"library:{built(folder, scene, 'c')}", 40)
        assert ended == 0, capsys.readouterr()
        assert found["worst_backward_error_u"] <= 1
        assert found["asked"] >= 160


@needs("c")
def test_a_kernel_with_the_frame_of_another_axis_fails_the_conformance_run(tmp_path):
    """The frame of another axis in the kernel of this one."""
    turned = replace(tower(PITCHED), mover=Mover(0.25, 0.15, axis=(0.1, 0.3, 1.0)))
    right, wrong = (emitted(plan_of(scene), "python", COMMAND) for scene in (tower(PITCHED), turned))

    def frame_in(text):
        start = text.index("FRAME_1 = (")
        return text[start : text.index("\n)", start)]

    (tmp_path / "kernel.py").write_text(right.replace(frame_in(right), frame_in(wrong)), encoding="utf-8")
    ended, found = gated(tmp_path, f"python:{tmp_path / 'kernel.py'}:classify", 40)
    assert ended == 1
    assert found["wrong"] > 0


@pytest.mark.parametrize("axis", [PITCHED, FREE])
def test_the_description_of_a_kernel_for_a_tilted_mover_names_its_axis(axis):
    claimed = described_by_json(json.dumps(description(plan_of(tower(axis)), "c")), Description(""))
    assert claimed.tilt
    assert [setting.axis for setting in claimed.domain.settings] == [axis]


@pytest.mark.parametrize(
    ("scene", "precision", "message"),
    [
        (
            tower(PITCHED),
            "float32",
            "no kernel is made in float32: where the mover is tilted, kernels compute in float64",
        ),
        (replace(tower(PITCHED), mover=Mover(0.25, 1e-5, axis=FREE)), "float64", "where a spheroid is tilted, alpha/b"),
    ],
)
def test_plan_of_refuses_unsupported_scenes_with_a_tilted_mover_in_one_sentence(scene, precision, message):
    with pytest.raises(InputError, match=message):
        plan_of(scene, precision)


def test_emit_with_proof_and_plan_with_measure_refuse_a_tilted_mover(tmp_path, capsys):
    path = tmp_path / "scene.toml"
    path.write_text(
        'name = "s"\n[[hyperboloid]]\nalpha = 2.0\ngamma = 9.0\n[mover]\nb = 0.25\nd = 0.15\naxis = "free"\n',
        encoding="utf-8",
    )
    kernel = tmp_path / "kernel.c"
    emit = ["emit", "--scene", str(path), "--language", "c", "--output", str(kernel)]
    assert main([*emit, "--proof", str(tmp_path / "proof.v")]) == 2
    assert "Coq has no proof" in capsys.readouterr().err
    assert not kernel.exists()
    assert main(["plan", str(path), "--measure"]) == 2
    assert "is not timed: its mover is tilted" in capsys.readouterr().err
    assert main(["plan", str(path)]) == 0
    assert "axis free" in capsys.readouterr().out
