"""The colours of all plots by what they mean, their rules for a style sheet, and the legends that a page shows.

Colours are after Okabe and Ito (https://jfly.uni-koeln.de/color/), darkened on light ground where their contrast would
be less than 3:1.
"""

from __future__ import annotations

ROLES = {
    "surface": ("#ffffff", "#14181d"),
    "ink": ("#1b2026", "#e7eaee"),
    "soft": ("#57606b", "#a9b2bd"),
    "rule": ("#d5dae0", "#39414b"),
    "series-1": ("#0072b2", "#4aa8e0"),
    "series-2": ("#d55e00", "#ff8a3d"),
    "series-3": ("#008a62", "#2fc79b"),
    "series-4": ("#b0568a", "#e495c3"),
    "series-5": ("#a87400", "#f0b429"),
    "series-6": ("#2d87ba", "#8accf5"),
    "series-7": ("#6b6375", "#c3b8d4"),
    "series-8": ("#1b2027", "#e7eaef"),
    "share-0": ("#e3e8ec", "#2a313a"),
    "share-1": ("#f2c14e", "#f2c14e"),
    "share-2": ("#ee8434", "#ee8434"),
    "share-3": ("#d1495b", "#d1495b"),
    "share-4": ("#9c3fb5", "#9c3fb5"),
    "clear": ("#d55e02", "#ff8a3e"),
    "contact": ("#0073b3", "#4aa8e1"),
    "side": ("#7a1c5b", "#e495c4"),
}
"""Every colour by its meaning: on light ground, on dark ground. No two roles have one colour on light ground."""

STEPS = ((0.0, "none wrong"), (0.01, "up to 1 %"), (0.1, "up to 10 %"), (0.5, "up to 50 %"), (1.0, "more"))
"""The shares at which the steps of colour end, and what a legend says of them."""

MISTAKES = {"c": ("false clear", "clear"), "w": ("false contact", "contact"), "s": ("wrong side", "side")}
"""The letters of wrong answers: what they are called, and the role of their colour."""


def colour_rules() -> str:
    """Return the rules of a style sheet that give each role its colour, on light and on dark ground; paper is light."""
    light, dark = ("".join(f"--{role}:{both[ground]};" for role, both in ROLES.items()) for ground in (0, 1))
    rules = "".join(f".f-{role}{{fill:var(--{role})}}.s-{role}{{stroke:var(--{role})}}" for role in ROLES)
    return f":root{{{light}}}@media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}{rules}"


def dark_rules() -> str:
    """Return the rules for dark ground of a picture in a file; its marks carry their light colours as attributes."""
    rules = "".join(f".f-{role}{{fill:{dark}}}.s-{role}{{stroke:{dark}}}" for role, (_, dark) in ROLES.items())
    return f"@media screen and (prefers-color-scheme:dark){{{rules}}}"
