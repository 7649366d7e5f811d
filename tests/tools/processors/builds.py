"""The processors that hypcheck.h is compiled for, with what compiles a program for each and what runs it here."""

from __future__ import annotations

import platform
import shutil
import subprocess
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from tests.support.inside import core

HERE = Path(__file__).parent
HEADER_FOLDER = Path(core.__file__).parent
LEVELS = ("plain", "sse2", "avx2", "avx512", "neon")
"""In the order of program.c."""

MODES = ("to nearest", "upward", "downward", "towards zero", "24 bits", "53 bits")
"""In the order of program.c; the last two are the precision of x87."""

_WHOLE = ("-std=gnu99", "-O2", "-ffp-contract=fast")


@dataclass(frozen=True)
class Build:
    """A processor: its compiler and flags, what runs its programs, the Debian packages of both, and what it can do.

    `small` are the flags of a build for little memory. `modes` are those of MODES that the program can set.
    """

    name: str
    title: str
    compiler: str
    flags: tuple[str, ...]
    packages: tuple[str, ...]
    runner: tuple[str, ...] = ()
    order: Literal["<", ">"] = "<"
    modes: tuple[str, ...] = MODES[:4]
    levels: tuple[str, ...] = ("plain",)
    system: tuple[str, ...] = ("-static", "-lm")
    counts_stack: bool = True

    def tool(self, name: str) -> str:
        """The tool of that name, nm or size or ld, that comes with the compiler."""
        return self.compiler.removesuffix("gcc").removesuffix("cc") + name

    @property
    def tools(self) -> tuple[str, ...]:
        """The commands that must be there."""
        return (self.compiler, *self.runner[:1], *(("wasm-ld",) if self.compiler == "clang" else ()))

    @property
    def missing(self) -> tuple[str, ...]:
        """The commands that are not."""
        return tuple(tool for tool in self.tools if shutil.which(tool) is None)


def _cross(machine: str, emulator: str, packages: str) -> tuple[str, tuple[str, ...], tuple[str, ...]]:
    name = f"{machine}-gcc"
    return name, (emulator,) if emulator else (), (f"gcc-{machine}", packages, *(["qemu-user"] if emulator else []))


def _linux(name: str, title: str, machine: str, emulator: str, libc: str, *flags: str, **rest: object) -> Build:
    compiler, runner, packages = _cross(machine, emulator, libc)
    return Build(name, title, compiler, (*_WHOLE, *flags), packages, runner, **rest)  # type: ignore[arg-type]


_BARE = ("-ffreestanding", "-fbuiltin", f"-I{HERE / 'bare'}", "-DBARE")
_ON_X86 = "" if platform.machine() in ("x86_64", "i686") else "qemu-i386"

BUILDS = {
    build.name: build
    for build in (
        Build(
            "here",
            "this machine",
            "cc",
            _WHOLE,
            ("gcc", "libc6-dev"),
            levels=("plain",),
            system=("-lm",),
        ),
        _linux(
            "aarch64",
            "64-bit ARM with NEON",
            "aarch64-linux-gnu",
            "qemu-aarch64",
            "libc6-dev-arm64-cross",
            "-march=armv8-a",
            levels=("neon", "plain"),
        ),
        _linux(
            "armv7",
            "32-bit ARM, VFP with FMA",
            "arm-linux-gnueabihf",
            "qemu-arm",
            "libc6-dev-armhf-cross",
            "-march=armv7-a",
            "-mfpu=neon-vfpv4",
        ),
        _linux("riscv64", "RISC-V, rv64gc", "riscv64-linux-gnu", "qemu-riscv64", "libc6-dev-riscv64-cross"),
        _linux(
            "s390x",
            "IBM Z, big-endian",
            "s390x-linux-gnu",
            "qemu-s390x",
            "libc6-dev-s390x-cross",
            "-march=z14",
            order=">",
        ),
        _linux(
            "i686",
            "32-bit x86 with x87",
            "i686-linux-gnu",
            _ON_X86,
            "libc6-dev-i386-cross",
            "-march=pentium",
            "-mfpmath=387",
            "-mno-sse",
            modes=MODES,
        ),
        Build(
            "cortex-m4",
            "microcontroller, floats in software",
            "arm-none-eabi-gcc",
            (*_WHOLE, "-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", *_BARE),
            ("gcc-arm-none-eabi", "qemu-user"),
            ("qemu-arm", "-cpu", "max"),
            modes=MODES[:1],
            system=("-nostdlib", "-lgcc"),
        ),
        Build(
            "wasm32",
            "WebAssembly in node",
            "clang",
            ("-std=gnu99", "-O2", "--target=wasm32", "-mbulk-memory", *_BARE),
            ("clang", "lld", "nodejs"),
            ("node", "--no-warnings", str(HERE / "run.mjs")),
            modes=MODES[:1],
            system=("-nostdlib", "-Wl,--no-entry", "-Wl,-z,stack-size=1048576"),
            counts_stack=False,
        ),
    )
}


class BuildError(Exception):
    """A build that failed; the text is what the compiler said."""


def packages_for(builds: Iterable[Build]) -> list[str]:
    """The Debian packages of those that cannot be built or run here."""
    return list(dict.fromkeys(package for build in builds if build.missing for package in build.packages))


def run(command: Sequence[str | Path], folder: Path) -> str:
    """What a command prints. Raises BuildError where it fails."""
    done = subprocess.run([str(part) for part in command], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        raise BuildError(f"{' '.join(map(str, command))}\n{done.stderr[-2000:]}")
    return done.stdout


def program(build: Build, folder: Path, *, header: Path = HEADER_FOLDER) -> Path:
    """program.c compiled for the processor, in that folder."""
    target = folder / build.name
    sources = (f"-I{header}", f"-I{HERE}", HERE / "program.c")
    run((build.compiler, *build.flags, *sources, "-o", target, *build.system), folder)
    return target
