"""The environment of an isolated program, by exact names, and texts in which secrets of ours are masked.

A prefix would let through what nobody thought of: GOOGLE_PIN begins like GOPATH, REDIS_URL like R_HOME.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence

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
"""Environment variables that the system, languages and numerical libraries read, as their manuals list them; those are
left out in which addresses with passwords or options of package managers stand."""

MARK = re.compile(r"HYPCHECK_[0-9a-f]{32}")
"""The variable by which memory.py knows the processes of a program."""


def environment_of(environment: Mapping[str, str], scratch: str, passed: Sequence[str] = ()) -> dict[str, str]:
    """The variables that a program sees: VARIABLES and those of `passed`; its temporary files go to `scratch`."""
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
"""Keys and tokens that show what they are: of code hosts, package indexes, clouds; signed tokens; private keys."""

_SHORTEST, _SHORTEST_NAMED = 8, 5
"""Characters of a value that is masked where it stands in a text; a shorter one stands in too many."""


def masked(text: str) -> str:
    """The text of a program, with MASK for what looks like a secret.

    That is the value of a variable of this process that is not one of VARIABLES and looks like one, a password in an
    address, and a key or token that shows what it is. A program that wants to tell a secret can write it otherwise.
    """
    for secret in sorted(_secrets(os.environ), key=len, reverse=True):
        text = text.replace(secret, MASK)
    return _KNOWN.sub(MASK, _IN_ADDRESS.sub(MASK, text))


def _secrets(environment: Mapping[str, str]) -> Iterator[str]:
    for name, value in environment.items():
        if name in VARIABLES or MARK.fullmatch(name):
            continue
        yield from _IN_ADDRESS.findall(value)
        if _looks_secret(name, value) and not os.path.exists(value):
            yield value


def _looks_secret(name: str, value: str) -> bool:
    """Whether a variable is named like a secret, or its value is long and neither a word nor a number."""
    if _SECRET.search(name):
        return len(value) >= _SHORTEST_NAMED
    letter, digit = (any(map(kind, value)) for kind in (str.isalpha, str.isdigit))
    return len(value) >= _SHORTEST and letter and digit and not any(map(str.isspace, value))
