"""The page on linearisations: its table of planted defects and its sessions are generated.

``python -m southwell.tests.support.linearised_page`` writes them anew; the folder SOUTHWELL_LINEARISED has the public files.
"""

import contextlib
import io
import os
import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from southwell.cases.linearisation.findings import Finding
from southwell.cases.linearisation.judgement import judge_set
from southwell.cases.linearisation.lin_file import parsed
from southwell.cases.linearisation.sets import azimuth_set
from southwell.reports.cli.app import main

from .linearised_defects import DEFECTS, Defect
from .linearised_machines import Lin

PAGE = Path(__file__).parents[2] / "docs" / "linearisations.md"

_SESSION = re.compile(r"(?<=```text\n)\$ southwell judge ([^\n]*)\n.*?(?=```)", re.DOTALL)
_TABLE = re.compile(r"(?<=\| planted \| named \| finding \|\n\|:--\|:--\|:--\|\n)(?:\|[^\n]*\n)+")


def findings_of(lins: Sequence[Lin]) -> tuple[Finding, ...]:
    """The findings about a set."""
    files = [parsed(Path(f"case.{k + 1}.lin"), lin.text()) for k, lin in enumerate(lins)]
    return judge_set(azimuth_set("case", files)).findings


def row(defect: Defect, findings: Sequence[Finding]) -> str:
    """The row of a defect in the table: planted, named, and what was found."""
    first = next(finding for finding in findings if finding.name in defect.names)
    return f"| {defect.title} | {first.name} | {first.observation.replace('|', '·')} |\n"


def sessions(text: str) -> Iterator[tuple[str, str]]:
    """The words of each session of the page, and the text of its block."""
    for block in _SESSION.finditer(text):
        yield block[1], block[0]


def session(words: str, folder: Path) -> str:
    """The block of a session, run in a folder."""
    expanded: list[str] = []
    for word in words.split():
        expanded += sorted(str(path.relative_to(folder)) for path in folder.glob(word)) if "*" in word else [word]
    out = io.StringIO()
    with contextlib.chdir(folder), contextlib.redirect_stdout(out):
        try:
            main(["judge", *expanded])
        except SystemExit as status:
            if status.code not in (0, 1, None):
                raise
    lines = [line.rstrip() for line in out.getvalue().splitlines()]
    return f"$ southwell judge {words}\n" + "\n".join(lines).rstrip() + "\n"


def written(text: str, folder: Path) -> str:
    """The page with its table and sessions written anew."""
    table = "".join(row(defect, findings_of(defect.plant())) for defect in DEFECTS)
    text = _TABLE.sub(lambda _: table, text)
    return _SESSION.sub(lambda block: session(block[1], folder), text)


if __name__ == "__main__":
    PAGE.write_text(
        written(PAGE.read_text(encoding="utf-8"), Path(os.environ["SOUTHWELL_LINEARISED"])), encoding="utf-8"
    )
