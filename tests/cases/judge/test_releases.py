"""Two releases of a code: what is compared, what counts as moved, and that the other one confirms nothing."""

from dataclasses import replace
from pathlib import Path

import pytest

from southwell.cases.judge.releases import Bisection, comparisons
from southwell.cases.judge.results import Cell, Origin, Run, read, write
from southwell.cases.judge.witnesses import groups, witnesses
from southwell.reports.verification import releases as shown
from southwell.reports.verification.report import headline, render

from ...support import samples

OLD = samples.cell(uncertainty=2e-6, shares="nothing")
NEW = replace(OLD, code="alpha@2.2", version="2.2")


def moved(by: float, **changes: object) -> Cell:
    assert OLD.frequency
    return replace(NEW, frequency=OLD.frequency * (1.0 + by), **changes)  # type: ignore[arg-type]


@pytest.mark.parametrize(("by", "beyond"), [(3.9e-6, False), (-3.9e-6, False), (4.1e-6, True), (-4.1e-6, True)])
def test_a_frequency_is_moved_beyond_the_uncertainties_of_both_answers(by: float, beyond: bool) -> None:
    (one,) = comparisons(Run((OLD, moved(by))))
    assert (one.code, one.other, len(one.compared), len(one.moved)) == ("alpha", "alpha@2.2", 1, int(beyond))
    assert one.largest
    assert one.largest.relative == pytest.approx(by, rel=1e-6)


def test_without_an_uncertainty_nothing_is_said_to_move() -> None:
    (one,) = comparisons(Run((OLD, moved(0.1, uncertainty=None))))
    assert (len(one.compared), one.moved) == (1, ())


def test_only_answers_to_the_same_question_are_compared() -> None:
    """By case, speed and mode; an answer that one release lacks is counted, and not as moved."""
    elsewhere = [moved(0.1, case="other"), moved(0.1, omega=20.0), moved(0.1, mode=2)]
    silent = samples.empty("fail", "crashed", code="alpha@2.2", version="2.2")
    (one,) = comparisons(Run((OLD, silent, *elsewhere)))
    assert (len(one.compared), one.moved, len(one.lost), len(one.gained)) == (0, (), 1, 3)
    assert comparisons(Run((OLD,))) == []


def test_another_release_is_no_further_witness() -> None:
    """Not even where the installed release itself disagrees."""
    origins = tuple(Origin("beam", code, "E", "T", "R", "blade", "its own") for code in ("alpha", "alpha@2.2"))
    both = witnesses(Run((OLD, NEW), origins=origins), "beam")
    assert [w.kind for w in both] == ["code", "other release"]
    assert len(groups(both)) == 1
    wrong = replace(OLD, difference=0.1, verdict="fail")
    assert groups(witnesses(Run((wrong, NEW), origins=origins), "beam")) == []


FOUND = Bisection(
    code="alpha",
    other="alpha@2.2",
    distribution="alphabet",
    case="beam",
    omega=10.0,
    mode=1,
    first="2.1.7",
    before="2.1.4",
    older="2.1",
    change=3e-4,
    uncertainty=4e-6,
    answers=True,
    reason="",
    tried=3,
    skipped={"2.1.5": "no wheel"},
)


def test_the_report_names_both_releases_and_the_first_that_differs() -> None:
    run = Run((OLD, moved(3e-4)), versions={"alpha": "2.1", "alpha@2.2": "2.2"}, bisections=(FOUND,))
    sentences = (
        "alpha@2.2 against 2.1: 1 frequency compared, 1 moved beyond uncertainty; largest change +3.0e-04 ± 4e-06.",
        "alpha: the first release of alphabet that moves it is 2.1.7, by +3.0e-04 ± 4e-06 from 2.1 (beam, alpha, "
        "edgewise 1, 10 rad/s); 2.1.4 does not; skipped between them: 2.1.5 (no wheel).",
    )
    assert shown.headline(run) == list(sentences)
    assert headline(run)[-2:] == list(sentences)
    text = render(run, {}).partition("## Versions")[2]
    assert "| alpha | 2.1 | 2.2 | 1 | +3.0e-04 ± 4e-06 |" in text
    assert "2.1.7 |" in text
    assert "skipped between them" in text
    silent = replace(FOUND, change=None, uncertainty=None, answers=False, reason="ImportError: gone", skipped={})
    assert shown.found(replace(run, bisections=(silent,))) == [
        "alpha: the first release of alphabet that does not answer is 2.1.7: ImportError: gone (beam, alpha, edgewise 1, "
        "10 rad/s); 2.1.4 does."
    ]


def test_bisections_are_in_the_results(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    write(path, Run((OLD, NEW), bisections=(FOUND,)))
    assert read(path).bisections == (FOUND,)
