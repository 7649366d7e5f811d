"""Plans of scenes: their settings, what each leaves out, and the text and JSON about them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.derivation.float_arithmetic import FLOAT_FORMATS
from hypcheck.errors import InputError
from hypcheck.scene.model import FREE, Hyperboloid, Mover, MoverPart, Region, SceneModel, Span
from hypcheck.scene.reading import read_scene
from tests.support import inside
from tests.support.inside import (
    Thresholds,
    centres,
    decided_by,
    far_corner,
    plan_as_json,
    plan_lines,
    plan_of,
    printed_operations,
    settings_of,
)
from tests.support.scenes import scene


def test_pairs_of_the_same_sizes_share_a_setting_of_the_plan():
    tower = read_scene("tower")
    body, rotors = settings_of(tower)
    assert body.sizes == (2.0, 17.8, 0.25, 0.15)
    assert rotors.sizes == (2.0, 17.8, 0.1, 0.05)
    assert rotors.uses == tuple(f"part {number} and tower" for number in (1, 2, 3, 4))


def test_a_scene_with_a_tilted_hyperboloid_has_no_plan():
    upright = SceneModel("s", "position", (Hyperboloid("oak", 1.0, 2.0),), Mover(0.5, 0.25))
    assert len(settings_of(upright)) == 1
    with pytest.raises(InputError, match=r"the hyperboloid 'oak' has the axis \[1.0, 0.0, 0.0\], and a kernel"):
        plan_of(replace(upright, hyperboloids=(Hyperboloid("oak", 1.0, 2.0, axis=(1.0, 0.0, 0.0)),)))


@pytest.mark.parametrize("axis", [FREE, (1.0, 0.0, 2.0)])
def test_a_scene_with_a_tilted_mover_has_the_settings_of_an_upright_one_and_its_axis(axis):
    upright = SceneModel("s", "position", (Hyperboloid("oak", 1.0, 2.0),), Mover(0.5, 0.25))
    tilted = replace(upright, mover=Mover(0.5, 0.25, axis=axis))
    (setting,) = settings_of(tilted)
    assert replace(setting, axis=None) == settings_of(upright)[0]
    assert setting.axis == axis


def test_a_ball_with_a_tilted_axis_has_the_plan_of_an_upright_one():
    upright = SceneModel("s", "position", (Hyperboloid("oak", 1.0, 2.0),), Mover(0.5, 0.5))
    for axis in (FREE, (1.0, 0.0, 2.0)):
        tilted = replace(upright, mover=Mover(0.5, 0.5, axis=axis))
        assert plan_of(tilted).settings == plan_of(upright).settings


def test_the_region_of_a_setting_is_relative_to_its_hyperboloid_and_widened_by_the_arm():
    trees = (Hyperboloid("oak", 1.0, 2.0, (10.0, 0.0, 0.0)), Hyperboloid("elm", 1.0, 3.0, (-10.0, 5.0, 1.0)))
    mover = Mover(0.5, 0.5, (MoverPart(0.1, 0.1, 0.25),))
    settings = settings_of(SceneModel("s", "position", trees, mover, Region(Span(-20, 20), None, Span(0, 4))))
    oak, arm, elm, _ = settings
    assert (oak.box.x, oak.box.y, oak.box.z) == (Span(-30, 10), None, Span(0, 4))
    assert (elm.box.x, elm.box.z) == (Span(-10, 30), Span(-1, 3))
    assert arm.box.x is not None
    assert -30.25001 < arm.box.x.low < -30.25


def test_a_setting_has_a_height_limit_only_if_the_region_extends_beyond_it():
    tree = Hyperboloid("oak", 1.0, 2.0, (0.0, 0.0, 0.0), Span(-1, 3))
    for region, cut in ((Region(), Span(-1, 3)), (Region(z=Span(0, 2)), None), (Region(z=Span(0, 5)), Span(-1, 3))):
        (setting,) = settings_of(SceneModel("s", "position", (tree,), Mover(1, 1), region))
        assert setting.cut == cut
    assert settings_of(SceneModel("s", "position", (tree,), Mover(1, 1), Region(z=Span(4, 5)))) == ()


def test_a_plan_for_one_constant_height_has_only_thresholds():
    (stages,) = plan_of(scene(z=Span(0.0, 0.0))).settings
    assert isinstance(stages.last, Thresholds)
    assert (stages.lines, stages.discriminant) == ((), None)


def test_a_plan_for_exterior_or_interior_has_only_lines_of_that_side_and_lists_the_others_as_omitted():
    for question, side, other in (("exterior", 1, "interior"), ("interior", -1, "exterior")):
        (stages,) = plan_of(scene(question=question)).settings
        assert {int(line.side) for line in stages.lines} == {side}
        assert f"whatever tells {other} from contact" in {omission.what for omission in stages.omitted}


def test_a_plan_does_not_use_a_positive_discriminant_for_sizes_where_it_does_not_prove_a_clear_pair():
    (stages,) = plan_of(scene((3.0, 1.0, 1.0, 1.0))).settings
    assert stages.discriminant is not None
    assert not stages.discriminant.clear_where_positive
    assert any("Δ > 0" in omission.what for omission in stages.omitted)


def test_the_plan_of_the_tower_needs_less_than_half_the_operations_of_table_2():
    lines = list(plan_lines(plan_of(replace(read_scene("tower"), question="position"))))
    averages = [float(line.split("search; ")[1].split()[0]) for line in lines if "before a search" in line]
    assert len(averages) == 1  # the body and the rotors cost the same and are told together
    assert averages[0] < printed_operations().rounded / 2
    assert (printed_operations().additions, printed_operations().multiplications) == (9, 17)


def test_the_text_of_a_plan_lists_every_setting_and_states_shared_reasons_once():
    plan = plan_of(read_scene("forest"))
    lines = list(plan_lines(plan))
    for number, stages in enumerate(plan.settings, start=1):
        assert sum(line.startswith(f"{number}. alpha {stages.setting.sizes[0]!r}, ") for line in lines) == 1
    assert lines.count("   each leaves out") == 1  # trees at one height; of two kinds two stand at several
    assert len(lines) < 5 * len(plan.settings)


def test_shares_of_the_stages_in_a_plan_add_up_to_one():
    for precision in ("float32", "float64"):
        for setting in plan_as_json(plan_of(read_scene("tower"), precision))["settings"]:
            assert sum(setting["shares"].values()) == pytest.approx(1)


def test_emit_refuses_float32_for_python(capsys):
    assert main(["emit", "--scene", "tower", "--language", "python", "--precision", "float32"]) == 2
    assert "python has no float32" in capsys.readouterr().err


def sample(setting):
    """The sample's centres as rows."""
    return np.stack([*np.broadcast_arrays(*setting.sizes, *centres(setting))], axis=1)


def test_lines_never_decide_contact_and_the_side_of_the_centre_answers_a_one_sided_question():
    for question in ("position", "exterior", "interior"):
        (stages,) = plan_of(scene(question=question)).settings
        rows = sample(stages.setting)
        contact = (inside.positions(rows) == 0).mean()
        outside = (rows[:, 4] ** 2 + rows[:, 5] ** 2 > 4 * (1 + (rows[:, 6] / 17.8) ** 2)).mean()
        if question == "position":
            assert stages.shares["lines"] <= 1 - contact
        else:
            assert stages.shares["lines"] >= (1 - outside if question == "exterior" else outside)


@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (1.0, 0.0, 2.0)])
def test_a_plan_leaves_out_the_test_of_height_only_where_the_region_ends_before_the_hyperboloids(axis):
    for z, height, left_out in ((None, None, False), (Span(-1, 3), None, True), (Span(-1, 3), Span(0, 2), False)):
        tree = Hyperboloid("oak", 2.0, 17.8, height=height)
        some = SceneModel("s", "position", (tree,), Mover(0.25, 0.15, axis=axis), Region(z=z))
        (stages,) = plan_of(some).settings
        said = [omission.what for omission in stages.omitted]
        assert ("the test of height" in said) == left_out
        assert any(what.startswith("the discriminant") for what in said) == (stages.discriminant is None)
        assert sum(stages.shares.values()) == pytest.approx(1)


def test_a_discriminant_whose_bound_is_infinite_decides_no_centre():
    (stages,) = plan_of(scene((3.0, 1.0, 1.0, 1.0))).settings
    delta, form = stages.discriminant, FLOAT_FORMATS["float64"]
    R, zz = np.array([1.0, 9.0, 100.0]), np.array([0.5, 0.5, 0.0])
    assert decided_by(delta, form, R, zz).any()
    assert not decided_by(replace(delta, bound=np.inf), form, R, zz).any()


def test_the_far_corner_of_an_unbounded_region_is_the_requested_multiple_of_alpha_and_gamma_away():
    (setting,) = settings_of(scene((3.0, 1.0, 0.5, 0.25)))
    assert far_corner(setting, 8) == (28, 10)
    (setting,) = settings_of(scene((3.0, 1.0, 0.5, 0.25), x=Span(-40, 1), z=Span(-2, 1)))
    assert far_corner(setting, 8) == (40, 2)


def test_sample_centres_advance_by_powers_of_the_inverse_root_of_x_to_the_4_equals_x_plus_1():
    (setting,) = settings_of(scene(x=Span(0, 1), y=Span(0, 1), z=Span(0, 1)))
    root = max(each.real for each in np.roots([1, 0, 0, -1, -1]) if each.imag == 0)
    for power, column in enumerate(centres(setting), start=1):
        assert column[0] == 0.5
        assert np.diff(column) % 1 == pytest.approx(np.full(len(column) - 1, root**-power), abs=1e-11)
