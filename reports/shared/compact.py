"""SVG in half the space: what Matplotlib writes, without what does not show.

Styles that repeat become classes, numbers have two decimals (hundredths of a point), and names that nothing refers to are left
out. Text is not touched.
"""

import re

UNSEEN = re.compile(r"<\?xml.*?\?>|<!DOCTYPE.*?>|<metadata>.*?</metadata>|<!--.*?-->", re.DOTALL)
TAG = re.compile(r"<[^<>]+>")
NUMBER = re.compile(r"-?\d+\.\d{3,}(?![\d.e])")
STYLE = re.compile(r' style="([^"]*)"')
NAME = re.compile(r' id="([^"]*)"')
REFERENCE = re.compile(r'(href="#|url\(#)([\w-]+)')
GROUP = re.compile(r"</?g\b[^<>]*>")

FONT = "'DejaVu Sans'"
FONTS = f"{FONT},Verdana,sans-serif"
"""Verdana has nearly the same widths; one of the two is on almost every machine."""


def compact(svg: str) -> str:
    """The same drawing in fewer characters."""
    svg = UNSEEN.sub("", svg)
    referenced = dict.fromkeys(name for tag in TAG.findall(svg) for _, name in REFERENCE.findall(tag))
    names = {old: f"i{k}" for k, old in enumerate(referenced)}
    looks: dict[str, str] = {}

    def shorter(tag: re.Match[str]) -> str:
        text = STYLE.sub(lambda m: f' class="{looks.setdefault(m[1], f"s{len(looks)}")}"', tag[0])
        text = NAME.sub(lambda m: f' id="{names[m[1]]}"' if m[1] in names else "", text)
        text = REFERENCE.sub(lambda m: m[1] + names[m[2]], text)
        text = NUMBER.sub(lambda m: f"{float(m[0]):.2f}".rstrip("0").rstrip("."), text)
        return " ".join(text.split())

    svg = TAG.sub(shorter, svg)
    rules = "".join(f".{name}{{{look}}}" for look, name in looks.items()).replace("; ", ";").replace(": ", ":")
    rules = f"text{{white-space:pre}}{rules.replace(FONT, FONTS)}"  # two spaces are two
    svg = svg.replace("</style>", f"{rules}</style>", 1)
    return _ungrouped(re.sub(r">\s+<", "><", svg)).strip() + "\n"


def _ungrouped(svg: str) -> str:
    """Without the groups that have no attribute: their members are drawn as if they were not in one."""
    inside: list[bool] = []

    def kept(tag: re.Match[str]) -> str:
        if tag[0].endswith("/>"):
            return tag[0].removeprefix("<g/>")
        if tag[0] != "</g>":
            inside.append(tag[0] != "<g>")
            return tag[0] if inside[-1] else ""
        return tag[0] if inside.pop() else ""

    return GROUP.sub(kept, svg)
