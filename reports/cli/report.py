"""``southwell report``, and what every run shows at its end."""

from pathlib import Path

from ...cases.judge.results import Run
from ..shared.console import output
from ..verification import terminal
from .arguments import RESULTS, Flag, finished
from .exit_status import PASSED, UsageError


def command(folder: Path, /, *, html: Flag = False, pdf: Flag = False) -> int:
    """Rewrite the report of a finished run from its results.jsonl.

    Parameters
    ----------
    folder
        Output folder of `southwell verify`.
    html
        Also write report.html, one file with its figures.
    pdf
        Also write report.pdf; requires the extra `pdf` (WeasyPrint).
    """
    written = show(finished(folder / RESULTS), folder)
    if html or pdf:
        from ..verification import html as page

        if html:
            print(page.write(written))
        if pdf:
            try:
                print(page.pdf(written))
            except page.PdfError as error:
                raise UsageError(str(error)) from error
    return PASSED


def show(run: Run, folder: Path) -> Path:
    """Write the report and print its summary; the path of the report."""
    from ..verification import (
        report as matrix_report,  # with its figures half of a command's time to start, and of every worker's
    )

    report = matrix_report.write(run, folder)
    console = output()
    for line in matrix_report.headline(run):
        console.print(line.replace("**", ""), markup=False)
    for table in terminal.matrix(run, console.width):
        console.print(table)
    console.print(terminal.legend(), style="dim", markup=False)
    if run.controls:
        console.print(terminal.controls(run))
    console.print(f"{report}, {folder / RESULTS}", markup=False, soft_wrap=True)
    return report
