"""Whether the proofs are compiled here: tests that ask Coq's files are skipped where they are not."""

from __future__ import annotations

import shutil

from hypcheck.proofs import build


def up_to_date() -> bool:
    """Whether the build folder has what these sources, as they are now, were compiled to."""
    try:
        texts = [(build.BUILT / f"{name}.v").read_text(encoding="utf-8") for name in build.FILES]
    except OSError:
        return False
    same = texts == [build.source(name) for name in build.FILES]
    return same and (build.BUILT / build.CHECKER).is_file() and shutil.which("coqc") is not None
