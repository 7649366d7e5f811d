"""docs/kernel.md: its constants are those of the header."""

from __future__ import annotations

import re
from pathlib import Path

from tests.support.inside import SLACK, U, generate

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "kernel.md").read_text(encoding="utf-8")
RAISED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")


def value_of(text: str) -> float:
    """A number as the page writes it: sums and products of numbers, powers of two, u and slack."""
    powers = re.sub("2([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)", lambda match: f"2.0**{match[1].translate(RAISED)}", text)
    python = powers.replace("−", "-").replace("·", "*").replace("u", "*u").replace("slack", "SLACK")
    return float(eval(python, {"u": U, "SLACK": SLACK}))  # noqa: S307 - the page is ours


def test_the_table_on_the_kernel_page_has_every_constant_of_the_header():
    rows = re.findall(r"^\| (`.*?`) \| (.*?) \| .+ \|$", PAGE, flags=re.MULTILINE)
    told = {
        name.strip("`"): value_of(value)
        for names, values in rows
        for name, value in zip(names.split(", "), values.split(", "), strict=True)
    }
    assert told == generate.CONSTANTS
