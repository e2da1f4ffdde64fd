"""A code that reads the deck itself contradicts a mistake in Southwell's reader, which all other codes follow."""

from pathlib import Path

import pytest

from southwell.cases.input.readers import Mount
from southwell.cases.input.readers.openfast import elastodyn
from southwell.cases.judge.results import Cell
from southwell.cases.plan.column import Column
from southwell.cases.plan.request import Request
from southwell.cases.plan.subject import Subject
from southwell.cases.plan.subjects import subjects
from southwell.references.protocol.description import describe
from southwell.references.protocol.process import Limits

from ...support import decks

pytest.importorskip("pybmodes")

SAMPLE = decks.BLADES / "elastodyn_blade.dat"
MOUNT = Mount(length=48.0, hub_radius=1.0)


def subject(path: Path, mount: Mount, rpm: str = "12") -> Subject:
    (subject_,) = subjects(Request((str(path),), rpm=rpm, mount=mount), lambda _: None)
    return subject_


def deck_columns(subject_: Subject, code: str = "pybmodes") -> list[Column]:
    assert subject_.blade is not None
    result = subject_.columns(describe([code], [subject_.blade]), Limits(), ())
    return [column for column in result if column.code == "pybmodes-deck"]


def cells(subject_: Subject) -> list[Cell]:
    (column,) = deck_columns(subject_)
    references = subject_.references([column])()
    return column(subject_.points, references[column.effects])[0]


def test_a_right_reader_is_confirmed_from_end_to_end() -> None:
    result = cells(subject(SAMPLE, MOUNT))
    assert {(c.verdict, c.shares) for c in result} == {("pass", "nothing")}
    assert max(abs(c.difference or 1.0) for c in result) < 5e-5


def test_exchanged_stiffnesses_fail_the_code_that_reads_the_deck_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    original = elastodyn.section_stiffness

    def exchanged(EA: float, GJ: float, EI_y: float, EI_z: float) -> object:
        return original(EA, GJ, EI_z, EI_y)

    monkeypatch.setattr(elastodyn, "section_stiffness", exchanged)
    assert "fail" in {c.verdict for c in cells(subject(SAMPLE, MOUNT))}


@pytest.mark.slow
def test_precone_which_pybmodes_ignores_is_in_the_uncertainty() -> None:
    flat = cells(subject(SAMPLE, MOUNT))[0]
    coned = cells(subject(SAMPLE, Mount(length=48.0, hub_radius=1.0, precone=-0.0436)))[0]
    assert coned.verdict == "pass"
    assert "without precone" in coned.reason
    assert (coned.uncertainty or 0.0) - (flat.uncertainty or 0.0) == pytest.approx(4.3e-5, rel=0.1)


def test_formats_that_pybmodes_does_not_read_have_no_column(tmp_path: Path) -> None:
    assert not deck_columns(subject(decks.csv(tmp_path), Mount(length=20.0, hub_radius=1.0)))


def test_without_pybmodes_among_the_codes_there_is_no_column() -> None:
    assert not deck_columns(subject(SAMPLE, MOUNT), "exact-beam")


def test_a_blade_that_its_beam_does_not_support_has_the_reason() -> None:
    (column,) = deck_columns(subject(SAMPLE, Mount(length=48.0, hub_radius=1.0, pitch=0.1)))
    assert not column.solves
