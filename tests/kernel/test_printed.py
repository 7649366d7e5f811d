"""hypcheck.h and the printed modules are what the programs print."""

from __future__ import annotations

import re

import pytest

from hypcheck.derivation.program import needed
from hypcheck.kernel.printed import scalars
from hypcheck.kernel.printing import modules
from tests.kernel.compiling import HEADER
from tests.support.inside import CERTIFIED, CERTIFIED_CONSTANTS, generate, header


def test_the_committed_header_is_what_its_generator_prints():
    assert HEADER.read_text(encoding="utf-8") == header(), f"run {generate.COMMAND}"


@pytest.mark.parametrize("name", modules.modules())
def test_each_committed_printed_module_is_what_its_generator_prints(name):
    assert (modules.FOLDER / name).read_text(encoding="utf-8") == modules.modules()[name], f"run {modules.COMMAND}"


def test_the_header_has_every_step_of_the_certified_program():
    text = HEADER.read_text(encoding="utf-8")
    for step in needed(CERTIFIED, ("exterior", "interior", "decided")):
        assert re.search(rf"const HC_(NUMBER|TRUTH) {step.name} = ", text), step.name


def test_limits_of_the_scalar_function_are_those_of_the_certified_program():
    constants = CERTIFIED_CONSTANTS
    assert (scalars.LEAST, scalars.GREATEST, scalars.FARTHEST, scalars.SLACK) == tuple(
        constants[name] for name in ("least", "greatest", "farthest", "slack")
    )
