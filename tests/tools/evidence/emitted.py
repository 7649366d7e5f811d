"""Branch coverage and MC/DC of the C that hypcheck writes for others: kernels of scenes, methods, and the adapters."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tests.tools.evidence.coverage import OPTIONS, Tools, gaps_of, tools
from tests.tools.evidence.emitted_adapters import adapters, talk
from tests.tools.evidence.emitted_kernels import kernels
from tests.tools.evidence.gaps import reason_of_emitted as reason
from tests.tools.evidence.parts import ROOT, Figures

TITLE = "Coverage of the code that hypcheck emits"

COUNTED = ("functions", "branches", "mcdc")


def measure() -> Figures:
    """Compiles every text, asks it, and reads what was reached."""
    found = tools()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        named = {**_built_kernels(found, folder), **_built_adapters(found, folder)}
        asking = [sys.executable, "-m", "tests.tools.evidence.emitted_kernels", str(folder)]
        subprocess.run(asking, cwd=ROOT, check=True)
        for adapter in adapters():
            talk(adapter, folder / adapter.file_name)
        files = [each for each in _exported(found, folder, list(named)) if each["filename"].endswith((".c", ".cpp"))]
        gaps = sorted(set(_gaps(files, {str(path): title for path, title in named.items()})))
    total = {key: _added(files, key) for key in COUNTED}
    unexplained = [gap for gap in gaps if reason(gap) is None]
    return {"texts": list(named.values()), **total, "gaps": gaps, "unexplained": unexplained, "count": len(unexplained)}


def _counting(made: Path) -> list[str]:
    """Options of the compiler: the counts of each program or library go to a file of its own, which its runs share."""
    left_out = ("-std=", "-fprofile-instr-generate")
    options = [each for each in OPTIONS if not each.startswith(left_out)]
    return [*options, f"-fprofile-instr-generate={made}-%m.profraw"]


def _built_kernels(found: Tools, folder: Path) -> dict[Path, str]:
    """Libraries, and what each is called."""
    made = kernels()
    (folder / "names").write_text(json.dumps(list(made)), encoding="utf-8")
    named = {}
    for number, (name, (text, _)) in enumerate(made.items()):
        path = folder / f"kernel-{number}.c"
        path.write_text(text, encoding="utf-8")
        library = path.with_suffix(".so")
        command = [
            found.clang,
            *_counting(library),
            "-std=c99",
            "-fPIC",
            "-shared",
            str(path),
            "-lm",
            "-o",
            str(library),
        ]
        subprocess.run(command, check=True)
        named[library] = name
    return named


def _built_adapters(found: Tools, folder: Path) -> dict[Path, str]:
    """Programs, and what each is called."""
    named = {}
    for adapter in adapters():
        own = folder / f"{adapter.file_name}-source"
        own.mkdir()
        for name, text in adapter.texts.items():
            (own / name).write_text(text, encoding="utf-8")
        sources = [str(own / name) for name in adapter.texts if name.endswith((".c", ".cpp"))]
        plus = adapter.language == "cpp"
        clang = found.clang.replace("clang", "clang++") if plus else found.clang
        standard = "-std=c++17" if plus else "-std=c11"
        program = folder / adapter.file_name
        subprocess.run([clang, *_counting(program), standard, *sources, "-lm", "-o", str(program)], check=True)
        named[program] = adapter.name
    return named


def _exported(found: Tools, folder: Path, objects: list[Path]) -> list[dict[str, Any]]:
    """What was reached of each source, of each object by itself: they have functions of the same names."""
    merged, files = folder / "merged", []
    subprocess.run([found.merge, "merge", *folder.glob("*.profraw"), "-o", merged], check=True)
    for each in objects:
        command = [found.show, "export", "-format=text", f"-instr-profile={merged}", str(each)]
        exported = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)["data"][0]
        files += [{**file, "object": str(each)} for file in exported["files"]]
    return files


def _gaps(files: list[dict[str, Any]], names: dict[str, str]) -> Iterator[str]:
    for file in files:
        yield from (f"{names[file['object']]}: {gap}" for gap in gaps_of(file))


def _added(files: list[dict[str, Any]], key: str) -> dict[str, float]:
    count, covered = (sum(file["summary"][key][what] for file in files) for what in ("count", "covered"))
    return {"count": count, "covered": covered, "share": round(100 * covered / count, 2)}


def section(figures: Figures) -> str:
    """Figures, and every gap with its reason."""
    titles = {"functions": "functions", "branches": "branches", "mcdc": "conditions, MC/DC"}
    rows = "\n".join(
        f"| {titles[key]} | {figures[key]['count']} | {figures[key]['covered']} | {figures[key]['share']:.2f} % |"
        for key in COUNTED
    )
    gaps = "\n".join(
        f"- {why or 'no reason is known; a row has still to be found'}:\n"
        + "\n".join(f"  - `{gap}`" for gap in figures["gaps"] if reason(gap) == why)
        for why in dict.fromkeys(map(reason, figures["gaps"]))
    )
    return f"""\
{len(figures["texts"])} texts are compiled: kernels of scenes and of whole scenes, in both precisions, for upright and
tilted movers; every method; the adapters in C and C++ with each of their stubs. Kernels answer frozen and drawn rows,
the families of their sizes, other sizes and axes, rows at, beside and beyond the limits of each stage, and centres
about the ends of hyperboloids. The answers are judged like those of any implementation, at the limits one in seven of
them. Adapters get questions, and also invalid lines and ends of input (`tests/tools/evidence/emitted*.py`).

| | count | reached | share |
| --- | --- | --- | --- |
{rows}

Code that no input reaches, with the reason ({figures["count"]} of {len(figures["gaps"])} have none yet):

{gaps}
"""
