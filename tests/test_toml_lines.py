"""The line of every value in a TOML text, against texts that were written with their lines known."""

from __future__ import annotations

import sys
import tracemalloc

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.toml import lines_of, nearest_line

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

EVERYTHING = '''\
# a comment with [brackets] and = signs

title = "a # no comment, ] } = \\" either"
"quoted key" = 'literal \\'
site."of the".tower = { alpha = 1, deep = [ { x = 2 } ] }
when = 1979-05-27 07:32:00   # a space within
long = """
line two ""\\
   line three"""""
raw = \'\'\'
[[not.a.table]]
''\'\'\'
numbers = [
  1,  # one

  [2, 3], { four = 4 },
]
empty = []

[a.b]  # a table
c = 1e400

[[tree]]
alpha = inf
  [[tree.part]]
  b = 1
  [[tree.part]]
  b = 2
  [tree.bark]
  rough = true
[[ tree ]]
alpha = -1
[tree.bark]
rough = false
'''

LINES = {
    ("title",): 3,
    ("quoted key",): 4,
    ("site", "of the", "tower", "alpha"): 5,
    ("site", "of the", "tower", "deep", 0, "x"): 5,
    ("when",): 6,
    ("long",): 7,
    ("raw",): 10,
    ("numbers",): 13,
    ("numbers", 0): 14,
    ("numbers", 1): 16,
    ("numbers", 1, 1): 16,
    ("numbers", 2, "four"): 16,
    ("empty",): 18,
    ("a", "b"): 20,
    ("a", "b", "c"): 21,
    ("tree",): 23,
    ("tree", 0): 23,
    ("tree", 0, "alpha"): 24,
    ("tree", 0, "part", 0): 25,
    ("tree", 0, "part", 0, "b"): 26,
    ("tree", 0, "part", 1, "b"): 28,
    ("tree", 0, "bark"): 29,
    ("tree", 0, "bark", "rough"): 30,
    ("tree", 1): 31,
    ("tree", 1, "alpha"): 32,
    ("tree", 1, "bark", "rough"): 34,
}


def leaves(value, path=()):
    if isinstance(value, dict):
        for key, each in value.items():
            yield from leaves(each, (*path, key))
    elif isinstance(value, list):
        for place, each in enumerate(value):
            yield from leaves(each, (*path, place))
    else:
        yield path


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_line_of_a_value_is_found_in_every_form_of_toml(newline):
    text = EVERYTHING.replace("\n", newline)
    found = lines_of(text)
    assert {path: found[path] for path in LINES} == LINES
    assert set(leaves(tomllib.loads(text))) <= set(found)


def test_line_of_a_missing_key_is_the_line_of_its_table():
    found = lines_of(EVERYTHING)
    assert nearest_line(found, ("tree", 1, "gamma")) == 31
    assert nearest_line(found, ("tree", 0, "part", 1, "arm", 3)) == 27
    assert nearest_line(found, ("nowhere",)) is None


_keys = st.text("abc.= #[]\"'\\é\t", min_size=1, max_size=4)
_strings = st.text("ab #=[]{}\"'\\\n,", max_size=6)
_scalars = st.one_of(
    st.integers(-9, 9).map(str),
    st.sampled_from(["true", "inf", "-0.0", "1e3", "1979-05-27"]),
    _strings.map(lambda text: '"' + _escaped(text) + '"'),
    _strings.filter(lambda text: "'" not in text and "\n" not in text).map("'{}'".format),
    _strings.map(lambda text: '"""\n' + _escaped(text).replace("\\n", "\n") + '"""'),
)


def _escaped(text):
    for plain, escaped in (("\\", "\\\\"), ('"', '\\"'), ("\n", "\\n"), ("\t", "\\t")):
        text = text.replace(plain, escaped)
    return text


class Written:
    """A text that grows, and the lines on which its values begin."""

    def __init__(self):
        self.text, self.lines = "", {}

    def add(self, text):
        """Go on with the text."""
        self.text += text

    def mark(self, path):
        """Here the value at the path begins."""
        self.lines[path] = self.text.count("\n") + 1


@st.composite
def documents(draw):
    written, blank = Written(), st.sampled_from(["", "\n", "# [x]\n", "  \n\t# = {\n"])

    def value(path, depth):
        written.mark(path)
        kind = draw(st.sampled_from(["scalar", "scalar", "array", "table"])) if depth < 3 else "scalar"
        if kind == "scalar":
            written.add(draw(_scalars))
        elif kind == "array":
            written.add("[" + draw(blank))
            for place in range(draw(st.integers(0, 3))):
                value((*path, place), depth + 1)
                written.add(draw(blank) + "," + draw(blank))
            written.add("]")
        else:
            written.add("{ ")
            for number, key in enumerate(draw(st.lists(_keys, unique=True, max_size=2))):
                written.add(", " * bool(number) + f'"{_escaped(key)}" = ')
                value((*path, key), depth + 1)
            written.add(" }")

    def pairs(path):
        for key in draw(st.lists(_keys, unique=True, max_size=3)):
            written.add(draw(blank) + f'"{_escaped(key)}" = ')
            value((*path, key), 0)
            written.add(draw(st.sampled_from(["\n", " # ]\n"])))

    pairs(())
    for name in draw(st.lists(st.sampled_from(["T", "U"]), unique=True)):
        for place in range(draw(st.integers(1, 3))):
            written.add(draw(blank))
            written.mark((name, place))
            written.add(f"[[{name}]]\n")
            pairs((name, place))
    return written


@pytest.mark.slow
@given(documents())
def test_line_of_every_value_is_found_in_random_toml(written):
    found = lines_of(written.text)
    assert {path: found.get(path) for path in written.lines} == written.lines
    assert set(leaves(tomllib.loads(written.text))) <= set(found)


@pytest.mark.slow
@pytest.mark.parametrize(
    "text",
    ["#\n" * 100_000, "\n" * 200_000, 'a = "%s"' % (r"\n" * 100_000), "'%s' = 1" % ("a " * 100_000)],
    ids=["comments", "blank lines", "a text of escapes", "a long key"],
)
def test_finding_lines_of_a_long_toml_text_takes_little_memory(text):
    tracemalloc.start()
    try:
        assert len(lines_of(text)) <= 1
        assert tracemalloc.get_traced_memory()[1] < 10 * len(text)
    finally:
        tracemalloc.stop()
