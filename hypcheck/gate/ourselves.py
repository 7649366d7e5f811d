"""What a chunk comes to depends on, besides the implementation: our own files, as one number.

Two machines may have hypcheck of one version and yet not the same files, where it is installed from a repository.
"""

from __future__ import annotations

import hashlib
from functools import lru_cache
from pathlib import Path

import hypcheck
from hypcheck.casebook.vectors import folder
from hypcheck.gate.fingerprint import sha256


@lru_cache
def own_sha256() -> str:
    """Of our modules and the frozen vectors, with their names."""
    package = Path(hypcheck.__file__).parent
    told = hashlib.sha256()
    for place, pattern in ((package, "**/*.py"), (folder(), "*.json")):
        for path in sorted(place.glob(pattern)):
            told.update(f"{path.relative_to(place).as_posix()} {sha256(path)}\n".encode())
    return told.hexdigest()
