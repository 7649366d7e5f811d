"""The command line says what its transcripts show: tests/support/transcripts.py."""

from __future__ import annotations

import pytest

from tests.support.transcripts import is_thorough, name_of, paths, renewed

SCENES = [
    pytest.param(path, id=name_of(path), marks=[pytest.mark.thorough] if is_thorough(path) else []) for path in paths()
]


@pytest.mark.parametrize("path", SCENES)
def test_commands_print_and_end_as_their_transcript_shows(path):
    """`make transcripts` writes what they print now: read the difference."""
    assert renewed(path) == path.read_text(encoding="utf-8")
