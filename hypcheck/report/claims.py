"""What a gated implementation says of itself, and as what it was judged, in the words of every report.

And what the settings of a run say that weakens its gate.
"""

from __future__ import annotations

from collections.abc import Iterator

from msgspec import UnsetType

from hypcheck.record.lines import Description, Domain, Implementation, NotStarted, Settings
from hypcheck.report.text import counted, figure, listed


def settings_facts(settings: Settings | UnsetType | None) -> Iterator[str]:
    """One sentence without a full stop about the settings of a run: their file, and each option that weakens the gate.

    None where there is no settings file and every option that decides is as strict as its default.
    """
    if not settings:
        return
    parts = [f"settings are those of {settings.file}"] if settings.file else []
    weakened = settings.weakened
    if weakened:
        named = (f"{each.option} {each.value}, not {each.default} ({each.source})" for each in weakened)
        parts.append(f"weaker than the default: {'; '.join(named)}")
    yield "; ".join(parts)


def claims(line: Implementation | NotStarted) -> Iterator[str]:
    """Sentences without a full stop from the record's line about an implementation; none of one that did not start."""
    if isinstance(line, NotStarted):
        return
    declared, used = line.declared, line.used
    changed = [name for name in ("question", "precision", "domain") if getattr(declared, name) != getattr(used, name)]
    yield f"declares {described(declared)}"
    if changed:
        yield f"judged as {listed([_said(used, name) for name in changed])}, as the options say"
    again, restarts = line.again, line.restarts
    other = again.within + again.beyond
    asked = f"asked again about {counted(again.asked, 'case')}, {other:,} answered otherwise"
    beyond = f" ({again.beyond:,} beyond the tolerance)"
    repeated = f"{asked}{beyond}" if again.asked else "nothing to ask again: no answer was judged"
    yield f"{repeated}; {counted(restarts, 'restart')}"


def described(description: Description) -> str:
    """Question, precision, domain and the rest of a description: what it answers, and where it claims to be right."""
    parts = [_said(description, name) for name in ("question", "precision", "domain")]
    parts += [text for text in (description.language, description.version) if text]
    if description.refuses:
        parts.append("refuses invalid rows")
    return ", ".join(parts)


def _said(description: Description, name: str) -> str:
    return domain(description.domain) if name == "domain" else str(getattr(description, name))


def domain(value: Domain) -> str:
    """A domain: "every regime, ratios 0.001 to 1,000, magnitudes not declared"."""
    regimes = listed(value.regimes) if value.regimes else "every regime"
    ranges = [f"ratios {_range(value.ratio)}", f"magnitudes {_range(value.magnitude)}"]
    settings = value.settings or ()
    sizes = [f"({', '.join(f'{size:.6g}' for size in each.sizes)})" for each in settings]
    only = [f"only α, γ, b, d = {listed(sizes, 'or')}"] if sizes else []
    return ", ".join([regimes, *only, *ranges])


def _range(limits: tuple[float, float] | None) -> str:
    return "not declared" if limits is None else " to ".join(figure(limit) for limit in limits)
