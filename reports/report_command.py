"""``southwell report``, and what every run shows at its end."""

from pathlib import Path

from ..cases import results
from ..cases.results import Run
from . import terminal
from .arguments import PASSED, RESULTS, Flag, UsageError


def command(folder: Path, /, *, html: Flag = False, pdf: Flag = False) -> int:
    """Write report.md and figures anew from the results.jsonl in a folder.

    Parameters
    ----------
    folder
        What `southwell verify --out` was given.
    html
        Also report.html, one file with the figures inside it.
    pdf
        Also report.pdf; needs the extra `pdf` (WeasyPrint).
    """
    written = show(stored(folder), folder)
    if html or pdf:
        from . import html as page

        if html:
            print(page.write(written))
        if pdf:
            try:
                print(page.pdf(written))
            except page.PdfError as error:
                raise UsageError(str(error)) from error
    return PASSED


def stored(folder: Path) -> Run:
    """The results in a report's folder."""
    path = folder / RESULTS
    try:
        run = results.read(path)
    except FileNotFoundError:
        raise UsageError(f"{path}: no such file: give a folder that `southwell verify --out` has written") from None
    except OSError as error:
        remedy = "give a folder that `southwell verify --out` has written"
        raise UsageError(f"{path}: cannot be read ({error.strerror}): {remedy}") from error
    except ValueError as error:
        raise UsageError(str(error)) from error
    if not run.cells:
        raise UsageError(f"{path}: no results in it: the run was cut short before its first; run `southwell verify`")
    return run


def show(run: Run, folder: Path) -> Path:
    """Write the report, print what it says first; the report's path."""
    from . import markdown  # with its figures half of a command's time to start, and of every worker's

    report = markdown.write(run, folder)
    console = terminal.output()
    for line in markdown.headline(run):
        console.print(line.replace("**", ""), markup=False)
    for table in terminal.matrix(run, console.width):
        console.print(table)
    console.print(terminal.legend(), style="dim", markup=False)
    if run.controls:
        console.print(terminal.controls(run))
    console.print(f"{report}, {folder / RESULTS}", markup=False, soft_wrap=True)
    return report
