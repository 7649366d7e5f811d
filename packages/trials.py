"""What a stranger types with each archive: installed in a fresh environment, one answer, one gate.

Each trial is a list of lines for a shell in an empty folder, each with what it must print. `$ARCHIVE` is the archive,
`$PYTHON` the Python that runs this, and `$GATE` its hypcheck, which gates what was installed.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import click
from packaging.tags import sys_tags
from packaging.utils import parse_wheel_filename

from packages.checks import archives

Line = tuple[str, str]
ASKED = "--families ring --count 0"
"""Of the gate: the frozen vectors of the family where published formulas err."""

_RUST = """pub const DESCRIPTION: &str = concat!(
    r#"{"protocol":1,"name":"crate","version":"1","language":"rust","precision":"float64","#,
    r#""question":"position","tilt":true,"binary":true,"time":true}"#
);

pub fn predicate(row: [f64; 7]) -> i8 {
    let mut answer = [0];
    hypcheck::classify(&[row], &mut answer);
    answer[0]
}

pub fn tilted(row: [f64; 10]) -> i8 {
    let mut answer = [0];
    hypcheck::classify_tilted(&[row], &mut answer);
    answer[0]
}
"""

_JAVASCRIPT = """import { classify } from "hypcheck";

export const description = {
  protocol: 1, name: "package", version: "1", language: "javascript", precision: "float64", question: "position",
  tilt: true, binary: true, time: true,
};
export const predicate = (...row) => classify(row)[0];
export const tilted = (...row) => classify(row, { width: 10 })[0];
"""

_ANSWER = """import { position } from "hypcheck";
console.log(position({ alpha: 2, gamma: 17.8, b: 0.25, d: 0.15 }, [2.2, 0, 1]));
"""

ADAPTERS = {"predicate.rs": _RUST, "predicate.mjs": _JAVASCRIPT, "answer.mjs": _ANSWER}
"""Files in the empty folder: what an adapter of `hypcheck init` asks, and one question to the package."""

_PYTHON_ASKED: list[Line] = [
    ("env/bin/hypcheck classify --alpha 1 --gamma 2 --b 1 --d 1 --center 2.5 0 0", "exterior"),
    ("env/bin/python -c 'import hypcheck; print(hypcheck.__file__)'", "site-packages"),
    (f"env/bin/hypcheck verify builtin:fast {ASKED}", "HELD"),
]


@dataclass(frozen=True)
class Trial:
    """Which archive is tried, as a pattern of its name, and the lines; of wheels it is the one for this Python."""

    archive: str
    lines: list[Line]


TRIALS = {
    "python": Trial(
        "hypcheck-*-cp*.whl",
        [("$PYTHON -m venv env && env/bin/pip install --quiet $ARCHIVE", ""), *_PYTHON_ASKED],
    ),
    "pure": Trial(
        "hypcheck-*-none-any.whl",
        [("$PYTHON -m venv env && env/bin/pip install --quiet $ARCHIVE", ""), *_PYTHON_ASKED],
    ),
    "sdist": Trial(
        "hypcheck-[0-9]*.tar.gz",
        [  # what it needs comes from the index; it is built without one
            ("tar xzOf $ARCHIVE --wildcards '*.egg-info/requires.txt' | sed '/^\\[/,$d' > needs.txt", ""),
            ("$PYTHON -m venv env && env/bin/pip install --quiet -r needs.txt tomli 'setuptools>=77'", ""),
            ("env/bin/pip install --quiet --no-index --no-build-isolation $ARCHIVE", ""),
            *_PYTHON_ASKED,
        ],
    ),
    "c": Trial(
        "hypcheck-c-*.tar.gz",
        [
            ("tar xzf $ARCHIVE --one-top-level=source --strip-components=1", ""),
            ("cmake -S source -B build -DCMAKE_INSTALL_PREFIX=$PWD/prefix -DCMAKE_INSTALL_LIBDIR=lib > log", ""),
            ("cmake --build build > log && cmake --install build > log", ""),
            ("cmake -S source/examples -B examples -DCMAKE_PREFIX_PATH=$PWD/prefix > log", ""),
            ("cmake --build examples > log && examples/example", "-1 0 1"),
            ("export PKG_CONFIG_PATH=$PWD/prefix/lib/pkgconfig LD_LIBRARY_PATH=$PWD/prefix/lib", ""),
            ("cc source/examples/example.c -o example $(pkg-config --cflags --libs hypcheck) && ./example", "-1 0 1"),
            (f"$GATE verify library:prefix/lib/libhypcheck.so {ASKED}", "HELD"),
        ],
    ),
    "rust": Trial(
        "hypcheck-rust-*.tar.gz",
        [
            ("tar xzf $ARCHIVE --one-top-level=crate --strip-components=1", ""),
            ("(cd crate && cargo package --quiet --allow-dirty && cargo test --quiet)", "test result: ok"),
            ("$GATE init --language rust --name crate", "Type next"),
            ("cp predicate.rs hypcheck-rust/src/predicate.rs", ""),
            ("cargo add --quiet --manifest-path hypcheck-rust/Cargo.toml --path crate hypcheck", ""),
            ("cargo build --quiet --manifest-path hypcheck-rust/Cargo.toml", ""),
            (f"$GATE verify command:hypcheck-rust/target/debug/hypcheck-adapter {ASKED}", "HELD"),
        ],
    ),
    "javascript": Trial(
        "hypcheck-javascript-*.tar.gz",
        [
            ('echo \'{"private": true, "type": "module"}\' > package.json', ""),
            ("npm install --offline --no-audit --no-fund $ARCHIVE", "added 1 package"),
            ("node answer.mjs", "0"),
            ("$GATE init --language javascript --name package", "Type next"),
            ("cp predicate.mjs hypcheck-javascript/predicate.mjs", ""),
            (f"$GATE verify 'command:node hypcheck-javascript/adapter.mjs' {ASKED}", "HELD"),
        ],
    ),
}


def _installs(archive: Path) -> bool:
    """Whether this Python installs the archive; a wheel says so in its name."""
    return archive.suffix != ".whl" or not parse_wheel_filename(archive.name)[3].isdisjoint(sys_tags())


_MARK = "@@"
"""Begins the line that is printed before each line of a trial."""


def _script(lines: list[Line]) -> str:
    """All lines for one shell; before what each prints comes a line with the mark and its number."""
    told = (f"printf '%s\\n' {_MARK}{place}\n{line}" for place, (line, _) in enumerate(lines))
    return "set -e\n" + "\n".join(told) + "\n"


def tried(name: str, dist: Path) -> Iterator[str]:
    """The transcript of a trial. Raises ClickException where a line fails, or prints something else."""
    trial = TRIALS[name]
    found = [path for path in archives(dist) if path.match(trial.archive) and _installs(path)]
    if len(found) != 1:
        raise click.ClickException(f"{dist} has {len(found)} archives {trial.archive}; it must have one")
    gate = f"{sys.executable} -m hypcheck"
    variables = {"ARCHIVE": str(found[0].resolve()), "PYTHON": sys.executable, "GATE": gate}
    outside = {key: text for key, text in os.environ.items() if not key.startswith(("PYTHON", "VIRTUAL_ENV"))}
    with tempfile.TemporaryDirectory() as folder:
        for adapter, text in ADAPTERS.items():
            Path(folder, adapter).write_text(text, encoding="utf-8")
        done = subprocess.run(  # noqa: S603
            ["/bin/bash", "-c", _script(trial.lines)],
            cwd=folder,
            env=outside | variables | {"CI": "true"},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )
    parts = done.stdout.split(_MARK)[1:]
    for (line, wanted), part in zip(trial.lines, parts, strict=False):
        printed = part.partition("\n")[2]
        yield f"$ {line}\n{printed}".rstrip()
        if wanted not in printed:
            raise click.ClickException(f"{name}: it must print {wanted!r}")
    if done.returncode:
        raise click.ClickException(f"{name}: its last line ended with {done.returncode}")
