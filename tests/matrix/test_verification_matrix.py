"""The verification matrix: every case × code × speed is what ``capabilities`` says, and no cell fails or stays open.

Blades that ask nothing of a code that another does not ask too are left to the night; ``make verify`` has them all. A
blade's references, and a code's answers for it, are computed once in a process (``pytest -n 2 --dist loadfile``).
"""

from functools import cache

import pytest

from southwell.cases.input import library
from southwell.cases.input.schema import Case, Variant
from southwell.cases.judge.results import Cell, Level
from southwell.cases.verify.columns import Column, columns
from southwell.cases.verify.reference import Reference, References, references
from southwell.references.protocol import registry
from southwell.references.protocol.description import describe
from southwell.references.protocol.process import Limits

from ..support.capabilities import BLADES, CODES, TABLES, allowed, solves

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("keeping")]

CASES: dict[str, tuple[Case, Variant]] = {
    variant.name: (case, variant) for case in library.everything()[0].values() for variant in case.variants
}


NIGHTLY = {
    "articulated/both",
    "articulated/sprung",
    "nrel-5mw-beamdyn",
    "park-blade/surrogate",
    "park-blade/surrogate-untwisted",
    "tapered-beam",
    "windpact-1.5/centred",
    "windpact-1.5/offset",
    "yoo-shin-chordwise/delta-0.1",
    "yoo-shin-chordwise/delta-1",
    "yoo-shin-chordwise/delta-5",
}


NIGHTLY_CODES = {
    ("curved-solid", "calculix"),
    ("curved-solid", "scikit-fem-solid"),
    ("park-cantilever", "scikit-fem-solid"),
}
"""Half a minute to two minutes each. At one refinement, ``test_curved`` compares the solids' modes with core's and with each
other's, and ``test_solid`` those of a cantilever with core's."""


def marks(blade: str, code: str) -> list[pytest.MarkDecorator]:
    """Whether a blade, or one code's answers for it, is for the night."""
    return [pytest.mark.nightly] if blade in NIGHTLY or (blade, code) in NIGHTLY_CODES else []


@cache
def plan(blade: str) -> dict[str, Column]:
    case, variant = CASES[blade]
    return {c.name: c for c in columns(case, variant, describe(tuple(CODES), [variant.blade]), Limits())}


@cache
def core(blade: str) -> References:
    case, variant = CASES[blade]
    models = [column.effects for column in plan(blade).values()]
    return references(variant.blade, variant.speeds.tolist(), case.text.compare, models)


@cache
def column(blade: str, name: str) -> tuple[list[Cell], list[Level]]:
    one = plan(blade)[name]
    return one(CASES[blade][1].speeds.tolist(), core(blade)[one.effects])


def at(blade: str, name: str, omega: float) -> list[Cell]:
    """A column's cells at one speed; skips if the code is not installed."""
    cells = [c for c in column(blade, name)[0] if c.omega == omega]
    if cells and cells[0].verdict == "not run":
        pytest.skip(cells[0].reason)
    return cells


def at_every_speed(names: list[tuple[str, str]]) -> list:
    return [
        pytest.param(blade, name, omega, id=f"{blade}-{name}-{omega:.4g}", marks=marks(blade, name))
        for blade, name in sorted(names)
        for omega in CASES[blade][1].speeds.tolist()
    ]


def holds(cell: Cell) -> bool:
    """Whether the cell's own numbers say what a pass must."""
    if cell.frequency is None or cell.reference is None or cell.uncertainty is None:
        return False
    return abs(cell.frequency / cell.reference - 1.0) + cell.uncertainty <= cell.target


def test_every_code_and_every_blade_is_in_the_table() -> None:
    assert set(CODES) == set(registry.OURS)
    assert set(BLADES) == set(CASES) | set(library.everything()[1])


@pytest.mark.parametrize(("blade", "name", "omega"), at_every_speed([(b, c) for b in CASES for c in CODES]))
def test_code(blade: str, name: str, omega: float) -> None:
    can, asks = CODES[name], BLADES[blade]
    cells = at(blade, name, omega)
    if not solves(can, asks):
        assert [(c.verdict, bool(c.reason)) for c in cells] == [("not applicable", True)]
        return
    assert [c.mode for c in cells] == list(range(1, CASES[blade][0].text.compare.modes + 1))
    for cell in cells:
        assert cell.verdict in allowed(can, asks, omega), cell
        assert cell.role == ("same discretisation" if can.twin else "code")
        assert cell.target == (1e-8 if can.twin else 1e-3)
        if cell.verdict == "pass":
            assert holds(cell), cell
        if cell.verdict == "known difference":
            assert holds(cell), cell  # like with like
            assert any(f"no {effect}" in cell.reason for effect in can.lacks), cell
            assert "%" in cell.reason
        if cell.verdict == "not applicable":
            assert cell.reason == "this code declares that its modes have no axial motion"
            assert cell.family in ("axial", "mixed")


@pytest.mark.parametrize(("name", "blade"), [pytest.param(n, b, marks=marks(b, n)) for n, b in TABLES.items()])
def test_table(name: str, blade: str) -> None:
    cells, _ = column(blade, name)
    assert cells
    for cell in cells:
        assert cell.role == "table"
        assert cell.verdict in ("pass", "known difference"), cell
        assert holds(cell) or "discretisation error of 50 elements" in cell.reason, cell


@pytest.mark.parametrize(
    ("blade", "name", "omega"), at_every_speed([(b, "core, as in the source") for b in BLADES if b.startswith("park")])
)
def test_source_discretisation(blade: str, name: str, omega: float) -> None:
    for cell in at(blade, name, omega):
        assert cell.verdict in ("pass", "known difference"), cell
        assert holds(cell) or "discretisation error of" in cell.reason, cell


def test_the_source_discretisation_prints_what_the_paper_prints() -> None:
    """Park et al. (2010), Table 1, column Present: 11.71, 70.37, 189.7."""
    cells = [c for c in at("park-cantilever", "core, as in the source", 10.0) if c.family == "edgewise"]
    assert [f"{c.frequency:.4g}" for c in cells] == ["11.71", "70.37", "189.7"]


def test_the_surrogate_rises_as_the_papers_blade_does() -> None:
    """Park et al. (2010), Fig. 3: 8 % at 20 rpm, 16.5 % at 30 rpm at most, which imply 1.06 Hz at rest."""
    (rest, _, twenty, thirty) = [
        r.core.modes[0].estimate.value
        for r in core("park-blade/surrogate")[plan("park-blade/surrogate")["exudyn-tree"].effects]
        if isinstance(r, Reference) and r.core.modes[0].estimate
    ]
    assert rest / 6.283185307 == pytest.approx(1.06, abs=0.01)
    assert twenty / rest - 1.0 == pytest.approx(0.08, abs=0.005)
    assert thirty / rest - 1.0 == pytest.approx(0.165, abs=0.01)
