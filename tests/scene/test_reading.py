"""Scene files: every key is read, and everything else is refused in one sentence with key and line."""

from __future__ import annotations

import codecs
import subprocess
import sys

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
LEANING = (
    'name = "a"\n'
    "hyperboloid = [{ alpha = 1, gamma = 2, axis = [0, -1, 3] }, { alpha = 1, gamma = 2 }]\n"
    "mover = { b = 1, d = 1, axis = [0.5, 0, 2] }\n"
)
WALK = "[walk]\nstart = [0, 0, 0]\nheading = 0\nsteps = 1\nstep = 1\nlargest_turn = 1\nrefused_turn = 1\n"


def refusal(text, source="s.toml"):
    with pytest.raises(InputError) as caught:
        parse_scene(text, source)
    message = str(caught.value)
    assert "\n" not in message
    assert len(message) < 300
    return message


def test_a_scene_with_every_key_is_read():
    assert parse_scene(WHOLE) == SceneModel(
        name="yard",
        question="exterior",
        hyperboloids=(
            Hyperboloid("oak", 0.5, 4.0, (1.0, -2.5, 0.0), Span(-1.0, 6.25)),
            Hyperboloid("hyperboloid 2", 1e-3, 2.0),
        ),
        mover=Mover(0.25, 0.15, (MoverPart(0.1, 0.05, 0.135, -45.0),)),
        region=Region(x=Span(-10.0, 10.0), z=Span(0.0, 0.0)),
    )


def test_missing_keys_of_a_scene_have_their_defaults():
    scene = parse_scene(LEAST)
    assert scene == SceneModel("a", "position", (Hyperboloid("hyperboloid 1", 1.0, 2.0),), Mover(1.0, 1.0), Region())


def test_axes_of_a_scene_are_read_without_normalisation():
    scene = parse_scene(LEANING)
    assert [body.axis for body in scene.hyperboloids] == [(0.0, -1.0, 3.0), UPRIGHT]
    assert scene.mover.axis == (0.5, 0.0, 2.0)
    assert scene.leaning
    assert parse_scene(LEANING.replace("[0.5, 0, 2]", '"free"')).mover.axis == FREE


def test_a_vertical_axis_is_upright_whatever_its_length_and_sense():
    text = LEANING.replace("[0, -1, 3]", "[0, 0, -3]").replace("[0.5, 0, 2]", "[0, 0, 1e300]")
    assert not parse_scene(text).leaning
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


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (changed("alpha = 0.5", "alpha = -1"), "line 6: hyperboloid 1: alpha is -1; it must be a finite number above"),
        (changed("alpha = 0.5", "alpha = 0.0"), "line 6: hyperboloid 1: alpha is 0.0; "),
        (changed("alpha = 0.5", "alpha = nan"), "line 6: hyperboloid 1: alpha is nan; "),
        (changed("alpha = 0.5", "alpha = inf"), "line 6: hyperboloid 1: alpha is inf; "),
        (changed("alpha = 0.5", "alpha = 1e400"), "line 6: hyperboloid 1: alpha is inf; "),
        (changed("alpha = 0.5", "alpha = 1e-400"), "line 6: hyperboloid 1: alpha is 0.0; "),
        (changed("alpha = 0.5", "alpha = true"), "line 6: hyperboloid 1: alpha is true; "),
        (changed("alpha = 0.5", 'alpha = "0.5"'), 'line 6: hyperboloid 1: alpha is "0.5"; '),
        (changed("alpha = 0.5", "alpha = 1979-05-27"), 'line 6: hyperboloid 1: alpha is "1979-05-27"; '),
        (changed("alpha = 0.5", "alpha = 1" + "0" * 400), "that float64 holds"),
        (changed("alpha = 0.5", ""), "line 4: hyperboloid 1 has no alpha; it must be a finite number above 0"),
        (changed("alpha = 0.5", "aplha = 1"), 'line 6: hyperboloid 1 has the key "aplha", which is not known; did'),
        (changed("alpha = 0.5", "Alpha = 1"), "did you mean alpha?"),
        (changed("alpha = 0.5", "thick = 1"), "it may have name, alpha, gamma, center, height, axis"),
        (
            changed("alpha = 0.5", "alpha = 0.5\naxis = [0, 0, 0]"),
            "line 7: hyperboloid 1: axis is [0, 0, 0]; it must be three finite numbers, [x, y, z], not all 0",
        ),
        (changed("alpha = 0.5", "alpha = 0.5\naxis = [1, nan, 0]"), "line 7: hyperboloid 1: axis is [1, nan, 0]; "),
        (changed("alpha = 0.5", 'alpha = 0.5\naxis = "free"'), 'line 7: hyperboloid 1: axis is "free"; '),
        (
            LEANING.replace("[0.5, 0, 2]", "[0, 0, -0.0]"),
            'line 3: [mover]: axis is [0, 0, -0.0]; it must be three finite numbers, [x, y, z], not all 0, or "free"',
        ),
        (LEANING.replace("[0.5, 0, 2]", '"any"'), 'line 3: [mover]: axis is "any"; '),
        (
            changed("d = 0.15", "d = 0.15\naxis = [1, 0, 4]"),
            "line 18: [mover]: axis is [1.0, 0.0, 4.0], and the mover has parts, whose places are known only where",
        ),
        (changed("d = 0.15", 'd = 0.15\naxis = "free"'), 'line 18: [mover]: axis is "free", and the mover has parts'),
        (LEANING + WALK, "line 4: [walk] is of a scene in which something leans; simulations fly and walk upright"),
        (changed("[-1, 6.25]", "[6, -1]"), "line 9: hyperboloid 1: height is [6, -1]; it must be two finite numbers"),
        (changed("[-1, 6.25]", "[2, 2.0]"), "line 9: hyperboloid 1: height is [2, 2.0]; "),
        (changed("[-1, 6.25]", "[2]"), "line 9: hyperboloid 1: height is [2]; "),
        (changed("[-1, 6.25]", "[2, nan]"), "line 9: hyperboloid 1: height is [2, nan]; "),
        (changed("[-1, 6.25]", "4"), "line 9: hyperboloid 1: height is 4; "),
        (changed("[1, -2.5, 0]", "[1, 2]"), "line 8: hyperboloid 1: center is [1, 2]; it must be three finite numbers"),
        (changed("[1, -2.5, 0]", "[1, 2, true]"), "line 8: hyperboloid 1: center is [1, 2, true]; "),
        (changed("[1, -2.5, 0]", "{ x = 1 }"), "line 8: hyperboloid 1: center is "),
        (changed('name = "oak"', 'name = " "'), "line 5: hyperboloid 1: name is "),
        (changed('name = "oak"', 'name = "hyperboloid 2"'), "line 11: hyperboloid 2 is called "),
        (changed("b = 0.25\n", ""), "line 15: [mover] has no b"),
        (changed("arm = 0.135", "arm = -1"), "line 22: [mover] part 1: arm is -1; it must be a finite number, 0 or"),
        (changed("arm = 0.135", "arm = 0.1500001"), "line 19: mover part 1 reaches beyond the mover"),
        (changed("angle = -45", "angle = nan"), "line 23: [mover] part 1: angle is nan; it must be a finite number"),
        (changed("x = [-10, 10]", "x = [10, -10]"), "line 26: [region]: x is [10, -10]; "),
        (changed("x = [-10, 10]", 'x = "ten"'), "line 26: [region]: x is "),
        (changed("z = -0.0", "w = 0"), 'line 27: [region] has the key "w", which is not known; it may have x, y, z'),
        (changed('question = "exterior"', 'question = "inside"'), "line 2: the scene: question is "),
        (changed('name = "yard"', ""), "s.toml: the scene has no name; it must be a text that is not empty"),
        (WHOLE + "[weather]\n", 'line 28: the scene has the key "weather", which is not known'),
        (WHOLE.replace("[mover]", "[mover]\nb = 1"), "s.toml: is no TOML: "),
        ('name = "a"\nmover = { b = 1, d = 1 }', "it must have one [[hyperboloid]] at least"),
        (LEAST.replace("[{ alpha = 1, gamma = 2 }]", "[]"), "line 2: the scene has no hyperboloid"),
        (LEAST.replace("[{ alpha = 1, gamma = 2 }]", "3"), "line 2: hyperboloid is 3; it must be an array of tables"),
        (LEAST.replace("[{ alpha = 1, gamma = 2 }]", "[3]"), "line 2: hyperboloid 1 is 3; it must be a table with"),
        (LEAST.replace("{ b = 1, d = 1 }", "[1]"), "line 3: [mover] is [1]; it must be a table with b, d, part"),
        (LEAST.replace("mover = { b = 1, d = 1 }", ""), "the scene has no [mover]; "),
        ("", "the scene has no name"),
        ("name", "is no TOML"),
        (LEAST + "x = " + "9" * 5000, "too many digits"),
        (LEAST + "x = " + "[" * 5000 + "]" * 5000, "is nested too deeply"),
        ("name = " + "[" * 300 + "]" * 300, "line 1: the scene: name is "),
    ],
)
def test_invalid_scene_is_refused_naming_key_and_line(text, message):
    assert message in refusal(text)


def test_fault_in_one_of_many_trees_is_reported_with_the_line_of_that_tree():
    rows = [f"  {{ alpha = {n}, gamma = 9 }},  # tree {n}" for n in (1, 2, 0, 4)]
    text = 'name = "wood"\nhyperboloid = [\n' + "\n".join(rows) + "\n]\nmover = { b = 1, d = 1 }\n"
    assert "s.toml, line 5: hyperboloid 3: alpha is 0; " in refusal(text)


def test_part_of_a_mover_may_touch_its_surface_from_within():
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
    ("content", "message"),
    [
        (b"name = \"a\"\nx = '\xff'", "line 2: is not UTF-8 text: invalid start byte at byte 16; save it as UTF-8"),
        (WHOLE.encode("utf-16"), "line 1: is not UTF-8 text"),
        (b"name = 'a\x00b'", "is no TOML"),
        (b"\x7fELF\x02\x01", "is no TOML"),
    ],
)
def test_read_scene_refuses_a_file_that_is_no_text(tmp_path, content, message):
    path = tmp_path / "s.toml"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_scene(str(path))
    assert str(caught.value).startswith(str(path))
    assert message in str(caught.value)


def test_scene_file_of_more_than_a_mebibyte_is_refused_unread(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text(LEAST + "#" * (1 << 20))
    with pytest.raises(InputError, match="has more than 1 MiB; it must be smaller"):
        read_scene(str(path))


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


def test_read_scene_refuses_a_file_that_cannot_be_opened(tmp_path):
    with pytest.raises(InputError, match="is a directory"):
        read_scene(str(tmp_path))
    with pytest.raises(InputError, match=r"there is no such file; it must be one, or a shipped scene: .*tower"):
        read_scene(str(tmp_path / "towre"))
    with pytest.raises(InputError, match="cannot read"):
        read_scene("a\0b.toml")


def test_each_shipped_scene_is_read_by_its_name_and_from_its_text():
    assert "tower" in shipped_scenes()
    for name in shipped_scenes():
        assert read_scene(name) == parse_scene(shipped_text(name))


def test_a_fault_in_a_shipped_scene_names_the_shipped_scene(monkeypatch):
    monkeypatch.setattr(reading, "shipped_text", lambda name: "")
    with pytest.raises(InputError, match=r"^the shipped scene tower: the scene has no name"):
        read_scene("tower")


def test_the_shipped_tower_is_the_papers():
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
