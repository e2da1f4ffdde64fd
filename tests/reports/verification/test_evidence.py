"""The lines of a report on what the evidence covers."""

from southwell.cases.judge.results import Planned, Run
from southwell.reports.verification import evidence, report

from ...support import samples


def test_a_file_of_another_program_with_few_frequencies_is_named() -> None:
    cells = tuple(samples.cell(code=code, mode=mode) for code, mode in (("few", 1), ("few", 3), ("all", 1), ("all", 2)))
    run = Run(
        (*cells, samples.cell(code="all", mode=3)),
        versions={"few": "results in few.csv", "all": "results in all.csv"},
        plan=(Planned("beam", "few", 0, 0), Planned("beam", "code", 1, 3)),
    )
    assert evidence.partial(run) == "Compared in part: few gives 2 of 3 frequencies (beam)."
    assert evidence.partial(run) in report.headline(run)
    assert evidence.partial(Run(cells, versions={"few": "1.0"}, plan=run.plan)) == ""
