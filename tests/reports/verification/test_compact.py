"""Compact SVG: the same drawing, with its text untouched and every reference resolved, in less than half the space."""

import re
from xml.etree import ElementTree

import matplotlib as mpl
from matplotlib.figure import Figure

from southwell.reports.shared.compact import compact
from southwell.reports.shared.style import plot_style, svg

NUMBERS = re.compile(r"-?\d+(?:\.\d+)?")


def full(figure: Figure, monkeypatch) -> str:
    monkeypatch.setattr("southwell.reports.shared.style.compact", lambda text: text)
    return svg(figure)


def drawing() -> Figure:
    with plot_style():
        figure = Figure((4.0, 3.0))
        axes = figure.subplots()
        axes.plot([0.123456789, 2.0, 3.3333333], [1.0, 0.7654321, 2.0], "o-", label="code 1.2345678 #m0")
        axes.plot([0.0, 3.0], [1.0, 2.0], "s", mfc="white", mec="#0072b2")
        axes.set_title("difference 1.23456e-05, core's  \u03b3 = 0.123456")
        axes.legend()
    return figure


def inside(text: str) -> list[str]:
    return ["".join(node.itertext()) for node in ElementTree.fromstring(text).iter() if node.tag.endswith("text")]


def test_text_is_unchanged(monkeypatch) -> None:
    before = inside(full(drawing(), monkeypatch))
    assert "code 1.2345678 #m0" in before
    assert inside(compact(full(drawing(), monkeypatch))) == before


def test_every_reference_is_resolved_and_half_the_space_is_saved(monkeypatch) -> None:
    long = full(drawing(), monkeypatch)
    short = compact(long)
    assert len(short) < 0.6 * len(long)
    named = set(re.findall(r' id="([^"]*)"', short))
    assert named == set(re.findall(r'(?:href="#|url\(#)([\w-]+)', short))
    classes = set(re.findall(r' class="(\w+)"', short))
    assert classes
    assert classes == set(re.findall(r"\.(s\d+)\{", short))


def test_shapes_and_looks_are_kept(monkeypatch) -> None:
    """Coordinates within 0.005 points, and the style of each shape, as a class."""
    long = full(drawing(), monkeypatch)
    short = compact(long)
    looks = dict(re.findall(r"\.(s\d+)\{([^}]*)\}", short))

    def shapes(text: str) -> list[tuple[list[float], str]]:
        out = []
        for node in ElementTree.fromstring(text).iter():
            look = looks.get(node.get("class", ""), node.get("style", "")).replace(" ", "")
            numbers = "".join(node.get(name, "") + " " for name in ("d", "x", "y", "transform"))
            out.append(([float(n) for n in NUMBERS.findall(numbers)], look))
        return [shape for shape in out if shape[0]]

    assert mpl.rcParams["svg.fonttype"] == "path"  # outside of the house's style
    before, after = shapes(long), shapes(short)
    assert [look for _, look in before] == [look.replace(",Verdana,sans-serif", "") for _, look in after]
    for (a, _), (b, _) in zip(before, after, strict=True):
        assert len(a) == len(b)
        assert max(abs(p - q) for p, q in zip(a, b, strict=True)) <= 0.005 + 1e-9


def test_only_groups_without_attributes_are_opened() -> None:
    drawn = '<g id="none"> <g clip-path="url(#c)"><g><path d="M0 0"/></g><g/></g><g><g class="x"/></g></g>'
    text = f'<svg><defs><clipPath id="c"/><style></style></defs>{drawn}</svg>'
    assert compact(text).partition("</defs>")[2] == '<g clip-path="url(#i0)"><path d="M0 0"/></g><g class="x"/></svg>\n'
