"""Writes the site: pages for the matrix, for each case and code, and for the history, with style and scripts."""

import json
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined, Template
from markupsafe import Markup

from ...cases.input import atomic
from ...cases.judge.results import Run
from ...cases.regression.history import History
from ..shared import summary
from . import data
from .past import of_history

SCRIPTS = {
    "matrix": ("page.js", "grid.js", "matrix.js"),
    "case": ("page.js", "grid.js", "charts.js", "rotor.js", "case.js"),
    "codes": ("page.js", "codes.js"),
    "code": ("page.js", "codes.js"),
    "history": ("page.js", "charts.js", "history.js"),
}
"""Scripts of each kind of page; the last one draws the page."""

POLICY = (
    "default-src 'none'; script-src 'self' file:; style-src 'self' file:; img-src data:; base-uri 'none'; "
    "form-action 'none'"
)
"""Content security policy of a page: only the site's scripts and style are allowed, none inline.

``file:`` allows them if the site is opened from a disk.
"""

ASSETS = ("dashboard.css", *dict.fromkeys(name for names in SCRIPTS.values() for name in names))


def write(runs: dict[str, Run], history: History | None, folder: Path) -> Path:
    """Write the site of ``runs`` (name → run, the first is the start page) into ``folder``; return its path.

    Raises:
        OSError: if a file cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for name in ASSETS:
        text = files(__package__ or "").joinpath("templates", name).read_text(encoding="utf-8")
        atomic.write(folder / name, text)
    starts = {name: "index.html" if k == 0 else f"run-{k + 1}/index.html" for k, name in enumerate(runs)}
    for k, (name, run) in enumerate(runs.items()):
        run_folder = folder / f"run-{k + 1}" if k else folder
        up = "../" if k else ""
        links = {n: up + path for n, path in starts.items()}
        _run(run, name, run_folder, {"up": up, "runs": links, "here": name, "past": history is not None})
    if history is not None:
        shared = {"up": "", "runs": starts, "here": "", "past": True}
        atomic.write(folder / "history.html", _page("history", "History", of_history(history), shared))
    return folder / "index.html"


def _run(run: Run, name: str, folder: Path, shared: dict[str, Any]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    codes = {"codes": data.codes(run), "verdicts": data.verdicts()}
    pages = {
        "index.html": _page("matrix", name, data.first(run, name), shared),
        "codes.html": _page("codes", f"Codes · {name}", codes, shared),
    }
    for code in data.code_names(run):
        pages[data.page(code, "code")] = _page("code", f"{code} · {name}", data.of_code(run, code), shared)
    for case in summary.cases(run):
        pages[data.page(case)] = _page("case", f"{case} · {name}", data.of_case(run, case), shared)
    for path, text in pages.items():
        atomic.write(folder / path, text)


def _page(kind: str, title: str, content: dict[str, Any], shared: dict[str, Any]) -> str:
    """One page, with its data as JSON, escaped so that text from a case cannot end the element or begin another."""
    text = json.dumps(content, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    for sign in "<>&\u2028\u2029":
        text = text.replace(sign, f"\\u{ord(sign):04x}")
    return _template().render(kind=kind, policy=POLICY, title=title, data=Markup(text), scripts=SCRIPTS[kind], **shared)


@cache
def _template() -> Template:
    environment = Environment(
        loader=PackageLoader(__package__ or "", "templates"),
        undefined=StrictUndefined,
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template("page.html.jinja")
