"""``convert``: the deck that is written has the frequencies of the one read; what it does not carry over is listed."""

import re
from pathlib import Path

import numpy as np
import pytest

from southwell import modes
from southwell.cases.input import readers
from southwell.cases.input.readers import Mount
from southwell.cases.writers.elastodyn_shapes import polynomials
from southwell.core.blade import Blade

from ...cases.input.readers.openfast.test_readers_elastodyn import real
from .test_cli import southwell

DATA = Path(__file__).parents[2] / "data" / "blades"


def frequencies(blade: Blade) -> np.ndarray:
    """At 5 and 15 rpm, rad/s."""
    return np.array([modes(blade, omega, elements=20, modes=8).frequencies for omega in (np.pi / 6, np.pi / 2)])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "to"),
    [
        ("nrel5mw/NRELOffshrBsline5MW_BeamDyn.dat", "beamdyn"),
        ("nrel5mw/NRELOffshrBsline5MW_Blade.dat", "elastodyn"),
        ("iea15/IEA-15-240-RWT_ElastoDyn_blade.dat", "elastodyn"),
        ("iea3.4/IEA-3.4-130-RWT_ElastoDyn_blade.dat", "elastodyn"),
        ("iea3.4/IEA-3.4-130-RWT_BeamDyn_Blade.dat", "beamdyn"),
        ("iea3.4/blade_st.dat", "beamdyn"),
    ],
)
def test_public_decks(tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, to: str) -> None:
    source, out = real(name), tmp_path / "out.dat"
    length = "" if name.endswith(("_BeamDyn.dat", "st.dat")) else " --length 63"
    status, _, err = southwell(f"convert {source} {out} --to {to} --hub-radius 2{length}", capsys)
    assert (status, err) == (0, "")
    mount = Mount(hub_radius=2.0, length=63.0 if length else None)
    second = readers.read(out, Mount(hub_radius=2.0, length=63.0) if to == "elastodyn" else Mount(hub_radius=2.0))
    np.testing.assert_allclose(frequencies(second), frequencies(readers.read(source, mount)), rtol=1e-6)


@pytest.fixture
def elastodyn(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> tuple[Path, Path, str]:
    """A table without its main file, the same written again, and what was said."""
    source, out = tmp_path / "alone.dat", tmp_path / "out.dat"
    source.write_bytes((DATA / "elastodyn_blade.dat").read_bytes())
    status, output, _ = southwell(f"convert {source} {out} --to elastodyn --length 50 --hub-radius 2 --rpm 12", capsys)
    assert status == 0
    return source, out, output


def test_elastodyns_damping_and_pitch_axis_are_carried_over(elastodyn: tuple[Path, Path, str]) -> None:
    source, out, output = elastodyn
    mount = Mount(length=50.0, hub_radius=2.0)
    before, after = ({u.name: u.values for u in readers.reading(p, mount).source.unused} for p in (source, out))
    for name in ("BldFlDmp(1), BldFlDmp(2), BldEdDmp(1)", "PitchAxis"):
        assert after[name] == before[name]
        assert name not in output
    assert before["PitchAxis"] == (0.25, 0.3, 0.375, 0.375, 0.375)


def test_elastodyns_mode_shapes_are_those_of_the_blade(elastodyn: tuple[Path, Path, str]) -> None:
    source, out, _ = elastodyn
    blade = readers.read(source, Mount(length=50.0, hub_radius=2.0))
    text = out.read_text()
    for name, shape in zip(("BldFl1Sh", "BldFl2Sh", "BldEdgSh"), polynomials(blade, 12 * np.pi / 30), strict=True):
        written = [float(x) for x in re.findall(rf"(\S+)  {name}\(\d\) - mode shape at 12 rpm", text)]
        np.testing.assert_array_equal(written, shape.coefficients)
        assert sum(written) == pytest.approx(1.0, abs=1e-9)  # ElastoDyn refuses shapes that do not add up to 1
    assert "x^2, not a mode" not in text


def test_beamdyns_damping_is_carried_over(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out.dat"
    status, output, _ = southwell(f"convert {DATA / 'beamdyn_main.dat'} {out} --to beamdyn", capsys)
    assert status == 0
    assert "mu1" not in output
    (mu,) = readers.reading(out).source.unused
    assert mu.values == (1e-3, 1e-3, 1e-3, 0.0014, 0.0022, 0.0022)


def test_a_curve_that_beamdyn_cannot_hold_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The stations of an Akima curve lie elsewhere on BeamDyn's natural spline; the message says by how much."""
    out = tmp_path / "out.dat"
    status, output, _ = southwell(f"convert {DATA / 'hawc2.htc'} {out} --to beamdyn", capsys)
    assert status == 0
    (phrase,) = re.findall(r"the curve between stations changes: BeamDyn's spline moves stations by (\S+) of", output)
    before, after = readers.read(DATA / "hawc2.htc"), readers.read(out)
    assert len(after.stations) == len(before.stations)
    np.testing.assert_allclose(after.curve, before.curve, rtol=1e-14, atol=1e-14)
    moved = np.abs(after.stations - before.stations).max() / before.length
    assert moved > 1e-6
    assert float(phrase) == pytest.approx(moved, rel=0.05)
    np.testing.assert_allclose(frequencies(after), frequencies(before), rtol=2e-4)


def test_properties_that_a_format_loses_are_listed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, output, _ = southwell(f"convert {DATA / 'beamdyn_main.dat'} {tmp_path / 'out.toml'} --hub-radius 0", capsys)
    assert status == 0
    assert "not used: mu1 … mu6 (largest 0.0022 s, beamdyn_blade.dat)" in output
    status, output, _ = southwell(f"convert {DATA / 'hawc2.htc'} {tmp_path / 'out.dat'} --to beamdyn", capsys)
    assert "not given or zero, written as 0: mu1 … mu6" in output
