"""Centres to try a plan on: the same ones every time, spread over the region of a setting or around its surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hypcheck.kernel.specialise.settings import Setting
from hypcheck.scene.model import Span

COUNT = 4096
LARGEST = 2.0**1021
"""Beyond it no centre lies, whatever the sizes: a span's width is then a number of float64."""

REACH = 2.0
"""How far around the surface centres lie where the region leaves an axis open: in waist radii and heights γ."""

Floats = NDArray[np.float64]


def centres(setting: Setting) -> tuple[Floats, Floats, Floats]:
    """x, y, z, (COUNT,) each: a rank-one lattice, which fills the box evenly and needs no random numbers."""
    alpha, gamma, b, d = setting.sizes
    across = Span(-REACH * (alpha + b), REACH * (alpha + b))
    up = Span(-REACH * (gamma + d), REACH * (gamma + d))
    index = np.arange(COUNT)
    spans = [_held(own or default) for own, default in zip(setting.box.spans, (across, across, up), strict=True)]
    # Powers of the root of x⁴ = x + 1 give the evenest lattice in three dimensions.
    shares = [((0.5 + index * step) % 1.0) for step in (0.8191725133961645, 0.6710436067037893, 0.5497004779019703)]
    x, y, z = (span.low + (span.high - span.low) * share for span, share in zip(spans, shares, strict=True))
    return np.asarray(x), np.asarray(y), np.asarray(z)


def _held(span: Span) -> Span:
    return Span(*(max(-LARGEST, min(end, LARGEST)) for end in (span.low, span.high)))
