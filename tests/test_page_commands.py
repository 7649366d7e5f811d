"""Whoever types the commands of a page, from an installed wheel in an empty folder, sees what the page shows.

What is not typed is listed below, with its reason: a line that fits no command of any page is an error. Of such
commands, and of those within sentences, the options are looked at.
"""

from __future__ import annotations

import os
import re
import shlex
import subprocess

import pytest

from hypcheck.cli.main import main
from tests.support.installed import VARIANTS, installation
from tests.support.pages import PAGES, ROOT, Typed, Written, commands_in_prose, parts, prints
from tests.support.transcripts import UNDRAWN

LIBRARY = "hypcheck emit --method exact --language c --output of.c && cc -O0 -fPIC -shared of.c -lm -o {name}"
ADAPTER = (
    "hypcheck init --language c && cc -O0 hypcheck-c/adapter.c hypcheck-c/predicate.c -o {name} && rm hypcheck.toml"
)
RUN = (
    '([ -d "$HOME/run" ] || hypcheck verify builtin:fast --families tower-body --count 2 --out "$HOME/run") && '
    'mkdir -p "$(dirname {name})" && cp -r "$HOME/run" {name}'
)
"""One run, which every page that takes a run for granted gets a copy of."""

DRONE = '"[[hyperboloid]]" "alpha = 2" "gamma = 17.8" "[mover]" "b = 0.25" "d = 0.15" "axis = [0.1, 0, 1]"'
SPANS = '"[region]" "x = [-3, 3]" "y = [-3, 3]" "z = [-9, 9]"'
GIVEN = {
    "./libcollide.so": LIBRARY,
    "./libpredicate.so": LIBRARY,
    "./adapter": ADAPTER,
    "drone.toml": f"printf '%s\\n' 'name = \"drone\"' {DRONE} {SPANS} > {{name}}",
    "forest.toml": "hypcheck simulate forest --show-scene > {name}",
    "two-trees.toml": f"cp '{ROOT}/docs/simulate/two-trees.toml' {{name}}",
    "example.c": "cp \"$(hypcheck info | sed -n 's/^C header *//p')\" .",
    "reports/latest": RUN,
    "new": RUN,
    "old": RUN,
    "reports/bench": f"mkdir -p reports && cp -r '{ROOT}/reports/reference/bench' {{name}}",
    "damaged.jsonl": f"{RUN.format(name='cut')} && sed 3d cut/record.jsonl > {{name}}",
}
"""What a page takes for granted that its reader has, and how it is made here before the first command that names it."""

CLONE = "it is for a clone of the repository"
MINUTES = "it takes minutes, and tests/bench runs its like"
OTHER_COMPILER = "tests/tools/processors calls these compilers, which few machines have"
INTERRUPTED = "a person presses Ctrl-C; tests/runs/resume does the same by a signal"
NOT_TYPED = {
    ".venv/bin/": CLONE,
    "make ": CLONE,
    "python -m tests": CLONE,
    "python -m packages": CLONE,
    "hypcheck bench": MINUTES,
    "hypcheck engines install": "it needs package indexes",
    "hypcheck engines verify": "it needs engines; tests/engines asks them",
    "hypcheck engines bench": "it needs engines; tests/engines asks them",
    "hypcheck cases check --checker coq": "it needs what Coq made; tests/proofs runs it",
    "hypcheck verify library:./libpredicate.so --count 1000000": INTERRUPTED,
    "hypcheck verify library:./libcollide.so --count 1e9 --cluster tcp:": "it needs a cluster",
    "hypcheck simulate tower --pitch 20 --runs 200": "it takes a quarter of an hour",
    "pip ": "it needs the package index",
    "python ompl_forest.py": "it is a file of examples/; tests/examples runs it",
    "python optimise_flight.py": "it is a file of examples/; tests/examples runs it",
    "c++ ": "it compiles a file of examples/; tests/examples does",
    "python3 -m venv": CLONE,
    "jq ": "it is not a program of ours, and not everywhere",
    **dict.fromkeys(("aarch64-", "arm-", "riscv64-", "s390x-", "i686-", "clang --target=wasm32"), OTHER_COMPILER),
}
"""How commands begin that are not typed, and why. The longest beginning here or in LONG is the one that holds."""

LONG = {
    "hypcheck derive": "15 s",
    "hypcheck simulate tower --table 5": "15 s",
    "hypcheck simulate tower --pitch 20": "30 s",
    "hypcheck bench --quick": "half a minute",
    "hypcheck simulate tower": "4 s; tests/transcripts simulates the forest",
    "hypcheck simulate forest --continuous": "2 s; tests/paper simulates the same",
    "hypcheck verify library:./kernel.so": "6 s; tests/kernel/emission asks the same",
    "hypcheck verify library:./pair.so --families '*'": "10 s; tests/kernel/emission asks the same",
}
"""How commands begin that `make thorough` types and `make test` does not, and how long one takes."""

FEW = "--count 20 --families tower-body"
SHORTER = {"--count 1e9": FEW, "--cluster local:4": f"--cluster local:1 {FEW}", "--workers 8": "--workers 2"}
SHORTER["--budget 2"] = "--queries 2500"
SHORTER |= dict.fromkeys(("cc -O3", "cc -std=c99 -O2"), "cc -O0")
"""Words that are replaced in what is typed, since what they ask for takes hours, or all of a machine, or optimises what
is hardly asked, or depends on the machine's speed."""

WHOLE = {"hypcheck verify": f"hypcheck verify {FEW}"}
"""Whole commands that are replaced: what the settings name is asked little."""

DRAWN = ROOT / "docs" / "reports.md"
"""The page that is typed with the libraries that draw: drawing takes most of a small run."""

TEXTS = {page: page.read_text(encoding="utf-8") for page in PAGES}
TYPED = {page: [part for part in parts(text) if isinstance(part, Typed)] for page, text in TEXTS.items()}
COMMANDS = {part.words for found in TYPED.values() for part in found}


def held(words):
    """The entry that holds for a command, of those that are not typed, or not by `make test`; None: it is typed."""
    return max((begin for begin in (*NOT_TYPED, *LONG) if words.startswith(begin)), key=len, default=None)


def is_typed(words, thorough):
    entry = held(words)
    return entry is None or (entry in LONG and thorough)


def pages_to_type():
    """Each page with commands; once more, for `make thorough`, those with long ones."""
    for page, found in TYPED.items():
        name = page.relative_to(ROOT).as_posix()
        if any(is_typed(part.words, thorough=False) for part in found):
            yield pytest.param(page, False, id=name)
        if any(held(part.words) in LONG for part in found):
            yield pytest.param(page, True, id=f"{name}-thorough", marks=pytest.mark.thorough)


@pytest.fixture(scope="module")
def environment(tmp_path_factory):
    """The variables of a user into whose environment the wheel was installed with all extras."""
    installed = installation(VARIANTS[0], tmp_path_factory)
    home = tmp_path_factory.mktemp("home")
    variables = {name: text for name, text in installed.variant.environment.items() if not name.startswith("XDG_")}
    return variables | {"PATH": f"{installed.user}/bin{os.pathsep}{os.environ['PATH']}", "HOME": str(home)}


def give(words, folder, environment):
    """Make what the command takes for granted, unless the page has made it."""
    for name, command in GIVEN.items():
        named = re.search(rf"(?:^|[\s:=]){re.escape(name)}(?:[\s/]|$)", words)
        made = folder / ("hypcheck.h" if name == "example.c" else name)
        if named and not made.exists():
            bash(command.format(name=name), folder, environment, check=True)


def bash(command, folder, environment, *, check=False):
    return subprocess.run(
        ["/bin/bash", "-c", command], cwd=folder, env=environment, capture_output=True, text=True, check=check
    )


@pytest.mark.parametrize(("page", "thorough"), list(pages_to_type()))
def test_the_commands_of_a_page_end_and_print_as_it_shows(page, thorough, environment, tmp_path):
    if page != DRAWN:
        (tmp_path / "undrawn").mkdir()
        (tmp_path / "undrawn/sitecustomize.py").write_text(UNDRAWN, encoding="utf-8")
        environment = environment | {"PYTHONPATH": str(tmp_path / "undrawn")}
    for part in parts(TEXTS[page]):
        if isinstance(part, Written):
            (tmp_path / part.name).write_text(part.text, encoding="utf-8")
        elif is_typed(part.words, thorough):
            give(part.words, tmp_path, environment)
            command = WHOLE.get(part.words, part.command)
            for long, short in SHORTER.items():
                command = command.replace(long, short)
            done = bash(command, tmp_path, environment)
            assert done.returncode == part.code, f"{command}\n{done.stdout}{done.stderr}"
            assert prints(done.stdout, part.shown), f"{command}\n{done.stdout}"


def test_every_line_about_commands_that_are_not_typed_as_printed_fits_a_command_of_a_page():
    entries = {held(words) for words in COMMANDS}
    assert [begin for begin in (*NOT_TYPED, *LONG) if begin not in entries] == []
    assert [words for words in WHOLE if words not in COMMANDS] == []
    assert [long for long in SHORTER if not any(long in words for words in COMMANDS)] == []
    words = " ".join(COMMANDS)
    assert [name for name in GIVEN if name not in words] == []


def options_alone(words):
    """The command with --help, so that its name and its options are looked at, and no more."""
    split = [word for word in shlex.split(words) if "=" not in word or word.startswith("-")]
    return [*split[1:], *(["VALUE"] if split[-1].startswith("--") else []), "--help"]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_command_of_hypcheck_on_a_page_has_a_name_and_options_that_exist(page, capsys):
    untyped = [part.words.split("&&")[0] for part in TYPED[page] if not is_typed(part.words, thorough=False)]
    named = [words.removeprefix(".venv/bin/") for words in untyped] + commands_in_prose(TEXTS[page])
    wrong = [words for words in named if words.startswith("hypcheck ") and main(options_alone(words)) != 0]
    assert wrong == [], capsys.readouterr().err


@pytest.mark.parametrize(
    ("shown", "found"),
    [
        (["a…", "c"], True),
        (["…", "c"], True),
        (["a b", "…"], True),
        (["a b", "…", "c"], True),
        ([], True),
        (["a b"], False),
        (["c"], False),
        (["…c"], False),
        (["c", "a b"], False),
        (["a…"], False),
    ],
)
def test_check_of_pages_finds_output_that_a_page_does_not_show(shown, found):
    assert prints("a b\nc\n", tuple(shown)) == found


def test_every_block_of_a_page_with_a_command_of_hypcheck_has_a_prompt_before_it():
    bare = re.compile(r"^    (?:hypcheck|\.venv/bin/\w+|make|pip|python3?) [^—\n]*$", re.MULTILINE)
    told = {page.name: bare.findall(text) for page, text in TEXTS.items()}
    assert {name: lines for name, lines in told.items() if lines} == {}
