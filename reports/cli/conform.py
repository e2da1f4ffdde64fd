"""``southwell conform``: what an adapter must pass, asked of one."""

from collections import Counter

from rich import box
from rich.table import Table

from ...cases.conformance.worker import outcomes
from ...references.protocol.description import describe
from ...references.protocol.registry import UnknownCodeError
from ..shared.console import output

MARKS = {"pass": "✔", "fail": "✘", "not applicable": "–", "not run": "○"}


def command(code: str, /) -> int:
    """Ask a code what every adapter must pass: closed forms, symmetries, and whether it drops what it does not refuse.

    Status 1 if it fails a check, or is not installed.

    Parameters
    ----------
    code
        A name (`southwell codes`), or the import path `module:attribute` of an adapter.
    """
    (known,) = describe([code])
    if not known.blades:
        raise UnknownCodeError(f"code: {code!r} takes mechanisms, not blades: there are no checks for it")
    table = Table(box=box.SIMPLE_HEAD)
    for head in ("", "check", "law, or why not"):
        table.add_column(head, overflow="fold")
    found = outcomes(code)
    for outcome in found:
        table.add_row(MARKS[outcome.verdict], outcome.check.name, outcome.reason or outcome.check.law)
    console = output()
    console.print(table, markup=False)
    tally = Counter(outcome.verdict for outcome in found)
    counted = ", ".join(f"{tally[verdict]} {verdict}" for verdict in MARKS if tally[verdict])
    console.print(f"{known.title or known.name}: {counted}", markup=False)
    return 1 if tally["fail"] or tally["not run"] else 0
