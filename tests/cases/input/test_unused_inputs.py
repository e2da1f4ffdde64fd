"""Every non-zero quantity of a file that a blade does not hold is listed once, with its largest value, by every command."""

import json
import shutil
from pathlib import Path

import pytest

from southwell.cases.input import library, readers
from southwell.cases.input.readers import Mount
from southwell.cases.plan.settings import NOT_USED
from southwell.cases.store import results_file

from ...reports.cli.test_cli import southwell

DATA = Path(__file__).parents[2] / "data" / "blades"

EXPECTED = {
    "elastodyn_main.dat": {
        "PitchAxis": (0.375, ""),
        "BldFlDmp(1), BldFlDmp(2), BldEdDmp(1)": (0.5, "% of critical"),
        "BldFl1Sh, BldFl2Sh, BldEdgSh": (1.7254, ""),
        "BlPitch": (3.0, "deg"),
    },
    "fast7_main.fst": {
        "AeroCent": (0.25, ""),
        "Alpha": (0.02, ""),
        "BldFlDmp(1), BldFlDmp(2), BldEdDmp(1)": (4.0, "% of critical"),
        "BldFl1Sh, BldFl2Sh, BldEdgSh": (0.9, ""),
        "FlStTunr(1), FlStTunr(2)": (1.25, ""),
        "BlPitch": (2.6, "deg"),  # 9.9 is a third blade's, of two
        "RotSpeed": (20.5, "rpm"),
        "PreCone(2), …": (3.5, "deg"),
        "TeetDOF": (1.0, ""),
        "UndSling": (-0.4, "m"),
        "Delta3": (15.0, "deg"),
        "TeetMod": (1.0, ""),
        "TeetDmp": (4e4, "N m s/rad"),
    },
    "beamdyn_main.dat": {"mu1 … mu6": (0.0022, "s")},
    "bmodes.bmi": {},
}


@pytest.mark.parametrize("file", EXPECTED)
def test_each_unused_input_is_listed_once(file: str) -> None:
    remainder = readers.reading(DATA / file).source.unused
    assert {u.name: (u.largest, u.unit) for u in remainder} == EXPECTED[file]
    assert len(remainder) == len(EXPECTED[file])


@pytest.mark.parametrize(
    ("case", "variant", "name", "switch"),
    [
        ("windpact-1.5", "centred", "cg_edge", "centred = true"),
        ("park-blade", "surrogate-untwisted", "twist", "twisted = false"),
    ],
)
def test_rows_that_a_switch_excludes_are_listed(case: str, variant: str, name: str, switch: str) -> None:
    unused = {v.name: {u.name: u for u in v.unused} for v in library.load(case).variants}
    switched = unused.pop(f"{case}/{variant}")
    assert set(switched) == {name}
    assert switch in switched[name].why
    assert switched[name].largest
    assert unused
    assert not any(name in others for others in unused.values())


def test_a_teeter_hinge_is_listed_as_clamped() -> None:
    (teeter,) = [u for u in readers.reading(DATA / "fast7_main.fst").source.unused if u.name == "TeetDOF"]
    assert "treated as clamped" in teeter.why


def test_a_locked_teeter_hinge_is_not_listed(tmp_path: Path) -> None:
    text = (DATA / "fast7_main.fst").read_text()
    shutil.copy(DATA / "fast7_blade.dat", tmp_path)
    for old, new in (("True        TeetDOF", "False       TeetDOF"), ("   2        NumBl", "   3        NumBl")):
        (tmp_path / "m.fst").write_text(text.replace(old, new))
        names = {u.name for u in readers.reading(tmp_path / "m.fst").source.unused}
        assert not names & {"TeetDOF", "TeetDmp", "UndSling", "Delta3"}


def test_an_unknown_column_is_listed(tmp_path: Path) -> None:
    lines = (DATA / "elastodyn_blade.dat").read_text().splitlines()
    head = next(k for k, line in enumerate(lines) if "BlFract" in line)
    lines[head] += " Chord"
    lines[head + 2 : head + 7] = [f"{line} {k - 3.5}" for k, line in enumerate(lines[head + 2 : head + 7])]
    (tmp_path / "b.dat").write_text("\n".join(lines))
    (chord,) = [u for u in readers.reading(tmp_path / "b.dat", Mount(length=50.0)).source.unused if u.name == "Chord"]
    assert chord.largest == -3.5


def test_beamdyns_damping_that_is_switched_off_is_not_listed(tmp_path: Path) -> None:
    shutil.copy(DATA / "beamdyn_main.dat", tmp_path)
    text = (DATA / "beamdyn_blade.dat").read_text()
    (tmp_path / "beamdyn_blade.dat").write_text(text.replace("1   damp_type", "0   damp_type"))
    assert not readers.reading(tmp_path / "beamdyn_main.dat").source.unused


def test_beamdyns_pitch_actuator(tmp_path: Path) -> None:
    shutil.copy(DATA / "beamdyn_blade.dat", tmp_path)
    actuator = (
        "\nTrue UsePitchAct - actuator? (flag)\n200 PitchJ - inertia\n2E7 PitchK - stiffness\n0 PitchC - damping\n"
    )
    (tmp_path / "m.dat").write_text((DATA / "beamdyn_main.dat").read_text() + actuator)
    remainder = {u.name: u.largest for u in readers.reading(tmp_path / "m.dat").source.unused}
    assert remainder == {"mu1 … mu6": 0.0022, "PitchJ": 200.0, "PitchK": 2e7}


def test_hawc2s_damping_and_lumped_masses(tmp_path: Path) -> None:
    shutil.copy(DATA / "hawc2_st.dat", tmp_path)
    extra = "    damping_posdef 0 0 0 1.5e-3 1.6e-3 4e-4 ;\n    concentrated_mass 5 0.1 0.0 0.0 250 1 1 1 ;\n"
    text = (
        (DATA / "hawc2.htc").read_text().replace("    type        timoschenko ;\n", "    type timoschenko ;\n" + extra)
    )
    (tmp_path / "h.htc").write_text(text)
    remainder = {u.name: (u.largest, u.unit) for u in readers.reading(tmp_path / "h.htc").source.unused}
    assert remainder == {"damping_posdef": (1.6e-3, "s"), "concentrated_mass": (250.0, "kg")}


LINE = "not used: BlPitch (largest 3 deg, elastodyn_main.dat)"


@pytest.mark.parametrize(
    "command",
    [
        "modes {file} --rpm 0,5 --modes 2 --elements 5",
        "show {file}",
        "campbell {file} --rpm 0,5 --modes 2 --elements 5 --out {out}/c",
        "convert {file} {out}/it.toml",
    ],
)
def test_every_command_lists_unused_inputs_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], command: str
) -> None:
    status, output, _ = southwell(command.format(file=DATA / "elastodyn_main.dat", out=tmp_path), capsys)
    assert status == 0
    assert output.count(LINE) == 1
    for name in EXPECTED["elastodyn_main.dat"]:
        assert output.count(f"not used: {name} (") == 1
    page = tmp_path / "c" / "campbell.md"
    assert not page.exists() or page.read_text().replace("\\", "").count(LINE.removeprefix("not used: ")) == 1


def test_unused_inputs_are_on_standard_error_beside_json(capsys: pytest.CaptureFixture[str]) -> None:
    line = f"modes {DATA / 'elastodyn_main.dat'} --rpm 0 --modes 2 --elements 5 --json"
    status, output, err = southwell(line, capsys)
    assert status == 0
    assert len(json.loads(output)) == 2
    assert err.replace("\n", " ").count("not used: BlPitch") == 1


CASE = """
name = "deck"
title = "A deck"
description = "For tests."
source = "nowhere"
[blade]
kind = "file"
file = "elastodyn_main.dat"
[speeds]
rpm = [0.0]
[compare]
modes = 1
"""


@pytest.mark.slow
def test_unused_inputs_are_in_results_and_report(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("elastodyn_main.dat", "elastodyn_blade.dat"):
        shutil.copy(DATA / name, tmp_path)
    (tmp_path / "deck.toml").write_text(CASE)
    line = (
        f"verify {tmp_path / 'deck.toml'} --codes southwell-equation --faults none --out {tmp_path / 'r'} --workers 1"
    )
    _, _, err = southwell(line, capsys)
    assert "BlPitch (largest 3 deg, elastodyn_main.dat)" in err
    (setting,) = results_file.read(tmp_path / "r" / "results.jsonl").settings
    assert setting.facts[NOT_USED].count("BlPitch (largest 3 deg") == 1
    assert (tmp_path / "r" / "report.md").read_text().count("BlPitch (largest 3 deg") == 1
