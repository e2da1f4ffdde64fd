"""A run with a reader, a sampling or an adapter that is wrong ends with status 1 and names the property."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from southwell.cases.input.readers import Mount
from southwell.cases.input.readers.openfast import elastodyn
from southwell.cases.judge.results import Cell, PropertyCheck, Run
from southwell.cases.plan.request import Execution, Request
from southwell.cases.plan.subjects import subjects
from southwell.cases.solve import properties as tasks
from southwell.cases.store import results_file
from southwell.cases.verify.pipeline import verify
from southwell.core import sampling as core_sampling
from southwell.core.blade import Blade
from southwell.references.protocol import registry
from southwell.references.protocol.description import describe
from southwell.references.protocol.fingerprint import Fingerprint
from southwell.references.protocol.interface import BladeAdapter
from southwell.references.protocol.process import Limits
from southwell.references.readers import openfast, stations
from southwell.reports.shared import summary
from southwell.reports.shared.statuses import FAILED, PASSED
from southwell.reports.verification import evidence, properties

from ...support import decks

pytest.importorskip("weio")

PASS = Cell(
    *("elastodyn_main", 1.0, 1, "flapwise", "a-code", "1", "code", 5.0, 5.0, 0.0, 1e-9, 1e-3, "pass"),
    shares="nothing",
    ordinal=1,
)


def checked(deck: Path, codes: Sequence[str] = (), **options: Any) -> Run:
    """A run of one passing cell with the second reading of a deck and the models of it."""
    (subject,) = subjects(Request((str(deck),), rpm="10", **options), lambda _: None)
    assert subject.blade is not None
    result = subject.property_checks(describe(list(codes), [subject.blade]), Limits())
    rows = [*result.rows, *(row for task in result.tasks if isinstance(task, tasks.Weighing) for row in task())]
    return Run((PASS,), property_checks=tuple(rows))


@pytest.fixture
def deck(tmp_path: Path) -> Path:
    decks.openfast(tmp_path)
    return tmp_path / "elastodyn_main.dat"


def in_this_process(name: str, blade: Blade, elements: Sequence[int], *_: object) -> list[Fingerprint | None]:
    code = registry.code(registry.locate(name))
    assert isinstance(code, BladeAdapter)
    return [code.fingerprint(blade, n) for n in elements]


def exchange(patch: pytest.MonkeyPatch) -> None:
    original = elastodyn.section_stiffness
    patch.setattr(elastodyn, "section_stiffness", lambda EA, GJ, flap, edge: original(EA, GJ, edge, flap))


def test_a_right_reader_is_confirmed(deck: Path, tmp_path: Path) -> None:
    checks = checked(deck, ["exudyn-tree"])
    assert {c.quantity for c in checks.property_checks} == {"reading", "fingerprint"}
    assert {c.verdict for c in checks.property_checks} == {"pass"}
    assert summary.status(checks) == PASSED
    (line,) = properties.lines(checks)
    assert line.startswith("Second reading: weio 2.0.0 reads the same 18 properties")
    case = checks.property_checks[0].case
    assert len(properties.readings(checks, case)) == 18
    assert [row["model of"] for row in properties.models(checks, case)] == ["Southwell's own solver", "exudyn-tree"]
    results_file.write(tmp_path / "results.jsonl", checks)
    assert results_file.read(tmp_path / "results.jsonl").property_checks == checks.property_checks


def test_exchanged_stiffnesses_are_named_and_give_status_1(deck: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    exchange(monkeypatch)
    checks = checked(deck)
    assert summary.status(checks) == FAILED
    assert evidence.verdict(checks) == "No: 2 properties of the blade differ in a second reading of its file."
    flapwise, edgewise, *_ = properties.lines(checks)
    assert flapwise.startswith("Second reading: flapwise stiffness at station")
    assert "edgewise stiffness at station 5 (50 m): reader 3e+06 N m², weio 2.0.0 1.65e+07 N m²" in edgewise


@pytest.mark.slow
def test_exchanged_stiffnesses_alone_fail_no_cell(deck: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The whole command: no code sees the exchange, because all of them take the blade from the reader."""
    exchange(monkeypatch)
    execution = Execution(threads=True, fresh=True)
    result = verify(Request((str(deck),), ("exudyn-tree",), rpm="10", faults="none", execution=execution))
    assert {c.verdict for c in result.cells} == {"pass"}
    assert summary.status(result) == FAILED
    assert {c.part for c in result.property_checks if c.verdict == "fail"} == {
        "flapwise stiffness",
        "edgewise stiffness",
    }
    assert {c.code for c in result.property_checks if c.quantity == "fingerprint"} == {"southwell", "exudyn-tree"}


def test_a_blade_changed_by_the_user_is_not_compared_with_its_file(deck: Path) -> None:
    checks = checked(deck, changes=("EI_flap=*1.1",))
    assert {(c.quantity, c.verdict) for c in checks.property_checks} == {("fingerprint", "pass")}


def test_without_a_parser_the_row_says_how_to_install_it(deck: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def absent(distribution: str, _: object) -> None:
        raise stations.NotInstalledError(f"{distribution} is not installed: {stations.HINT}")

    monkeypatch.setattr(openfast, "parser", absent)
    checks = checked(deck)
    (row,) = (c for c in checks.property_checks if c.quantity == "reading")
    assert (row.verdict, row.reason) == ("not run", f"weio is not installed: {stations.HINT}")
    assert properties.lines(checks)[0].startswith("Second reading: none: weio is not installed")
    assert summary.status(checks) == PASSED


def test_a_wrong_sampling_of_core_is_named_for_core_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    interpolate = core_sampling._interpolate

    def heavier(at: Any, values: Any, s: Any) -> Any:
        return interpolate(at, values, s) * (1.01 if (values[:, 0, 0] == values[:, 1, 1]).all() else 1.0)

    monkeypatch.setattr(core_sampling, "_interpolate", heavier)
    monkeypatch.setattr(tasks, "fingerprints", in_this_process)
    checks = checked(decks.csv(tmp_path), ["scikit-fem-reissner"], mount=Mount(length=20.0, hub_radius=1.0))
    assert evidence.verdict(checks) == "No: the model of Southwell's own solver differs from the stations of the blade."
    first = properties.lines(checks)[0]
    assert first.startswith(
        "Model of Southwell's own solver: mass: 1212 kg in the code's model, 1200 kg by quadrature of the stations: +1 %"
    )


def test_a_code_without_fingerprint_is_reported(deck: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tasks, "fingerprints", lambda *_: [None])
    checks = checked(deck, ["exudyn-tree"])
    rows = [c for c in checks.property_checks if c.code == "exudyn-tree"]
    assert [(c.verdict, c.reason) for c in rows] == [("not applicable", "the code reports no mass")]
    assert isinstance(rows[0], PropertyCheck)


def test_properties_that_need_more_elements_are_one_line_for_each_code() -> None:
    """Eleven such lines stood above the evidence of the whole matrix; nothing that fails is shortened."""
    row = PropertyCheck(
        *("a", "beam", "1", "fingerprint", "tip flexibility about x", 1e-3),
        *("inconclusive", "too few elements to judge", 1.0, 1.1, "rad/(N m)", -0.09),
    )
    rows = (row, replace(row, case="b", part="tip flexibility about y", difference=0.02))
    run = Run(cells=(), settings=(), property_checks=rows)
    assert properties.lines(run) == [
        "Model of beam: 2 properties need more elements to be judged; the largest differs by −9.00 % (a, b)."
    ]
    altered = replace(run, property_checks=tuple(replace(r, verdict="fail", reason="wrong") for r in rows))
    assert properties.lines(altered) == ["Model of beam: wrong (a).", "Model of beam: wrong (b)."]
