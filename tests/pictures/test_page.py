"""The page of a scene in 3-D: three.js whole and unchanged, and in a browser without a network."""

from __future__ import annotations

import base64
import hashlib
import json
import re
import sys
import tarfile
import warnings
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from hypcheck import InputError, Mover, Scene
from hypcheck.cli.main import main
from hypcheck.errors import UnavailableError
from hypcheck.scene.model import FREE
from tests.report import browser

THREE = Path(__file__).parents[2] / "hypcheck" / "pictures" / "three"
FLAGS = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist")
"""A browser on a machine without a graphics card draws in software."""


def test_three_js_is_whole_and_unchanged():
    listed = dict(re.findall(r"^ +([0-9a-f]{64})  (\S+)$", (THREE / "README.md").read_text("utf-8"), re.MULTILINE))
    with tarfile.open(THREE / "three.tar.xz") as archive:
        contents = {member.name: archive.extractfile(member).read() for member in archive.getmembers()}
    files = {name: hashlib.sha256(content).hexdigest() for name, content in contents.items()}
    files["LICENSE"] = hashlib.sha256((THREE / "LICENSE").read_bytes()).hexdigest()
    assert {name: checksum for checksum, name in listed.items()} == files
    assert "three@0.187.0" in (THREE / "README.md").read_text("utf-8")
    assert b"const REVISION = '187'" in contents["three.core.js"]
    assert "MIT License" in (THREE / "LICENSE").read_text("utf-8")


def forest(count=4):
    random = np.random.default_rng(5)
    place = np.stack(np.meshgrid(np.arange(count), np.arange(count)), axis=-1).reshape(-1, 2) * 5.0
    centers = np.c_[place, np.zeros(len(place))]
    return Scene.from_arrays(
        random.uniform(0.2, 0.5, len(place)), 6.0, centers, mover=Mover(0.4, 0.2), z_min=-1, z_max=8, solid=True
    )


PATH = [[-2.0, 2.5, 2.0], [12.0, 2.5, 2.0], [12.0, 2.5, 4.0], [15.0, 5.0, 4.0], [20.0, 9.0, 4.0]]


def data_of(page):
    return json.loads(re.search(r'id="data">(.*?)</script>', page.html, re.DOTALL)[1])


def test_the_page_says_what_first_contact_says():
    scene = forest()
    found, data = scene.first_contact(PATH), data_of(scene.show(PATH))
    assert found.hit
    assert data["contacts"][0]["segment"] == found.segment
    assert len(data["distances"]["upper"]) == len(data["touched"]) == 240
    assert 1 in data["touched"]
    flown = np.append(0, np.cumsum(np.linalg.norm(np.diff(PATH, axis=0), axis=1)))
    place = flown[found.segment] + found.time_lower * (flown[found.segment + 1] - flown[found.segment])
    assert data["touched"].index(1) == int(place / flown[-1] * 240)
    assert data["least"]["flown"] == pytest.approx(place)
    clear = scene.show(PATH[:3])
    assert data_of(clear)["touched"] == [0] * 240
    assert min(data_of(clear)["distances"]["upper"]) == pytest.approx(
        scene.first_contact(PATH[:3]).least.distance_upper, rel=1e-6
    )
    assert "clear, its least distance is" in clear.html


def test_a_page_without_a_flight_or_with_one_that_stays_has_no_nan():
    for page in (forest().show(), forest().show([[2.5, 2.5, 2.0]]), Scene.from_toml("tower").show()):
        assert "NaN" not in json.dumps(data_of(page))


@pytest.mark.parametrize(
    ("alpha", "gamma", "x", "path"),
    [(1, 1e-160, 0, None), (1e308, 6, 0, None), (1, 1e308, 0, None), (1, 6, 1e300, [[5, 0, 0], [0, 0, 5]])],
)
def test_a_scene_that_is_too_large_to_draw_is_refused_without_warnings(alpha, gamma, x, path):
    scene = Scene.from_arrays(alpha, gamma, [[0, 0, 0], [x, 0, 0]], z_max=17, mover=(0.25, 0.15))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(InputError, match=r"is too large to draw: .* within 1e\+18 units"):
            scene.show(path)


def test_a_page_shows_one_flight_and_needs_a_free_axis():
    with pytest.raises(InputError, match="a picture shows one flight"):
        forest().show([PATH, PATH])
    free = Scene.from_arrays(1, 6, [[0, 0, 0]], mover=Mover(0.4, 0.2, axis=FREE))
    with pytest.raises(InputError, match="axis"):
        free.show(PATH)
    assert "canvas" in free.show(PATH, axis=(1, 0, 1)).html


def test_a_name_cannot_break_out_of_the_page():
    scene = Scene.from_arrays(
        1, 6, [[0, 0, 0]], mover=Mover(1, 1), names=["</script><b>"], name="<script>alert(1)</script>"
    )
    page = scene.show([[5, 0, 0], [9, 0, 0]]).html
    assert "<b>" not in page
    assert "<script>alert" not in page


def test_a_notebook_shows_the_page_in_a_frame_whose_text_is_the_page():
    page = forest().show()
    frame = ElementTree.fromstring(page._repr_html_())  # noqa: S314 - our own
    assert frame.tag == "iframe"
    assert frame.get("srcdoc").split() == page.html.split()


def test_show_without_a_flight_writes_the_page_of_the_scene(tmp_path, capsys):
    page = tmp_path / "view.html"
    assert main(["show", "tower", "--out", str(page)]) == 0
    assert capsys.readouterr().out == f"wrote {page}\n"
    assert page.read_text("utf-8") == Scene.from_toml("tower").show().html


def test_a_body_whose_axis_points_down_is_drawn_as_the_one_turned_over():
    down, up = (
        Scene.from_arrays(1, 6, [[0, 0, 3]], axis=[[0, 0, way]], z_min=low, z_max=high, mover=Mover(0.4, 0.2))
        for way, low, high in ((-1, -2, 5), (1, -5, 2))
    )
    drawn = [np.frombuffer(base64.b64decode(data_of(scene.show())["bodies"]), np.float32) for scene in (down, up)]
    assert drawn[0].tolist() == drawn[1].tolist()


def test_without_matplotlib_a_plot_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.delitem(sys.modules, "matplotlib.collections", raising=False)
    monkeypatch.delitem(sys.modules, "matplotlib.figure", raising=False)
    with pytest.raises(UnavailableError, match=r"a plot needs matplotlib; install it, or hypcheck with its extra"):
        forest().plot(PATH)


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pages")
    for name, page in {"flight": forest().show(PATH), "alone": forest().show()}.items():
        page.save(folder / f"{name}.html")
    return folder


@pytest.mark.parametrize(("width", "scheme"), [pytest.param(1400, "light", marks=pytest.mark.thorough), (390, "dark")])
def test_the_page_draws_plays_and_answers_keys_and_fingers_in_a_browser_without_a_network(
    pages, monkeypatch, width, scheme
):
    monkeypatch.setattr(browser, "FLAGS", (*browser.FLAGS, *FLAGS))
    with browser.opened() as window:
        page = window.page
        window.visit(pages / "flight.html", width=width)
        page.emulate_media(color_scheme=scheme)
        page.wait_for_function("document.body.dataset.frames > 0", timeout=60000)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert page.is_hidden("#trouble")
        assert "contact" in page.inner_text("#said")
        drawn = page.evaluate("document.body.dataset.frames")
        page.focus("#view")
        page.keyboard.press("ArrowLeft")
        page.wait_for_function(f"document.body.dataset.frames > {drawn}")
        page.evaluate("const at = document.getElementById('at'); at.value = 0; at.dispatchEvent(new Event('input'))")
        assert page.inner_text("#said").startswith("0 of")
        page.keyboard.press(".")
        assert not page.inner_text("#said").startswith("0 of")
        touch = page.context.new_cdp_session(page)
        for fingers in ([(150, 200)], [(150, 200), (250, 300)]):  # one turns the view, two bring it nearer
            page.wait_for_timeout(500)  # nothing is drawn while nothing moves
            drawn = page.evaluate("document.body.dataset.frames")
            moved = [(x + 40 - number * 60, y + 30) for number, (x, y) in enumerate(fingers)]
            for kind, points in (("touchStart", fingers), ("touchMove", moved), ("touchEnd", [])):
                places = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(points)]
                touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": places})
            page.wait_for_function(f"document.body.dataset.frames > {drawn}")
        page.click("#play")
        assert page.inner_text("#play") == "Pause"
        assert page.locator("#curve .line").count() == 1
        assert [each for each in window.said if "GL Driver Message" not in each] == []
        assert [each for each in window.requests if not each.startswith(("file:", "blob:"))] == []
        window.visit(pages / "alone.html")
        page.wait_for_function("document.body.dataset.frames > 0", timeout=60000)
        assert [each for each in window.said if "GL Driver Message" not in each] == []


def test_the_plot_shows_plan_and_elevation_with_the_sweep_as_wide_as_the_mover():
    """Segment 0 goes along x at y 2.5, z 2: its sweep is 0.4 wide in plan, and 0.2 high in elevation."""
    pytest.importorskip("matplotlib")
    figure = forest().plot(PATH)
    plan, elevation = figure.axes
    assert [plan.get_title(), elevation.get_title()] == ["plan", "elevation"]
    for axes, middle, half in ((plan, 2.5, 0.4), (elevation, 2.0, 0.2)):
        clear, _ = axes.collections[2:]
        clear_alone = forest().plot([*PATH[:1], [-1.5, 2.5, 2.0]]).axes[axes is elevation].collections[2]
        corners = clear_alone.get_paths()[0].vertices
        assert (corners[:, 1].min(), corners[:, 1].max()) == pytest.approx((middle - half, middle + half), abs=1e-3)
        assert len(clear.get_paths()) > 0
    assert len(forest().plot().axes) == 2
