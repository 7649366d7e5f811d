"""Ships the folder cases/ inside the package, as hypcheck/cases, and compiles what is in C where there is a compiler.

The vectors are half of a wheel, so they are packed by xz there. Everything else is said in pyproject.toml.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext
from setuptools.command.build_py import build_py
from setuptools.modified import newer_group

lzma = None
with suppress(ImportError):  # some builds of Python lack it, and could not read what is packed
    import lzma

CASES = sorted(path for path in Path("cases").rglob("*") if path.is_file())


def packed_name(path: Path) -> Path:
    """The name of a file of cases/ in the package."""
    return path.with_name(f"{path.name}.xz") if lzma and path.match("cases/*.json") else path


class BuildWithCases(build_py):
    """build_py, and the vectors copied beside the modules. An editable install reads them where they stand."""

    def run(self) -> None:
        """Build as always, then copy."""
        super().run()
        if not self.editable_mode:
            for path, target in zip(CASES, self._targets(), strict=True):
                self.mkpath(str(target.parent))
                if target.suffix == ".xz":
                    target.write_bytes(lzma.compress(path.read_bytes()))
                else:
                    self.copy_file(str(path), str(target))

    def get_outputs(self, include_bytecode: bool = True) -> list[str]:
        """What is installed."""
        return [*super().get_outputs(include_bytecode), *map(str, self._targets())]

    def get_source_files(self) -> list[str]:
        """What a source distribution must have."""
        return [*super().get_source_files(), *map(str, CASES)]

    def _targets(self) -> list[Path]:
        return [Path(self.build_lib, "hypcheck", packed_name(path)) for path in CASES]


STRIPPED = ["-s"] if sys.platform == "linux" else []
"""Of a linker: no symbols that only a debugger reads, a third of the launcher."""

CORE = "hypcheck/kernel/core"
KERNEL = Extension(
    "hypcheck.kernel._compiled",
    sources=[f"{CORE}/binding.c"],
    depends=[f"{CORE}/{name}.h" for name in ("hypcheck", "columns", "at_once")],
    include_dirs=[CORE],
    # FMA may replace a product and a sum: the bounds hold with and without. Never -ffast-math: hypcheck.h refuses it.
    extra_compile_args=[] if os.name == "nt" else ["-O3", "-g0", "-ffp-contract=fast"],
    extra_link_args=STRIPPED,
    optional=True,  # without a compiler numpy gives the same answers; `hypcheck info` says which it is
)

CALLS = Extension(
    "hypcheck.implementations._calls",
    sources=["hypcheck/implementations/calls.c"],
    extra_link_args=STRIPPED,
    optional=True,  # without it ctypes makes the calls, and fewer of their leftovers are seen
)

ISOLATION = "hypcheck/isolation"
LAUNCHER = Extension(
    "hypcheck.isolation.launcher",
    sources=[f"{ISOLATION}/launcher.c"],
    depends=[f"{ISOLATION}/{name}.h" for name in ("filter", "landlock", "mounts")],
    optional=True,  # without it nothing is isolated, and each run says so
)


class BuildWithLauncher(build_ext):
    """build_ext, and the launcher, which is a program: it stands where the library of a module of its name would."""

    def get_ext_filename(self, fullname: str) -> str:
        """The file of a module; the launcher's has no ending."""
        if fullname.rpartition(".")[2] == "launcher":
            return os.path.join(*fullname.split("."))
        return super().get_ext_filename(fullname)

    def build_extension(self, ext: Extension) -> None:
        """Compile a module, or the launcher."""
        if ext is not LAUNCHER:
            super().build_extension(ext)
            return
        target = Path(self.get_ext_fullpath(ext.name))
        if not (self.force or newer_group([*ext.sources, *ext.depends], str(target), "newer")):
            return
        objects = self.compiler.compile(
            ext.sources, output_dir=self.build_temp, depends=ext.depends, extra_postargs=["-std=gnu11", "-O2", "-g0"]
        )
        self.mkpath(str(target.parent))
        self.compiler.link_executable(objects, target.name, output_dir=str(target.parent), extra_postargs=STRIPPED)


PURE = bool(os.environ.get("HYPCHECK_PURE"))
"""A wheel without compiled parts, for machines for which there is no other."""

setup(
    cmdclass={"build_py": BuildWithCases, "build_ext": BuildWithLauncher},
    ext_modules=[] if PURE else [KERNEL, CALLS, *([LAUNCHER] if sys.platform == "linux" else [])],
)
