"""The report of a run in GitHub-flavoured Markdown: the verdict, a heat table, then one section per case."""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined

from ...cases.input import atomic
from ...cases.judge.results import Cell, Run, Setting, Verdict
from ...cases.run.executors import Serial
from ...cases.store.stored import remembering
from ..condense import page
from ..shared import summary
from ..shared.markdown import anchor, plain, plain_table, table
from ..shared.paths import file_name
from ..shared.summary import SYMBOL, amount, columns, table_column
from ..shared.units import Units
from . import case_tables, controls, diagnoses, error_budget, evidence, paper_table, properties, witnesses

FEW = 3
"""Number of cases whose figures take no longer to draw than other processes take to start."""

SHORT: dict[Verdict, str] = {"known difference": "known", "not applicable": "n/a"}
"""Short names of verdicts in the heat table; its legend explains them."""

LEGEND = ", ".join(f"{sign} {v}{f' ({SHORT[v]})' if v in SHORT else ''}" for v, sign in SYMBOL.items())


def write(run: Run, folder: Path, executor: Executor | None = None) -> Path:
    """Write ``report.md`` and ``figures/*.svg`` into ``folder``; the same run gives the same bytes.

    The ``executor`` draws the figures of more than ``FEW`` cases; otherwise, this thread.

    Raises:
        OSError: if a folder or file cannot be written.
    """
    figures = folder / "figures"
    figures.mkdir(parents=True, exist_ok=True)
    figure_paths: dict[str, list[str]] = {}
    among = columns(run.cells)
    cases = summary.cases(run)
    drawing = remembering(executor if executor and len(cases) > FEW else Serial())
    futures = {case: drawing.submit(_figures, part(run, case), case, summary.units(run, case), among) for case in cases}
    for case, images in futures.items():
        for kind, image in images.result().items():
            name = f"{file_name(case)}-{kind}.svg"
            atomic.write(figures / name, image)
            figure_paths.setdefault(case, []).append(f"figures/{name}")
    path = folder / "report.md"
    atomic.write(path, render(run, figure_paths, condensed=page.include_page(folder)))
    return path


def part(run: Run, case: str) -> Run:
    """The rows of one case, on which its figures depend."""
    cells, levels = tuple(c for c in run.cells if c.case == case), tuple(v for v in run.levels if v.case == case)
    return Run(cells, levels, settings=tuple(s for s in run.settings if s.case == case))


def _figures(run: Run, case: str, units: Units, among: Sequence[str]) -> dict[str, str]:
    from . import drawing  # Matplotlib

    return drawing.of_case(run, case, units, among)


def render(run: Run, figures: dict[str, list[str]], condensed: str = "") -> str:
    """The text of the report.

    Args:
        run: the results.
        figures: paths of each case's figures, relative to the report.
        condensed: the page of ``condense``.
    """
    environment = Environment(
        loader=PackageLoader(__package__ or "", "templates"),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters["plain"] = plain
    return environment.get_template("report.md.jinja").render(
        headline=marked(run, [line for line in (summary.incomplete(run), *evidence.first(run)) if line]),
        evidence=plain_table(evidence.rows(run)),
        remarks=[
            plain(line) for line in (paper_table.line(run), witnesses.headline(run), controls.headline(run)) if line
        ],
        heat=heat(run, linked=True),
        unasked=unasked(run),
        legend=LEGEND,
        cases=[section(run, case, figures.get(case, [])) for case in summary.cases(run)],
        witnesses=plain_table(witnesses.table(run)),
        origins=plain_table(witnesses.origins(run)),
        short=[plain(line) for line in witnesses.missing(run)],
        controls=plain_table(controls.overview(run)),
        versions=table([{"what": plain(k), "version": plain(v)} for k, v in run.versions.items()])
        if run.versions
        else "",
        command=" ".join(run.command.split()).replace("`", "'"),
        condensed=condensed,
    )


def headline(run: Run) -> list[str]:
    """The verdict in a few sentences, the worst first, without markup."""
    lines = [summary.incomplete(run), evidence.answer(run), *properties.lines(run), *evidence.urgent(run)]
    lines.append(evidence.measured(run))
    if worst := summary.largest(c for c in run.cells if c.verdict == "pass"):
        lines.append(f"Largest difference among passes: {summary.plus_minus(worst)} ({evidence.where(run, worst)}).")
    lines += [
        evidence.beyond_uncertainty(run),
        evidence.partial(run),
        paper_table.line(run),
        witnesses.headline(run),
        *witnesses.missing(run),
        controls.headline(run),
    ]
    return [line for line in lines if line]


def marked(run: Run, lines: Sequence[str]) -> list[str]:
    """Lines as Markdown, with the verdict and the note on an incomplete run in bold."""
    out = []
    for line in lines:
        bold = next((b for b in (summary.incomplete(run), evidence.verdict(run)) if b and line.startswith(b)), "")
        remainder = line[len(bold) :]
        out.append(f"**{plain(bold)}**{' ' * remainder.startswith(' ')}{plain(remainder)}" if bold else plain(line))
    return out


def unasked(run: Run) -> str:
    """The codes without any answer, with the reasons, in one line; empty if there are none."""
    omitted = []
    for name, cells in _silent(run).items():
        reasons = "; ".join(dict.fromkeys(c.reason for c in cells if c.verdict == "not run"))
        omitted.append(f"{plain(name)} ({plain(reasons) or 'not applicable'})")
    return ", ".join(omitted)


def _by_column(cells: Sequence[Cell]) -> dict[str, list[Cell]]:
    """The cells of each column, in the order of the columns."""
    by_name: dict[str, list[Cell]] = {name: [] for name in columns(cells, table_column)}
    for cell in cells:
        by_name[table_column(cell)].append(cell)
    return by_name


def _silent(run: Run) -> dict[str, list[Cell]]:
    """The columns without any answer, with their cells, unless no column has one."""
    by = _by_column(run.cells)
    empty = {n: cells for n, cells in by.items() if all(c.verdict in ("not run", "not applicable") for c in cells)}
    return empty if len(empty) < len(by) else {}


def heat(run: Run, linked: bool = False) -> str:
    """The heat table, case × code: the worst verdict of all modes and speeds, and its largest difference.

    Codes without any answer have no column; ``unasked`` names them. With ``linked``, cases link to their sections.
    """
    silent = _silent(run)
    columns = {n: cells for n, cells in _by_column(run.cells).items() if n not in silent}
    rows = []
    for case in summary.cases(run):
        case_columns = _by_column([c for c in run.cells if c.case == case])
        name = f"[{plain(case)}](#{anchor(case)})" if linked else plain(case)
        rows.append({"case": name} | {plain(n): _heat(case_columns.get(n, [])) for n in columns})
    if any(c.shares for c in run.cells):
        shares = {plain(n): plain(witnesses.shared(cells)) for n, cells in columns.items()}
        rows.append({"case": "*shares with Southwell*"} | shares)
    return table(rows)


def _heat(cells: Sequence[Cell]) -> str:
    if not cells:
        return ""
    verdict, worst = summary.worst_verdict(cells), summary.worst(cells)
    size = summary.size(worst) if worst else None
    difference = f"<br>{amount(size, worst.target)}{summary.wide(worst)}" if worst and size is not None else ""
    return f"{SYMBOL[verdict]} {SHORT.get(verdict, verdict)}{difference}"


@dataclass(frozen=True)
class Section:
    """The section of one blade, ready for the template."""

    name: str
    setting: Setting | None
    first: bool
    facts: str
    focus: str
    main: str
    rest: list[tuple[str, str]]
    verdicts: str
    measured: str
    figures: list[str]
    reasons: str
    count: int
    diagnoses: str
    error_budget: str
    error_budget_at: str
    readings: str
    models: str
    invariances: str
    fastest: str


def section(run: Run, case: str, figures: list[str]) -> Section:
    """The section of one blade: setting, frequencies, differences by speed, and reasons."""
    cells = [c for c in run.cells if c.case == case]
    setting = summary.setting(run, case)
    unit = summary.units(run, case)
    compared = [c for c in cells if c.role != "measured"] or cells
    speeds = sorted({c.omega for c in compared if c.mode})
    printed_speeds = [c.omega for c in cells if c.role == "table"]
    focus = max([omega for omega in printed_speeds if omega in speeds] or speeds, default=None)
    tables = {
        omega: case_tables.comparison([c for c in cells if c.omega == omega and c.mode], unit) for omega in speeds
    }
    reasons, split = case_tables.why(compared, unit), error_budget.rows(run, case)
    return Section(
        name=case,
        setting=setting,
        first=case == next((c for c in summary.cases(run) if c.partition("/")[0] == case.partition("/")[0]), case),
        facts="; ".join(f"{k}: {v}" for k, v in setting.facts.items()) if setting else "",
        focus=unit.at(focus) if focus is not None else "",
        main=tables[focus] if focus is not None else "",
        rest=[(unit.at(omega), text) for omega, text in tables.items() if omega != focus],
        verdicts=case_tables.verdicts(cells),
        measured=case_tables.measured(run, case, unit),
        figures=figures,
        reasons=table(reasons) if reasons else "",
        count=len(reasons),
        diagnoses=plain_table(diagnoses.rows(run, case)),
        error_budget=plain_table(split),
        error_budget_at=error_budget.heading(run, case, unit),
        readings=plain_table(properties.readings(run, case)),
        models=plain_table(properties.models(run, case)),
        invariances=plain_table(properties.invariances(run, case)),
        fastest=unit.at(max(speeds)) if speeds else "the highest speed",
    )
