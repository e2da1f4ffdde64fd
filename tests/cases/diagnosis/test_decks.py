"""How HAWC2 and ElastoDyn describe a blade of their files: closed forms, and their differences are named."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.diagnosis import decks, model
from southwell.cases.diagnosis.diagnose import diagnose, explain
from southwell.cases.diagnosis.elastodyn_blade import AssumedShapes
from southwell.cases.diagnosis.hypotheses import INPUT
from southwell.cases.diagnosis.model import Model
from southwell.cases.diagnosis.spectra import Problem
from southwell.cases.input import readers
from southwell.cases.input.readers import BladeFile, Mount
from southwell.cases.input.readers.hawc2.elements import _averaged, with_elements
from southwell.cases.input.readers.openfast.mode_shapes import Shape
from southwell.cases.input.readers.text import Table, Text
from southwell.core.blade import BEND_Y, TORSION, Blade, uniform_blade
from southwell.tests.support import blade_files
from southwell.tests.support.decks import hawc2

BEAM = uniform_blade("beam", 6.0, 0.6, EA=1e9, GJ=40.0, EI_y=1e4, EI_z=2e4, mass=1.2, I_y=0.02, I_z=0.03)


def file_of(path: Path) -> BladeFile:
    reading = readers.reading(path)
    return BladeFile(path, reading.blade, reading.source, Mount())


def test_two_node_elements_are_linear_in_torsion() -> None:
    """A clamped shaft of n elements: ω² = (6 GJ/(I h²)) (1 − cos kh)/(2 + cos kh) with k = π/2L, the exact one is (GJ/I) k²."""
    n, k = 3, np.pi / 12.0
    h = 6.0 / n
    expected = np.sqrt(40.0 / 0.05 * 6.0 / h**2 * (1.0 - np.cos(k * h)) / (2.0 + np.cos(k * h)))
    (modes,) = model.solve(Model(BEAM, elements=n, two_node=True), [0.0], 12)
    assert modes is not None
    exact = np.sqrt(40.0 / 0.05) * k
    assert expected > 1.01 * exact
    assert np.abs(modes.frequencies / expected - 1.0).min() < 1e-9
    (fine,) = model.solve(Model(BEAM, elements=n), [0.0], 12)
    assert fine is not None
    assert np.abs(fine.frequencies / exact - 1.0).min() < 1e-4


@pytest.mark.parametrize("omega", [0.0, 9.0])
def test_an_assumed_shape_is_integrated_by_the_rule_of_the_middle(omega: float) -> None:
    """Shape (s/L)² on three nodes of an untwisted beam: sums written down by hand; flapwise, so that nothing softens it."""
    length, step, i = 6.0, 2.0, np.arange(3)
    s, bent = (i + 0.5) * step, 2.0 / length**2
    deflection = bent * step**2 * (i**2 + i + 0.5) / 2.0
    shortening = np.array([np.sum((bent * s[:k]) ** 2) * step + (bent * s[k]) ** 2 * step / 2.0 for k in i])
    mass = 1.2 * step
    stiffness = 1e4 * bent**2 * length + omega**2 * np.sum(mass * (0.6 + s) * shortening)
    shape = Shape(np.array([1.0, 0.0, 0.0, 0.0, 0.0]), 0.01, 1.0)
    (modes,) = model.solve(Model(BEAM, assumed=AssumedShapes({"flapwise 1": shape}, 3)), [omega], 4)
    assert modes is not None
    assert modes.frequencies == pytest.approx([np.sqrt(stiffness / np.sum(mass * deflection**2))], rel=1e-12)


def test_columns_are_averaged_by_themselves_and_mass_by_its_moment() -> None:
    """Over an element from a to b: mean of c + d r is c + d (a + b)/2; the mass has the first moment of 8 − r/2."""
    r = np.array([0.0, 3.0, 10.0])
    columns = {"r": r, "m": 8.0 - 0.5 * r, "E": 2.0 + r, "x_cg": 0.3 + 0.0 * r, "x_sh": 0.4 + 0.0 * r, "y_cg": 0.0 * r,
               "y_sh": 0.0 * r, "x_e": 0.1 + 0.0 * r, "y_e": 0.0 * r}  # fmt: skip
    averaged = _averaged(Table(Text(Path("st.dat"), ()), columns, (0, 1, 2)), np.array([0.0, 4.0, 10.0]))
    assert averaged["E"] == pytest.approx([4.0, 9.0])
    assert averaged["x_cg"] == pytest.approx([0.2, 0.2])
    assert averaged["x_sh"] == pytest.approx([0.3, 0.3])
    assert averaged["x_e"] == pytest.approx([0.0, 0.0])
    assert averaged["m"] == pytest.approx(
        [8.0 - 0.5 * (4**3 / 3) / (4**2 / 2), 8.0 - 0.5 * ((10**3 - 4**3) / 3) / ((10**2 - 4**2) / 2)]
    )


def hawc2_file(folder: Path) -> tuple[BladeFile, Blade]:
    """The file of a blade, and the blade made of HAWC2's elements."""
    file = file_of(hawc2(folder))
    blade = with_elements(file.blade, file.path, file.mount)
    assert blade is not None
    return file, blade


def test_elements_are_straight_prismatic_and_along_the_elastic_centres(tmp_path: Path) -> None:
    file, blade = hawc2_file(tmp_path)
    c2 = np.array(
        [[0.0, 0.0, 0.0, -12.0], [-0.02, -0.05, 7.0, -8.0], [-0.06, -0.2, 14.0, -3.0], [-0.1, -0.5, 20.0, 1.0]]
    )
    angle = np.radians(c2[:, 3])
    c, s = np.cos(angle), np.sin(angle)
    centre = np.stack([c2[:, 2], c2[:, 0] + 0.12 * c + 0.03 * s, c2[:, 1] + 0.12 * s - 0.03 * c], axis=1)
    assert blade.curve[[1, 3, 5]] == pytest.approx((centre - centre[0])[1:])
    assert blade.stations[[1, 3, 5]] == pytest.approx(np.cumsum(np.linalg.norm(np.diff(centre, axis=0), axis=1)))
    assert np.degrees(blade.twist[::2]) == pytest.approx([-10.0, -5.5, -1.0])
    assert np.array_equal(blade.stiffness[::2], blade.stiffness[1::2])
    assert np.array_equal(blade.mass[::2], blade.mass[1::2])
    assert with_elements(file.blade, tmp_path / "plain_st.dat", Mount()) is None


def test_the_differences_of_hawc2s_elements_are_named(tmp_path: Path) -> None:
    file, blade = hawc2_file(tmp_path)
    (modes,) = model.solve(Model(blade, elements=1, two_node=True), [0.0], 6)
    assert modes is not None
    kinds = (*decks.hypotheses(file, file.blade), *INPUT[:14])
    problem = Problem(file.blade, (0.0,), (1, 2, 3, 4, 5, 6), hypotheses={kind.name: kind for kind in kinds})
    diagnosis = explain(problem, modes.frequencies[None, :6])
    assert diagnosis.largest > 0.01
    assert diagnosis.sentence.startswith(
        "agrees with Southwell's own solver with HAWC2's 3 elements (each column averaged) (0.0"
    )


def test_a_changed_blade_is_not_that_of_the_file(tmp_path: Path) -> None:
    file, _ = hawc2_file(tmp_path)
    assert len(decks.hypotheses(file, replace(file.blade, hub_radius=2.0))) == 1
    assert decks.hypotheses(file, replace(file.blade, twist=0.0 * file.blade.twist)) == ()
    stiffness = file.blade.stiffness.copy()
    stiffness[:, [TORSION, BEND_Y], [TORSION, BEND_Y]] *= 2.0
    assert decks.hypotheses(file, replace(file.blade, stiffness=stiffness)) == ()


@pytest.mark.slow
def test_openfasts_linearised_blade_is_named(tmp_path: Path) -> None:
    """OpenFAST 3.5's NREL 5-MW blade at rest: 17 nodes, three assumed shapes (OpenFAST/openfast_toolbox, 5MW_Land_ED)."""
    table = blade_files.real("nrel5mw/NRELOffshrBsline5MW_Blade.dat")
    main = tmp_path / "ElastoDyn.dat"
    main.write_text(f'63.0 TipRad\n1.5 HubRad\n-2.5 PreCone(1)\n0 TipMass(1)\n17 BldNodes\n"{table.name}" BldFile(1)\n')
    (tmp_path / table.name).write_bytes(table.read_bytes())
    blade = readers.read(main)
    frequencies = 2.0 * np.pi * np.array([[0.67167, 1.07914, 1.98086]])
    labels = ["flapwise 1", "edgewise 1", "flapwise 2"]
    diagnosis = diagnose(blade, [0.0], frequencies, labels, deck=main)
    assert (
        diagnosis.sentence
        == "agrees with Southwell's own solver in ElastoDyn's 3 assumed shapes on 17 nodes (0.012 % remains)"
    )
