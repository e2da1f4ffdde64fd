"""Colours of verdicts in tables on the screen and on paper, in addition to their signs and words."""

from ..shared.summary import SYMBOL

INK, FAINT, GREY, HEAD = "#1a1a1a", "#d8d8d8", "#6b6b6b", "#f3f4f6"
"""Colours of text, of lines, of text about answers that are missing, and of the head of a table."""

NAMES = {sign: verdict.replace(" ", "-") for verdict, sign in SYMBOL.items()}
"""Sign of a verdict → its name in styles."""

BACKGROUND = {
    "pass": "#b7e3d3",
    "fail": "#f3b08f",
    "inconclusive": "#f9dd9a",
    "known-difference": "#bfe0f7",
    "measured": "#ead9f0",
}
"""Background of cells of a verdict; the other verdicts are grey text."""

MUTED = tuple(name for name in NAMES.values() if name not in BACKGROUND)
"""Verdicts without a colour of their own."""
