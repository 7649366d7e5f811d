"""Names from a scene file in an emitted kernel: readable in any script, and without effect on the program."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hypcheck.scene.model import Hyperboloid
from tests.kernel.emission.building import asking, built, skip_without
from tests.support.inside import EMITTED_LANGUAGES, comment_text, emitted, plan_of
from tests.support.scenes import PLAIN

WORDS = (
    "Kühlturm", "塔", "*/", "/*", '"""', "'''", "??/", "???/", "\\", "a\\ b", "C:\\x\\Users\\N{x}", "\\udfff", "${x}",
    "a\u202eb", "line\u2028end", "\udcff", "*\\", "%s", "#{", "`", "//", "#", "\n#error no\n",
    "*/ int main(void) { return 1; } /*", '\\" ${header} \\u000a',
)  # fmt: skip
NASTY = " ".join(WORDS)


def scene_named(name):
    """A scene with more settings than the head of a kernel tells, so that functions have notes too; all so named."""
    others = tuple(Hyperboloid(name, 0.2 + n / 8, 9.0) for n in range(5))
    return replace(PLAIN, name=name, hyperboloids=(*PLAIN.hyperboloids, *others))


@pytest.mark.parametrize("language", EMITTED_LANGUAGES)
def test_a_scene_name_in_any_script_is_unchanged_in_the_head_of_its_kernel(language):
    text = emitted(plan_of(scene_named("Kühlturm 塔")), language, ["hypcheck", "emit", "--scene", "Türme/塔.toml"])
    assert 'in the scene "Kühlturm 塔"' in text
    assert "hypcheck emit --scene 'Türme/塔.toml'" in text
    assert "the mover and Kühlturm 塔" in text


def test_invisible_characters_in_scene_names_are_escaped_in_the_kernel():
    assert comment_text("a\u202eb \udcff") == "a\\u202eb \\udcff"
    shown = comment_text(NASTY)
    assert not [harm for harm in ("*/", "/*", '"""', "??", "\u2028", "\n") if harm in shown]
    assert not [word for word in shown.split() if word.endswith("\\")]
    assert not comment_text("C:\\").endswith("\\")


@pytest.mark.parametrize("language", EMITTED_LANGUAGES)
def test_a_kernel_of_a_scene_with_a_hostile_name_builds_without_warnings_and_answers(language, tmp_path):
    """As the same kernel with a plain name does; warnings are errors, and C's trigraphs count."""
    skip_without(language)
    sizes = plan_of(scene_named("tree")).settings[0].setting.sizes
    rows = np.array([[*sizes, x, 0.1, 0.0] for x in (0.1, 0.8, 1.5, 4.0, 9.0)])
    found = []
    for place, name in enumerate(("tree", NASTY, "a tower\\", '""')):
        folder = tmp_path / str(place)
        folder.mkdir()
        found.append(asking(built(folder, scene_named(name), language), language)(rows).tolist())
    assert found == [found[0]] * 4
    assert len(set(found[0])) > 1
