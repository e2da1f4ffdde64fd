"""Pitch has a sign of its own and OpenFAST's; an initial pitch is not an operating point."""

from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import readers
from southwell.cases.input.properties import about_hub
from southwell.cases.input.readers import Mount
from southwell.reports.cli.mounting import Mounting

from .test_cli import southwell

DATA = Path(__file__).parents[2] / "data" / "blades"


def test_openfasts_pitch_has_the_other_sign() -> None:
    actual, expected = Mounting(pitch=-10.0), Mounting(pitch=10.0, pitch_convention="openfast")
    assert actual.mount() == expected.mount()
    assert expected.mount().pitch == pytest.approx(np.radians(-10.0))
    assert Mounting(pitch=0.0, pitch_convention="openfast").mount() == Mounting(pitch=0.0).mount()


def test_openfasts_positive_pitch_feathers_as_its_positive_twist_does() -> None:
    """The mass centre of a section ahead of the axis goes upwind (−z) under pitch to feather, by sin of the angle."""
    straight = Mount(length=50.0, hub_radius=2.0)
    feathered = Mounting(pitch=90.0, pitch_convention="openfast", length=50.0, hub_radius=2.0).mount()
    before, after = (about_hub(readers.read(DATA / "bmodes.bmi", m)).centre for m in (straight, feathered))
    untwisted = about_hub(readers.read(DATA / "bmodes.bmi", Mounting(pitch=0.0).mount())).centre
    assert abs(before[1]) + abs(untwisted[1]) > 0  # off the axis: else this shows nothing
    table = DATA / "elastodyn_blade.dat"
    blade = readers.read(table, feathered)
    assert blade.pitch == pytest.approx(-np.pi / 2)
    assert (blade.twist <= 0).all()  # StrcTwst is positive in the file: pitch and twist turn alike
    assert not np.allclose(before, after)


def test_a_convention_without_a_pitch_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    status, _, err = southwell(f"show {DATA / 'bmodes.bmi'} --pitch-convention openfast", capsys)
    assert status == 2
    assert "--pitch-convention openfast: no pitch is given: add --pitch" in err


def test_show_prints_both_signs(capsys: pytest.CaptureFixture[str]) -> None:
    line = f"show {DATA / 'elastodyn_main.dat'} --pitch 10 --pitch-convention openfast"
    _, output, _ = southwell(line, capsys)
    assert "-10° (positive with the leading edge downwind; as OpenFAST's BlPitch: 10°)" in output


@pytest.mark.parametrize("file", ["elastodyn_main.dat", "elastodyn_blade.dat", "fast7_main.fst"])
def test_the_initial_pitch_is_listed_and_not_used(file: str) -> None:
    reading = readers.reading(DATA / file)
    assert reading.blade.pitch == 0.0
    (pitch,) = [u for u in reading.source.unused if u.name == "BlPitch"]
    assert f"--pitch {pitch.values[0]:g} --pitch-convention openfast" in pitch.why


def test_bmodes_pitch_is_a_setting_of_its_analysis_and_used() -> None:
    assert np.degrees(readers.read(DATA / "bmodes.bmi").pitch) == pytest.approx(4.0)  # bl_thp -4
