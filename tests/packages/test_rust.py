"""The crate, as a stranger has it: unpacked, tested, packaged by cargo, and gated by an adapter of `hypcheck init`."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

import pytest

from packages.trials import ADAPTERS
from tests.packages.archives import gate, packed, quietly, unpacked_archive

CARGO = shutil.which("cargo")

pytestmark = [
    pytest.mark.skipif(CARGO is None, reason="there is no cargo"),
    pytest.mark.slow,
]


@pytest.fixture(scope="module")
def crate(tmp_path_factory):
    folder = unpacked_archive(packed(tmp_path_factory.mktemp("rust"), "rust"))
    fetched = subprocess.run([CARGO, "fetch"], cwd=folder, capture_output=True, text=True, check=False)
    if fetched.returncode:
        pytest.skip(f"the crate cc cannot be fetched: {fetched.stderr.strip().splitlines()[-1]}")
    return folder


UNOPTIMISED = {**os.environ, "CFLAGS": "-O0", "CARGO_PROFILE_DEV_DEBUG": "0"}
"""The header is compiled in a fifth of the time."""


def test_the_crates_own_tests_pass_and_cargo_packages_it_with_pages_made_without_a_warning(crate):
    """In one test, since to compile the crate takes longer."""
    said = quietly(CARGO, "test", "--offline", cwd=crate, env=UNOPTIMISED)
    assert said.count("test result: ok") == 3  # of the library, of its tests, and of the pages' examples
    assert "(line 5) ... ok" in said  # the example of its README
    listed = quietly(CARGO, "package", "--offline", "--allow-dirty", "--list", cwd=crate).split()
    assert {"src/hypcheck.h", "src/lib.rs", "build.rs", "README.md", "LICENSE"} <= set(listed)
    words = [CARGO, "doc", "--offline", "--no-deps"]
    done = subprocess.run(words, cwd=crate, env=UNOPTIMISED, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "warning" not in done.stderr


@pytest.mark.thorough
def test_the_crate_is_held_by_the_gate_about_upright_and_tilted_rows(crate, tmp_path):
    quietly(sys.executable, "-m", "hypcheck", "init", "--language", "rust", "--name", "crate", cwd=tmp_path)
    adapter = tmp_path / "hypcheck-rust"
    (adapter / "src" / "predicate.rs").write_text(ADAPTERS["predicate.rs"], encoding="utf-8")
    manifest = adapter / "Cargo.toml"
    text = manifest.read_text(encoding="utf-8")
    dependency = f"hypcheck = {{ path = '{crate}' }}"
    manifest.write_text(text.replace("[dependencies]", "[dependencies]\n" + dependency), encoding="utf-8")
    built = crate / "target"  # where the tests of the crate have compiled it already
    quietly(CARGO, "build", "--offline", "--manifest-path", manifest, "--target-dir", built)
    said = gate(tmp_path, f"command:{built / 'debug' / 'hypcheck-adapter'}", "--count", "40")
    assert "HELD" in said
