"""``southwell dashboard``: writes runs and their history as a static site that opens from the file system."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from ...cases.input.errors import CaseError
from ..dashboard.write import write
from ..shared.statuses import INCOMPLETE, PASSED
from ..shared.summary import incomplete
from .arguments import run_in
from .history import load


def command(
    *folders: Path,
    history: Path | None = None,
    out: Annotated[Path, Parameter(name=["--out", "-o"])] = Path("southwell-dashboard"),
) -> int:
    """Write one or several runs as a static web site.

    The site needs neither a server nor a network connection.

    The status is 3 if a run is incomplete, which its pages state.

    Parameters
    ----------
    folders
        Output folders of `southwell verify`, or their results.jsonl.
    history
        History file (`southwell history add`): adds a page with every frequency and difference by commit.
    out
        Output folder.
    """
    if not folders:
        raise CaseError("folders: none given: give an output folder of `southwell verify`")
    names = [folder.name or str(folder.resolve()) for folder in folders]
    if len(set(names)) < len(names):
        names = [str(folder) for folder in folders]
    runs = {name: run_in(folder) for name, folder in zip(names, folders, strict=True)}
    for name, run in runs.items():
        if message := incomplete(run):
            print(f"{name}: {message}")
    loaded_history = load(history) if history is not None else None
    try:
        print(write(runs, loaded_history, out))
    except OSError as error:
        raise CaseError(f"{error.filename}: {error.strerror}: give another --history or --out") from error
    return INCOMPLETE if any(run.unfinished for run in runs.values()) else PASSED
