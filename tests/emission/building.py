"""Emitted kernels, built with the compilers that the machine has, and loaded."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import sys
from uuid import uuid4

import numpy as np
import pytest

from hypcheck.kernel.emission.kernel import EXTENSIONS, emitted
from hypcheck.kernel.specialise.plan import plan_of

STRICT = ("-pedantic", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-O2", "-fPIC", "-shared")
COMMANDS = {
    "c": ("cc", "-std=c99", *STRICT),
    "cpp": ("c++", "-std=c++11", *STRICT),
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
    path = folder / f"kernel.{EXTENSIONS[language]}"
    path.write_text(emitted(plan_of(scene, precision), language, COMMAND), encoding="utf-8")
    if language not in COMMANDS:
        return path
    library = folder / f"{language}-{uuid4().hex}.so"  # a library is loaded once for each name
    command = [*COMMANDS[language], *options, str(path), *(["-lm"] if language == "c" else []), "-o", str(library)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return library


def pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)


def answers(library, rows):
    """What hypcheck_classify answers."""
    found = np.full(len(rows), 99, np.int8)
    queries = np.ascontiguousarray(rows)
    ctypes.CDLL(str(library)).hypcheck_classify(ctypes.c_size_t(len(rows)), pointer(queries), pointer(found))
    return found


def answers_by_scene(library, rows):
    """What hypcheck_classify_scene answers; all rows have the sizes of the first."""
    found = np.full(len(rows), 99, np.int8)
    sizes, columns = rows[0, :4].copy(), [np.ascontiguousarray(column) for column in rows[:, 4:].T]
    ctypes.CDLL(str(library)).hypcheck_classify_scene(
        pointer(sizes), ctypes.c_size_t(len(rows)), *map(pointer, columns), pointer(found)
    )
    return found
