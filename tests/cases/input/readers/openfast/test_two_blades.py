"""A deck of two blades: the hub of ElastoDyn, its teeter hinge, and the diagram."""

from pathlib import Path

import numpy as np
import pytest

from southwell.cases.campbell.machine import MachineRequest, machine_diagram
from southwell.cases.input.errors import CaseError
from southwell.cases.input.readers.openfast import turbine
from southwell.cases.plan.request import Request
from southwell.cases.plan.subjects import subjects
from southwell.core.turbine.turbine import Teeter
from southwell.reports.cli import app
from southwell.tests.support.turbine_decks import deck


def changed(path: Path, old: str, new: str) -> Path:
    main = path.parent / "main.dat"
    assert old in main.read_text()
    main.write_text(main.read_text().replace(old, new))
    return path


def test_the_hub_of_two_blades(tmp_path: Path) -> None:
    """HubIner is about the hinge; OverHang reaches to it, and the apex is upwind of it by UndSling (ElastoDyn's code)."""
    path = deck(tmp_path, two=True)
    assert turbine.is_turbine(path)
    read = turbine.read(path)
    assert (read.turbine.blades, read.turbine.teeter) == (2, Teeter(0.2, 5e5))
    tilt = np.radians(-5.0)
    apex = np.array([1.1 - 2.7 * np.sin(tilt), 0.0, -2.7 * np.cos(tilt)])
    np.testing.assert_allclose(read.turbine.shaft[:3, 3], apex, atol=1e-12)
    own = 2000.0 - 3000.0 * 0.1**2  # about the mass centre, 0.1 m upwind of the hinge, across the blades
    about_apex = 3000.0 * 0.1**2
    np.testing.assert_allclose(np.diagonal(read.turbine.hub)[3:], [about_apex, own + about_apex, own], rtol=1e-12)
    unused = {u.name: u.why for u in read.source.unused}
    assert unused["TeetDmp"] == "the hinge is linear and undamped"
    assert not {"TeetDOF", "UndSling", "TeetSSSp"} & unused.keys()
    assert any("the hub teeters, with a spring of 500000 N m/rad" in note for note in read.source.notes)


def test_the_hinge_as_the_deck_says(tmp_path: Path) -> None:
    path = changed(deck(tmp_path, two=True), "True TeetDOF", "False TeetDOF")
    read = turbine.read(path).turbine
    assert read.teeter is None
    assert read.shaft[2, 3] == pytest.approx(-2.7 * np.cos(np.radians(5.0)))
    changed(path, "2000 HubIner", "900 HubIner\n2000 HubIner_Teeter")
    assert turbine.read(path).turbine.hub[5, 5] == pytest.approx(900.0)
    changed(path, "2000 HubIner_Teeter", "20 HubIner_Teeter")
    with pytest.raises(CaseError, match="HubIner_Teeter: less than HubMass at its distance"):
        turbine.read(path)
    path = changed(deck(tmp_path, two=True), "0 TeetSStP", "3 TeetSStP")
    read = turbine.read(path)
    assert read.turbine.teeter == Teeter(0.2, 0.0)
    assert {"TeetSStP", "TeetSSSp"} <= {u.name for u in read.source.unused}
    with pytest.raises(CaseError, match="Delta3: 30: only a teeter hinge perpendicular"):
        turbine.read(changed(deck(tmp_path, two=True), "0 Delta3", "30 Delta3"))


@pytest.mark.slow
def test_the_diagram_of_two_blades(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, out = deck(tmp_path, two=True), tmp_path / "out"
    with pytest.raises(SystemExit) as stop:
        app.main(f"campbell {path} --rpm 16,20 --modes 3 -o {out}".split())
    assert stop.value.code == 0
    output = " ".join(capsys.readouterr().out.split())
    assert "hub and 2 blades" in output
    assert "those of the two blades in the rotor's" in output
    for name in ("teeter", "1st tower fore-aft", "1st tower side-side"):
        assert name in (out / "campbell.csv").read_text()
    with pytest.raises(CaseError, match=r"at rest depend on the azimuth; give speeds above 0, as in 0\.5"):
        machine_diagram(turbine.read(path).turbine, MachineRequest((0.0, 2.0)))


def test_other_codes_do_not_take_two_blades(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=r"two blades: .* `southwell campbell` does"):
        subjects(Request((str(deck(tmp_path, two=True)),), rpm="20"), print)
