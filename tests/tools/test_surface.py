"""The committed list of what users depend on is the one of today."""

from __future__ import annotations

from tests.tools.surface import PAGE, PARTS, surface


def test_committed_list_of_what_users_depend_on_is_the_one_of_today():
    assert PAGE.read_text(encoding="utf-8") == surface(), "run make surface, read the difference, and docs/stability.md"


def test_list_has_known_things_of_each_part():
    lines = {title: list(part()) for title, part in PARTS.items()}
    assert "Span(low, high)" in lines["Python"]
    options = lines["Command line"]
    assert "    --fail-on [wrong|false-clear]" in options[options.index("hypcheck verify") :]
    assert "6 ORACLES_DISAGREE" in lines["Exit codes"]
    assert any(line.startswith("record-1.0.0.json ") for line in lines["Schemas"])
    assert "int hypcheck_use_level(const char *name)" in lines["C"]
