"""The files of the site beside mkdocs.yml: pages from all over the repository under their own paths, and the explorer.

mkdocs reads one folder, but our pages link to others above it. So every file gets the path that it has in the
repository, and each link leads in the site where it leads in the repository.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

from hypcheck.report.html import explorer_page

ROOT = Path(__file__).resolve().parents[1]

BESIDE = (
    "LICENSE",
    "CITATION.cff",
    "docs/site.css",
    "examples/*",
    "docs/**/*.svg",
    "docs/**/*.png",
    "docs/**/*.txt",
    "docs/**/*.toml",
    "docs/**/*.csv",
    "cases/LICENSE",
    "cases/**/*.json",
    "cases/*.csv",
    "hypcheck/report/schemas/*.json",
    "reports/engines/*.json",
    "reports/engines/*.csv",
    "tests/tools/mutants/*.csv",
    "reports/engines/**/*.svg",
    "reports/engines/findings/*",
    "reports/reference/**/*.*",
)
"""What pages show or link to. The pages themselves are those of the navigation."""


def pages(nav: list[dict[str, str | list]]) -> Iterator[str]:
    """The pages of the navigation, or of a part of it."""
    for entry in nav:
        for value in entry.values():
            yield from pages(value) if isinstance(value, list) else (value,)


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Every page and what it links to, each under its path in the repository; what a theme brings stays."""
    docs = Path(config.docs_dir)
    kept = Files([each for each in files if not (docs / each.src_uri).exists()])
    patterns = (*pages(config.nav), *BESIDE)
    for path in sorted({found for pattern in patterns for found in ROOT.glob(pattern) if found.is_file()}):
        kept.append(File.generated(config, path.relative_to(ROOT).as_posix(), abs_src_path=str(path)))
    kept.append(File.generated(config, "docs/explorer.html", content=explorer_page()))
    return kept
