"""Emitted kernels, built by real compilers, against exact positions: the error never exceeds the promised bound."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.implementations.description import Description, described_by_json
from hypcheck.scene.model import Hyperboloid, Mover, Region, SceneModel, Span
from hypcheck.scene.reading import read_scene
from tests.kernel.emission.building import COMMAND, answers, answers_by_scene, asking, built, needs, worst_error
from tests.support import inside
from tests.support.inside import EMITTED_LANGUAGES, description, emitted, plan_of
from tests.support.scenes import scene

TOWER = read_scene("tower")
SCENES = {
    "tower": TOWER,
    "level flight": replace(TOWER, region=Region(z=Span(3.0, 3.0))),
    "waist": scene(z=Span(0.0, 0.0)),
    "far": scene(x=Span(9.0, 12.0), z=Span(-1.0, 1.0)),
    "thin drone": scene((30.0, 70.0, 0.01, 0.005)),
    "narrow": scene((0.4, 3.0, 1.0, 1.0)),
    "steep": scene((3.0, 1.0, 1.0, 1.0)),
}


@pytest.mark.parametrize("precision", ["float64", "float32"])
@pytest.mark.parametrize("name", SCENES)
@needs("c")
def test_the_emitted_c_kernel_is_within_its_error_bound(name, precision, tmp_path):
    for question in ("position", "interior") if name != "tower" else ("position", "exterior", "interior", "contact"):
        chosen = replace(SCENES[name], question=question)
        plan = plan_of(chosen, precision)
        worst, asked = worst_error(asking(built(tmp_path, chosen, "c", precision), "c"), plan, 128)
        assert asked > 0
        assert worst <= min(8, plan.bound_u)


@needs("c")
def test_an_emitted_kernel_answers_cannot_say_beyond_the_height_and_for_other_sizes(tmp_path):
    stump = SceneModel("s", "position", (Hyperboloid("stump", 1.0, 2.0, height=Span(-1.0, 1.0)),), Mover(0.5, 0.5))
    library = built(tmp_path, stump, "c")
    rows = np.tile([1.0, 2.0, 0.5, 0.5, 1.2, 0.0, 0.0], (600, 1))
    rows[:, 6] = np.linspace(-2, 2, 600)
    beyond = np.abs(rows[:, 6]) > 1
    for found in (answers(library, rows), answers_by_scene(library, rows)):
        assert (found[beyond] == CANNOT_SAY).all()
        assert (found[~beyond] == inside.positions(rows[~beyond])).all()
    rows[:, 0] = 1.5
    assert (answers(library, rows) == CANNOT_SAY).all()
    assert (answers_by_scene(library, rows) == CANNOT_SAY).all()


@pytest.mark.parametrize("language", EMITTED_LANGUAGES)
def test_emit_gives_the_same_text_every_time_with_its_command(language):
    plan = plan_of(TOWER)
    text = emitted(plan, language, COMMAND)
    assert text == emitted(plan_of(TOWER), language, COMMAND)
    head = text[:2500]
    for word in ("cooling tower", "hypcheck emit --scene", "multiplications", "8 u", "2^-53"):
        assert word in head


def test_the_description_of_an_emitted_kernel_fits_the_protocol():
    claimed = described_by_json(json.dumps(description(plan_of(TOWER, "float32"), "rust")), Description(""))
    assert (claimed.precision, claimed.question) == ("float32", "interior")
    assert [setting.sizes for setting in claimed.domain.settings] == [(2.0, 17.8, 0.25, 0.15), (2.0, 17.8, 0.1, 0.05)]
