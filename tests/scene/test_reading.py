"""Scene files: every key is read, and everything else is refused in one sentence with key and line."""

from __future__ import annotations

import codecs
import subprocess
import sys
from math import inf

import pytest

from hypcheck.errors import InputError
from hypcheck.scene import reading
from hypcheck.scene.model import FREE, UPRIGHT, Hyperboloid, Mover, MoverPart, Region, SceneModel, Span
from hypcheck.scene.reading import parse_scene, read_scene, shipped_scenes, shipped_text

WHOLE = """\
name = "yard"
question = "exterior"

[[hyperboloid]]
name = "oak"
alpha = 0.5
gamma = 4
center = [1, -2.5, 0]
height = [-1, 6.25]
solid = true

[[hyperboloid]]
alpha = 1e-3
gamma = 2

[mover]
b = 0.25
d = 0.15

[[mover.part]]
b = 0.1
d = 0.05
arm = 0.135
angle = -45

[region]
x = [-10, 10]
z = -0.0
"""

LEAST = 'name = "a"\nhyperboloid = [{ alpha = 1, gamma = 2 }]\nmover = { b = 1, d = 1 }\n'
TILTED = (
    'name = "a"\n'
    "hyperboloid = [{ alpha = 1, gamma = 2, axis = [0, -1, 3] }, { alpha = 1, gamma = 2 }]\n"
    "mover = { b = 1, d = 1, axis = [0.5, 0, 2] }\n"
)


def refusal(text, source="s.toml"):
    with pytest.raises(InputError) as caught:
        parse_scene(text, source)
    message = str(caught.value)
    assert "\n" not in message
    assert len(message) < 300
    return message


def test_a_height_of_a_scene_may_be_infinite_but_not_if_the_scene_has_a_flight():
    def text(height):
        return WHOLE.replace("[-1, 6.25]", height)

    assert parse_scene(text("[-1, inf]")).hyperboloids[0].height == Span(-1.0, inf)
    assert parse_scene(text("[-inf, 6.25]")).hyperboloids[0].height == Span(-inf, 6.25)
    assert "it must be two numbers, finite or infinite" in refusal(text("[-1, nan]"))
    tower = shipped_text("tower").replace("height = [-17.8, 17.8]", "height = [-17.8, inf]")
    assert "[flight] is of a scene in which a height is infinite" in refusal(tower)


def test_a_scene_with_every_key_is_read():
    assert parse_scene(WHOLE) == SceneModel(
        name="yard",
        question="exterior",
        hyperboloids=(
            Hyperboloid("oak", 0.5, 4.0, (1.0, -2.5, 0.0), Span(-1.0, 6.25), solid=True),
            Hyperboloid("hyperboloid 2", 1e-3, 2.0),
        ),
        mover=Mover(0.25, 0.15, (MoverPart(0.1, 0.05, 0.135, -45.0),)),
        region=Region(x=Span(-10.0, 10.0), z=Span(0.0, 0.0)),
    )


def test_missing_keys_of_a_scene_have_their_defaults():
    scene = parse_scene(LEAST)
    assert scene == SceneModel("a", "position", (Hyperboloid("hyperboloid 1", 1.0, 2.0),), Mover(1.0, 1.0), Region())


def test_axes_of_a_scene_are_read_without_normalisation():
    scene = parse_scene(TILTED)
    assert [body.axis for body in scene.hyperboloids] == [(0.0, -1.0, 3.0), UPRIGHT]
    assert scene.mover.axis == (0.5, 0.0, 2.0)
    assert scene.tilted
    assert parse_scene(TILTED.replace("[0.5, 0, 2]", '"free"')).mover.axis == FREE


def test_a_vertical_axis_of_any_length_pointing_up_or_down_makes_no_tilted_scene():
    text = TILTED.replace("[0, -1, 3]", "[0, 0, -3]").replace("[0.5, 0, 2]", "[0, 0, 1e300]")
    assert not parse_scene(text).tilted
    parted = WHOLE.replace("d = 0.15", "d = 0.15\naxis = [0, 0, -2]")
    assert len(parse_scene(parted).mover.parts) == 1


def test_span_of_a_region_is_fixed_if_it_is_a_single_number():
    region = parse_scene(WHOLE).region
    assert region.z is not None
    assert region.z.fixed
    assert region.z.holds(0.0)
    assert not region.z.holds(1e-300)
    assert region.x is not None
    assert not region.x.fixed
    assert str(region.z.low) == "0.0"


def changed(old, new):
    assert WHOLE.count(old) == 1
    return WHOLE.replace(old, new)


def test_fault_in_one_of_many_trees_is_reported_with_the_line_of_that_tree():
    rows = [f"  {{ alpha = {n}, gamma = 9 }},  # tree {n}" for n in (1, 2, 0, 4)]
    text = 'name = "wood"\nhyperboloid = [\n' + "\n".join(rows) + "\n]\nmover = { b = 1, d = 1 }\n"
    assert "s.toml, line 5: hyperboloid 3: alpha is 0; " in refusal(text)


def test_a_part_of_a_mover_may_touch_the_surface_of_the_mover_from_within():
    text = changed("arm = 0.135", "arm = 0.15")  # 0.15 + 0.1 is 0.25 exactly, in float64 too
    assert parse_scene(text).mover.parts[0].arm == 0.15


@pytest.mark.parametrize(
    ("part", "inside"),
    [
        (MoverPart(0.5, 0.5, 0.5), True),
        (MoverPart(0.5, 0.5, 0.5000000000000001), False),
        (MoverPart(0.25, 0.75, 0.25), True),
        (MoverPart(0.25, 0.75, 0.625), False),  # tall: it comes out beside its equator
        (MoverPart(0.25, 1.0, 0.0), True),
        (MoverPart(0.25, 1.0, 1e-12), False),
    ],
)
def test_whether_a_part_lies_within_the_mover_is_decided_exactly(part, inside):
    assert reading.within(part, 1.0, 1.0) is inside
    assert reading.within(MoverPart(part.b * 4, part.d * 8, part.arm * 4), 4.0, 8.0) is inside
    worst = max((part.arm + part.b * c / 999) ** 2 + part.d**2 * (1 - (c / 999) ** 2) for c in range(1000))
    assert (worst <= 1 + 1e-12) or not inside


def test_read_scene_reads_a_file(tmp_path):
    (tmp_path / "yard.toml").write_bytes(codecs.BOM_UTF8 + WHOLE.replace("\n", "\r\n").encode())
    assert read_scene(str(tmp_path / "yard.toml")) == parse_scene(WHOLE)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "name = 'a'\nhyperboloid = [" + "{}," * 20_001 + "]",
            "line 2: the scene has 20,001 tables hyperboloid; a file may",
        ),
        (
            LEAST.replace("d = 1 }", "d = 1, part = [" + "{}," * 101 + "] }"),
            r"\[mover\] has 101 tables part; a file may have 100 at most",
        ),
        (LEAST.replace("name = ", "name = 'a" + "b" * 1000 + "' #", 1), "not empty, of at most 1,000 characters"),
    ],
    ids=["hyperboloids", "parts", "a name"],
)
def test_scene_with_more_bodies_or_parts_than_allowed_is_refused(text, message):
    with pytest.raises(InputError, match=message):
        parse_scene(text)


def test_each_shipped_scene_is_read_by_its_name_and_from_its_text():
    assert "tower" in shipped_scenes()
    for name in shipped_scenes():
        assert read_scene(name) == parse_scene(shipped_text(name))


def test_the_shipped_scene_tower_has_the_sizes_of_the_paper():
    scene = read_scene("tower")
    (tower,) = scene.hyperboloids
    assert (tower.alpha, tower.gamma, tower.height) == (2.0, 35.6 / 2, Span(-17.8, 17.8))
    assert (scene.mover.b, scene.mover.d, scene.question) == (0.25, 0.15, "interior")
    assert [(part.b, part.d) for part in scene.mover.parts] == [(0.1, 0.05)] * 4


def test_reading_a_scene_loads_no_heavy_library():
    code = (
        "import sys; from hypcheck.scene.reading import read_scene; read_scene('tower');"
        "sys.exit(bool({'numpy', 'sympy', 'mpmath', 'matplotlib', 'fcl'} & set(sys.modules)))"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
