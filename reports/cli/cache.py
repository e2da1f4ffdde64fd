"""``southwell cache``: lists, checks and removes stored answers."""

import sys
import time

from cyclopts import App
from rich import box
from rich.table import Table

from ...references.protocol import store
from ..shared import console
from ..shared.statuses import FAILED, PASSED
from .arguments import Positive
from .errors import UsageError

DAY = 86_400.0

app = App(
    name="cache",
    help="Show, check or empty the store of answers that verify reuses.",
    result_action="return_value",
)


@app.command(name="list")
def listing() -> int:
    """List the stored answers by code: number, size, and when they were computed."""
    user_store = _opened()
    table = Table(box=box.SIMPLE_HEAD, caption=str(store.path()))
    for head, side in (("code", "left"), ("answers", "right"), ("MB", "right"), ("first", "left"), ("last", "left")):
        table.add_column(head, justify=side, overflow="fold")  # pyright: ignore[reportArgumentType]
    for entry in user_store.kept():
        first, last = (
            time.strftime("%Y-%m-%d %H:%M", time.localtime(seconds)) for seconds in (entry.first, entry.last)
        )
        table.add_row(entry.label, str(entry.count), f"{entry.size / 1e6:.1f}", first, last)
    console.output().print(table)
    return PASSED


@app.command
def verify() -> int:
    """Check the integrity of every stored answer; status 1 if one is damaged (a run would compute it again)."""
    user_store = _opened()
    damaged = user_store.damaged()
    total = sum(entry.count for entry in user_store.kept())
    print(f"{total} answers, {len(damaged)} damaged")
    return FAILED if damaged else PASSED


@app.command
def prune(*, days: Positive = 30.0) -> int:
    """Remove stored answers.

    Parameters
    ----------
    days
        Age in days above which answers are removed.
    """
    print(f"{_opened().prune(time.time() - days * DAY)} answers removed", file=sys.stdout)
    return PASSED


def _opened() -> store.Store:
    try:
        return store.users()
    except OSError as error:
        raise UsageError(f"store of answers: {error}: set SOUTHWELL_CACHE to another folder") from error
