"""Starts a foreign program, isolated as far as this system allows, and ends it with everything that it started.

What this system offers is tried first, and answers `--isolate`: auto, on or off. The launcher (launcher.c) is a C
program that is compiled with the package: it runs between the start of a process and that of the program, and Python
would take five times as long there. No library on the package index does all of this; bubblewrap, the most similar
program, is on few machines, and supports neither Landlock nor a filter of its own.

An isolated program sees only some folders and files, and some environment variables, by exact names: a prefix would
also allow unexpected variables, since GOOGLE_PIN begins like GOPATH, and REDIS_URL like R_HOME. In texts of the program
the secrets of our environment are masked.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

from hypcheck.errors import Exit, HypcheckError, InputError, limit_reached
from hypcheck.isolation import view

MODES = ("auto", "on", "off")

LAUNCHER = Path(__file__).with_name("launcher")


class NotIsolatedError(HypcheckError):
    """`--isolate on` where the system cannot isolate a program; the sentence says what is missing."""

    exit_code = Exit.NOT_STARTED


@dataclass(frozen=True, slots=True)
class Means:
    """The means that isolate programs here, and those that are missing.

    namespaces: user, PID, network, IPC, host name and mount namespaces.
    landlock: the version of Landlock, 0 where there is none.
    seccomp: the filter of system calls.
    missing: why a means is missing, each as the part of a sentence.
    """

    namespaces: bool = False
    landlock: int = 0
    seccomp: bool = False
    missing: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the available means."""
        landlock = f"Landlock {self.landlock}"
        named = {"namespaces": self.namespaces, landlock: bool(self.landlock), "seccomp": self.seccomp}
        return tuple(name for name, there in named.items() if there)

    @property
    def whole(self) -> bool:
        """Whether nothing that `--isolate on` promises is missing; namespaces do all that Landlock does."""
        return self.namespaces and self.seccomp

    @property
    def word(self) -> str:
        """The isolation of a program here, in words: "isolated", "partly isolated" or "not isolated"."""
        return isolation_word(self.names)


def isolation_word(means: Sequence[str]) -> str:
    """Return the isolation of a program with these means, in words: "isolated", "partly isolated" or "not isolated"."""
    return "isolated" if {"namespaces", "seccomp"} <= {*means} else "partly isolated" if means else "not isolated"


def isolation_text(means: Sequence[str], missing: Sequence[str]) -> str:
    """Return the end of "it is": isolated or partly isolated, by these means, and why others are missing.

    If a program is only partly isolated, the missing means come first.
    """
    word, reasons = isolation_word(means), "; ".join(missing)
    by = f"by {', '.join(means[:-1])}{' and ' if means[1:] else ''}{means[-1]}" if means else ""
    if word == "partly isolated":
        return f"{word}: {'; '.join(filter(None, (reasons, by)))}"
    return f"{word} {by}".strip() + (f" ({reasons})" if reasons else "")


OFF = Means(missing=("--isolate is off",))


def means_of(mode: str, here: Means | None = None) -> Means:
    """Return the means by which programs are isolated in this mode.

    `here` are the available means, by default this system's.

    Raises NotIsolatedError if the mode is "on" and something is missing.
    """
    if mode == "off":
        return OFF
    available_here = available() if here is None else here
    if mode == "on" and not available_here.whole:
        raise NotIsolatedError(
            f"--isolate is on, and this system cannot isolate a program: {'; '.join(available_here.missing)}; "
            "--isolate auto uses what there is"
        )
    return available_here


@lru_cache
def available() -> Means:
    """Return the means that this system allows.

    They are tried once, since only a trial shows whether a system call is allowed.
    """
    if sys.platform != "linux":
        return Means(missing=(f"{sys.platform} has no namespaces, no Landlock and no seccomp",))
    if not os.access(LAUNCHER, os.X_OK):
        return Means(missing=("the launcher was not compiled: hypcheck was installed without a C compiler",))
    try:
        text = subprocess.run((LAUNCHER, "--probe"), capture_output=True, check=True, timeout=20).stdout.decode()  # noqa: S603
    except (OSError, subprocess.SubprocessError) as error:
        return Means(missing=(f"the launcher does not run here: {error}",))
    probed = dict(line.partition(" ")[::2] for line in text.splitlines())
    failed = tuple(f"no {name}: {probed[name]}" for name in ("namespaces", "landlock", "seccomp") if probed.get(name))
    return Means(
        namespaces=not probed.get("namespaces", "?"),
        landlock=int(probed.get("abi", "0")),
        seccomp=not probed.get("seccomp", "?"),
        missing=failed,
    )


_NAMES = """
PATH HOME USER LOGNAME SHELL PWD TERM TZ TZDIR LANG LANGUAGE LC_ALL LC_ADDRESS LC_COLLATE LC_CTYPE LC_IDENTIFICATION
LC_MEASUREMENT LC_MESSAGES LC_MONETARY LC_NAME LC_NUMERIC LC_PAPER LC_TELEPHONE LC_TIME
LD_LIBRARY_PATH LD_PRELOAD LD_BIND_NOW GLIBC_TUNABLES MALLOC_ARENA_MAX MALLOC_CHECK_ MALLOC_PERTURB_
MALLOC_TRIM_THRESHOLD_ MALLOC_MMAP_THRESHOLD_ MALLOC_CONF
ASAN_OPTIONS ASAN_SYMBOLIZER_PATH LSAN_OPTIONS MSAN_OPTIONS MSAN_SYMBOLIZER_PATH TSAN_OPTIONS UBSAN_OPTIONS
OMP_NUM_THREADS OMP_DYNAMIC OMP_PLACES OMP_PROC_BIND OMP_SCHEDULE OMP_STACKSIZE OMP_THREAD_LIMIT OMP_WAIT_POLICY
OMP_MAX_ACTIVE_LEVELS OMP_NESTED OMP_DISPLAY_ENV GOMP_CPU_AFFINITY GOMP_SPINCOUNT GOMP_STACKSIZE
KMP_AFFINITY KMP_BLOCKTIME KMP_DUPLICATE_LIB_OK KMP_INIT_AT_FORK KMP_SETTINGS KMP_STACKSIZE KMP_WARNINGS
MKL_NUM_THREADS MKL_DYNAMIC MKL_CBWR MKL_ENABLE_INSTRUCTIONS MKL_INTERFACE_LAYER MKL_THREADING_LAYER MKL_VERBOSE
OPENBLAS_NUM_THREADS OPENBLAS_CORETYPE OPENBLAS_VERBOSE BLIS_NUM_THREADS BLIS_ARCH_TYPE VECLIB_MAXIMUM_THREADS
RAYON_NUM_THREADS RAYON_RS_NUM_THREADS TBB_NUM_THREADS UV_THREADPOOL_SIZE
PYTHONPATH PYTHONHOME PYTHONUSERBASE PYTHONNOUSERSITE PYTHONSAFEPATH PYTHONSTARTUP PYTHONPLATLIBDIR PYTHONEXECUTABLE
PYTHONHASHSEED PYTHONUNBUFFERED PYTHONDONTWRITEBYTECODE PYTHONPYCACHEPREFIX PYTHONOPTIMIZE PYTHONUTF8 PYTHONIOENCODING
PYTHONCOERCECLOCALE PYTHONWARNINGS PYTHONFAULTHANDLER PYTHONMALLOC PYTHONMALLOCSTATS PYTHONDEVMODE PYTHONDEBUG
PYTHONVERBOSE PYTHONTRACEMALLOC PYTHONPROFILEIMPORTTIME PYTHONASYNCIODEBUG PYTHONBREAKPOINT PYTHONINTMAXSTRDIGITS
PYTHONNODEBUGRANGES PYTHONPERFSUPPORT PYTHON_COLORS PYTHON_CPU_COUNT PYTHON_FROZEN_MODULES PYTHON_GIL PYTHON_JIT
VIRTUAL_ENV CONDA_PREFIX CONDA_DEFAULT_ENV CONDA_EXE CONDA_PYTHON_EXE CONDA_SHLVL PYENV_ROOT PYENV_VERSION
NPY_DISABLE_CPU_FEATURES NPY_PROMOTION_STATE NUMEXPR_NUM_THREADS NUMEXPR_MAX_THREADS
NUMBA_NUM_THREADS NUMBA_CACHE_DIR NUMBA_CPU_FEATURES NUMBA_CPU_NAME NUMBA_DEBUG NUMBA_DISABLE_JIT NUMBA_OPT
NUMBA_THREADING_LAYER JAX_ENABLE_X64 JAX_PLATFORMS JAX_PLATFORM_NAME JAX_DISABLE_JIT XLA_FLAGS
XLA_PYTHON_CLIENT_PREALLOCATE XLA_PYTHON_CLIENT_MEM_FRACTION CUDA_VISIBLE_DEVICES CUDA_HOME CUDA_PATH
CLASSPATH JAVA_HOME JDK_HOME JRE_HOME JAVA_OPTS JAVA_TOOL_OPTIONS JDK_JAVA_OPTIONS _JAVA_OPTIONS
GOPATH GOROOT GOBIN GOMAXPROCS GOGC GOMEMLIMIT GODEBUG GOTRACEBACK GORACE GOCOVERDIR GOAMD64 GOARM64
RUST_BACKTRACE RUST_LIB_BACKTRACE RUST_LOG RUST_MIN_STACK RUSTUP_HOME RUSTUP_TOOLCHAIN CARGO_HOME CARGO_MANIFEST_DIR
NODE_PATH NODE_OPTIONS NODE_ENV NODE_NO_WARNINGS NODE_DISABLE_COLORS NODE_ICU_DATA NODE_PENDING_DEPRECATION NVM_DIR
JULIA_NUM_THREADS JULIA_NUM_GC_THREADS JULIA_DEPOT_PATH JULIA_LOAD_PATH JULIA_PROJECT JULIA_CPU_TARGET JULIA_BINDIR
JULIA_EXCLUSIVE JULIA_HISTORY JULIA_PKG_OFFLINE
OCAMLPATH OCAMLLIB OCAMLRUNPARAM CAMLRUNPARAM CAML_LD_LIBRARY_PATH OPAMROOT OPAMSWITCH OPAM_SWITCH_PREFIX
GHCRTS GHC_PACKAGE_PATH ERL_LIBS ERL_FLAGS ERL_AFLAGS ERL_ZFLAGS ERL_MAX_PORTS
DOTNET_ROOT DOTNET_ROOT_X64 DOTNET_ROOT_ARM64 DOTNET_CLI_HOME DOTNET_CLI_TELEMETRY_OPTOUT DOTNET_NOLOGO
DOTNET_ROLL_FORWARD DOTNET_SYSTEM_GLOBALIZATION_INVARIANT DOTNET_gcServer DOTNET_gcConcurrent DOTNET_GCHeapCount
DOTNET_GCHeapHardLimit DOTNET_TieredCompilation DOTNET_TieredPGO DOTNET_ReadyToRun DOTNET_PROCESSOR_COUNT
LUA_PATH LUA_CPATH LUA_INIT PERL5LIB PERL5OPT PERL_HASH_SEED PERL_PERTURB_KEYS RUBYLIB RUBYOPT RUBY_YJIT_ENABLE
GEM_HOME GEM_PATH BUNDLE_GEMFILE R_HOME R_LIBS R_LIBS_SITE R_LIBS_USER R_ENVIRON R_PROFILE R_MAX_VSIZE
"""

VARIABLES = frozenset(_NAMES.split())
"""Environment variables that the system, languages and numerical libraries read, as their manuals list them, except
those that may contain addresses with passwords or options of package managers."""

MARK = re.compile(r"HYPCHECK_[0-9a-f]{32}")
"""The variable by which memory.py recognises the processes of a program."""


def environment_of(environment: Mapping[str, str], scratch: str, passed: Sequence[str] = ()) -> dict[str, str]:
    """Return the variables that a program sees: VARIABLES and those of `passed`.

    Its temporary files go to `scratch`.
    """
    seen = {*VARIABLES, *passed}
    kept = {name: value for name, value in environment.items() if name in seen or MARK.fullmatch(name)}
    return {**kept, "TMPDIR": scratch, "XDG_CACHE_HOME": scratch, "DOTNET_EnableDiagnostics": "0"}


MASK = "***"

_SECRET = re.compile(r"TOKEN|SECRET|PASS|PWD|_PW|_PAT\b|CRED|AUTH|PRIVATE|KEY|DSN|_PIN\b|COOKIE|LICENSE", re.IGNORECASE)
"""Names of variables whose values are secret, however simple."""

_IN_ADDRESS = re.compile(r"(?<=://)[^\s/@:]*:([^\s/@]+)(?=@)")
_KNOWN = re.compile(
    r"\b(?:gh[a-z]_|github_pat_|glpat-|npm_|pypi-|xox[a-z]-|sk-|AKIA|ASIA|AIza|hf_)[\w-]{12,}"
    r"|\beyJ[\w-]{10,}\.[\w-]{10,}\.[\w-]*|-----BEGIN [A-Z ]*PRIVATE KEY-----[\s\S]*?(?:KEY-----|\Z)"
)
"""Keys and tokens with a recognisable form: of code hosts, package indexes, clouds; signed tokens; private keys."""

_SHORTEST, _SHORTEST_NAMED = 8, 5
"""Least length of a value that is masked in a text; a shorter one occurs in too many texts by chance."""


def masked(text: str) -> str:
    """Return the text of a program, in which MASK replaces each part that looks like a secret.

    These are values of variables of this process that are not in VARIABLES and look like secrets, passwords in
    addresses, and keys or tokens of a known form. A program can still reveal a secret if it writes it in another form.
    """
    for secret in _secrets(tuple(os.environ.items())):
        text = text.replace(secret, MASK)
    return _KNOWN.sub(MASK, _IN_ADDRESS.sub(MASK, text))


@lru_cache(maxsize=1)  # a program may say something of every row
def _secrets(variables: tuple[tuple[str, str], ...]) -> tuple[str, ...]:
    """Return the secrets in the values of variables, the longest first, since it may contain another."""
    secrets: set[str] = set()
    for name, value in variables:
        if name in VARIABLES or MARK.fullmatch(name):
            continue
        secrets.update(_IN_ADDRESS.findall(value))
        if _looks_secret(name, value) and not os.path.exists(value):
            secrets.add(value)
    return tuple(sorted(secrets, key=lambda secret: (-len(secret), secret)))


def _looks_secret(name: str, value: str) -> bool:
    """Whether a variable is named like a secret, or its value is long and neither a word nor a number."""
    if _SECRET.search(name):
        return len(value) >= _SHORTEST_NAMED
    letter, digit = (any(map(kind, value)) for kind in (str.isalpha, str.isdigit))
    return len(value) >= _SHORTEST and letter and digit and not any(map(str.isspace, value))


THREADS = 1024
"""Processes and threads of a program: the Java machine starts one for each processor, twice."""

DESCRIPTORS = 4096
"""The most files that a program may have open."""

SCRATCH_BYTES = 256 << 20
"""The size of the scratch folder in bytes; if it is not a separate folder in memory, of each file in it."""

_END_S = 2.0
"""How many seconds an isolated program may take to end, after which we no longer wait for it."""

VARIABLE = "HYPCHECK_ISOLATE"
"""The environment variable with the mode that holds if `--isolate` is not given."""


def usual_mode() -> str:
    """Return the default mode."""
    return os.environ.get(VARIABLE) or "auto"


class IsolationError(Exception):
    """The launcher could not isolate the program; the text says which step failed."""


@dataclass(frozen=True, slots=True)
class Isolation:
    """The isolation of foreign programs: its mode, and what they may see.

    mode: one of MODES. hidden: paths that they must not see. variables: names of environment variables that they see
    beyond those of runtimes. seen: paths that they see beyond what they need. here: the means of this system, or None
    to find them out by a trial. threads and scratch_bytes: limits of a program.
    """

    mode: str = field(default_factory=usual_mode)
    hidden: tuple[str, ...] = ()
    variables: tuple[str, ...] = ()
    seen: tuple[str, ...] = ()
    here: Means | None = None
    threads: int = THREADS
    scratch_bytes: int = SCRATCH_BYTES

    def __post_init__(self) -> None:
        if self.mode not in MODES:
            raise InputError(f"--isolate, or {VARIABLE}, is {self.mode!r}; it must be one of {', '.join(MODES)}")

    @property
    def means(self) -> Means:
        """The means that isolate programs here. Raises NotIsolatedError if the mode is "on" and one is missing."""
        return means_of(self.mode, self.here)


class Launched:
    """A started program, and the pipe that keeps it alive: when the pipe is closed, the launcher ends the program.

    Raises OSError if the system cannot run it, and IsolationError or NotIsolatedError if it cannot be isolated.
    `isolated` is false if this system or the mode isolates nothing. `revealed` are the files of this package that it
    needs to see.
    """

    def __init__(
        self, words: Sequence[str], environment: Mapping[str, str], isolation: Isolation, revealed: Sequence[str] = ()
    ) -> None:
        means = isolation.means
        self.isolated = bool(means.names)
        self._scratch: str | None = None
        self._life = -1
        if not self.isolated:
            self.process = _started(words, environment)
            return
        if not means.namespaces:
            self._scratch = tempfile.mkdtemp(prefix="hypcheck-scratch-")
        try:
            self._launch(words, environment, isolation, revealed)
        except BaseException:
            self._remove_scratch()
            raise

    def _launch(
        self,
        words: Sequence[str],
        environment: Mapping[str, str],
        isolation: Isolation,
        revealed: Sequence[str],
    ) -> None:
        """Start the program by the launcher. Raises OSError if it cannot run, or IsolationError."""
        needed = view.needed_paths(words, environment, isolation.seen)
        private = view.private_folders(needed)
        scratch = self._scratch or next((path for path in view.TEMPORARY if path in private), view.SHARED_MEMORY)
        hidden = view.hidden_paths(isolation.hidden, needed, isolation.seen)
        options = _options(isolation, scratch, needed, private, hidden, revealed)
        seen = environment_of(environment, scratch, isolation.variables)
        life, self._life = os.pipe()
        report, report_end = os.pipe()
        try:
            own = (LAUNCHER, *options, f"--life={life}", f"--report={report_end}", "--", *words)
            self.process = _started(own, seen, (life, report_end))
        except BaseException:
            os.close(report)
            self._end_life()
            raise
        finally:
            os.close(life)
            os.close(report_end)
        self._require_start(report)

    def _require_start(self, report: int) -> None:
        """Raise the error that the launcher reports, unless the program runs."""
        with open(report, "rb") as file:
            text = file.read().decode("utf-8", "replace")
        if not text:
            return
        self.end()
        self.process.communicate()
        number, _, text = text.partition(" ")
        error = OSError(int(number), os.strerror(int(number)))
        if text.startswith("exec "):
            raise error
        raise limit_reached(error) or IsolationError(text)

    def end(self) -> None:
        """End the program with everything that it started, if it is isolated."""
        self._end_life()
        if self.isolated:
            with suppress(subprocess.TimeoutExpired):
                self.process.wait(_END_S)
        self._remove_scratch()

    def _end_life(self) -> None:
        """Close the pipe that keeps an isolated program alive; a second call does nothing."""
        if self._life >= 0:
            os.close(self._life)
            self._life = -1

    def _remove_scratch(self) -> None:
        """Remove the scratch folder, if it is a separate folder."""
        if self._scratch is not None:
            shutil.rmtree(self._scratch, ignore_errors=True)
            self._scratch = None


def _started(
    words: Sequence[object], environment: Mapping[str, str], descriptors: tuple[int, ...] = ()
) -> subprocess.Popen[bytes]:
    """Start a process with three pipes, in a session of its own."""
    return subprocess.Popen(  # noqa: S603 - what the user asked to run
        [os.fspath(word) for word in words],  # type: ignore[call-overload]
        bufsize=0,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
        env=environment,
        pass_fds=descriptors,
    )


def _options(
    isolation: Isolation,
    scratch: str,
    needed: Sequence[str],
    private: Sequence[str],
    hidden: Sequence[str],
    revealed: Sequence[str],
) -> list[str]:
    """Return the options of the launcher, as launcher.c explains them.

    `scratch` is the folder for temporary files. The program sees the paths `needed`. Of the folders `private` it sees
    only the needed parts (view.private_folders). The paths `hidden` appear empty (view.hidden_paths), except for
    `revealed`, the files of this package that it needs.
    """
    means = isolation.means
    options = [f"--threads={isolation.threads}", f"--descriptors={DESCRIPTORS}", f"--bytes={isolation.scratch_bytes}"]
    options += ["--seccomp"] * means.seccomp + ["--landlock"] * bool(means.landlock)
    if means.namespaces:
        others = [folder for folder in private if folder != scratch]
        shown = [path for path in needed if any(view.within(path, folder) for folder in private)]
        options += ["--namespaces", f"--scratch={scratch}", "--read=/"]
        options += [f"--private={folder}" for folder in others] + [f"--show={path}" for path in shown]
        options += [f"--hide={path}" for path in hidden] + [f"--reveal={path}" for path in revealed]
        return options + [f"--write={folder}" for folder in (scratch, view.SHARED_MEMORY)]
    read, listed = view.readable_paths(
        hidden, (*private, "/dev"), needed
    )  # the launcher opens the devices that hold nothing
    read += revealed
    listed += [str(view.PACKAGE.parent)] if revealed else []  # Python lists it, to find this package there
    options += [f"--judge={os.getpid()}", f"--write={scratch}"]
    return options + [f"--read={path}" for path in read] + [f"--list={path}" for path in listed]
