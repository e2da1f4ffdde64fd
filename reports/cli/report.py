"""``southwell report``, and the summary that every run prints at its end."""

from concurrent.futures import Executor
from pathlib import Path

from ...cases.judge.results import Run
from ...cases.store import unfinished
from ..shared.console import output
from ..shared.statuses import INCOMPLETE, PASSED
from ..verification import diagnoses, evidence, terminal
from .arguments import RESULTS, run_in, writing


def command(folder: Path, /, *, html: bool = False, pdf: bool = False) -> int:
    """Rewrite the report of a finished run from its results.jsonl.

    A stopped run is shown as far as it got, with status 3; the report of an earlier complete run is kept.

    Parameters
    ----------
    folder
        Output folder of `southwell verify`.
    html
        Also write report.html, one file with its figures.
    pdf
        Also write report.pdf; requires the extra `pdf` (Typst).
    """
    if pdf:
        from ..documents import pdf as paper

        paper.require()
    run = run_in(folder if folder.is_dir() else folder / RESULTS)
    with writing(folder):
        report_path = show(run, folder)
    if report_path is None:
        return INCOMPLETE
    if html:
        from ..documents import html as page

        print(page.write(report_path))
    if pdf:
        from ..documents import pdf as paper

        print(paper.write(report_path))
    return INCOMPLETE if run.unfinished else PASSED


def show(run: Run, folder: Path, executor: Executor | None = None) -> Path | None:
    """Write the report, its figures by the ``executor``, and print its summary; return the path of the report.

    Nothing is written, and None returned, if the run is unfinished and the existing report is of a complete run.
    """
    from ..verification import (
        report as matrix_report,  # not at the top: the figures take half of the start-up time
    )

    keeps_earlier = bool(run.unfinished) and (folder / RESULTS).exists()
    report = None if keeps_earlier else matrix_report.write(run, folder, executor)
    show_tables(run)
    notice = f"{folder / RESULTS}: of an earlier run, unchanged"
    message = notice if keeps_earlier else f"{report}, {folder / (unfinished.NAME if run.unfinished else RESULTS)}"
    output().print(message, markup=False, soft_wrap=True)
    return report


def show_tables(run: Run) -> None:
    """Print the headline, the matrix and the controls on standard output."""
    from ..verification import report as matrix_report

    console = output()
    answer = evidence.verdict(run)
    for line in matrix_report.headline(run):
        style = f"bold {terminal.COLOUR[evidence.VERDICT_OF[evidence.word(run)]]}" if line.startswith(answer) else None
        console.print(line, style=style, markup=False, soft_wrap=True)
    for table in terminal.matrix(run, console.width):
        console.print(table)
    console.print(terminal.legend(), style="dim", markup=False)
    for line in diagnoses.lines(run):
        console.print(f"Why it differs: {line}", markup=False, soft_wrap=True)
    if run.controls:
        console.print(terminal.controls(run, console.width))
