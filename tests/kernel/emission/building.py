"""Emitted kernels for tests: built with the compilers of this machine, loaded, asked, judged by their worst error."""

from __future__ import annotations

import ctypes
import importlib.util
import json
import shutil
import subprocess
import sys
from collections import defaultdict
from fractions import Fraction
from functools import partial
from uuid import uuid4

import numpy as np
import pytest

from hypcheck.implementations.description import domain_of
from hypcheck.implementations.domain import representable
from hypcheck.runs import judge
from hypcheck.vectors.fixed_sizes import families_for
from tests.support.inside import description, dialect_of, emitted, plan_of
from tests.support.judging import wrong_cases

STRICT = ("-pedantic", "-Wall", "-Wextra", "-Wconversion", "-Wsign-conversion", "-Wshadow", "-Werror")
LIBRARY = ("-O2", "-fPIC", "-shared")
COMMANDS = {
    "c": ("cc", "-std=c99", *STRICT, "-Wmissing-prototypes", *LIBRARY),
    "cpp": ("c++", "-std=c++11", *STRICT, *LIBRARY),
    "rust": ("rustc", "--edition", "2021", "-D", "warnings", "-O", "--crate-type", "cdylib"),
}
COMMAND = ["hypcheck", "emit", "--scene", "a scene"]


def missing(language):
    """What a language needs and is not here; None where all is."""
    tool = {"javascript": "node", "python": sys.executable}.get(language) or COMMANDS[language][0]
    return None if shutil.which(tool) else tool


def needs(language):
    """A mark for tests that build in a language."""
    return pytest.mark.skipif(missing(language) is not None, reason=f"there is no {missing(language)}")


def skip_without(language):
    """Skip the test where what a language needs is not here."""
    if missing(language):
        pytest.skip(f"there is no {missing(language)}")


def built(folder, scene, language, precision="float64", *options):
    """The file of a kernel: a library, or the text itself where nothing compiles. Fails with the compiler's words."""
    return built_of(folder, emitted(plan_of(scene, precision), language, COMMAND), language, *options)


def built_of(folder, text, language, *options):
    """The file of a kernel with this text."""
    path = folder / f"kernel.{dialect_of(language).extension}"
    path.write_text(text, encoding="utf-8")
    return library_of(path, language, *options)


def library_of(path, language, *options):
    """The library that the code in this file makes; the file itself where nothing compiles."""
    if language not in COMMANDS:
        return path
    library = path.with_name(f"{language}-{uuid4().hex}.so")  # a library is loaded once for each name
    command = [*COMMANDS[language], *options, str(path), *(["-lm"] if language == "c" else []), "-o", str(library)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return library


def pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)


def answers(library, rows):
    """What hypcheck_classify answers; hypcheck_classify_tilted to rows of ten, hypcheck_passage_tilted of thirteen."""
    found = np.full(len(rows), 99, np.int8)
    queries = np.ascontiguousarray(rows)
    loaded = ctypes.CDLL(str(library))
    if rows.shape[1] == 13:
        loaded.hypcheck_passage_tilted(ctypes.c_size_t(len(rows)), pointer(queries), pointer(found), None)
        return found
    classify = loaded.hypcheck_classify if rows.shape[1] == 7 else loaded.hypcheck_classify_tilted
    classify(ctypes.c_size_t(len(rows)), pointer(queries), pointer(found))
    return found


def asking(path, language, name=None):
    """What answers rows: the built kernel in its own language, both entries of a library at once."""
    if language == "python":
        module = load_module(path)

        def ask_module(rows):
            many = module.passage if rows.shape[1] == 13 else module.classify
            return np.array(many(rows.tolist()), np.int8)

        return ask_module
    if language == "javascript":
        return lambda rows: _asked_of_node(path, rows, name)

    def ask(rows):
        found = answers(path, rows)
        for axis in np.unique(rows[:, 7:], axis=0):
            alike = (rows[:, 7:] == axis).all(axis=1)
            assert (found[alike] == answers_by_scene(path, rows[alike])).all()
        return found

    return ask


def asking_pairs(path, language):
    """What answers rows of any sizes: a library has no entry for scenes then."""
    return partial(answers, path) if language in COMMANDS else asking(path, language)


def load_module(path):
    """The Python module of a kernel."""
    spec = importlib.util.spec_from_file_location("kernel", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


_NODE = """
import { NAME } from KERNEL;
const chunks = [];
for await (const chunk of process.stdin) chunks.push(chunk);
const bytes = Buffer.concat(chunks);
const rows = new Float64Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
const found = new Int8Array(rows.length / WIDE).map((_, i) => NAME(...rows.subarray(WIDE * i, WIDE * i + WIDE)));
process.stdout.write(Buffer.from(found.buffer));
"""


def _asked_of_node(path, rows, name=None):
    script = path.with_name("ask.mjs")
    wide = rows.shape[1]
    text = _NODE.replace("NAME", name or {7: "predicate", 10: "tilted", 13: "passage"}[wide]).replace("WIDE", str(wide))
    script.write_text(text.replace("KERNEL", json.dumps(str(path))), encoding="utf-8")
    node, sent = str(shutil.which("node")), np.ascontiguousarray(rows).tobytes()
    done = subprocess.run([node, str(script)], input=sent, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr
    return np.frombuffer(done.stdout, np.int8)


def answers_by_scene(library, rows):
    """What hypcheck_classify_scene, or the tilted one, answers; all rows have the sizes and the axis of the first."""
    found = np.full(len(rows), 99, np.int8)
    sizes, axis = rows[0, :4].copy(), rows[0, 7:].copy()
    columns = [np.ascontiguousarray(column) for column in rows[:, 4:7].T]
    given = (ctypes.c_size_t(len(rows)), *map(pointer, columns), pointer(found))
    loaded = ctypes.CDLL(str(library))
    if len(axis):
        loaded.hypcheck_classify_tilted_scene(pointer(sizes), pointer(axis), *given)
    else:
        loaded.hypcheck_classify_scene(pointer(sizes), *given)
    return found


def worst_error(asked_of, plan, count):
    """The largest backward error in units u of what `asked_of(rows)` answers, and how many rows were asked.

    All rows of one pair of sizes are asked at once: for some languages a question starts a process.
    """
    domain = domain_of(description(plan, "c")["domain"])
    criterion = judge.Criterion(plan.question, plan.format.name, Fraction(8))
    tables = defaultdict(list)
    for family in families_for(domain.settings):
        rows = family.rows(0, count)
        rows = rows[domain.holds(rows) & representable(rows, plan.format.name)]
        if len(rows):
            tables[tuple(rows[0, :4])].append(rows)
    alike = [np.concatenate(parts) for parts in tables.values()]
    return max((worst_of(asked_of, rows, criterion) for rows in alike), default=0.0), sum(map(len, alike))


def worst_of(asked_of, rows, criterion):
    """The largest backward error in units u of what `asked_of` answers to these rows."""
    wrong = wrong_cases(rows, judge.exact_positions(rows), asked_of(rows), criterion)
    return max(
        (judge.in_units(judge.measured(case, criterion.question), criterion.unit) for case in wrong), default=0.0
    )
