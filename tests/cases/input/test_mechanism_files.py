"""Mechanisms in TOML: the same as by hand, every fault one line, the command shows what was found."""

import json
import re
import runpy
from pathlib import Path

import numpy as np
import pytest

from southwell import multibody as mb
from southwell.cases.input import library, mechanisms
from southwell.cases.input.errors import CaseError
from southwell.core.mechanism.description import Beam
from southwell.reports.cli import app as cli

EXAMPLES = Path(__file__).parents[3] / "examples"
HINGED, LINKED = "hinged-blade", "pitch-link"


def test_the_example_by_hand_is_its_closed_form() -> None:
    example = runpy.run_path(str(EXAMPLES / "hinged_blade.py"))
    solution = mb.solve(example["hinged_blade"]())
    flap, lag, ratio = example["closed_form"]()
    np.testing.assert_allclose(solution.frequencies, [lag, flap], rtol=1e-12)
    np.testing.assert_allclose(solution.damping, [ratio, 0.0], atol=1e-12)
    assert solution.leading == ("lag.rz", "flap.rz")


def test_the_free_shaft_has_each_mode_once_in_each_plane() -> None:
    """Timoshenko's free beam, in closed form: 9646.8 and 25312.6 rad/s (petrobras/ross issue 885).

    Rounding once gave the pencil's infinite eigenvalues finite values, and then every mode counted twice.
    """
    solution = mb.solve(runpy.run_path(str(EXAMPLES / "free_shaft.py"))["free_shaft"]())
    assert len(solution.frequencies) == len(solution.linear.names)
    np.testing.assert_allclose(solution.frequencies[:6], 0.0)
    np.testing.assert_allclose(solution.frequencies[6:10], [9646.8, 9646.8, 25312.6, 25312.6], rtol=5e-5)


def test_the_example_in_toml_is_the_one_by_hand() -> None:
    """M̂, Ĉ and K̂ alike, not only frequencies."""
    by_hand = mb.solve(runpy.run_path(str(EXAMPLES / "hinged_blade.py"))["hinged_blade"]())
    read = library.mechanism(HINGED).solve()
    for name in "MCK":
        expected, actual = getattr(read.linear, name), getattr(by_hand.linear, name)
        np.testing.assert_allclose(expected, actual, rtol=1e-12, atol=1e-12 * np.abs(actual).max())


def test_the_example_on_the_page_of_mechanisms_prints_what_it_says(capsys) -> None:
    """And is the one in the module's own words: lag Ω √(e S/I), c/(2 I ω)."""
    page = (EXAMPLES.parent / "docs" / "mechanisms.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```python\n(.*?)```", page, re.S)
    message = re.search(r"# ([\d.]+) rad/s, ([\d.]+) of critical", block)
    exec(block, {})
    frequency, ratio = map(float, re.findall(r"[\d.]+", capsys.readouterr().out))
    lag = 30.0 * np.sqrt(0.3 * 80.0 / 210.0)
    assert (frequency, ratio) == (pytest.approx(lag, rel=1e-6), pytest.approx(600.0 / (2 * 210.0 * lag), rel=1e-6))
    assert message
    assert (message[1], message[2]) == (f"{frequency:.2f}", f"{ratio:.3f}")
    assert "0.141 of critical" in (mb.__doc__ or "")


WHOLE = """
name = "whole"
gravity = [0.0, 0.0, -9.81]
independent = ["leg.rz"]

[bodies.table]
[bodies.leg]
mass = 2
centre = [0.5, 0, 0]
moments = [[1.0, 0.1, 0.0], [0.1, 2.0, 0.0], [0.0, 0.0, 3.0]]
[bodies.top]
mass = 1.0
moments = 0.5

[joints.lift]
kind = "prismatic"
parent = "ground"
child = "table"
[joints.leg]
kind = "revolute"
parent = "table"
child = "leg"
at_parent = { point = [1.0, 0.0, 0.0], axis = [0.0, 2.0, 0.0] }
at_child = { turn = [0.3, 0.2, 0.1] }
[joints.top]
kind = "elastic"
parent = "leg"
child = "top"
at_parent = { point = [1.0, 0.0, 0.0] }

[motions]
lift.z = { polynomial = [0.1, 0.0, 0.25], harmonics = [{ amplitude = 0.2, frequency = 3.0, phase = 0.5, mean = 0.1 }] }

[coordinate_springs]
leg.rz = { stiffness = 100.0, damping = 2.0, neutral = 0.1 }

[[springs]]
body_a = "ground"
body_b = "leg"
point_a = [0.0, 0.0, 2.0]
point_b = [0.3, 0.0, 0.0]
stiffness = 20.0
damping = 0.5
free_length = 1.0

[[bushings]]
body_a = "leg"
body_b = "top"
at_a = { point = [1.0, 0.0, 0.0] }
stiffness = [1e4, 2e4, 3e4, 100.0, 200.0, 300.0]
damping = [1.0, 2.0, 3.0, 0.1, 0.2, 0.3]
preload = [1.0, 0.0, 0.0, 0.0, 0.0, 0.5]

[[beams]]
body_a = "leg"
body_b = "top"
length = 0.5
at_a = { point = [0.5, 0.0, 0.0] }
EA = 1e6
GJ = 1e3
EI_y = 2e3
EI_z = 3e3
GA_y = 1e6

[guess]
leg.rz = 0.2
"""


def write(folder: Path, text: str) -> Path:
    path = folder / "m.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_every_table_is_read_into_its_field(tmp_path: Path) -> None:
    read = mechanisms.read(write(tmp_path, WHOLE))
    m = read.mechanism
    tensor = np.array([[1.0, 0.1, 0], [0.1, 2, 0], [0, 0, 3]])
    np.testing.assert_allclose(m.bodies[1].inertia, mb.inertia(2.0, tensor, (0.5, 0, 0)))
    np.testing.assert_allclose(m.bodies[2].inertia, mb.inertia(1.0, 0.5))
    assert (m.joints[1].name, m.joints[1].kind, m.joints[1].parent, m.joints[1].child) == (
        "leg",
        "revolute",
        "table",
        "leg",
    )
    np.testing.assert_allclose(m.joints[1].at_parent[:3, 2:], [[0, 1], [1, 0], [0, 0]])
    angle = np.linalg.norm([0.3, 0.2, 0.1])
    assert np.trace(m.joints[1].at_child[:3, :3]) == pytest.approx(1 + 2 * np.cos(angle))
    (motion,) = m.motions
    assert motion.law is not None
    assert motion.law(2.0) == pytest.approx(0.1 + 0.25 * 4 + 0.1 + 0.2 * np.sin(6.5))
    assert m.coordinate_springs == (mb.CoordinateSpring("leg.rz", 100.0, 2.0, 0.1),)
    (spring,) = m.springs
    assert (spring.stiffness, spring.damping, spring.free_length, spring.point_a[2], spring.point_b[0]) == (
        20,
        0.5,
        1,
        2,
        0.3,
    )
    bushing, beam = m.beams
    assert isinstance(bushing, Beam)
    np.testing.assert_allclose(np.diagonal(bushing.beams.stiffness[0]), [1e4, 2e4, 3e4, 100, 200, 300])
    np.testing.assert_allclose(np.diagonal(bushing.damping), [1, 2, 3, 0.1, 0.2, 0.3])
    np.testing.assert_allclose(bushing.beams.preload[0], [1, 0, 0, 0, 0, 0.5])
    assert beam.beams.undeformed[0, 0, 3] == 0.5
    assert beam.beams.stiffness[0, 0, 0] == pytest.approx(1e6 / 0.5)
    assert beam.at_a[0, 3] == 0.5
    assert (m.gravity, read.guess, read.text.independent) == ((0, 0, -9.81), {"leg.rz": 0.2}, ("leg.rz",))


def test_mass_of_a_beam_is_inside_it(tmp_path: Path) -> None:
    """A cantilever of two elements on a free hub that is held: the first bending frequency of the clamped beam."""
    frame = (
        '[bodies.hub]\n[bodies.middle]\n[bodies.tip]\n[joints.hub]\nkind = "fixed"\nparent = "ground"\nchild = "hub"\n'
    )
    joint = '[joints.j{0}]\nkind = "elastic"\nparent = "{0}"\nchild = "{1}"\nat_parent = {{ point = [0.5, 0, 0] }}\n'
    beam = '[[beams]]\nbody_a = "{0}"\nbody_b = "{1}"\nlength = 0.5\nEA = 1e4\nGJ = 1\nEI_y = 1\nEI_z = 4\nmass = 1\n'
    pairs = [("hub", "middle"), ("middle", "tip")]
    text = (
        'name = "beam"\n' + frame + "".join(joint.format(*p) for p in pairs) + "".join(beam.format(*p) for p in pairs)
    )
    solution = mechanisms.read(write(tmp_path, text)).solve(2)
    np.testing.assert_allclose(solution.frequencies, np.array([1.0, 2.0]) * 1.8751040687**2, rtol=1e-3)


BAD = [
    ("[bodies.leg]\nmass = 2", "[bodies.leg]\nmas = 2", ["bodies.leg.mas: unknown key: did you mean mass?"]),
    ("mass = 2", "mass = -2", ["bodies.leg.mass: -2", ">= 0"]),
    ("mass = 2", "mass = nan", ["bodies.leg.mass: nan", "not a finite number"]),
    ("moments = 0.5", "moments = [0.5, 1.0]", ["bodies.top.moments: [0.5, 1.0]", "give 3 numbers or 3 rows of 3"]),
    (
        "moments = 0.5",
        "moments = [5.0, 11.0, []]",
        ["bodies.top.moments: [5.0, 11.0, []]", "give 3 numbers or 3 rows of 3"],
    ),
    ("moments = 0.5", "moments = [0.5, 1.0, []]", ["bodies.top.moments: [0.5, 1.0, []]: give 3 numbers"]),
    ("moments = 0.5", "moments = [[], [], []]", ["bodies.top.moments: [[], [], []]: give 3 numbers"]),
    ("moments = 0.5", "moments = [0.1, 0.2, 5.0]", ["bodies.top.moments: 5 is more than 0.1 and 0.2 together"]),
    ("moments = 0.5", 'moments = "big"', ["bodies.top.moments: 'big'"]),
    ("moments = 0.5", "moments = -5.0", ["body 'top'", "must be positive"]),
    ("centre = [0.5, 0, 0]", "centre = [0.5, 0]", ["bodies.leg.centre: [0.5, 0]"]),
    ('kind = "prismatic"', 'kind = "hinge"', ["joints.lift.kind: 'hinge'"]),
    ('kind = "prismatic"\n', "", ["joints.lift.kind: missing: add it"]),
    ('parent = "ground"', 'parent = "floor"', ["joint 'lift': body 'floor' is unknown"]),
    ("axis = [0.0, 2.0, 0.0]", "axis = [0.0, 0.0, 0.0]", ["joints.leg.at_parent.axis", "not all zero"]),
    ("turn = [0.3, 0.2, 0.1]", 'turn = [0.3, 0.2, 0.1], axis = "x"', ["joints.leg.at_child: both axis and turn"]),
    (
        "axis = [0.0, 2.0, 0.0]",
        "axes = [0.0, 2.0, 0.0]",
        ["joints.leg.at_parent.axes: unknown key: did you mean axis?"],
    ),
    ("lift.z =", "lift.x =", ["motions: 'lift.x': no joint has this coordinate: did you mean lift.z?"]),
    ("polynomial = [0.1, 0.0, 0.25]", "rate = 1.0", ["motions.lift.z: both numbers"]),
    ("amplitude = 0.2, ", "", ["motions.lift.z.harmonics[0].amplitude: missing"]),
    ("leg.rz = { stiffness", "leg.ry = { stiffness", ["coordinate_springs: 'leg.ry'", "did you mean leg.rz?"]),
    ("neutral = 0.1 }", "length = 0.1 }", ["coordinate_springs.leg.rz.length: unknown key"]),
    ("free_length = 1.0", "free_length = -1.0", ["springs[0].free_length: -1.0"]),
    ('body_a = "ground"', 'body_a = "sky"', ["spring: body 'sky' is unknown"]),
    ("stiffness = [1e4, 2e4,", "stiffness = [1e4,", ["bushings[0].stiffness", "give 6 numbers or 6 rows of 6"]),
    ("preload = [1.0,", "preload = [", ["bushings[0].preload: 5 numbers: give 6"]),
    ("EI_y = 2e3", "EI_y = 0", ["beams[0].EI_y: 0", "> 0"]),
    ("length = 0.5\n", "length = 1e30\n", ["beams[0].length: 1e+30 m", "check the unit"]),
    ("EI_y = 2e3\n", "", ["beams[0].EI_y: missing"]),
    ("[guess]\nleg.rz", "[guess]\nleg.angle", ["guess: 'leg.angle': no joint has this coordinate"]),
    ('independent = ["leg.rz"]', 'independent = ["leg"]', ["independent: 'leg': no joint has this coordinate"]),
    ('name = "whole"', "", ["name: missing"]),
    ("[guess]", "[gues]", ["gues: unknown key: did you mean guess?"]),
]


@pytest.mark.parametrize(
    ("old", "new", "phrase"), BAD, ids=[" ".join(new.split()) or f"no {old}" for old, new, _ in BAD]
)
def test_invalid_input_is_reported_in_one_line(tmp_path: Path, old: str, new: str, phrase: list[str]) -> None:
    assert WHOLE.count(old) >= 1
    path = write(tmp_path, WHOLE.replace(old, new, 1))
    with pytest.raises(CaseError) as caught:
        mechanisms.read(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert "\n" not in message
    for part in phrase:
        assert part in message, message


def test_errors_of_solving_name_the_file(tmp_path: Path) -> None:
    path = write(tmp_path, WHOLE.replace('independent = ["leg.rz"]', 'independent = ["leg.rz", "lift.z"]'))
    with pytest.raises(CaseError, match=r"m\.toml: independent: leg\.rz, lift\.z do not determine the others"):
        mechanisms.read(path).solve()
    with pytest.raises(CaseError, match=r"time: nan: give a finite instant"):
        mechanisms.read(path).solve(time=float("nan"))


def run(capsys, *arguments: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as exit_info:
        cli.main(arguments)
    out, err = capsys.readouterr()
    return int(exit_info.value.code or 0), out, err


def test_the_command_prints_modes_state_and_constraints(capsys) -> None:
    status, out, _ = run(capsys, "mechanism", LINKED, "--modes", "1")
    assert status == 0
    for word in (
        "41.75",
        "flap.rz",
        "control.z",
        "prescribed",
        "independent",
        "follows",
        "redundant constraints: none",
    ):
        assert word in out
    assert "213.8" not in out


def test_rounding_errors_of_zero_are_printed_as_zero(capsys) -> None:
    _, out, _ = run(capsys, "mechanism", "pitch-link")
    state = out[out.index("steady state") : out.index("redundant")]
    assert "e-" not in state
    assert re.search(r"flap\.rz\s+0\s+rad\s+independent", state)


def test_json_has_the_numbers_of_the_library(capsys) -> None:
    status, out, _ = run(capsys, "mechanism", HINGED, "--json")
    solution, data = library.mechanism(HINGED).solve(), json.loads(out)
    assert status == 0
    np.testing.assert_allclose([m["frequency_rad_s"] for m in data["modes"]], solution.frequencies, rtol=1e-13)
    np.testing.assert_allclose([m["damping_ratio"] for m in data["modes"]], solution.damping, atol=1e-13)
    assert data["steady"] == solution.steady
    assert data["independent"] == ["flap.rz", "lag.rz"]
    assert data["redundant"] == []


def test_redundant_constraints_are_named(capsys, tmp_path: Path) -> None:
    """A plane four-bar in space is three times overdetermined; the loop's plane is x y."""
    link = "[bodies.{0}]\nmass = 1.0\ncentre = [{1}, 0, 0]\nmoments = 0.1\n"
    pin = '[joints.{0}]\nkind = "revolute"\nparent = "{1}"\nchild = "{2}"\nat_parent = {{ point = [{3}, 0, 0] }}\n'
    text = 'name = "four-bar"\ngravity = [0, -9.81, 0]\n'
    text += "".join(link.format(*b) for b in (("crank", 0.5), ("coupler", 1.5), ("rocker", 1.0)))
    text += pin.format("A", "ground", "crank", 0) + pin.format("B", "crank", "coupler", 1)
    text += pin.format("C", "coupler", "rocker", 3) + "at_child = { point = [2, 0, 0] }\n"
    text += pin.format("D", "ground", "rocker", 3)
    text += "[guess]\nA.rz = -2.0\nB.rz = 2.0\nC.rz = -1.4\nD.rz = -1.4\n"
    status, out, err = run(capsys, "mechanism", str(write(tmp_path, text)))
    assert status == 0, err
    line = out.split("redundant constraints: ")[1].splitlines()[0]
    assert line.startswith("3: ")
    assert {"rotation x", "rotation y", "z"} == {part.split(": ")[1] for part in line[3:].split(", ")}


@pytest.mark.parametrize(
    ("arguments", "phrase"),
    [
        (("mechanism", "pitch-lnk"), "mechanism: 'pitch-lnk' is not known: did you mean pitch-link?"),
        (("modes", "pitch-link"), "it is a mechanism, not a blade: see `southwell mechanism pitch-link`"),
        (("modes", "FILE"), "it is a mechanism, not a blade: see `southwell mechanism"),
        (("verify", "pitch-lnk"), "case: 'pitch-lnk' is not known: did you mean pitch-link?"),
        (("verify", "FILE"), "speeds: missing"),
    ],
)
def test_a_mechanism_in_place_of_a_blade_is_refused_and_the_reverse(
    capsys, tmp_path: Path, arguments, phrase: str
) -> None:
    path = write(tmp_path, WHOLE)
    status, _, err = run(capsys, *(str(path) if a == "FILE" else a for a in arguments))
    assert (status, err.count("\n")) == (2, 1)
    assert phrase in err


@pytest.mark.slow
def test_cases_lists_mechanisms_and_codes_lists_what_solves_them(capsys) -> None:
    assert all(name in run(capsys, "cases")[1] for name in library.mechanisms())
    assert "exudyn-loops" in run(capsys, "codes")[1]


def test_a_mechanism_is_linearised_at_the_requested_time(capsys, tmp_path: Path) -> None:
    """A pendulum whose support shakes: ω² = (g + a)/l at that time, a = −A Ω² sin(Ω t)."""
    text = """
name = "shaken"
gravity = [0.0, -9.81, 0.0]
[bodies.support]
[bodies.bob]
mass = 2.0
centre = [0.0, -0.5, 0.0]
[joints.lift]
kind = "prismatic"
parent = "ground"
child = "support"
at_parent = { axis = "y" }
at_child = { axis = "y" }
[joints.pin]
kind = "revolute"
parent = "support"
child = "bob"
[motions]
lift.z = { harmonics = [{ amplitude = 0.1, frequency = 6.0 }] }
"""
    for time in (0.0, 0.2, 0.7):
        status, out, _ = run(capsys, "mechanism", str(write(tmp_path, text)), "--time", str(time), "--json")
        (mode,) = json.loads(out)["modes"]
        assert status == 0
        expected = np.sqrt((9.81 - 0.1 * 36.0 * np.sin(6.0 * time)) / 0.5)
        assert mode["frequency_rad_s"] == pytest.approx(expected, rel=1e-12)
