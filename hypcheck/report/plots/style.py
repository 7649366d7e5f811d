"""The style of figures: lines that differ without colour, sizes for a telephone, axes; and each figure as SVG.

Widths are in points of the picture, which a page scales: a width of 380 is legible on a telephone and on half a screen.
Each curve has its own marker and dashes besides its colour.

SVG is for a page or a file: colours by role, tooltips, a title and a description, nothing to load. matplotlib writes
colours and sizes as style attributes, which a strict content security policy forbids, and ids that clash with those of
other figures on a page. Here colours become classes, which a page's style sheet defines for light and dark ground, the
rest become attributes, and ids begin with the plot's name. In a separate file each mark also has its colour on light
ground as an attribute, because viewers outside a browser do not support variables of style sheets.
"""

from __future__ import annotations

import io
import math
import re
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, NamedTuple
from xml.etree import ElementTree as Xml

import matplotlib.style
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hypcheck.messages import escaped
from hypcheck.report.colours import ROLES, dark_rules

WIDTH = 380.0
SMALL = 178.0
"""The width of a single plot, and of a plot in a row of plots."""

MARKERS = "osD^vPX*"
DASHES: tuple[Any, ...] = (
    "-",
    (0, (5, 2)),
    (0, (2, 1.5)),
    (0, (6, 2, 1.5, 2)),
    (0, (8, 2)),
    (0, (1, 1.2)),
    (0, (4, 4)),
    (0, (10, 2, 1, 2)),
)

LIMIT: dict[str, Any] = {"marker": "v", "markerfacecolor": "none", "markersize": 5.5}
"""The mark of an upper limit: none of n was wrong."""

NONE_WRONG = "none of n wrong: at most 3/n (95 %)"
"""The text of an upper limit in a legend."""

SETTINGS = {
    "figure.facecolor": "none",  # the page's own ground, light or dark
    "axes.facecolor": "none",
    "font.family": "DejaVu Sans",  # wider than the page's font, so that a text that fits here fits there
    "font.size": 10.5,
    "axes.titlesize": 10.5,
    "axes.labelsize": 10.5,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.edgecolor": ROLES["soft"][0],
    "axes.labelcolor": ROLES["ink"][0],
    "axes.titlecolor": ROLES["ink"][0],
    "grid.color": ROLES["rule"][0],
    "grid.linewidth": 0.6,
    "text.color": ROLES["ink"][0],
    "xtick.color": ROLES["soft"][0],
    "ytick.color": ROLES["soft"][0],
    "xtick.labelcolor": ROLES["ink"][0],
    "ytick.labelcolor": ROLES["ink"][0],
    "xtick.minor.visible": False,
    "ytick.minor.visible": False,
    "legend.frameon": False,
    "legend.fontsize": 10,
    "legend.handlelength": 2.6,
    "legend.columnspacing": 1.2,
    "lines.linewidth": 1.4,
    "lines.markersize": 4.5,
    "svg.fonttype": "none",  # text stays text: it can be read aloud, found and copied
    "svg.hashsalt": "hypcheck",  # element ids: the same picture is the same file
    "text.parse_math": False,  # a name with dollars in it is not a formula
}
"""The differences from matplotlib's defaults; settings of users are not read."""


class CurveStyle(NamedTuple):
    """The style of one of several curves."""

    colour: str
    marker: str
    dashes: Any

    @property
    def line(self) -> dict[str, Any]:
        """The style of its line, as arguments of matplotlib."""
        return {"color": self.colour, "linestyle": self.dashes}

    @property
    def marks(self) -> dict[str, Any]:
        """The style of its marks without a line, as arguments of matplotlib."""
        return {"color": self.colour, "marker": self.marker, "linestyle": "none"}


def colour(role: str) -> str:
    """Return the colour that represents a role while a plot is drawn; the SVG has a class instead."""
    return ROLES[role][0]


def curve_style(place: int) -> CurveStyle:
    """Return the style of the curve with this number; after eight, markers and dashes are combined differently."""
    number = len(MARKERS)
    turn = place // number
    return CurveStyle(
        colour(f"series-{place % number + 1}"), MARKERS[(place + turn) % number], DASHES[(place + turn) % number]
    )


def legend_handles(names: Iterable[str]) -> list[Line2D]:
    """Return the entries of a legend for curves with these names, in order."""
    looks = [(curve_style(place), escaped(name, 48)) for place, name in enumerate(names)]
    return [Line2D([], [], **look.line, marker=look.marker, label=label) for look, label in looks]


class Mark(NamedTuple):
    """A place of a plot and the tooltip of its mark; `limit`: it is only an upper limit."""

    x: float
    y: float
    tip: str
    limit: bool = False


def draw_marks(axes: Axes, gid: str, marks: Sequence[Mark], **look: Any) -> dict[str, list[str]]:  # noqa: ANN401
    """Draw marks of one style without a line. Returns their tooltips by the gid; empty if there are no marks."""
    if not marks:
        return {}
    xs, ys = [mark.x for mark in marks], [mark.y for mark in marks]
    axes.plot(xs, ys, gid=gid, **{**look, "linestyle": "none"})
    return {gid: [mark.tip for mark in marks]}


@contextmanager
def styled() -> Iterator[None]:
    """Make matplotlib draw in the house style within the block."""
    with matplotlib.style.context(["default", SETTINGS]):
        yield


def new_figure(width: float, height: float) -> Figure:
    """Make a figure of this width and height in points, with a layout that leaves room for labels."""
    figure = Figure(figsize=(width / 72, height / 72), layout="constrained")
    FigureCanvasAgg(figure)  # the layout measures texts
    return figure


def with_one_layout(plots: Iterable[Plot]) -> Iterator[Plot]:
    """Yield the plots, which have equal axes, and give them all the layout of the first one.

    Computing a layout takes half of the time of drawing a small plot.
    """
    first: Figure | None = None
    for plot in plots:
        if first is None:
            first = plot.figure
            first.draw_without_rendering()
        else:
            for axes, model in zip(plot.figure.axes, first.axes, strict=True):
                axes.set_position(model.get_position())
        plot.figure.set_layout_engine("none")
        yield plot


_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def power_of_ten(exponent: int) -> str:
    """Return the label of a power of ten on an axis: 0.01, 0.1, 1, 10, 100, else 10⁻¹²."""
    if -2 <= exponent <= 2:
        return f"{10.0**exponent:g}"
    return f"10{str(exponent).translate(_SUPERSCRIPTS)}"


def _axis_number(value: float) -> str:
    """Return the label of a number of one digit on an axis: 0.02, 5, 2·10⁻⁴."""
    exponent = math.floor(math.log10(value) + 1e-9)
    digit = round(value / 10.0**exponent)
    if digit == 1:
        return power_of_ten(exponent)
    return f"{digit * 10.0**exponent:g}" if -3 <= exponent <= 2 else f"{digit}·{power_of_ten(exponent)}"


def ticks(low: float, high: float) -> list[tuple[float, str]]:
    """Return places and labels on a logarithmic axis: powers of ten, and digits between them if the powers are few."""
    powers = [10.0**exponent for exponent in decades(low, high)]
    if len(powers) < 2:
        first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
        for digits in ((1, 2, 5), (1, 2, 3, 4, 5, 6, 8)):
            finer = [digit * 10.0**exponent for exponent in range(first, last + 1) for digit in digits]
            powers = [value for value in finer if low <= value <= high]
            if len(powers) > 1:
                break
    return [(value, _axis_number(value)) for value in powers]


def decades(low: float, high: float, most: int = 7) -> list[int]:
    """Return exponents of the powers of ten from `low` to `high`, both positive, at most about `most` of them."""
    first, last = math.ceil(math.log10(low) - 1e-9), math.floor(math.log10(high) + 1e-9)
    step = max(1, -(-(last - first) // most))
    return [exponent for exponent in range(first, last + 1) if exponent % step == 0]


def log_axis(axes: Axes, name: str, low: float, high: float) -> None:
    """Make the axis "x" or "y" logarithmic, with named marks."""
    marks = ticks(low, high)
    getattr(axes, f"set_{name}scale")("log")
    getattr(axes, f"set_{name}lim")(low, high)
    axis = getattr(axes, f"{name}axis")
    axis.set_ticks([value for value, _ in marks], [label for _, label in marks])
    axis.set_ticks([], minor=True)


_SVG = "{http://www.w3.org/2000/svg}"
_LINK = "{http://www.w3.org/1999/xlink}href"
_ROLE: dict[str | None, str] = {light: role for role, (light, _) in ROLES.items()}
_FONT = "'DejaVu Sans', system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif"
"""The fonts of a file: first the one that the picture was laid out with; some viewers try no other."""

_PAINT = {"fill": "f", "stroke": "s"}
_PAINTED = {letter: attribute for attribute, letter in _PAINT.items()}
_NUMBER = re.compile(r"-?\d+\.\d{3,}")
_AROUND_LETTERS = re.compile(r" ?([A-Za-z]) ?")
_REFERENCE = re.compile(r"#([\w.-]+)")
_SHARP_LETTERS = "@media screen{text{text-rendering:geometricPrecision}}"
"""The rule of a style sheet for what `_describe` sets as an attribute; only browsers follow it.

cairosvg, which obeys the attribute, draws such letters in slices.
"""

_COLUMNS, _APART = 2, 24.0
"""Plots side by side in one file, and the points between two of them."""

_LONGEST = 1000
"""Characters of a title, a description or a tooltip."""

_MARKS = (f"{_SVG}use", f"{_SVG}path", f"{_SVG}image")


@dataclass(frozen=True, slots=True)
class Plot:
    """A figure with its `name` (of letters, digits and hyphens; its own on the page), its title and its description.

    `tips` are tooltips by the gid of an artist: one for each of its marks, in the order of drawing.
    """

    name: str
    title: str
    description: str
    figure: Figure
    tips: Mapping[str, Sequence[str]] = field(default_factory=dict)


def inline(plot: Plot) -> str:
    """Return the plot as an element of an HTML page."""
    return _text(_element(plot))


def standalone(plot: Plot) -> bytes:
    """Return the plot as a file, which follows the reader's scheme of colours."""
    return _file(_element(plot))


def together(name: str, title: str, plots: Sequence[tuple[str, str]]) -> bytes:
    """Put several plots, each a title and its element, into one file: row by row under their titles."""
    parts = [Xml.fromstring(svg) for _, svg in plots]  # noqa: S314 - as inline made it
    sizes = [tuple(float(size) for size in part.get("viewBox", "0 0 0 0").split()[2:]) for part in parts]
    widest, top = max(wide for wide, _ in sizes), 0.0
    whole = Xml.Element(f"{_SVG}svg")
    for first in range(0, len(parts), _COLUMNS):
        row = range(first, min(first + _COLUMNS, len(parts)))
        for column, place in enumerate(row):
            left = column * (widest + _APART)
            look = {"class": "f-ink", "font-size": "12px", "font-weight": "bold"}
            heading = Xml.SubElement(whole, f"{_SVG}text", {"x": f"{left + 6:g}", "y": f"{top + 14:g}", **look})
            heading.text = _shown(plots[place][0])
            wide, tall = sizes[place]
            for attribute, value in (("x", left), ("y", top + 20), ("width", wide), ("height", tall)):
                parts[place].set(attribute, f"{value:g}")
            whole.append(parts[place])
        top += max(sizes[place][1] for place in row) + 20 + _APART
    columns = min(_COLUMNS, len(parts))
    whole.set("viewBox", f"0 0 {widest * columns + _APART * (columns - 1):g} {top - _APART:g}")
    _describe(whole, name, title, "; ".join(words for words, _ in plots))
    return _file(whole)


def _file(root: Xml.Element) -> bytes:
    """Make a separate file of a described element: with its colours, the rules for dark ground, and a background."""
    root.set("font-family", _FONT)
    style = Xml.Element(f"{_SVG}style")
    style.text = _SHARP_LETTERS + dark_rules()
    ground = Xml.Element(f"{_SVG}rect", {"width": "100%", "height": "100%", "class": "f-surface"})
    root[2:2] = [style, ground]  # behind title and description
    for element in root.iter():
        element.attrib.pop("text-rendering", None)
        _paint(element)
    return (_text(root) + "\n").encode("utf-8")


def _paint(element: Xml.Element) -> None:
    """Give an element the light colours of its classes as attributes; a rule of a style sheet overrides them."""
    for name in (element.get("class") or "").split():
        letter, _, role = name.partition("-")
        if letter in _PAINTED:
            element.set(_PAINTED[letter], ROLES[role][0])


def _element(plot: Plot) -> Xml.Element:
    """Draw a plot as an element of SVG without style attributes, with tooltips and unique ids."""
    stream = io.BytesIO()
    with styled(), warnings.catch_warnings():  # the style says how text and ids are written, too
        warnings.filterwarnings("ignore", message="Glyph")  # a name with letters that the font lacks
        metadata = dict.fromkeys(("Creator", "Date", "Format", "Type"))
        plot.figure.set_dpi(144)  # for the parts that are drawn as an image
        FigureCanvasSVG(plot.figure).print_svg(stream, metadata=metadata)  # savefig draws everything twice
    root = Xml.fromstring(stream.getvalue())  # noqa: S314 - just written
    for parent in list(root.iter()):
        for child in list(parent):
            if child.tag in (f"{_SVG}metadata", f"{_SVG}style"):
                parent.remove(child)
    for element in root.iter():
        _unstyle(element)
    _give_tips(root, plot)
    _rename(root, plot.name)
    _describe(root, plot.name, plot.title, plot.description)
    return root


def _unstyle(element: Xml.Element) -> None:
    """Replace style attributes by attributes, and colours by classes; drop digits that no screen shows."""
    declarations = [part.partition(":") for part in element.attrib.pop("style", "").split(";") if part.strip()]
    for name, _, value in declarations:
        element.set(name.strip(), value.strip())
    painted = {name: _ROLE[element.attrib.pop(name)] for name in _PAINT if element.get(name) in _ROLE}
    classes = [f"{_PAINT[name]}-{role}" for name, role in painted.items()]
    if element.tag == f"{_SVG}text":
        for name in ("font", "font-family"):
            element.attrib.pop(name, None)
        if "fill" not in painted and element.get("fill") is None:
            classes.append("f-ink")
        if element.get("transform", "").startswith("rotate(-0 "):
            del element.attrib["transform"]
    if classes:
        element.set("class", " ".join(classes))
    _shorten(element)


def _shorten(element: Xml.Element) -> None:
    """Round the numbers of an element to two decimals, and replace the old form of links by the new one."""
    for name in ("d", "x", "y", "transform", "width", "height", "points"):
        if name in element.attrib:
            short = _NUMBER.sub(lambda digits: f"{float(digits[0]):.2f}".rstrip("0").rstrip("."), element.attrib[name])
            element.set(name, _AROUND_LETTERS.sub(r"\1", " ".join(short.split())) if name == "d" else short)
    if _LINK in element.attrib:
        element.set("href", element.attrib.pop(_LINK))


def _give_tips(root: Xml.Element, plot: Plot) -> None:
    """Add the tooltips to the marks. Raises ValueError if an artist has another number of marks than of tooltips."""
    groups = {element.get("id"): element for element in root.iter(f"{_SVG}g")}
    for gid, tips in plot.tips.items():
        definitions = {id(node) for defs in groups[gid].iter(f"{_SVG}defs") for node in defs.iter()}
        marks = [node for node in groups[gid].iter() if node.tag in _MARKS and id(node) not in definitions]
        if len(marks) != len(tips):
            raise ValueError(f"{plot.name}: {gid} has {len(marks)} marks and {len(tips)} tooltips")
        for mark, tip in zip(marks, tips, strict=True):
            Xml.SubElement(mark, f"{_SVG}title").text = _shown(tip)


def _shown(words: str) -> str:
    """Cut a text to _LONGEST characters, and escape it."""
    return escaped(words[:_LONGEST], _LONGEST)


def _rename(root: Xml.Element, name: str) -> None:
    """Prefix ids that are referred to with the plot's name; remove the other ids."""
    used = {
        reference
        for element in root.iter()
        for value in element.attrib.values()
        for reference in _REFERENCE.findall(value)
    }
    for element in root.iter():
        identity = element.attrib.pop("id", None)
        if identity in used:
            element.set("id", f"{name}-{identity}")
        for attribute in ("href", "clip-path"):
            value = element.get(attribute)
            if value is not None and not value.startswith("data:"):
                element.set(attribute, _REFERENCE.sub(rf"#{name}-\1", value))


def _describe(root: Xml.Element, name: str, title: str, description: str) -> None:
    """Give a picture its title, its description and the attributes of every plot; remove its fixed size."""
    for attribute in ("width", "height", "version"):
        root.attrib.pop(attribute, None)
    for place, (tag, words) in enumerate((("title", title), ("desc", description))):
        element = Xml.Element(f"{_SVG}{tag}", {"id": f"{name}-{tag}"})
        element.text = _shown(words)
        root.insert(place, element)
    root.set("class", "plot")
    root.set("role", "img")
    root.set("aria-labelledby", f"{name}-title {name}-desc")
    root.set("stroke-linejoin", "round")
    root.set("text-rendering", "geometricPrecision")  # else a scaled picture keeps the unscaled letter spacing


def _text(root: Xml.Element) -> str:
    """Return an element as text, without white space between elements."""
    Xml.register_namespace("", _SVG.strip("{}"))
    for element in root.iter():  # white space that matplotlib adds for people
        element.tail = None
        if element.text is not None and not element.text.strip():
            element.text = None
    return Xml.tostring(root, encoding="unicode")
