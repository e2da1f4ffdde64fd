"""``southwell pages``: a run as pages for readers: report.html, the dashboard, and the summary on two pages."""

from importlib.util import find_spec
from pathlib import Path

from ...cases.regression import history
from ...cases.regression.gate import compare
from ..ci import gate_text
from ..dashboard.write import write as write_dashboard
from ..documents import html
from ..shared.statuses import INCOMPLETE, PASSED
from ..shared.units import BY_KEY
from ..verification import brief
from .arguments import RESULTS, run_in, writing
from .gate import earlier

DASHBOARD = "dashboard"


def command(
    folder: Path, /, *, document: str = "", revision: str = "", since: Path | None = None, commit: str = ""
) -> int:
    """Write the HTML report, the dashboard and a two-page summary of a run.

    The files are report.html (if report.md exists), dashboard/index.html, summary.html and, if Typst is installed (extra
    `pdf`), summary.pdf. The summary has the verdict, the evidence, a diagram, margins, digests, versions, and what changed
    since an earlier run.

    Parameters
    ----------
    folder
        Output folder of `southwell verify`.
    document
        Document number on the cover.
    revision
        Revision on the cover.
    since
        History (`southwell history add`), or the output folder or results.jsonl of the run of an earlier release.
    commit
        The run of this commit, or release, in the history; its first characters suffice.
    """
    run = run_in(folder)
    lines: list[str] = []
    if since:
        gate = compare(earlier(since, commit), history.entry(run, str(folder)))
        units = {s.case: BY_KEY[s.unit] for s in run.settings}
        counts = [f"{title}: {len(rows)}" for title, rows in gate_text.sections(gate, units)]
        versions = [f"{name} {before} → {after}" for name, (before, after) in gate.versions.items()]
        lines = [gate_text.verdict(gate, strict=False), *filter(None, ["; ".join(counts), "; ".join(versions)])]
    with writing(folder):
        paths = [brief.write(run, folder, brief.Document(document, revision, lines))]
        if (report := folder / "report.md").is_file():
            paths.append(html.write(report))
        paths.append(html.write(paths[0]))
        if find_spec("typst"):
            from ..documents import pdf

            paths.append(pdf.write(paths[0]))
        paths.append(write_dashboard({folder.name or RESULTS: run}, None, folder / DASHBOARD))
    print(f"{folder}: {', '.join(str(path.relative_to(folder)) for path in paths)}")
    return INCOMPLETE if run.unfinished else PASSED
