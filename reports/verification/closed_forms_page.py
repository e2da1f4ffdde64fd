"""``southwell closed-forms``: writes the page of mechanisms that have closed-form solutions."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import numpy as np
from cyclopts import Parameter
from numpy.typing import NDArray

from ...cases.closed_forms.closed_forms import FORMS, ClosedForm
from ...cases.input import atomic
from ...cases.verify.cached import remembered
from ...core.regular_files import read_bytes
from ..shared.console import output
from ..shared.markdown import plain, table
from ..shared.statuses import FAILED, PASSED
from ..shared.style import svg
from ..shared.writing import writable

Found = tuple[ClosedForm, NDArray[np.complex128], NDArray[np.float64]]
Page = tuple[dict[str, str], list[dict[str, str]], bool]
"""The page and its figures, by path; the rows of its table; and whether all differences are within their targets."""

PAGE, FOLDER = "closed-forms.md", "closed-forms"
"""File name of the page, and sub-folder of its figures."""


def command(*, out: Annotated[Path, Parameter(name=["--out", "-o"])] = Path("southwell-report")) -> int:
    """Compare core with mechanisms that have closed-form solutions.

    Pendulums, a top, a turntable, linkages and a spinning ring. Takes ten seconds. Writes closed-forms.md and its figures,
    which `southwell report` includes if they are in the folder of the report.

    Parameters
    ----------
    out
        Output folder.
    """
    return write(remembered(computed), out)


def write(page: Page, out: Path) -> int:
    """Write a page to a folder, print its table, and return the exit status."""
    written, rows, passed = page
    with writable(f"--out {out}"):
        for path, text in written.items():
            (out / path).parent.mkdir(parents=True, exist_ok=True)
            atomic.write(out / path, text)
    console = output()
    console.print(table(rows), markup=False, soft_wrap=True)
    console.print(f"{out / PAGE}", markup=False, soft_wrap=True)
    return PASSED if passed else FAILED


def beside(folder: Path) -> str:
    """A report's page, with headings one level lower and without formulas; empty if there is none."""
    path = folder / PAGE
    if not path.exists():
        return ""
    text = re.sub(r"\$\$.*?\$\$\n\n", "", read_bytes(path).decode(errors="replace"), flags=re.DOTALL)
    return re.sub(r"^#", "##", text, flags=re.MULTILINE)


def pages() -> dict[str, str]:
    """The page and its figures as SVG, by path."""
    return remembered(computed)[0]


def computed() -> Page:
    """Compare core with all closed forms."""
    from .closed_forms_figure import solved  # Matplotlib, which the stored page does not need

    found = [(form, *solved(form)) for form in FORMS]
    return _page(found), _rows(found), all(np.nanmax(off) < form.target for form, _, off in found)


def _page(found: Sequence[Found]) -> dict[str, str]:
    from .closed_forms_figure import figure

    out, parts = {}, [_HEAD, table(_rows(found))]
    for form, values, off in found:
        out[f"{FOLDER}/{form.name}.svg"] = svg(figure(form, values, off))
        parts.append(_section(form))
    return {PAGE: "\n\n".join(parts) + "\n"} | out


def _rows(found: Sequence[Found]) -> list[dict[str, str]]:
    return [
        {
            "mechanism": plain(form.title),
            "source": plain(form.source),
            "speeds": str(len(form.speeds)),
            "largest difference": f"{np.nanmax(off):.1e}",
            "target": f"{form.target:.0e}",
            "verdict": "✔ pass" if np.nanmax(off) < form.target else "✘ fail",
        }
        for form, _, off in found
    ]


_HEAD = """# Closed forms

Core solves any mechanism, so it can be compared with every mechanism that has a closed-form solution. All of these rotate, and
each has a feature that no blade has: critical speeds, a steady state far from the guess, or closed loops. The numbers and
figures are computed when this page is written. The tests contain more closed forms (a rotating slot, a compound pendulum, a
portal frame).

Lines: closed form. Points: core. Below them: the relative difference of the eigenvalues."""


def _section(form: ClosedForm) -> str:
    picture = f"![{form.title}: frequencies against speed]({FOLDER}/{form.name}.svg)"
    return f"## {form.title}\n\n$$\n{form.formula}\n$$\n\n{plain(form.about)}\n\n*Source:* {plain(form.source)}.\n\n{picture}"
