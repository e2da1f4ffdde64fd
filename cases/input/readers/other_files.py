"""Files that come with a blade's but are not one: what they are, and which file to give."""

import re
from collections.abc import Callable

from .text import Text

OPENFAST = re.compile(
    r"-{3,}\s*(aerodyn|servodyn|inflowwind|hydrodyn|subdyn|moordyn|map\+*|icedyn|elastodyn)\b", re.IGNORECASE
)
"""Heading of an input file of one of OpenFAST's modules."""

MODULE_FILE = (
    "an input file of OpenFAST's {}, without the blade's structure: give ElastoDyn's or BeamDyn's file, or the .fst"
)

MARKS: tuple[tuple[Callable[[Text], bool], str], ...] = (
    (
        lambda text: any(line.startswith("Linearized model") for line in text.lines[:5]),
        "a linearisation that OpenFAST has written, not its input: give the .fst file of that run, or the blade's file; "
        "to judge the linearisation, run `southwell judge FILE.lin`",
    ),
    (
        lambda text: any(re.search(r"Mode No\.\s*\d+\s*\(freq", line) for line in text.lines),
        "frequencies that BModes has printed, not its input: give the .bmi file; to compare these frequencies, add "
        "--add bmodes=FILE.out to `southwell verify`",
    ),
)
"""How a file is recognised, and what it is."""


def description(text: Text) -> str | None:
    """What a file is that contains no blade, and the remedy; None if it is unknown."""
    for matches, explanation in MARKS:
        if matches(text):
            return explanation
    module = next((match[1] for line in text.lines[:3] if (match := OPENFAST.match(line))), None)
    return MODULE_FILE.format(module) if module else None
