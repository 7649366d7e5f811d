"""C code that this machine's compiler compiles: the methods, and the programs compared with the compiled kernel.

The methods are printed from the programs that numpy runs. Each method is two functions, for rows and for the centres of
one scene, in a table. A driver calls them through the table the requested number of times, so that neither Python nor
an optimiser affects the timing. What is no straight-line program is written by hand (templates/): the roots, and the
search of the dual form.
"""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from time import thread_time_ns
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.bench.loaded import EmptyCall, LoadedMethod, PreparedWork
from hypcheck.bench.procedures import CRAFT, MOVING, CraftPath, procedures_source
from hypcheck.bench.workloads import scene_of
from hypcheck.derivation.formulas import FORMULAS, REPAIRED, Formula
from hypcheck.derivation.program import cut
from hypcheck.errors import UnavailableError
from hypcheck.geometry.pair import Sizes
from hypcheck.geometry.rows import Columns, Positions, Rows
from hypcheck.implementations.alternatives import DISTANCES
from hypcheck.implementations.method import RECIPROCAL, Answers, parts
from hypcheck.kernel import core
from hypcheck.kernel.choice import choice
from hypcheck.kernel.choice import compiled as compiled_kernel
from hypcheck.kernel.compiled_kernel import in_parts
from hypcheck.kernel.emission.dialects import filled
from hypcheck.kernel.printing.languages import C_SUFFIXES, c_statements
from hypcheck.record.measurements import CompilerLine
from hypcheck.runs.timing import Clocked, clocked, clocked_in_c
from hypcheck.vectors.random_pairs import BODY, TOWER

FLAGS = ("-O3", "-march=native", "-std=c99", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math", "-fPIC")
"""No flag changes a result: no fast-math, no contraction. The last two let gcc vectorise comparisons."""

LISTED = ("table-2", "coefficients", "hessian", "shared", "local-maximum")
FORMATS = ("float32", "float64")

_SECONDS = 120
_INCLUDE = f"-I{core.__path__[0]}"


KERNEL_FLAGS = ("-O3", "-ffp-contract=fast", "-fPIC")
"""The flags of the package's own build (setup.py): the kernel selects its instruction set at run time, and its bounds
allow FMA."""

NUMBERS = {"float32": "float", "float64": "double", "longdouble": "long double"}
"""The C type of each format."""

DIGITS = {"float": "FLT_MANT_DIG", "double": "DBL_MANT_DIG", "long double": "LDBL_MANT_DIG"}
LEAST = {"float": "FLT_MIN", "double": "DBL_MIN", "long double": "LDBL_MIN"}

_TABLE_2 = FORMULAS["table-2"]
_CUBIC = Formula("cubic", "the cubic of Table 2", "position", _TABLE_2.program, "delta", "Table 2")


@dataclass(frozen=True)
class CMethod:
    """A method's name, and the code of its two functions: identifier(NAME) with _rows and _scene appended."""

    name: str
    code: str


def identifier(name: str) -> str:
    """Return a method's name as an identifier of C."""
    return name.replace("-", "_").replace(".", "_")


def of_formula(formula: Formula, format_name: str) -> CMethod:
    """Return a formula's printed program; steps that depend only on sizes come before the loop."""
    number = NUMBERS[format_name]
    outside, inside = parts(formula)
    known = tuple(step.name for step in outside.steps)
    return _method(
        f"{formula.name}-{format_name}",
        number,
        c_statements(outside, known, number=number),
        c_statements(inside, (formula.answer,), number=number),
        formula.answer,
    )


def trigonometric(format_name: str) -> CMethod:
    """Return the roots of g by the trigonometric form, only if Δ > 0.

    Decisions are as in implementations/alternatives.py.
    """
    number = NUMBERS[format_name]
    outside, inside = parts(_CUBIC)
    known = tuple(step.name for step in outside.steps)
    wanted = tuple(name for name in ("c0", "c1", "c2", "delta") if name not in known)
    roots = _template("trigonometric", number=number, suffix=C_SUFFIXES[number])
    statements = (*c_statements(inside, wanted, number=number), roots)
    before = c_statements(outside, known, number=number)
    return _method(f"trigonometric-{format_name}", number, before, statements, "side")


def dual(format_name: str) -> CMethod:
    """Return the dual form in C: the search of implementations/alternatives.py, then the rest of the program."""
    number = NUMBERS[format_name]
    program = cut(FORMULAS["dual"].program, DISTANCES, ("phi",))
    search = _template("dual", number=number, suffix=C_SUFFIXES[number], digits=DIGITS[number], least=LEAST[number])
    return _method(
        f"dual-{format_name}",
        number,
        (),
        (search, *c_statements(program, ("phi",), number=number)),
        "phi > 0 ? (lambda_ > 0) - (lambda_ < 0) : 0",
    )


def _method(name: str, number: str, before: Sequence[str], within: Sequence[str], answer: str) -> CMethod:
    """Return a method from its statements before the loop over centres and within it, and the expression of the answer.

    `number` is the C type of its numbers.
    """
    lines = {"before": "\n".join(before), "within": "\n".join(within)}
    return CMethod(name, _template("formula", name=identifier(name), number=number, answer=answer, **lines))


def _template(name: str, /, **marks: str) -> str:
    """Return the C code of that name in templates/, with its marks filled in."""
    return filled("hypcheck.bench", f"{name}.c.tmpl", marks)


@cache
def bodies() -> tuple[CMethod, ...]:
    """Return all methods in C; a method's place in the driver's table is its place here plus one.

    The first is the fast path as hypcheck.classify runs it if it was compiled.
    """
    fast = CMethod("fast", _template("fast"))
    listed = [of_formula(FORMULAS[name], format_name) for name in LISTED for format_name in FORMATS]
    roots = [trigonometric(format_name) for format_name in FORMATS]
    others = [of_formula(_TABLE_2, "longdouble"), of_formula(RECIPROCAL, "float64")]
    others.append(of_formula(REPAIRED["procedure-1-repaired"], "float64"))
    duals = [dual(format_name) for format_name in FORMATS]
    return (fast, *listed, *others, *roots, *duals)


def methods_source() -> str:
    """Return the file of all methods and procedures; the table of methods begins with one that does nothing."""
    names = [identifier(method.name) for method in bodies()]
    return _template(
        "methods",
        functions="\n".join(method.code for method in bodies()),
        rows=", ".join(f"{name}_rows" for name in names),
        scenes=", ".join(f"{name}_scene" for name in names),
        procedures=procedures_source(),
    )


def place_of(name: str) -> int:
    """Return a method's place in the table. Raises ValueError if it has none."""
    return [body.name for body in bodies()].index(name) + 1


def compiled(folder: Path) -> tuple[Path, CompilerLine]:
    """Return the library of the methods, compiled in a folder.

    Raises UnavailableError if no compiler can compile it.
    """
    code, methods, library = folder / "methods.c", folder / "methods.o", folder / "methods.so"
    code.write_text(methods_source(), encoding="ascii")
    with ThreadPoolExecutor(1) as beside:
        kernel = beside.submit(_kernel, folder)
        compiler = compile_c(code, methods, "-c")
    words = [compiler.program, "-shared", str(methods), kernel.result(), "-o", str(library), "-lm"]
    _require(run_compiler(words), f"link {library.name}")
    return library, compiler


def compile_c(code: Path, target: Path, how: str = "-shared") -> CompilerLine:
    """Compile a C file to a library, or as `how` says. Raises UnavailableError without a compiler."""
    program = compiler_here()
    tried = []
    for flags in (FLAGS, tuple(flag for flag in FLAGS if flag != "-march=native")):  # not every target has this flag
        tried.append(run_compiler([program, *flags, _INCLUDE, how, str(code), "-o", str(target), "-lm"]))
        if tried[-1].returncode == 0:
            break
    else:
        _require(tried[0], f"compile {code.name}")
    version = run_compiler([program, "--version"]).stdout.splitlines() or [""]
    return CompilerLine(program=program, version=version[0], flags=list(flags))


def _kernel(folder: Path) -> str:
    """Return the object file of the fast path."""
    program, code, target = compiler_here(), folder / "fast.c", folder / "fast.o"
    code.write_text('#define HYPCHECK_IMPLEMENTATION\n#include "hypcheck.h"\n', encoding="ascii")
    result = run_compiler([program, *KERNEL_FLAGS, _INCLUDE, "-c", str(code), "-o", str(target)])
    _require(result, "compile the fast path")
    return str(target)


def compiler_here() -> str:
    """Return the C compiler of this machine. Raises UnavailableError if there is none."""
    named = os.environ.get("CC", "")
    for name in (named, "cc", "gcc", "clang"):
        path = shutil.which(name) if name else None
        if path:
            return path
    raise UnavailableError("no C compiler is found (cc, gcc, clang, or what CC names)")


def run_compiler(words: list[str]) -> subprocess.CompletedProcess[str]:
    """Run the compiler. Raises UnavailableError if it cannot be run, or does not end in time."""
    try:
        return subprocess.run(words, capture_output=True, text=True, timeout=_SECONDS, check=False)  # noqa: S603
    except (OSError, subprocess.TimeoutExpired) as error:
        raise UnavailableError(f"{words[0]} cannot be run: {error}") from None


def _require(result: subprocess.CompletedProcess[str], what: str) -> None:
    """Raise UnavailableError if the compiler failed to do `what`."""
    if result.returncode != 0:
        first_line = (result.stderr.strip().splitlines() or ["it says nothing"])[0]
        raise UnavailableError(f"{result.args[0]} does not {what}: {first_line}")


_SIZE, _POINTER = ctypes.c_size_t, ctypes.c_void_p
_FUNCTIONS: Mapping[str, tuple[Any, tuple[Any, ...]]] = MappingProxyType(
    {
        "bench_rows": (None, (_SIZE, _SIZE, _SIZE, _POINTER, _POINTER)),
        "bench_single": (None, (_SIZE, _SIZE, _SIZE, _POINTER, _POINTER)),
        "bench_scene": (None, (_SIZE, _SIZE, _POINTER, _SIZE, *[_POINTER] * 4)),
        "bench_bodies": (None, (_SIZE, _SIZE, _POINTER, _SIZE, *[_POINTER] * 6)),
        "read_only": (ctypes.c_uint64, (_SIZE, *[_POINTER] * 3)),
        "read_over_and_over": (None, (_SIZE, _SIZE, *[_POINTER] * 3)),
        "products": (ctypes.c_uint32, (_SIZE, _POINTER, _POINTER)),
        "rows_over_and_over": (None, (_POINTER, _SIZE, _SIZE, _POINTER, _POINTER)),
        "over_and_over": (None, (_POINTER, _SIZE, _POINTER, _SIZE, *[_POINTER] * 4)),
        "plain": (None, (_POINTER, _SIZE, *[_POINTER] * 4)),
    }
)
"""The result and the arguments of each function in C, of whichever library has it."""


@cache
def _loaded(library: Path) -> ctypes.CDLL:
    """Load a library, and declare the functions that it has."""
    loaded = ctypes.CDLL(str(library))
    for name, (result, arguments) in _FUNCTIONS.items():
        if hasattr(loaded, name):
            function = getattr(loaded, name)
            function.restype, function.argtypes = result, arguments
    return loaded


@dataclass(frozen=True)
class InC(LoadedMethod):
    """A method of the library, by its place in the table; the method at place 0 does nothing."""

    library: Path
    place: int

    def answer(self, rows: Rows) -> Answers:
        """Return the method's answers, by the entry for rows."""
        return self._by_rows("bench_rows", rows).answers()

    def batch(self, rows: Rows) -> PreparedWork:
        """Return a call for all rows: the entry for scenes if the rows share their sizes, else the entry for rows."""
        sizes = scene_of(rows)
        if sizes is None:
            return self._by_rows("bench_rows", rows)
        function, answers = _loaded(self.library).bench_scene, np.zeros(len(rows), dtype=np.int8)
        parts: list[NDArray[np.float64]] = [np.array(sizes), *np.ascontiguousarray(rows[:, 4:].T)]
        fixed = _pointers(parts)

        def call(repeat: int) -> object:
            held = parts  # pointers would not keep the arrays alive
            return function(self.place, repeat, fixed[0], len(held[1]), *fixed[1:], answers.ctypes.data)

        return _prepared(call, answers)

    def single(self, rows: Rows) -> PreparedWork:
        """Return a call for each row, from C through the table of functions: the time that a C program would wait."""
        return self._by_rows("bench_single", rows)

    def empty(self, rows: Rows, mode: str) -> EmptyCall:
        """Return a function in C that does nothing."""
        nothing = InC(self.library, 0)
        return EmptyCall("C", nothing.single(rows) if mode == "single" else nothing._by_rows("bench_rows", rows[:1]))

    def _by_rows(self, name: str, rows: Rows) -> PreparedWork:
        """Prepare calls of a function about rows."""
        function, queries = getattr(_loaded(self.library), name), np.ascontiguousarray(rows)
        answers = np.zeros(len(queries), dtype=np.int8)

        def call(repeat: int) -> object:
            return function(self.place, repeat, len(queries), queries.ctypes.data, answers.ctypes.data)

        return _prepared(call, answers)


def bodies_asked(library: Path, place: int, flight: CraftPath) -> PreparedWork:
    """Return a quadcopter procedure, by its place in the C table of_bodies, called for each position of a flight."""
    craft = np.array([flight.craft[name] for name in CRAFT])
    columns = [np.ascontiguousarray(flight.columns[name]) for name in MOVING]
    answers = np.zeros(len(flight), dtype=np.int8)

    def call(repeat: int) -> object:
        moving = [column.ctypes.data for column in columns]
        return _loaded(library).bench_bodies(
            place, repeat, craft.ctypes.data, len(answers), *moving, answers.ctypes.data
        )

    return _prepared(call, answers)


def _prepared(call: Callable[[int], object], filled: Answers) -> PreparedWork:
    """Return prepared work: `call` runs it a number of times and fills the answers."""

    def answers() -> Answers:
        call(1)
        return filled

    return PreparedWork(len(filled), clocked_in_c(call, filled), answers)


WORDS = 40
"""How many 32-bit words the integers have whose product measures exact decisions. 1280 bits have room for the
discriminant of a row: it is of degree 24 in numbers of 53 bits that are alike in magnitude."""


def baselines_source() -> str:
    """Return the programs to compare with the compiled kernel: reading rows, long products, the uncertified Table 2.

    Other functions of the file call the kernel repeatedly.
    """
    return _template("baselines", words=str(WORDS), plain=of_formula(_TABLE_2, "float64").code)


BASELINE_FLAGS = ("-O3", "-std=c99", "-ffp-contract=fast", "-fno-math-errno", "-fno-trapping-math", "-fPIC")

LEVEL_FLAGS = {
    "avx512": (("-march=native", "-mprefer-vector-width=512"), ("-march=native", "-mprefer-vector-width=256")),
    "avx2": (("-mavx2", "-mfma", "-mbmi2"),),
    "sse2": ((),),
    "neon": ((),),
    "plain": ((),),
}
"""For each level of the kernel the flags for each width of vectors."""

TOWER_SIZES: Sizes = (*TOWER, *BODY)
"""α, γ, b, d of the scene in which the kernel is timed, the paper's cooling tower."""

_SIZES = np.array(TOWER_SIZES)


@dataclass(frozen=True)
class CBaseline:
    """A compiled library of the programs compared with the compiled kernel, with the flags of the compiler.

    It reads columns (x, y, z), each (n,), or classifies them in the scene of TOWER_SIZES; `out` (n,) takes answers.
    Callers must keep the arrays alive, because pointers do not.
    """

    library: ctypes.CDLL
    flags: tuple[str, ...]

    def read(self, columns: Columns, threads: int = 1, clock: Callable[[], int] = thread_time_ns) -> Clocked:
        """Read the columns, in threads that share them as the kernel does; one thread is timed by its CPU time."""

        def part(start: int, stop: int) -> int:
            return int(self.library.read_only(stop - start, *_pointers(column[start:] for column in columns))) & 0xFFFF

        return clocked(lambda: np.array([in_parts(part, len(columns[0]), threads)]), clock)

    def reading(self, columns: Columns) -> Callable[[int], None]:
        """Return a call that reads the columns the given number of times; meanwhile other Python threads can run."""
        function, pointers = self.library.read_over_and_over, _pointers(columns)
        return lambda times: function(times, len(columns[0]), *pointers)

    def product(self) -> Clocked:
        """Return a multiplication of long integers, half of the product: exact decisions consist of such products."""
        numbers = np.random.Generator(np.random.PCG64(1)).integers(1 << 31, 1 << 32, (2, WORDS), dtype=np.uint32)
        no_answers = np.zeros(0, dtype=np.int8)
        return clocked_in_c(lambda times: self.library.products(times, *_pointers(numbers)), no_answers, thread_time_ns)

    def of_rows(self, rows: Rows, out: Positions) -> Callable[[int], None]:
        """Return a call that runs the compiled kernel on rows the given number of times."""
        ask = ctypes.cast(ctypes.CDLL(str(compiled_kernel().__file__)).hypcheck_ask, _POINTER)
        function, pointers = self.library.rows_over_and_over, _pointers((rows, out))
        return lambda times: function(ask, times, len(rows), *pointers)

    def of_scene(self, columns: Columns, out: Positions) -> Callable[[int], None]:
        """Return a call that runs the compiled kernel the given number of times.

        Meanwhile other Python threads can run.
        """
        ask = ctypes.cast(ctypes.CDLL(str(compiled_kernel().__file__)).hypcheck_ask_scene, _POINTER)
        function, pointers = self.library.over_and_over, _pointers((*columns, out))
        return lambda times: function(ask, times, _SIZES.ctypes.data, len(out), *pointers)

    def plain(self, columns: Columns, out: Positions) -> Clocked:
        """Return the plain formula in one thread; the sum is the sum of its answers."""
        function, pointers = self.library.plain, _pointers((*columns, out))

        def work() -> Positions:
            function(_SIZES.ctypes.data, len(out), *pointers)
            return out

        return clocked(work, thread_time_ns)


def _pointers(arrays: Iterable[NDArray[Any]]) -> list[int]:
    """Return the addresses of arrays, which the caller must keep alive."""
    return [array.ctypes.data for array in arrays]


@cache
def c_baselines(folder: Path, level: str | None = None) -> list[CBaseline]:
    """Return a library for each vector width of the level (by default the kernel's level). They are compiled once.

    Raises UnavailableError if there is no compiler.
    """
    program, code = compiler_here(), folder / "baselines.c"
    code.write_text(baselines_source(), encoding="ascii")
    baselines = []
    for number, flags in enumerate(LEVEL_FLAGS[level or str(choice().level)]):
        library = folder / f"baselines-{number}.so"
        words = [program, *BASELINE_FLAGS, *flags, "-shared", str(code), "-o", str(library), "-lm"]
        if run_compiler(words).returncode == 0:
            baselines.append(CBaseline(_loaded(library), flags))
    if not baselines:
        raise UnavailableError(f"{program} does not compile the baselines in C")
    return baselines
