"""OpenFAST's linearisation files: what is read, and input that cannot be used."""

import gzip
import random
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input.errors import CaseError
from southwell.cases.linearisation.judgement import judge_set
from southwell.cases.linearisation.lin_file import LinFile, parsed, read
from southwell.cases.linearisation.sets import azimuth_set, collect, stem
from southwell.cases.linearisation.states import parse
from southwell.tests.support.linearised_machines import Machine, elastodyn

MACHINE = Machine()
LIN = elastodyn(MACHINE, 0.3)
TEXT = LIN.text()


def lin_file(text: str = TEXT, name: str = "case.1.lin") -> LinFile:
    return parsed(Path(name), text)


def test_a_written_file_is_read_unchanged() -> None:
    lin = lin_file()
    assert (lin.version, lin.azimuth, lin.rotor_speed, lin.digits) == ("v3.5.3", 0.3, 1.0, 4)
    assert "BeamDyn" in lin.modules
    assert np.abs(lin.A - LIN.A).max() <= lin.half_unit.max()
    assert (np.abs(lin.A - LIN.A) <= lin.half_unit + 1e-12 * np.abs(LIN.A)).all()
    assert len(lin.derivatives) == len(lin.states) == 28


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "ED First time derivative of 1st flapwise bending-mode DOF of blade 2 (internal DOF index = DOF_BF(2,1)), m/s",
            ("ED", "flapwise 1", "m/s", True, 2),
        ),
        (
            "ED Variable speed generator DOF (internal DOF index = DOF_GeAz), rad",
            ("ED", "generator", "rad", False, None),
        ),
        (
            "BD_3 First time derivative of finite element node 6 (number of elements = 1; element order = 5) rotational "
            "displacement in X, rad/s",
            ("BD", "edgewise", "rad/s", True, 3),
        ),
        ("AD x1 (UA) blade 1, node 4, rad", ("AD", "unsteady airfoil", "rad", False, 1)),
        ("HD RdtnPtfmSg12", ("HD", "wave radiation", "", False, None)),
        (
            "ED Platform pitch tilt rotation DOF (internal DOF index = DOF_P), rad",
            ("ED", "platform pitch", "rad", False, None),
        ),
        # descriptions of r-test's StC_test_OC4Semi_Linear_Nac and Fake5MW_AeroLin_B1_UA4_DBEMT3, and of ServoDyn's source
        (
            "SrvD Nacelle StC 1 local displacement state dX/dt  m/s",
            ("SrvD", "Nacelle StC 1 displacement X", "m/s", True, None),
        ),
        (
            "SrvD Blade 2 StC 1 local displacement state Y  m",
            ("SrvD", "blade StC 1 displacement Y", "m", False, 2),
        ),
        ("AD x4 blade 1, node 2, -", ("AD", "unsteady airfoil", "-", False, 1)),
        (
            "AD First time derivative of vind (axial) at blade 1, node 3, m/s/s",
            ("AD", "dynamic inflow", "m/s/s", True, 1),
        ),
        (
            "SD First time derivative of Craig-Bampton mode 2 amplitude, -/s",
            ("SD", "substructure 2", "-/s", True, None),
        ),
        ("Unheard-of state, furlong", ("", "Unheard-of state", "furlong", False, None)),
    ],
)
def test_a_state_is_identified_by_its_description(text: str, expected: tuple[object, ...]) -> None:
    state = parse(text, True, 2, 0.0)
    assert (state.module, state.family, state.unit, state.rate, state.blade) == expected


def test_displacement_and_rate_have_one_kind() -> None:
    azimuths = azimuth_set("case", [lin_file()])
    assert len(azimuths.pairs) == 14
    assert all(azimuths.states[q].kind == azimuths.states[v].kind for q, v in azimuths.pairs)
    assert sum(not group.rate for group in azimuths.groups) == 3


def test_the_layout_of_2017_is_read() -> None:
    """FAST 8.17 wrote no derivative orders and no wind speed, and its version in parentheses."""
    old = re.sub(r"OpenFAST,.* v3\.5\.3", "OpenFAST (v8.17.01b-dev, 18-Jan-2017), compiled", TEXT).replace(
        " Derivative Order", ""
    )
    old = re.sub(r"   Wind Speed:.*\n", "", re.sub(r"( [TF]) +\d  ", r"\1  ", old))
    assert old.count("\n") == TEXT.count("\n") - 1
    former = lin_file(old)
    assert (former.version, former.states[0].order) == ("v8.17.01b-dev", None)
    assert [state.key for state in former.states] == [state.key for state in lin_file().states]
    assert np.array_equal(former.A, lin_file().A)


def structural_control(stiffness: float = 0.1) -> str:
    """A structural control beside the machine: X moves by the spring, Y has no equation, as OpenFAST 3.1 to 5.0 write it."""
    names = ("X  m", "Y  m", "dX/dt  m/s", "dY/dt  m/s")
    n, lines = len(LIN.rows), TEXT.splitlines()
    rows = [
        f"{n + k + 1:11d} 0.000E+00 F 2 SrvD Nacelle StC 1 local displacement state {name}"
        for k, name in enumerate(names)
    ]
    own = [[0.0, 0, 1, 0], [0.0] * 4, [-stiffness, 0, -0.01, 0], [0.0] * 4]
    at = lines.index(next(line for line in lines if line.startswith("A:")))
    matrix = [line + "  0.000E+00" * 4 for line in lines[at + 1 : at + 1 + n]]
    matrix += ["  0.000E+00" * n + "".join(f"  {value:.3E}" for value in row) for row in own]
    table = lines.index("Order of continuous states:") + 3 + n
    head = [line.replace(f"continuous states: {n:10d}", f"continuous states: {n + 4:10d}") for line in lines[:table]]
    return "\n".join([*head, *rows, "", f"A: {n + 4} x {n + 4}", *matrix, ""])


def test_idle_directions_of_a_structural_control_are_no_defect() -> None:
    judged_set = judge_set(azimuth_set("case", [lin_file(structural_control())]))
    assert "kinematic rows" not in {finding.name for finding in judged_set.findings}
    assert len(judged_set.azimuth_set.pairs) == 16
    control = next(mode for mode in judged_set.modes if mode.name == "Nacelle StC 1 displacement X")
    assert control.frequency == pytest.approx(np.sqrt(0.1) / (2 * np.pi), rel=1e-9)
    # a row that is zero while its column is not is still a defect
    broken = structural_control().replace("  0.000E+00  0.000E+00  1.000E+00  0.000E+00\n", "  0.000E+00" * 4 + "\n")
    judged_set = judge_set(azimuth_set("case", [lin_file(broken)]))
    assert "kinematic rows" in {finding.name for finding in judged_set.findings}


def test_a_compressed_file_is_read(tmp_path: Path) -> None:
    path = tmp_path / "case.1.lin.gz"
    path.write_bytes(gzip.compress(TEXT.encode()))
    assert np.array_equal(read(path).A, lin_file().A)
    path.write_bytes(gzip.compress(TEXT.encode())[:-400])
    with pytest.raises(CaseError, match="damaged gzip file"):
        read(path)


def test_a_decompression_bomb_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "case.1.lin.gz"
    path.write_bytes(gzip.compress(b" " * 2_000_000))
    monkeypatch.setattr("southwell.cases.linearisation.lin_file.LARGEST_DATA", 1 << 20)
    with pytest.raises(CaseError, match="larger than 1 MB when unpacked"):
        read(path)


def test_an_exponent_of_three_digits_without_its_letter_is_read() -> None:
    row = next(line for line in TEXT.splitlines() if line.startswith("    0.000E+00    0.000E+00"))
    assert lin_file(TEXT.replace(row, row.replace("0.000E+00", "1.234-105", 1), 1)).A.min() < 0


def test_asterisks_in_the_header_are_counted_and_those_in_the_matrix_refused() -> None:
    assert lin_file(replace(LIN, states="****").text()).overflowed == ("Number of continuous states",)
    row = next(line for line in TEXT.splitlines() if line.startswith("    0.000E+00    0.000E+00"))
    with pytest.raises(
        CaseError, match=r"line \d+: A\[1,1\]: '\*\*\*\*\*\*\*\*\*' is not a number: it overflowed its format"
    ):
        lin_file(TEXT.replace(row, row.replace("0.000E+00", "*********", 1), 1))


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("Linearized model", "Model", "not a linearisation of OpenFAST"),
        ("Order of continuous states:", "Order of states:", "no table of continuous states"),
        ("A: 28 x 28", "A: 27 x 28", "the table has 28 states"),
        ("A: 28 x 28", "Z: 28 x 28", "no matrix A"),
        ("states:         28", "states:         27", "27 in the header"),
        ("   Rotor Speed:", "   Rotor Sped:", "Rotor Speed: missing in the header"),
        (
            "Azimuth:                             0.3000",
            "Azimuth:                             ******",
            "Azimuth: overflowed",
        ),
        ("   3.096E+00", "         NaN", "operating point"),
        (
            "blade 2 (internal DOF index = DOF_BF(2,1))",
            "blade 1 (internal DOF index = DOF_BF(1,1))",
            "in the table twice",
        ),
        ("0.000E+00\n", "nan\n", "not a finite number"),
        ("0.000E+00\n", "\n", "27 numbers instead of 28"),
    ],
)
def test_damaged_files_are_refused_in_one_line(old: str, new: str, words: str) -> None:
    assert old in TEXT
    with pytest.raises(CaseError, match=words.replace("[", r"\[")) as error:
        lin_file(TEXT.replace(old, new, 1) if "DOF_BF" not in old else TEXT.replace(old, new))
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("seed", range(3))
def test_mutated_files_are_refused_or_read(seed: int) -> None:
    """Nothing but ``CaseError``: lines and characters are removed, doubled, exchanged and replaced at random."""
    random_ = random.Random(seed)
    refused, judged = [], 0
    for _ in range(20):
        lines = TEXT.splitlines()
        for _ in range(random_.randint(1, 3)):
            k, j = (random_.randrange(len(lines)) for _ in range(2))
            match random_.randrange(5):
                case 0:
                    del lines[k]
                case 1:
                    lines.insert(k, lines[j])
                case 2:
                    lines[k], lines[j] = lines[j], lines[k]
                case 3:
                    place = random_.randrange(len(lines[k]) + 1)
                    lines[k] = (
                        lines[k][:place]
                        + random_.choice(["*", "1e999", "\x00", "٣", "-", ",", "e", "\t"])
                        + lines[k][place:]
                    )
                case _:
                    lines = lines[:k] or [""]
        try:
            modes = judge_set(azimuth_set("case", [lin_file("\n".join(lines))])).modes
        except CaseError as error:
            refused.append(str(error))
        else:
            judged += 1
            assert np.isfinite([mode.frequency for mode in modes]).all()
    assert refused
    assert not any("\n" in message for message in refused)
    assert judged


def test_azimuths_of_one_stem_are_one_set() -> None:
    names = ("a.1.lin", "a.12.lin", "b.1.lin", "a.1.ED.lin", "c.2.lin.gz", "alone.lin")
    assert [stem(Path(name)) for name in names] == ["a", "a", "b", "a.ED", "c", "alone"]
    faster = elastodyn(replace(MACHINE, omega=1.2), 0.0).text()
    sets = collect([lin_file(faster, "b.1.lin"), lin_file(name="a.2.lin"), lin_file(name="a.1.lin")])
    assert [(azimuth_set.name, len(azimuth_set.files)) for azimuth_set in sets] == [("a", 2), ("b", 1)]


def test_files_of_different_models_are_refused() -> None:
    other = TEXT.replace(
        "Nacelle yaw DOF (internal DOF index = DOF_Yaw)", "Nacelle nod DOF (internal DOF index = DOF_Nod)"
    )
    with pytest.raises(CaseError, match="of different models"):
        azimuth_set("case", [lin_file(), lin_file(other, "case.2.lin")])
