"""The package for C and C++, as a stranger has it: unpacked, built, installed, and used in each of the three ways."""

from __future__ import annotations

import io
import re
import shutil
import sys
import tarfile
from pathlib import Path

import pytest

from hypcheck.version import VERSION
from tests.packages.archives import packed, quietly, unpacked_archive

ROOT = Path(__file__).resolve().parents[2]
HEADER = ROOT / "hypcheck" / "kernel" / "core" / "hypcheck.h"
SYMBOLS = ROOT / "packages" / "c" / "symbols.map"
CMAKE = shutil.which("cmake", path=str(Path(sys.executable).parent)) or shutil.which("cmake")
CPP = shutil.which("c++")
FIRST_OF_1980 = 315532800
POSITIONS = "-1 0 1"
"""Of the example: within the tower's wall, across it, and more than a metre outside."""

needs_cmake = pytest.mark.skipif(None in (CMAKE, CPP), reason="there is no cmake or no C++ compiler")


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory):
    folder = tmp_path_factory.mktemp("c")
    return unpacked_archive(packed(folder, "c"))


def installed_in(folder, archive, *options):
    """Where the shared library, built from the unpacked archive with options for CMake, is installed."""
    build, prefix, moved = folder / "build", folder / "prefix", folder / "moved"
    places = f"-DCMAKE_INSTALL_PREFIX={prefix}", "-DCMAKE_INSTALL_LIBDIR=lib"
    quietly(CMAKE, "-S", archive, "-B", build, *places, *options)
    quietly(CMAKE, "--build", build)
    quietly(CMAKE, "--install", build)
    prefix.rename(moved)  # what is installed must not remember where
    return moved


@pytest.fixture(scope="module")
def installed(unpacked):
    """The library as CMake builds it unasked, but not optimised: that takes a sixth of the time."""
    return installed_in(unpacked.parent, unpacked, "-DCMAKE_C_FLAGS_RELEASE=-O0")


def declared():
    """The functions that the header declares."""
    contract, _, _ = HEADER.read_text(encoding="utf-8").partition("#if defined(HYPCHECK_IMPLEMENTATION)")
    return set(re.findall(r"^[\w ]+[ *](\w+)\([^;]*;", contract, re.MULTILINE))


def check_examples(build):
    assert quietly(build / "example").splitlines() == [POSITIONS, f"{VERSION} {VERSION}"]
    assert quietly(build / "example_cpp").splitlines() == ["1", f"{VERSION} {VERSION}"]


def test_the_symbol_table_lists_every_function_that_the_header_declares_and_no_other():
    assert len(declared()) > 15
    listed = re.findall(r"^ {8}(\w+);$", SYMBOLS.read_text(encoding="utf-8"), re.MULTILINE)
    assert listed == sorted(declared())


def test_the_node_of_the_symbol_table_is_the_major_version():
    assert re.findall(r"^(\w+) {", SYMBOLS.read_text(encoding="utf-8"), re.MULTILINE) == [
        f"HYPCHECK_{VERSION.partition('.')[0]}"
    ]


def test_all_that_the_header_declares_to_a_program_begins_with_its_name():
    contract, _, _ = HEADER.read_text(encoding="utf-8").partition("#if defined(HYPCHECK_IMPLEMENTATION)")
    code = re.sub(r"/\*.*?\*/", "", contract, flags=re.DOTALL)
    names = re.findall(r"^#define (\w+)|^}\s*(\w+);|(\w+) = \d+|^[\w ]+[ *](\w+)\(", code, re.MULTILINE)
    found = {name for groups in names for name in groups if name}
    assert {"HYPCHECK_H", "HYPCHECK_VERSION", "HYPCHECK_CONTACT", "hypcheck_near"} | declared() <= found
    assert [name for name in found if not name.startswith(("hypcheck_", "HYPCHECK_"))] == []


def test_all_that_the_header_defines_besides_is_static_and_begins_with_hc():
    _, _, code = HEADER.read_text(encoding="utf-8").partition("#if defined(HYPCHECK_IMPLEMENTATION)")
    named = r"^#define (\w+)|^(?:HC_\w+ )?static [^;(=]*?(\w+)(?:\(|\[| = |, \w+ = )"
    found = {name for groups in re.findall(named, code, re.MULTILINE) for name in groups if name}
    assert len(found) > 200
    assert {name for name in found if not name.startswith(("hc_", "HC_"))} <= {"HYPCHECK_SELF", "HYPCHECK_SMALL_LIMBS"}


def test_two_archives_of_one_tree_have_the_same_bytes(tmp_path):
    first, second = (packed(tmp_path / name, "c").read_bytes() for name in ("first", "second"))
    assert first == second
    assert int.from_bytes(first[4:8], "little") == FIRST_OF_1980, "gzip keeps the time of its making"
    with tarfile.open(fileobj=io.BytesIO(first)) as files:
        entries = files.getmembers()
    assert [entry.name for entry in entries] == sorted(entry.name for entry in entries)
    assert {(entry.mtime, entry.mode, entry.uid, entry.uname) for entry in entries} == {(FIRST_OF_1980, 0o644, 0, "")}


@needs_cmake
@pytest.mark.skipif(shutil.which("readelf") is None, reason="there is no readelf, which lists symbols")
def test_the_shared_library_exports_what_the_header_declares_under_its_version(installed):
    table = quietly("readelf", "--dyn-syms", "--wide", installed / "lib" / "libhypcheck.so")
    exported = [line.split()[-1] for line in table.splitlines() if re.search(r" (GLOBAL|WEAK) +DEFAULT +\d+ ", line)]
    major = VERSION.partition(".")[0]
    assert sorted(exported) == sorted(f"{name}@@HYPCHECK_{major}" for name in declared())


@needs_cmake
def test_the_example_finds_the_installed_package(installed, tmp_path):
    source = ROOT / "packages" / "c" / "examples"
    quietly(CMAKE, "-S", source, "-B", tmp_path, f"-DCMAKE_PREFIX_PATH={installed}", "-DCMAKE_BUILD_TYPE=Debug")
    quietly(CMAKE, "--build", tmp_path)
    check_examples(tmp_path)


@pytest.mark.thorough
@needs_cmake
def test_the_example_fetches_the_archive(unpacked, tmp_path):
    source = ROOT / "packages" / "c" / "examples"
    archive = unpacked.parent / f"{unpacked.name}.tar.gz"
    quietly(CMAKE, "-S", source, "-B", tmp_path, f"-DHYPCHECK_URL={archive.as_uri()}")
    quietly(CMAKE, "--build", tmp_path)
    check_examples(tmp_path)


@needs_cmake
@pytest.mark.skipif(shutil.which("pkg-config") is None, reason="there is no pkg-config")
def test_the_example_is_built_with_what_pkg_config_says(installed, tmp_path):
    environment = {"PKG_CONFIG_PATH": str(installed / "lib" / "pkgconfig"), "PATH": "/usr/bin:/bin"}
    assert quietly("pkg-config", "--modversion", "hypcheck", env=environment).strip() == VERSION
    options = quietly("pkg-config", "--cflags", "--libs", "hypcheck", env=environment).split()
    for compiler, source, name in (("cc", "example.c", "example"), ("c++", "example.cpp", "example_cpp")):
        path = ROOT / "packages" / "c" / "examples" / source
        quietly(compiler, path, "-o", tmp_path / name, *options, f"-Wl,-rpath,{installed / 'lib'}")
    check_examples(tmp_path)


@pytest.mark.thorough
@needs_cmake
@pytest.mark.slow
def test_the_installed_library_passes_the_gate(unpacked, tmp_path):
    library = installed_in(tmp_path, unpacked) / "lib" / "libhypcheck.so"
    options = ("--count", "0", "--out", tmp_path / "report")
    out = quietly(sys.executable, "-m", "hypcheck", "verify", f"library:{library}", *options, cwd=tmp_path)
    assert re.match(r"HELD: libhypcheck.so: [1-9],\d{3} judged: ", out)
