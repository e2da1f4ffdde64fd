"""``southwell cases`` and ``southwell codes``: lists, and installation of codes in isolated environments."""

import sys
from collections.abc import Sequence
from pathlib import Path

from cyclopts import App

from ...cases.input import library
from ...cases.input.errors import nearest
from ...cases.plan import mechanism, turbine
from ...cases.plan.settings import settings
from ...references import isolated
from ...references.isolated import ENVIRONMENTS
from ...references.protocol import registry as registry
from ...references.protocol.description import describe
from ..shared import console
from ..shared.statuses import PASSED
from ..shared.table_columns import tables
from .arguments import RESULTS, finished
from .errors import UsageError


def cases() -> int:
    """List the cases that come with the package."""
    rows = []
    loaded, failures = library.load_all()
    for name, case in loaded.items():
        first, *_ = settings(case)
        blades = ", ".join(v.name.partition("/")[2] for v in case.variants) if len(case.variants) > 1 else "1"
        rows.append((name, case.text.title, blades, first.facts["speeds"]))
    for name in library.mechanisms():
        description = mechanism.subject(library.mechanism(name)).setting()
        rows.append((name, description.title, "mechanism", description.facts["speeds"]))
    for name in library.turbines():
        description = turbine.of_case(library.turbine(name)).setting()
        rows.append((name, description.title, "turbine", description.facts["speeds"]))
    _print(("case", "what", "blades", "speeds"), rows)
    for name, reason in failures.items():
        console.output().print(f"○ {name}: {reason}", style="dim", markup=False, soft_wrap=True)
    return PASSED


def _print(head: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    out = console.output()
    out.print(*tables(head, rows, out.width), sep="\n")


code_app = App(name="codes", result_action="return_value")


@code_app.default
def codes(*, pages: Path | None = None) -> int:
    """List the codes with their versions, what they share with Southwell's own solver, and how to install them.

    Parameters
    ----------
    pages
        Output folder of `southwell verify`. Instead of the list, one page per code is written into the folder, with the
        worst difference of the code on every blade.
    """
    if pages:
        from ..verification import code_pages

        print(code_pages.write(finished(pages / RESULTS), pages))
        return PASSED
    rows = []
    for code in describe(registry.names()):
        version = f"✔ {code.version}" if code.version else f"○ not found; {code.hint}"
        omitted = ", ".join(code.effects.lacks()) or "nothing"
        rows.append(
            (code.name, code.title, f"✘ {code.failure.reason}" if code.failure else version, code.shares, omitted)
        )
    _print(("code", "title", "version", "shares with Southwell", "omits"), rows)
    return PASSED


@code_app.command
def install(code: str, /) -> int:
    """Install a code in an isolated environment, where its dependencies conflict with those of Southwell.

    The environment is created in the cache. Status 1 if it cannot be created.

    Parameters
    ----------
    code
        Name of the code; `southwell codes` lists the codes that need an isolated environment.
    """
    if code not in ENVIRONMENTS:
        raise UsageError(
            f"code: {code!r}: not a code that needs an isolated environment: {nearest(code, list(ENVIRONMENTS))}"
        )
    try:
        folder = isolated.install(ENVIRONMENTS[code])
    except isolated.EnvironmentMissingError as error:
        print(f"southwell: {error}", file=sys.stderr)
        return 1
    print(f"{code} {ENVIRONMENTS[code].version()} in {folder}")
    return PASSED
