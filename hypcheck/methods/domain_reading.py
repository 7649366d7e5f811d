"""A domain read from a mapping: regimes, ratio, magnitude, and the settings that a kernel for one scene has."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from hypcheck.errors import InputError
from hypcheck.methods.checks import number, shown, two_numbers
from hypcheck.methods.domain import Domain
from hypcheck.pairs import CENTER, SIZES, trouble_with
from hypcheck.ranges import FixedSizes
from hypcheck.tables.strict_json import object_of


def domain_of(value: object, where: str) -> Domain:
    """The domain that a mapping describes, or that is one already; raises InputError naming key and value."""
    if isinstance(value, Domain):
        return value
    said = object_of(value, where, tuple(_READERS), required=())
    return Domain(**{key: _READERS[key](each, f"{where}'s {key}") for key, each in said.items()})


def _regimes(value: object, where: str) -> tuple[str, ...]:
    if not isinstance(value, (list, tuple)) or not all(isinstance(each, str) for each in value):
        raise InputError(f"{where} is {shown(value)}; it must be a list of names")
    return tuple(value)


def _settings(value: object, where: str) -> tuple[FixedSizes, ...]:
    if not isinstance(value, (list, tuple)) or not value:
        raise InputError(f"{where} is {shown(value)}; it must be a list of mappings with sizes and, at will, x, y, z")
    return tuple(_setting(each, f"{where}[{place}]") for place, each in enumerate(value))


def _setting(value: object, where: str) -> FixedSizes:
    said = object_of(value, where, ("sizes", *CENTER), required=("sizes",))
    sizes = said["sizes"]
    if not isinstance(sizes, (list, tuple)) or len(sizes) != len(SIZES):
        raise InputError(f"{where}'s sizes is {shown(sizes)}; it must be four numbers, {', '.join(SIZES)}")
    alpha, gamma, b, d = (number(each, f"{where}'s sizes") for each in sizes)
    for name, size in zip(SIZES, (alpha, gamma, b, d), strict=True):
        trouble = trouble_with(name, size)
        if trouble is not None:
            raise InputError(f"{where}'s sizes: {trouble}")
    spans = {key: two_numbers(said[key], f"{where}'s {key}") for key in CENTER if key in said}
    for key, (low, high) in spans.items():
        if not low <= high:
            raise InputError(f"{where}'s {key} is [{low}, {high}]; it must be two numbers, the least first")
    return FixedSizes((alpha, gamma, b, d), **spans)


_READERS: Mapping[str, Callable[[object, str], Any]] = MappingProxyType(
    {"regimes": _regimes, "ratio": two_numbers, "magnitude": two_numbers, "settings": _settings}
)
