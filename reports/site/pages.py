"""Generated pages of the documentation: cases, codes, command line, API, a run's report.

The text is taken from case files, adapters, docstrings and options.
"""

from collections.abc import Sequence
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from pkgutil import iter_modules, walk_packages

from ...cases.input import library
from ...cases.judge.results import Cell, Run, Setting
from ...cases.plan import mechanism, turbine
from ...cases.plan.blade import blades
from ...cases.plan.subject import Subject
from ...cases.store import results_file
from ...references.protocol import registry as registry
from ..cli import app, arguments
from ..shared import summary
from ..shared.markdown import plain, table
from ..shared.paths import file_name
from ..verification import code_pages
from . import notebook, readme

Pages = dict[str, str]

REPORT = "report.md"
"""Path of a run's report on the site; present only if there is a run."""

NOTEBOOK = readme.ROOT / "docs" / "first-blade.ipynb"
"""The notebook that is run for the site."""

FLOORS = ("core", "references", "cases", "reports")
"""Parts of the package; each imports only those before it."""


def pages(folder: Path) -> Pages:
    """Every generated page, by its path in the site.

    Args:
        folder: folder of a run's results; without them, code pages explain how to get them, and the report is left out.
    """
    path = folder / arguments.RESULTS
    run = results_file.read(path) if path.exists() else Run(())
    return {
        **cases(folder),
        **codes(run),
        **notebook.page(NOTEBOOK),
        "results.md": readme.results_page(),
        "cli.md": command_line(),
        **api(),
        **report(folder),
        **figures(folder),
    }


def figures(folder: Path) -> Pages:
    """The figures of a run, by their paths; empty if there is none."""
    return {
        f"figures/{path.name}": path.read_text(encoding="utf-8") for path in sorted((folder / "figures").glob("*.svg"))
    }


def report(folder: Path) -> Pages:
    """The report of a run in ``folder``; empty if there is none. Its figures are those of ``figures``."""
    path = folder / "report.md"
    if not path.exists():
        return {}
    text = path.read_text(encoding="utf-8")
    return {REPORT: text.replace("<details>", '<details markdown="1">')}


def cases(folder: Path | None = None) -> Pages:
    """One page per case that comes with the package, with its results and the figures of a run in ``folder``, and an index."""
    present, failures = library.load_all()
    subjects: dict[str, Sequence[Subject]] = {case.name: blades(case) for case in present.values()}
    subjects |= {name: [mechanism.subject(library.mechanism(name))] for name in library.mechanisms()}
    subjects |= {name: [turbine.of_case(library.turbine(name))] for name in library.turbines()}
    rows = [_row(*subject_item) for subject_item in subjects.items()]
    rows += [{"case": f"`{name}`", "what": plain(why), "blades": "", "speeds": ""} for name, why in failures.items()]
    head = "# Cases\n\nWhat `southwell verify` runs, from the files in `cases/data/`.\n\n"
    stored = results_file.read(readme.ROWS).cells
    file_names = [path.name for path in sorted((folder / "figures").glob("*.svg"))] if folder else []
    pages = {f"cases/{name}.md": _case(name, own, stored, file_names) for name, own in subjects.items()}
    return {"cases/index.md": f"{head}{table(rows)}\n"} | pages


def _row(name: str, subjects: Sequence[Subject]) -> dict[str, str]:
    first = subjects[0].setting()
    link = f"[{plain(first.title)}]({name}.md)"
    folder = _folder(name)
    count = f"a {folder.rstrip('s/')}" if folder else str(len(subjects))
    return {"case": f"`{name}`", "what": link, "blades": count, "speeds": plain(first.facts["speeds"])}


def _folder(name: str) -> str:
    """Folder of a case's file in ``cases/data``, with a slash; empty for blades."""
    return "mechanisms/" if name in library.mechanisms() else "turbines/" if name in library.turbines() else ""


def _case(name: str, subjects: Sequence[Subject], stored: Sequence[Cell], file_names: Sequence[str]) -> str:
    first, *_ = facts = [subject.setting() for subject in subjects]
    parts = [
        f"# {plain(first.title)}",
        plain(first.description),
        f"*Source:* {plain(first.source)}.",
        f"```console\nsouthwell verify {name}\n```",
        f"File: `cases/data/{_folder(name)}{name}.toml`.",
        *(part for s in facts for part in (_facts(s), _results(s.case, stored), _pictures(s.case, file_names)) if part),
    ]
    return "\n\n".join(parts) + "\n"


def _facts(facts: Setting) -> str:
    rows = [{"": plain(k), facts.case: plain(v)} for k, v in facts.facts.items()]
    return f"## {plain(facts.case)}\n\n{table(rows)}"


def _results(case: str, stored: Sequence[Cell]) -> str:
    """The worst verdict and the largest difference of each code, from the stored rows; empty without any."""
    cells = [c for c in stored if c.case == case]
    rows = []
    for code in summary.columns(cells, summary.table_column):
        group = [c for c in cells if summary.table_column(c) == code]
        verdict = summary.worst_verdict(group)
        if verdict in ("not run", "not applicable"):
            continue
        largest = summary.worst(group)
        rows.append(
            {
                "code": f"`{code}`" if code in registry.names() else plain(code),
                "verdict": f"{summary.SYMBOL[verdict]} {verdict}",
                "largest difference": summary.plus_minus(largest) if largest else "–",
                "shares with Southwell's own solver": plain(group[0].shares),
            }
        )
    return (
        f"{table(rows)}\n\nAll modes and speeds of the last complete run; [how to read a verdict](../reading-a-verdict.md)."
        if rows
        else ""
    )


PICTURES = {
    "campbell": "Frequencies over rotor speed: Southwell's own solver (lines) and the other codes (marks)",
    "differences": "Differences from Southwell's own solver with their uncertainties, against the target",
    "convergence": "Difference over the number of elements",
}
"""What the figures of a case show."""


def _pictures(case: str, file_names: Sequence[str]) -> str:
    """The figures of a case that a run has drawn."""
    captions = {f"{file_name(case)}-{kind}.svg": text for kind, text in PICTURES.items()}
    return "\n\n".join(f"![{text}](../figures/{name})" for name, text in captions.items() if name in file_names)


def codes(run: Run) -> Pages:
    """One page per code, and an index."""
    descriptions = code_pages.described()
    out: Pages = {"codes/index.md": code_pages.index(run, descriptions)}
    return out | {f"codes/{code.name}.md": code_pages.page(run, code) for code in descriptions}


def command_line() -> str:
    """All commands with their options, taken from the application."""
    return app.app.generate_docs(heading_level=1, max_heading_level=3)


def api() -> Pages:
    """An index, one page for each module to import, and one for each package inside, filled by mkdocstrings."""
    root = __name__.partition(".")[0]
    out = {
        f"api/{root}.md": f"# {root}\n\nThe names to import from `{root}`.\n{_documented(root)}",
        f"api/{root}.adapter.md": f"# {root}.adapter\n{_documented(f'{root}.adapter')}",
    }
    index = [
        "# API",
        f"Import from [`{root}`]({root}.md), from [`{root}.adapter`]({root}.adapter.md) to add a code, and from "
        f"[`{root}.multibody`]({root}.core.md#{root}.core.multibody) to describe a mechanism. "
        "The packages below are internal; their modules may move between versions.",
    ]
    for floor in FLOORS:
        package = import_module(f"{root}.{floor}")
        inside = [name for _, name, is_package in walk_packages(package.__path__, f"{package.__name__}.") if is_package]
        rows: list[dict[str, str]] = []
        for name in (package.__name__, *inside):
            text, modules = _summary(name), _modules(name)
            if modules:
                out[f"api/{name}.md"] = f"# {name}\n\n{text}\n" + "".join(_documented(module) for module in modules)
            rows.append({"package": f"[`{name}`]({name}.md)" if modules else f"`{name}`", "contents": text})
        index += [f"## {floor}", table(rows)]
    return {"api/index.md": "\n\n".join(index) + "\n"} | out


def _documented(module: str) -> str:
    """The section of a module on a page, in the syntax of mkdocstrings."""
    return f"\n::: {module}\n    options:\n      heading_level: 2\n      show_submodules: false\n"


def _summary(package: str) -> str:
    """First line of a package's docstring."""
    return (import_module(package).__doc__ or "").partition("\n")[0].replace("``", "`")


def _modules(package: str) -> list[str]:
    """The modules of a package that are written in Python, without those of packages inside it."""
    modules = iter_modules(import_module(package).__path__, f"{package}.")
    return [module.name for module in modules if not module.ispkg and _has_source(module.name)]


def _has_source(module: str) -> bool:
    """Whether a module is written in Python, not compiled."""
    spec = find_spec(module)
    return spec is not None and str(spec.origin).endswith(".py")
