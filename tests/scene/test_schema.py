"""The schema and the reader agree on what a scene file may hold, as far as a schema can say it."""

from __future__ import annotations

import copy
import json
import sys
from importlib import resources

import pytest

from hypcheck.errors import InputError
from hypcheck.scene.reading import parse_scene, shipped_scenes, shipped_text
from tests.scene.test_reading import LEAST, TILTED, WHOLE
from tests.support.records import violations

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

SCHEMA = json.loads(
    resources.files("hypcheck.scene").joinpath("schemas", "scene-1.2.0.json").read_text(encoding="utf-8")
)
TEXTS = [WHOLE, LEAST, TILTED, TILTED.replace("[0.5, 0, 2]", '"free"'), *map(shipped_text, shipped_scenes())]
WRONG = (True, -1.0, 0, "", "text", [], [1.0], [1.0, 2.0], [1.0, 2.0, 3.0], [True, 1], {}, {"x": 1}, [{}], [3])
"""Values of every type, put in the place of every value of a scene."""


def toml(value):
    """A value as TOML; JSON but for tables."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{json.dumps(key)} = {toml(each)}" for key, each in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value)


def document(content):
    return "\n".join(f"{json.dumps(key)} = {toml(value)}" for key, value in content.items())


def places(value, path=()):
    """The path of every value, tables and arrays among them."""
    if path:
        yield path
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, each in inner:
        yield from places(each, (*path, key))


def replaced(content, path, value):
    result = copy.deepcopy(content)
    around = result
    for key in path[:-1]:
        around = around[key]
    if value is None:
        del around[path[-1]]
    else:
        around[path[-1]] = copy.deepcopy(value)
    return result


def accepted(content):
    try:
        parse_scene(document(content))
    except InputError:
        return False
    return True


@pytest.mark.parametrize("text", TEXTS)
def test_scenes_that_the_reader_accepts_fit_the_schema(text):
    assert violations(tomllib.loads(text), SCHEMA, closed=True) == []


@pytest.mark.slow
@pytest.mark.parametrize("text", [WHOLE])
def test_scene_reader_and_schema_agree_on_missing_values_and_wrong_types(text):
    """A missing value, a wrong one, an unknown key; what a schema cannot say is left out."""
    content = tomllib.loads(text)
    for path in list(places(content)):
        for value in (None, *WRONG):
            changed = replaced(content, path, value)
            fits, read = not violations(changed, SCHEMA), accepted(changed)
            assert fits == read or (fits and beyond_a_schema(path, value)), (path, value)


def beyond_a_schema(path, value):
    """The order of a range's ends and that parts lie within the mover: the schema's description names them."""
    return any(key in ("height", "part", "x", "y", "z", "b", "d") for key in path if isinstance(key, str))


def test_scene_reader_and_schema_refuse_an_unknown_key_in_every_table():
    content = tomllib.loads(WHOLE)
    for path in [(), *places(content)]:
        table = content
        for key in path:
            table = table[key]
        if isinstance(table, dict):
            changed = replaced(content, (*path, "colour"), "green")
            assert violations(changed, SCHEMA)
            assert not accepted(changed)
