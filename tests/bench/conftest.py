"""Files that bench compiles are compiled once in a run of the tests."""

from __future__ import annotations

import hashlib
import os
import shutil
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from hypcheck.bench import c_library
from tests.support.shared_folders import made_once


@pytest.fixture(autouse=True, scope="package")
def compiled_once(tmp_path_factory):
    compile_anew = c_library.run_compiler

    def run_compiler(words):
        if "-o" not in words:
            return compile_anew(words)
        target = words[words.index("-o") + 1]

        def make(folder):
            done = compile_anew([str(folder / "made") if word == target else word for word in words])
            if done.returncode:
                raise _FailedError(done)

        key = hashlib.sha256(repr([_content(word) for word in words if word != target]).encode()).hexdigest()
        try:
            made = made_once(tmp_path_factory, f"compiled-{key}", make)
        except _FailedError as failed:
            return failed.args[0]
        Path(target).unlink(missing_ok=True)  # as a linker does: what was loaded from there stays whole
        shutil.copy(made / "made", target)
        return CompletedProcess(words, 0, "", "")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(c_library, "run_compiler", run_compiler)
        yield


class _FailedError(Exception):
    """The compiler failed, and what it said; the next test tries again."""


def _content(word):
    return hashlib.sha256(Path(word).read_bytes()).digest() if os.path.isfile(word) else word
