"""Who counts as a witness: by what it shares with core, once for each group, and only if it agrees throughout."""

import re
from dataclasses import replace
from io import StringIO

import pytest
from rich.console import Console

from southwell.cases.judge.results import Cell, Origin, Run, Setting
from southwell.cases.judge.witnesses import groups, witnesses
from southwell.references.protocol.interface import ADAPTERS
from southwell.reports.verification import report as matrix_report
from southwell.reports.verification import terminal
from southwell.reports.verification import witnesses as reported

from ...support import samples


def cell(code: str, shares: str = "nothing", **changes: object) -> Cell:
    return samples.cell(code=code, shares=shares, **changes)


def run(*cells: Cell, declared: bool = True) -> Run:
    """Each code with an origin of its own, printed tables with their source's."""
    codes = dict.fromkeys((c.case, c.code) for c in cells if c.shares)
    made = tuple(
        Origin(case, code, *3 * (code.partition("/")[0],), sections="blade", eigensolver="its own")
        for case, code in codes
    )
    return Run(cells, origins=made if declared else ())


OURS = [
    cell("twin", "discretisation", role="same discretisation", target=1e-8, difference=1e-12, uncertainty=1e-12),
    cell("chain", "mechanical model"),
]
TABLES = [cell(f"author2000/{series}", role="table", version="") for series in ("a", "b")]
CLOSED = cell("exact", version="southwell 0.1.0")


def test_codes_on_cores_model_are_no_independent_witnesses() -> None:
    result = witnesses(run(*OURS), "beam")
    assert [(w.name, w.kind, w.standing, w.fine) for w in result] == [
        (name, "Southwell's model", "agrees", None) for name in ("twin", "chain")
    ]
    assert groups(result) == []


def test_two_series_of_one_source_are_one_group() -> None:
    result = witnesses(run(*TABLES), "beam")
    assert [(w.kind, w.answers, w.fine) for w in result] == [("printed source", 1, None)] * 2
    assert len(groups(result)) == 1


def test_kinds_and_count() -> None:
    result = witnesses(run(cell("alpha"), CLOSED, *TABLES, *OURS, cell("southwell", "", role="discretisation")), "beam")
    assert [w.kind for w in result] == [
        "code", "closed form", "printed source", "printed source", "Southwell's model", "Southwell's model",
    ]  # fmt: skip
    assert len(groups(result)) == 3


@pytest.mark.parametrize(
    ("changes", "standing", "fine"),
    [
        ({}, "agrees", "agrees"),
        ({"difference": 5e-4}, "agrees", "disagrees"),
        ({"difference": 5e-6, "uncertainty": 2e-4}, "agrees", "open"),
        ({"difference": 2e-3, "verdict": "fail"}, "disagrees", "disagrees"),
        ({"uncertainty": None, "verdict": "inconclusive"}, "open", "open"),
        ({"difference": 3e-2, "uncertainty": 8e-2, "verdict": "estimate"}, "estimate", "estimate"),
        ({"full": 11.8, "verdict": "known difference"}, "agrees", "agrees"),  # like with like it agrees
    ],
)
def test_one_number_stands_for_its_witness(changes: dict, standing: str, fine: str) -> None:
    """The worst of a code's numbers: one that agrees beside it does not help."""
    (witness,) = witnesses(run(cell("alpha"), cell("alpha", mode=2, **changes)), "beam")
    assert (witness.standing, witness.fine) == (standing, fine)


@pytest.mark.parametrize(("verdict", "standing"), [("fail", "disagrees"), ("inconclusive", "open")])
def test_a_missing_answer_is_no_agreement(verdict: str, standing: str) -> None:
    """A mode without a partner, a crash, a time limit."""
    silent = samples.empty(verdict, "no partner", code="alpha", shares="nothing")
    result = witnesses(run(cell("alpha"), silent), "beam")
    assert [(w.standing, w.fine, w.answers) for w in result] == [(standing, standing, 1)]
    assert groups(result) == []


def test_a_disagreement_outweighs_an_open_answer() -> None:
    altered = cell("alpha", mode=2, difference=2e-3, verdict="fail")
    unknown = cell("alpha", mode=3, uncertainty=None, verdict="inconclusive")
    (witness,) = witnesses(run(cell("alpha"), unknown, altered), "beam")
    assert witness.standing == "disagrees"


def test_agreement_of_adapters_theories_alone_is_said() -> None:
    """The programs are foreign, but what they solve is not."""
    first_run = run(cell("alpha"), cell("beta"))
    actual = replace(
        first_run, origins=tuple(replace(o, theory=f"forms of {o.code}, {ADAPTERS}") for o in first_run.origins)
    )
    mixed = replace(first_run, origins=(actual.origins[0], first_run.origins[1]))
    headlines = [reported.headline(r) for r in (first_run, mixed, actual)]
    assert ["No foreign theory agrees for beam" in line for line in headlines] == [False, False, True]


def test_a_measurement_is_no_witness() -> None:
    assert witnesses(run(cell("rig", role="measured", verdict="measured")), "beam") == []


def test_a_table_with_one_wider_target_is_coarse() -> None:
    """The case's target is 0.1 %; one number of the table supports only 2 %."""
    table = [cell("author2000/a", role="table", version="", mode=k, target=t) for k, t in ((1, 1e-3), (2, 2e-2))]
    setting = Setting("beam", "", "", "", "rad_s", target=1e-3)
    (witness,) = witnesses(replace(run(*table), settings=(setting,)), "beam")
    assert (witness.kind, witness.target) == ("coarse source", 2e-2)


def test_a_code_without_a_number_is_no_witness() -> None:
    assert witnesses(run(samples.empty("not run", "not installed", code="delta", shares="nothing")), "beam") == []


RUN = run(
    cell("alpha"), CLOSED, *TABLES, *OURS, cell("beta", case="other"), cell("rough", difference=2e-3, case="other")
)


def test_the_report_counts_witnesses() -> None:
    first, second = reported.table(RUN)
    assert first["independent groups"] == "3"
    assert first["who agrees, group by group"] == "(alpha); (exact); (author2000/a, author2000/b)"
    assert first["confirms the implementation only"] == "twin, chain"
    assert second["independent groups"] == "1"
    assert second["not counted"].startswith("rough (disagrees")
    assert "for each blade: 1 (other: beta) to 3" in reported.headline(RUN)
    assert [row["engine"] for row in reported.origins(RUN)][:2] == ["alpha", "exact"]


def test_without_declarations_nothing_is_counted() -> None:
    bare = run(cell("alpha"), declared=False)
    assert reported.headline(bare) == ""
    assert reported.table(bare)[0]["independent groups"] == "0"


def test_the_matrix_says_what_each_column_shares() -> None:
    last = matrix_report.heat(RUN).splitlines()[-1]
    assert "discretisation" in last
    assert "mechanical model" in last
    (table,) = terminal.matrix(RUN, 140)
    assert table.row_count == 3


@pytest.mark.parametrize("width", [24, 40, 80, 140])
def test_on_a_terminal_of_any_width_nothing_of_the_matrix_is_cut_off(width: int) -> None:
    names = [f"code-{k}" for k in range(12)]
    run = Run(tuple(samples.cell(code=name, difference=1.234e-5 * k**6) for k, name in enumerate(names)))
    console = Console(width=width, file=StringIO(), highlight=False)
    for table in terminal.matrix(run, width):
        console.print(table)
    output = console.file.getvalue()  # type: ignore[attr-defined]
    assert "…" not in output
    assert all(len(line) <= width for line in output.splitlines())
    for size in ("0", "0.0012", "0.079", "0.9", "5.1", "19", "58", "145", "323", "656", "1234", "2186"):
        assert re.search(rf"(?<![\d.]){re.escape(size)}(?![\d.])", output), size


def test_rows_that_do_not_say_leave_it_out() -> None:
    old = Run((samples.cell(),))
    assert reported.table(old) == []
    assert reported.headline(old) == ""
    assert "shares" not in matrix_report.heat(old)
