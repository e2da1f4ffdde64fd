"""``southwell cases`` and ``southwell codes``: lists, and installation of codes in isolated environments."""

import sys
from pathlib import Path

from cyclopts import App
from rich import box
from rich.table import Table
from rich.text import Text

from ...cases.input import library
from ...cases.input.errors import nearest
from ...cases.verify import mechanism_case
from ...cases.verify.settings import settings
from ...references import isolated
from ...references.isolated import ENVIRONMENTS
from ...references.protocol import registry as registry
from ...references.protocol.description import describe
from ..shared import console
from ..shared.statuses import PASSED
from .arguments import RESULTS, finished
from .errors import UsageError


def cases() -> int:
    """List the cases that come with the package."""
    table = Table(box=box.SIMPLE_HEAD)
    for head in ("case", "what", "blades", "speeds"):
        table.add_column(head, overflow="fold")
    found, absent = library.everything()
    for name in library.names():
        if name in absent:
            table.add_row(name, absent[name], "", "")
            continue
        known = found[name]
        first, *_ = settings(known)
        blades = ", ".join(v.name.partition("/")[2] for v in known.variants) if len(known.variants) > 1 else "1"
        table.add_row(name, known.text.title, blades, first.facts["speeds"])
    for name in library.mechanisms():
        about = mechanism_case.setting(mechanism_case.case(library.mechanism(name)))
        table.add_row(name, about.title, "mechanism", about.facts["speeds"])
    console.output().print(table)
    return PASSED


code_app = App(name="codes", result_action="return_value")


@code_app.default
def codes(*, pages: Path | None = None) -> int:
    """List the codes: version, what they share with core, how to install them.

    Parameters
    ----------
    pages
        Output folder of `southwell verify`: write one page per code into it instead, with its worst difference on every blade.
    """
    if pages:
        from ..verification import code_pages

        print(code_pages.write(finished(pages / RESULTS), pages))
        return PASSED
    table = Table(box=box.SIMPLE_HEAD)
    for head in ("code", "title", "version", "shares with core", "omits"):
        table.add_column(head, overflow="fold")
    for known in describe(registry.names()):
        found = f"✔ {known.version}" if known.version else f"○ not found; {known.hint}"
        table.add_row(
            known.name,
            known.title,
            Text(f"✘ {known.failure.reason}" if known.failure else found),
            known.shares,
            ", ".join(known.effects.lacks()) or "nothing",
        )
    console.output().print(table)
    return PASSED


@code_app.command
def install(code: str, /) -> int:
    """Install a code in an isolated environment, where its dependencies conflict with those of Southwell.

    The environment is created in the cache. Status 1 if it cannot be created.

    Parameters
    ----------
    code
        Name of the code; `southwell codes` shows which need this.
    """
    if code not in ENVIRONMENTS:
        raise UsageError(f"code: {code!r}: no environment of its own: {nearest(code, list(ENVIRONMENTS))}")
    try:
        folder = isolated.install(ENVIRONMENTS[code])
    except isolated.EnvironmentMissingError as error:
        print(f"southwell: {error}", file=sys.stderr)
        return 1
    print(f"{code} {ENVIRONMENTS[code].version()} in {folder}")
    return PASSED
