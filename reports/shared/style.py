"""The style of every figure: one palette, one marker per code, and the same bytes for the same numbers.

The colours are those of Okabe and Ito (Color Universal Design, 2008), which people with any common colour vision can
distinguish. Colour is never the only distinction: codes also differ in marker, families in line style.

Matplotlib takes a second to import, so this module does not import it before something is drawn.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from io import StringIO
from math import log10
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...cases.input import atomic
from .compact import compact

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

INK, MUTED, FAINT = "#1a1a1a", "#6b6b6b", "#d0d0d0"
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#8A6D3B")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
LINES = {"edgewise": "-", "flapwise": (0, (5, 2)), "torsion": (0, (1, 1.5)), "axial": (0, (6, 2, 1, 2)), "mixed": "-"}

RC: dict[Any, Any] = {
    "svg.hashsalt": "southwell",
    "svg.fonttype": "none",
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.titlesize": 10.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.titlepad": 10.0,
    "axes.titley": 1.0,
    "axes.labelcolor": INK,
    "axes.edgecolor": MUTED,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.8,
    "text.color": INK,
    "xtick.color": MUTED,
    "ytick.color": MUTED,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "legend.frameon": False,
    "axes.unicode_minus": True,
    "figure.facecolor": "white",
    "axes.facecolor": "white",
    "savefig.facecolor": "white",
}


@dataclass(frozen=True)
class Look:
    """One code's colour and marker."""

    colour: str
    marker: str


@contextmanager
def plot_style() -> Iterator[None]:
    """Apply the settings under which figures are drawn and saved, regardless of the user's Matplotlib settings."""
    import matplotlib as mpl

    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(RC)
        yield


def looks(codes: Sequence[str]) -> dict[str, Look]:
    """The look of each code by its position in the list, so that it is the same in every figure of a run."""
    return {
        code: Look(COLOURS[k % len(COLOURS)], MARKERS[(k + k // len(COLOURS)) % len(MARKERS)])
        for k, code in enumerate(codes)
    }


WIDTH = 8.6
"""Width of every figure, inches."""


def key(figure: "Figure", handles: "Sequence[Line2D]", left: float, across: int = 4) -> None:
    """Draw the legend in a band along the lower edge, whose height is given by ``band``."""
    figure.legend(
        handles=handles,
        loc="lower left",
        bbox_to_anchor=(left - 0.02, 0.0),
        ncols=across,
        columnspacing=1.6,
        handletextpad=0.5,
        labelspacing=0.35,
    )


def band(count: int, across: int = 4) -> float:
    """Height (inches) of the band for a legend of ``count`` entries and the axis label above it."""
    return 0.62 + 0.185 * -(-count // across)


def power(exponent: int) -> str:
    """A power of ten as plain text: 10⁻⁴."""
    return "10" + str(exponent).translate(_RAISED)


def decades(axis: "Axis", limit: int) -> None:
    """Label at most ``limit`` decades of a logarithmic axis: 10⁻⁴ as plain text, which is drawn faster than a formula."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axis.set_major_locator(LogLocator(numticks=limit))
    axis.set_major_formatter(FuncFormatter(lambda value, _: power(round(log10(value)))))
    axis.set_minor_formatter(NullFormatter())


def title(figure: "Figure", text: str, below: str = "") -> None:
    """Draw the figure's title in the upper left corner, with an optional muted line below it."""
    height = figure.get_figheight()
    figure.text(0.012, 1 - 0.25 / height, text, weight="bold", size=10.5)
    figure.text(0.012, 1 - 0.44 / height, below, size=8.5, color=MUTED)


def svg(figure: "Figure") -> str:
    """The figure as SVG with its text as text, without date or random identifiers."""
    out = StringIO()
    with plot_style():
        figure.savefig(out, format="svg", metadata={"Date": None, "Creator": "southwell"})
    return compact(out.getvalue())


DPI = 180


def save(figure: "Figure", stem: Path) -> tuple[Path, Path]:
    """Write the figure as SVG and as PNG, and return their paths; the same figure gives the same bytes.

    Raises:
        OSError: if a file cannot be written.
    """
    vector, raster = stem.with_suffix(".svg"), stem.with_suffix(".png")
    atomic.write(vector, svg(figure))
    with plot_style():
        atomic.through(
            raster, lambda file: figure.savefig(file, format="png", dpi=DPI, metadata={"Software": "southwell"})
        )
    return vector, raster


def spread(targets: Sequence[float], gap: float) -> list[float]:
    """Positions as near as possible to ``targets``, in the same order, at least ``gap`` apart; for labels at lines."""
    order = sorted(range(len(targets)), key=lambda k: targets[k])
    blocks: list[tuple[float, list[int]]] = []  # centre and members of labels that touch
    for k in order:
        centre, members = targets[k], [k]
        while blocks and centre - blocks[-1][0] < gap * (len(blocks[-1][1]) + len(members)) / 2:
            members = blocks.pop()[1] + members
            centre = sum(targets[i] for i in members) / len(members)
        blocks.append((centre, members))
    out = [0.0] * len(targets)
    for centre, members in blocks:
        for position, k in enumerate(members):
            out[k] = centre + gap * (position - (len(members) - 1) / 2)
    return out


def label_ends(axes: "Axes", labels: Sequence[tuple[float, str] | tuple[float, str, str]]) -> None:
    """Draw labels at the right edge of ``axes``, each as near to its height (data) as its neighbours allow.

    Args:
        axes: axes whose limits and scales are final.
        labels: height, text, and optional colour.
    """
    size = 8.5
    figure = axes.figure.figure
    assert figure is not None
    points = axes.get_position().height * figure.get_figheight() * 72
    fractions = [float((axes.transScale + axes.transLimits).transform((axes.get_xlim()[1], y))[1]) for y, *_ in labels]
    for y, (_, text, *colour) in zip(spread([f * points for f in fractions], 1.3 * size), labels, strict=True):
        at, offset = (1.0, y / points), (6, 0)
        axes.annotate(
            text, at, offset, "axes fraction", "offset points", va="center", size=size, color=(*colour, INK)[0]
        )
