"""The summary of a run on two pages: cover, verdict, evidence, what changed since an earlier run, diagram and margins."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from hashlib import sha256
from pathlib import Path

from ...cases.input import atomic
from ...cases.judge.results import Run
from ...cases.judge.witnesses import INDEPENDENT, Witness, groups, witnesses
from ...cases.regression.history import this_machine
from ...cases.store.results_file import RESULTS
from ...core.regular_files import LARGEST_DATA, read_bytes
from ..shared import summary
from ..shared.markdown import plain, plain_table, table
from ..shared.paths import file_name
from . import controls, evidence, paper_table, report
from . import witnesses as groups_text

PAGE = "summary.md"

ROWS = 10
"""Largest number of blades in the table of margins, which has the smallest margins first."""


@dataclass(frozen=True)
class Document:
    """What an archive asks of a document.

    Attributes:
        number: document number.
        revision: of the document.
        since: lines on what changed since an earlier run, the first one the verdict.
    """

    number: str = ""
    revision: str = ""
    since: Sequence[str] = ()


def write(run: Run, folder: Path, document: Document) -> Path:
    """Write ``summary.md`` beside the results of a run and return its path; figures are those of its report.

    Raises:
        OSError: if the results cannot be read or the page cannot be written.
    """
    path = folder / PAGE
    atomic.write(path, render(run, folder, document))
    return path


def render(run: Run, folder: Path, document: Document) -> str:
    """The page as Markdown."""
    cases = summary.cases(run)
    name = plain(cases[0]) if len(cases) == 1 else f"{len(cases)} cases"
    by_margin = sorted(cases, key=lambda case: -_used(run, case))
    figure = next(
        (f for case in by_margin if (folder / (f := f"figures/{file_name(case)}-campbell.svg")).is_file()), ""
    )
    selection_note = (
        f" {ROWS} of {len(cases)}, the smallest margins first; the report has all." if len(cases) > ROWS else ""
    )
    parts = [
        f"# Verification of {name}",
        *report.marked(run, [line for line in (summary.incomplete(run), evidence.answer(run)) if line]),
        table(_cover(run, folder, document)),
        "## Evidence",
        plain_table(evidence.rows(run)),
        *[plain(line) for line in (paper_table.line(run), groups_text.headline(run), controls.headline(run)) if line],
        "## Changes",
        "\n\n".join(plain(line) for line in document.since) or "Not compared with an earlier run (`--since`).",
        f"![Natural frequencies versus rotor speed]({figure})" if figure else "",
        "## Margins to the target",
        f"*used*: largest |difference| + uncertainty of the answers that share nothing with Southwell's own solver, in % "
        f"of the target.{selection_note}",
        table([_margin(run, case) for case in by_margin[:ROWS]]),
    ]
    return "\n\n".join(part for part in parts if part) + "\n"


def _cover(run: Run, folder: Path, document: Document) -> list[dict[str, str]]:
    results = folder / RESULTS
    digest = sha256(read_bytes(results, LARGEST_DATA)).hexdigest()
    computed = datetime.fromtimestamp(results.stat().st_mtime, UTC)
    versions = ", ".join(
        f"{name} {v}" for name, v in run.versions.items() if v != "not installed" and "southwell " not in v
    )
    inputs = "; ".join(dict.fromkeys(s.source for s in run.settings if s.source)) if len(run.settings) == 1 else ""
    cases = "1 case" if len(run.settings) == 1 else f"{len(run.settings)} cases"
    settings = sha256(repr(run.settings).encode()).hexdigest()
    rows = {
        "document": document.number,
        "revision": document.revision,
        "source of the blade": plain(inputs),
        "input": f"settings of {cases}, SHA-256 `{settings}`",
        "results": f"{RESULTS}, SHA-256 `{digest}`",
        "computed, written": f"{computed:%Y-%m-%d %H:%M} UTC, {datetime.now(UTC):%Y-%m-%d %H:%M} UTC",
        "versions": plain(versions),
        "machine": plain(this_machine()),
        "command": f"`{' '.join(run.command.split()).replace('`', '')}`" if run.command else "",
    }
    return [{"": k, "value": v} for k, v in rows.items() if v]


def _independent(run: Run, case: str) -> list[Witness]:
    return [w for w in witnesses(run, case) if w.kind in INDEPENDENT]


def _used(run: Run, case: str) -> float:
    """Largest |d| + u of a case's independent answers, relative to their target; 0 without one."""
    names = {w.name for w in _independent(run, case)}
    considered = (c for c in run.cells if c.case == case and c.code in names and c.verdict in ("pass", *summary.BAD))
    return max((_size(c.difference, c.uncertainty) / c.target for c in considered), default=0.0)


def _size(difference: float | None, uncertainty: float | None) -> float:
    return abs(difference or 0.0) + (uncertainty or 0.0)


def _margin(run: Run, case: str) -> dict[str, str]:
    cells = [c for c in run.cells if c.case == case]
    setting = summary.setting(run, case)
    verdict = summary.worst_verdict(c for c in cells if c.verdict != "known difference") if cells else "not run"
    required = f" of {setting.groups} required" if setting and setting.groups else ""
    return {
        "blade": plain(case),
        "answer": f"{summary.SYMBOL[verdict]} {verdict}",
        "target": summary.allowed(setting.target) if setting and setting.target else "",
        "used": f"{100 * _used(run, case):.0f} %",
        "independent groups": f"{len(groups(witnesses(run, case)))}{required}",
    }
