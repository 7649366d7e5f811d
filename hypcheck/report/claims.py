"""What a gated implementation says of itself, and as what it was judged, in the words of every report.

And what the settings of a run say that weakens its gate.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from hypcheck.record import Line
from hypcheck.report.text import counted, figure, listed


def settings_facts(header: Line) -> Iterator[str]:
    """One sentence without a full stop about the settings of a run: their file, and each option that weakens the gate.

    None where there is no settings file and every option that decides is as strict as its default.
    """
    settings = header.get("settings")
    if settings is None:
        return
    parts = [f"settings are those of {settings['file']}"] if settings["file"] else []
    weakened = settings["weakened"]
    if weakened:
        named = (f"{each['option']} {each['value']}, not {each['default']} ({each['source']})" for each in weakened)
        parts.append(f"weaker than the default: {'; '.join(named)}")
    yield "; ".join(parts)


def claims(line: Line) -> Iterator[str]:
    """Sentences without a full stop from the record's line about an implementation; none of one that did not start."""
    if not line["started"]:
        return
    declared, used = line["declared"], line["used"]
    changed = [name for name in ("question", "precision", "domain") if declared[name] != used[name]]
    yield f"declares {described(declared)}"
    if changed:
        yield f"judged as {listed([_said(name, used[name]) for name in changed])}, as the options say"
    again, restarts = line["again"], line["restarts"]
    other = again["within"] + again["beyond"]
    asked = f"asked again about {counted(again['asked'], 'case')}, {other:,} answered otherwise"
    beyond = f" ({again['beyond']:,} beyond the tolerance)"
    repeated = f"{asked}{beyond}" if again["asked"] else "nothing to ask again: no answer was judged"
    yield f"{repeated}; {counted(restarts, 'restart')}"


def described(description: Mapping[str, Any]) -> str:
    """Question, precision, domain and the rest of a description: what it answers, and where it claims to be right."""
    parts = [_said(name, description[name]) for name in ("question", "precision", "domain")]
    parts += [str(description[name]) for name in ("language", "version") if description[name]]
    if description["refuses"]:
        parts.append("refuses invalid rows")
    return ", ".join(parts)


def _said(name: str, value: Any) -> str:  # noqa: ANN401 - a field of a description
    return domain(value) if name == "domain" else str(value)


def domain(value: Mapping[str, Any]) -> str:
    """A domain: "every regime, ratios 0.001 to 1,000, magnitudes not declared"."""
    regimes = listed(value["regimes"]) if value["regimes"] else "every regime"
    ranges = [f"{name}s {_range(value[name])}" for name in ("ratio", "magnitude")]
    settings = value.get("settings") or ()
    sizes = [f"({', '.join(f'{size:.6g}' for size in each['sizes'])})" for each in settings]
    only = [f"only α, γ, b, d = {listed(sizes, 'or')}"] if sizes else []
    return ", ".join([regimes, *only, *ranges])


def _range(limits: tuple[float | str, float | str] | None) -> str:
    return "not declared" if limits is None else " to ".join(figure(float(limit)) for limit in limits)
