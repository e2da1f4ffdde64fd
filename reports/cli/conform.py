"""``southwell conform``: the conformance checks of an adapter."""

from collections import Counter

from ...cases.conformance.suite import CHECKS, FOR_MECHANISMS
from ...cases.conformance.worker import outcomes
from ...references.protocol.description import describe
from ...references.protocol.registry import ADVICE, UnknownCodeError
from ..shared.console import output
from ..shared.table_columns import tables
from .errors import UsageError

MARKS = {"pass": "✔", "fail": "✘", "not applicable": "–", "not run": "○"}


def command(code: str, /) -> int:
    """Run the conformance checks on a code.

    The checks compare the code with closed forms and symmetries, and test whether its adapter ignores an effect that it neither
    declines nor declares. The status is 1 if a check fails or the code is not installed.

    Parameters
    ----------
    code
        Name of a code (listed by `southwell codes`), or import path `module:attribute` of an adapter.
    """
    (description,) = describe([code])
    if description.failure and description.failure.reason.startswith("import: "):
        why = description.failure.reason.removeprefix("import: ")
        raise UnknownCodeError(f"code: {code!r} cannot be loaded: {why}: {ADVICE}")
    if description.turbines and not (description.blades or description.mechanisms):
        why = "the checks are for codes that solve blades or mechanisms"
        raise UsageError(f"conform {code}: {why}: run southwell verify nrel-5mw-turbine --codes {code}")
    checks = (*(CHECKS if description.blades else ()), *(FOR_MECHANISMS if description.mechanisms else ()))
    results = outcomes(code, checks if not description.failure else CHECKS)
    rows = [(MARKS[outcome.verdict], outcome.check.name, outcome.reason or outcome.check.law) for outcome in results]
    console = output()
    console.print(*tables(("", "check", "law, or reason"), rows, console.width), sep="\n")
    tally = Counter(outcome.verdict for outcome in results)
    tally_text = ", ".join(f"{tally[verdict]} {verdict}" for verdict in MARKS if tally[verdict])
    console.print(f"{description.title or description.name}: {tally_text}", markup=False)
    return 1 if tally["fail"] or tally["not run"] else 0
