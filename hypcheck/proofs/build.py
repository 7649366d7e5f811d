"""The build of the proofs with Coq, of what they assume, of weakened statements, and of the proved checker.

`make prove` runs it. Nothing is installed here: a missing program is named. Everything is built in build/proofs beside
the package.

weakened.toml has constants and comparisons that Coq must refuse: with them the proof as written does not go through;
the statement may be false or not. A proof that went through in spite of one would prove less than it says. Every
change is made in a copy of the file, and Coq is asked about that alone, beside the compiled proofs.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

from hypcheck import toml
from hypcheck.errors import Exit, HypcheckError, InputError
from hypcheck.proofs import printed_c
from hypcheck.proofs.weakenings import Made

SOURCES = Path(__file__).parent
OF_HEADER = SOURCES / "header"
"""The proofs about the text of hypcheck.h, PRINTED and COMPOSED: a wheel has none of them."""

BUILT = SOURCES.parents[1] / "build" / "proofs"
CHECKER = "check_cases"
"""The name of the proved checker in the build folder."""

FROZEN = SOURCES.parents[1] / "cases"

SOUNDNESS = (
    *("Geometry", "Certificates", "UnitBall", "Checker", "Leaning", "LeaningChecker", "RowChecker"),
    *("Ends", "EndsChecker"),
)
"""What the checker's soundness rests on, in the order in which Coq needs it."""

RULE = ("Duality", "AnyAxis", "Completeness", "Cubic", "Rule", "Paper", "RootPatterns")
"""What the exact answers rest on."""

STAGES = ("Positions", "HalfPlanes", "Tangency")
"""From the signs that the kernel's stages ask for to the position."""

ROUNDING = ("Rounding", "Floats", "StageTwo", "Kernel", "RunningBound", "Region")
"""What the constants of the kernel and the bounds of emitted kernels rest on."""

HEADER_TEXT = "HeaderText"
"""The printed C of hypcheck.h as strings of Coq: made when the proofs are built, and kept nowhere else."""

PRINTED = ("Steps", "Programs", HEADER_TEXT, "Printed", "Fixed", "FixedRuns", "Ranges")
"""What the printed C rests on, the words of 128 bits that it computes with, and the range of its floats."""

COMPOSED = (
    *("Stages", "StageTwoAnswers", "Underflow", "StageOne", "StageTwoRuns"),
    *("StageThree", "StageFive", "Long", "StageFour", "Limbs", "LimbsRuns", "ShiftRuns"),
    *("Trees", "Computed", "StageThreeRuns", "StageThreeAnswers", "StageThreeNumbers", "StageThreePosition"),
    *("PlainerTexts", "StageFourSteps", "StageFourPlane", "StageFourGuesses", "StageFourShort"),
    *("StageFourTurns", "StageFourTouches"),
    *("LongIntegers", "LongOutcomes", "LongRuns", "LongSums", "LongProducts", "LongUnits"),
    *("StageFiveAnswers", "StageFiveLimbs", "StageFiveIntegers", "StagesRuns", "Doubles", "StagesOnDoubles"),
    *("FloatSteps", "FloatTexts", "SingleBound", "SingleRuns", "CertifiedText", "CertifiedAnswers", "StagesOfFloats"),
    *("StageFourBeside", "StageFourPosition", "StageFourExact"),
    *("TangentTexts", "TangentRuns", "TangentWithin", "DoubleValues", "StageFourHair", "AllStages", "AllStagesMet"),
)
"""All stages in one theorem, Stages.whatever_stage_answers; from a stage's numbers to the position; the C of words; the
functions of the C that decide; the C of long integers."""

OF_STAGES = (
    *("Stages", "StageTwoAnswers", "StageThree", "StageThreePosition"),
    *("StageFive", "StageFiveAnswers", "StageFiveIntegers", "StageFour", "StageFourPlane", "StagesRuns"),
    *("StageFourPosition", "StageFourExact", "StagesOnDoubles"),
)
"""The files whose theorems say that what a stage answers is the position."""

OF_RUNS = (
    *("StageOne", "TangentRuns", "TangentWithin", "StageTwoRuns", "SingleRuns"),
    *("CertifiedAnswers", "StagesOfFloats", "StageFourHair", "AllStages", "AllStagesMet"),
)
"""The same from the steps of the C in float64, with its guards."""

FILES = (*SOUNDNESS, "ExtractedChecker", *RULE, *STAGES, *ROUNDING, *PRINTED, *COMPOSED)
"""Every file, in the order in which Coq needs them; the name says what it proves."""

AXIOMS = (
    "ClassicalDedekindReals.sig_not_dec",
    "ClassicalDedekindReals.sig_forall_dec",
    "FunctionalExtensionality.functional_extensionality_dep",
)
"""What the real numbers of Coq's standard library rest on. The proofs may assume this and nothing else."""

OF_FLOCQ = "Classical_Prop.classic"
"""The excluded middle, which Flocq uses: what is said of its floats may assume it too."""

ON_FLOCQ = ("Floats", "Ranges", "Underflow", *OF_RUNS, "DoubleValues")
"""The files that say something of Flocq's floats."""

PACKAGES = {
    "coqc": "coq",
    "ocamlfind": "ocaml-findlib",
    "ocamlopt": "ocaml-nox",
}
"""The programs that a build needs, with the Debian package of each."""

LIBRARIES = {"zarith": "libzarith-ocaml-dev", "Flocq": "libcoq-flocq"}
"""The OCaml library and the Coq library that it needs besides."""

_THEOREM = re.compile(r"^\s*(Theorem|Lemma|Corollary)\s+(\w+)", re.MULTILINE)
_UNPROVED = re.compile(r"\b(Admitted|admit|Axiom|Axioms|Parameter|Parameters|Conjecture|Abort)\b")
_COMMENT = re.compile(r"\(\*.*?\*\)", re.DOTALL)


class ProofError(HypcheckError):
    """A file that Coq refuses, or an assumption that is not allowed."""

    exit_code = Exit.WRONG


@dataclass(frozen=True, slots=True)
class Compiled:
    """One file that Coq accepted: its name, how many statements it proves, its lines, and the seconds it took."""

    name: str
    statements: int
    lines: int
    seconds: float


def missing() -> list[str]:
    """The Debian packages that a build needs and this machine has not."""
    absent = [package for program, package in PACKAGES.items() if not shutil.which(program)]
    if absent:
        return [*absent, *LIBRARIES.values()]
    if _run(["ocamlfind", "query", "zarith"], Path()).returncode:
        absent.append(LIBRARIES["zarith"])
    if not (Path(_run(["coqc", "-where"], Path()).stdout.strip()) / "user-contrib" / "Flocq").is_dir():
        absent.append(LIBRARIES["Flocq"])
    return absent


def demand_tools() -> None:
    """Raise InputError with what to install where a program is missing."""
    absent = missing()
    if absent:
        raise InputError(f"the proofs need programs that are not here; on Debian: apt-get install {' '.join(absent)}")


def path_of(name: str) -> Path:
    """The Coq file of this name. Raises InputError where this installation does not have it."""
    path = (OF_HEADER if name in (*PRINTED, *COMPOSED) else SOURCES) / f"{name}.v"
    if not path.is_file():
        raise InputError(f"{name}.v is not here: a wheel has no proofs about the C header; check them in a clone")
    return path


def source(name: str) -> str:
    """The text of a Coq file."""
    if name == HEADER_TEXT:
        return printed_c.header_text()
    return path_of(name).read_text(encoding="utf-8")


def statements(name: str) -> tuple[str, ...]:
    """The theorems, lemmas and corollaries that a file proves, by name."""
    return tuple(found for _, found in _THEOREM.findall(_COMMENT.sub("", source(name))))


def unproved(text: str) -> str:
    """The first word of a file by which it leaves something unproved, or nothing."""
    found = _UNPROVED.search(_COMMENT.sub("", text))
    return found.group() if found else ""


def proves(name: str, statement: str) -> bool:
    """Whether a file states this theorem and leaves nothing in it unproved; Coq itself is not asked."""
    return statement in statements(name) and not unproved(source(name))


def pattern_table() -> list[tuple[str, str, tuple[tuple[str, int], ...]]]:
    """The rows of RootPatterns.v: kind, meaning, and the roots' places with their multiplicities, by Coq's names."""
    rows = re.findall(r'^ *\("([\w-]+)", (\w+), \[(.*?)\]\);?$', source("RootPatterns"), re.MULTILINE)
    return [
        (kind, meaning, tuple((place, int(count)) for place, count in re.findall(r"\((\w+), (\d)\)", roots)))
        for kind, meaning, roots in rows
    ]


def _run(command: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)  # noqa: S603 - fixed names


def refusal(folder: Path, name: str, compiled: Path = Path()) -> str:
    """What Coq says against a file in a folder, or nothing where it accepts it.

    The proofs compiled before lie there too, or in a folder of their own.
    """
    command = ["coqc", "-q", "-R", str(compiled), "Hypcheck", f"{name}.v"]
    found = _run(command, folder)
    return (found.stderr.strip() or "coqc failed without a message") if found.returncode else ""


def compile_file(name: str, built: Path = BUILT) -> Compiled:
    """Compile one file in the build folder; those it needs have been compiled. Raises ProofError where Coq refuses."""
    text = source(name)
    if word := unproved(text):
        raise ProofError(f"{name}.v has an unproved part: {word}")
    built.mkdir(parents=True, exist_ok=True)
    (built / f"{name}.v").write_text(text, encoding="utf-8")
    start = perf_counter()
    message = refusal(built, name)
    if message:
        raise ProofError(f"Coq refuses {name}.v:\n{message}")
    return Compiled(name, len(statements(name)), text.count("\n"), perf_counter() - start)


def assumptions(names: tuple[str, ...], built: Path = BUILT) -> set[str]:
    """The axioms on which the statements of these compiled files rest, as Coq prints them."""
    needed = [f"From Hypcheck Require {name}." for name in names]
    every = " ".join(f"let _ := @{name}.{each} in" for name in names for each in statements(name))
    text = "\n".join((*needed, f"Definition everything := {every} tt.", "Print Assumptions everything.", ""))
    (built / "Assumptions.v").write_text(text, encoding="utf-8")
    command = ["coqc", "-q", "-R", ".", "Hypcheck", "Assumptions.v"]
    found = _run(command, built)
    if found.returncode or not found.stdout.startswith(("Axioms:", "Closed under the global context")):
        raise ProofError(f"Coq does not say what the proofs assume: {found.stderr.strip() or found.stdout[-200:]}")
    return set(re.findall(r"^(\w[\w.']*)(?=\s*:|$)", found.stdout.partition("Axioms:")[2], re.MULTILINE))


def demand_known_axioms(names: tuple[str, ...], built: Path = BUILT) -> tuple[set[str], set[str]]:
    """The axioms of these compiled files: of those without floats of Flocq, and of those with them.

    Raises ProofError where one is not allowed.
    """
    others = assumptions(tuple(name for name in names if name not in ON_FLOCQ), built)
    on_flocq = tuple(name for name in ON_FLOCQ if name in names)
    floats = assumptions(on_flocq, built) if on_flocq else set()
    unknown = (others - set(AXIOMS)) | (floats - {*AXIOMS, OF_FLOCQ})
    if unknown:
        raise ProofError(f"the proofs assume {', '.join(sorted(unknown))}; that is not allowed")
    return others, floats


def refuse_changes(each: int, built: Path = BUILT) -> int:
    """Have Coq refuse changes of the printed C, `each` of every kind in every part. Returns how many were refused.

    Raises ProofError where Coq accepts one, or where it refuses the text without a change.
    """
    found = printed_c.changes(each, seed=45)
    (built / "Changes.v").write_text(printed_c.question([printed_c.UNCHANGED, *found]), encoding="utf-8")
    said = _run(["coqc", "-q", "-R", ".", "Hypcheck", "Changes.v"], built)
    verdicts = re.findall(r"\b(true|false)\b", said.stdout)
    if said.returncode or len(verdicts) != len(found) + 1:
        raise ProofError(f"Coq does not say whether it accepts changes of the printed C: {said.stderr.strip()}")
    if verdicts[0] == "false":
        raise ProofError("Coq refuses the printed C without a change")
    for change, verdict in zip(found, verdicts[1:], strict=True):
        if verdict == "true":
            raise ProofError(f"Coq accepts the printed C with {change[2]!r} in line {change[1]} of part {change[0]}")
    return len(found)


def check_kernel(path: Path, built: Path = BUILT) -> float:
    """Have Coq check a file of `hypcheck emit --proof`; the proofs have been compiled. Returns the seconds it took.

    Raises InputError where the file cannot be read or the proofs are not compiled, ProofError where Coq refuses it.
    """
    if not (built / "Region.vo").is_file():
        raise InputError("the proofs are not compiled; `make prove` compiles them")
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path} cannot be read: {error}") from None
    with TemporaryDirectory(prefix="hypcheck-kernel-") as folder:
        (Path(folder) / "Emitted.v").write_text(text, encoding="utf-8")
        start = perf_counter()
        message = refusal(Path(folder), "Emitted", built.resolve())
    if message:
        raise ProofError(f"Coq refuses {path}:\n{message}")
    return perf_counter() - start


def build_checker(built: Path = BUILT) -> None:
    """Compile the extracted checker and the program that reads cases for it."""
    programs = ["witnesses.ml", f"{CHECKER}.ml"]
    for program in programs:
        shutil.copy(SOURCES / program, built)
    command = ["ocamlfind", "ocamlopt", "-w", "-a", "-package", "zarith", "-linkpkg"]
    command += ["checker.mli", "checker.ml", *programs, "-o", CHECKER]
    found = _run(command, built)
    if found.returncode:
        raise ProofError(f"OCaml refuses the checker:\n{found.stderr.strip()}")


def frozen_files() -> list[str]:
    """The frozen files that the checker reads: all but those about sweeps beside a hyperboloid that ends."""
    contents = {path: json.loads(path.read_bytes())["content"] for path in FROZEN.glob("*.json")}
    return sorted(str(path) for path, content in contents.items() if not content.startswith("ended-way"))


def run_checker(files: list[str], built: Path = BUILT) -> int:
    """Let the proved checker check vector files; it prints what it finds. Returns 0, or 1 where a label is wrong.

    Raises InputError where it has not been built, or where a file cannot be read.
    """
    checker = built / CHECKER
    if not checker.is_file():
        raise InputError(f"the proved checker is not built: there is no {checker}; `make prove` builds it, in a clone")
    found = subprocess.run([checker, *files], stderr=subprocess.PIPE, text=True, check=False)  # noqa: S603 - ours
    if found.returncode not in (0, 1):
        raise InputError(
            found.stderr.strip().removeprefix("check_cases: ") or f"{checker} ended with {found.returncode}"
        )
    return found.returncode


@dataclass(frozen=True, slots=True)
class Weakened:
    """A change of one place of a file: what stands there, what is put in its place, and what that would allow."""

    file: str
    old: str
    new: str
    allows: str


@cache
def weakened() -> tuple[Weakened, ...]:
    """The changes of weakened.toml; each must be refused."""
    name = "weakened.toml"
    table = toml.parsed((SOURCES / name).read_text(encoding="utf-8"), name)
    return tuple(Weakened(**each) for each in table["weakened"])


@cache
def changed_functions() -> tuple[Weakened, ...]:
    """LimbsRuns.v or ShiftRuns.v with one change of a function of words that it speaks of; each must be refused."""
    changes = printed_c.function_changes()
    return tuple(Weakened(printed_c.PROVED_IN[name], "HeaderText.functions", new, what) for name, new, what in changes)


@cache
def changed_decisions() -> tuple[Weakened, ...]:
    """The file that runs a function that decides, with one change of that function; each must be refused."""
    changes = (
        ("deciding", printed_c.deciding_changes()),
        ("beside_tangency", printed_c.tangency_changes()),
        ("of_doubles", printed_c.double_changes()),
        ("floats", printed_c.float_changes()),
        ("tangents", printed_c.tangent_changes()),
    )
    return tuple(
        Weakened(printed_c.PROVED_IN[name], f"HeaderText.{texts}", new, what)
        for texts, found in changes
        for name, new, what in found
    )


@cache
def changed_integers() -> tuple[Weakened, ...]:
    """The file that runs a function of long integers, with one change of that function; each must be refused."""
    changes = printed_c.integer_changes()
    return tuple(Weakened(printed_c.PROVED_IN[name], "HeaderText.integers", new, what) for name, new, what in changes)


CONTROL = Weakened("Checker", "Definition less", "Definition less", "nothing")
"""No change at all: this must be accepted, or the refusals would mean nothing."""


def accepted(change: Weakened | Made, built: Path = BUILT) -> bool:
    """Whether Coq accepts the changed file, which it must not. Raises ValueError where the change does not fit."""
    text = source(change.file)
    if text.count(change.old) != 1:
        raise ValueError(f"{change.file}.v has {text.count(change.old)} places with {change.old!r}; one is needed")
    changed = text.replace(change.old, change.new)
    if isinstance(change, Made) and change.until:
        changed = changed.partition(change.until)[0]
    with TemporaryDirectory(prefix="hypcheck-proofs-") as folder:
        (Path(folder) / f"{change.file}.v").write_text(changed, encoding="utf-8")
        message = refusal(Path(folder), change.file, built.resolve())
    if "Syntax error" in message:
        raise ValueError(f"the change of {change.file}.v is no Coq: {message}")
    return not message
