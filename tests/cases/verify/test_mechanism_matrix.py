"""Mechanisms in the matrix: every code and closed form at every speed, pairing by shape, damping judged, faults told."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell import multibody as mb
from southwell.cases.input import library, mechanisms
from southwell.cases.input.errors import CaseError
from southwell.cases.judge.cells import Head
from southwell.cases.judge.reference import Reference
from southwell.cases.judge.same import same_discretisation_cells
from southwell.cases.judge.spectrum import Spectrum
from southwell.cases.plan import mechanism
from southwell.cases.plan.blade_columns import columns as blade_columns
from southwell.core.effects import ALL_EFFECTS
from southwell.references.protocol import boundary, registry, wire, worker
from southwell.references.protocol.description import Description, describe
from southwell.references.protocol.interface import MechanismAdapter, MechanismModes
from southwell.references.protocol.process import Failure, Limits
from southwell.references.theories import blade_formulae
from southwell.reports.cli import app as cli

HEAD = Head("case", "code", "1", "same discretisation", 1e-8)


def reference() -> Reference:
    core = mechanism.subject(library.mechanism("hinged-blade")).references(())()[ALL_EFFECTS][2]
    assert isinstance(core, Reference)
    return core


def reported(change) -> list:
    """The cells of an answer that equals core's but for ``change``: frequency and damping of each of two modes."""
    core = reference()
    answer = change(replace(core.core.spectrum, weight=None, labels=()))
    return same_discretisation_cells(HEAD, 30.0, core, answer, core.core.spectrum)[0]


def verdicts(cells: list, quantity: str = "frequency") -> list[str]:
    return [c.verdict for c in cells if c.quantity == quantity]


def test_the_solver_itself_passes() -> None:
    cells = reported(lambda a: a)
    assert [(c.mode, c.quantity, c.verdict) for c in cells] == [
        (mode, quantity, "pass") for mode in (1, 2) for quantity in ("frequency", "damping")
    ]
    assert [c.name for c in cells[:2]] == ["lag 1", "lag 1, damping"]


def test_modes_are_paired_by_shape_not_by_number() -> None:
    turned = reported(lambda a: replace(a, values=a.values[::-1], shapes=1j * a.shapes[::-1]))
    assert {c.verdict for c in turned} == {"pass"}


def test_coordinates_may_come_in_another_order_and_some_be_missing() -> None:
    def fewer(a: Spectrum) -> Spectrum:
        order = [2, 1]  # lag and flap, without the prescribed shaft
        return replace(a, names=tuple(a.names[k] for k in order), shapes=a.shapes[:, :, order])

    assert {c.verdict for c in reported(fewer)} == {"pass"}


def test_a_wrong_frequency_fails() -> None:
    faulty = reported(lambda a: replace(a, values=a.values * np.array([1.0, 1 + 1e-6])))
    assert verdicts(faulty) == ["pass", "fail"]
    assert verdicts(faulty, "damping") == ["pass", "pass"]
    assert "exceeds" in faulty[2].reason


def test_a_wrong_damping_ratio_fails() -> None:
    faulty = reported(lambda a: replace(a, values=1j * np.abs(a.values)))
    assert verdicts(faulty) == ["pass", "pass"]
    assert verdicts(faulty, "damping") == ["fail", "pass"]
    lag = faulty[1]
    assert (lag.value, lag.reference) == (0.0, pytest.approx(0.1397, abs=1e-4))
    assert lag.difference == pytest.approx(-lag.reference)
    assert "exceeds" in lag.reason


def test_a_wrong_shape_has_no_partner() -> None:
    faulty = reported(lambda a: replace(a, shapes=np.stack([a.shapes[0] + a.shapes[1], a.shapes[0] - a.shapes[1]])))
    assert verdicts(faulty) == verdicts(faulty, "damping") == ["fail", "fail"]
    assert "no partner: its most similar mode" in faulty[0].reason
    assert "has MAC 0.5" in faulty[0].reason


def test_coordinates_that_do_not_tell_the_modes_apart_are_a_failure() -> None:
    """Over one coordinate every mode has MAC 1 with every other, and pairing would be by number."""

    def flap_only(a: Spectrum) -> Spectrum:
        return replace(a, names=("flap.rz",), shapes=np.ones((len(a.values), 1, 1), complex))

    (cell,) = reported(flap_only)
    assert cell.verdict == "fail"
    assert "coordinates flap.rz: these do not distinguish the 2 modes" in cell.reason


def test_spurious_modes_are_a_failure() -> None:
    def more(a: Spectrum) -> Spectrum:
        return replace(
            a, values=np.append(a.values, 0.9 * a.values[1:]), shapes=np.append(a.shapes, a.shapes[:1], axis=0)
        )

    (cell,) = reported(more)
    assert (cell.verdict, "3 modes, and Southwell's own solver has 2" in cell.reason) == ("fail", True)


@pytest.mark.parametrize(
    ("kind", "verdict"), [("crashed", "fail"), ("timed out", "inconclusive"), ("not installed", "not run")]
)
def test_a_missing_answer_is_a_cell_with_a_reason(kind, verdict: str) -> None:
    (cell,) = reported(lambda _: Failure(kind, "because"))
    assert (cell.verdict, cell.reason, cell.mode) == (verdict, "because", 0)


def test_codes_for_blades_have_no_column_unless_there_is_no_other() -> None:
    subject = mechanism.subject(library.mechanism("hinged-blade"))
    descriptions = describe(("southwell-equation", "exudyn-loops"))
    assert [c.name for c in subject.columns(descriptions, Limits(1.0), ())] == ["exudyn-loops", "closed form"]
    alone = subject.columns(descriptions[:1], Limits(1.0), ())
    (cell,) = alone[0]([10.0], [reference()])[0]
    assert (cell.verdict, cell.reason) == ("not applicable", "the code takes blades, not mechanisms")


def test_codes_for_mechanisms_have_no_column_of_a_blade_unless_there_is_no_other() -> None:
    case = library.load("wright-flapwise")
    descriptions = describe(("southwell-equation", "exudyn-loops"))
    assert "exudyn-loops" not in [c.name for c in blade_columns(case, case.variants[0], descriptions, Limits(1.0))]
    alone = blade_columns(case, case.variants[0], descriptions[1:], Limits(1.0))
    (cell,) = next(c for c in alone if c.name == "exudyn-loops").work([(1.0, None)])[0]
    assert (cell.verdict, cell.reason) == ("not applicable", "the code takes mechanisms, not blades")


def test_answers_are_transferred_from_a_worker_bit_for_bit() -> None:
    m = library.mechanism("pitch-link").mechanism
    returned = wire.decode_mechanism(json.loads(json.dumps(wire.encode_mechanism(m))))
    for actual, expected in zip(m.bodies, returned.bodies, strict=True):
        np.testing.assert_array_equal(actual.inertia, expected.inertia)
    for actual, expected in zip(m.joints, returned.joints, strict=True):
        np.testing.assert_array_equal(actual.at_parent, expected.at_parent)
        assert (actual.name, actual.kind, actual.cut) == (expected.name, expected.kind, expected.cut)
    described = library.mechanism("pitch-link")
    solved = mb.solve(described.mechanism, described.guess)
    modes = MechanismModes(solved.coordinates, solved.linear.state.q, solved.values, solved.shapes)
    second = boundary.mechanism_modes(json.loads(json.dumps(wire.encode(modes))))
    np.testing.assert_array_equal(second.shapes, modes.shapes)
    np.testing.assert_array_equal(second.values, modes.values)


class Wild(MechanismAdapter):
    """A code that raises what it likes."""

    name = title = "wild"
    hint = "pip install wild"

    def version(self) -> str:
        return "1"

    def unsupported_mechanism(self, mechanism: mb.Mechanism) -> None:
        return None

    def mechanism_modes(self, mechanism: mb.Mechanism, guess) -> MechanismModes:
        raise RuntimeError("out of\n  cheese")


CODE = Wild()


class Unadapted:
    """Has the methods of an adapter, without its base class."""

    solve_mechanism = None


UNADAPTED = Unadapted()


def test_a_code_for_mechanisms_without_the_base_class_is_refused() -> None:
    with pytest.raises(registry.UnknownCodeError, match="is Unadapted, not an adapter"):
        registry.code("southwell.tests.cases.verify.test_mechanism_matrix:UNADAPTED")


def test_an_exception_of_a_code_affects_its_own_cells_only() -> None:
    m = library.mechanism("pitch-link").mechanism
    (answer,) = worker.mechanism_answers(
        "southwell.tests.cases.verify.test_mechanism_matrix:CODE", [m], {}, Limits(60.0)
    )
    assert answer == Failure("nonsense", "RuntimeError: out of cheese")


def write(folder: Path, name: str, *changes: tuple[str, str]) -> Path:
    text = Path(library.__file__).parents[1].joinpath("data", "mechanisms", f"{name}.toml").read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = folder / f"{name}.toml"
    path.write_text(text, encoding="utf-8")
    return path


BAD = [
    ("rad_s = [10.0, 20.0, 30.0, 40.0]", "rad_s = [10.0, 5.0]", "speeds.rad_s: .*not ascending"),
    ("rad_s = [10.0, 20.0, 30.0, 40.0]", "gamma = [1.0]", "speeds.gamma"),
    ("[compare]\nmodes = 2\ngroups = 2", "", "compare: missing"),
    ("groups = 2", "groups = 0", "compare.groups: give groups = 0 and compare.lacking, the reason"),
    ("[speeds]\nrad_s = [10.0, 20.0, 30.0, 40.0]", "", "speeds: missing"),
    ('rotor = "shaft.rz"', 'rotor = "lag.rz"', "rotor: coordinate 'lag.rz': no motion at a rate"),
    ('formula = "flap-lag"', 'formula = "flap-lap"', "closed_form.formula: 'flap-lap'.*did you mean flap-lag"),
]


@pytest.mark.parametrize(("old", "new", "match"), BAD, ids=[match for _, _, match in BAD])
def test_invalid_requests_are_reported(tmp_path: Path, old: str, new: str, match: str) -> None:
    path = write(tmp_path, "hinged-blade", (old, new))
    with pytest.raises(CaseError, match=match):
        mechanism.subject(mechanisms.read(path))


def test_more_modes_than_a_mechanism_has_are_reported(tmp_path: Path) -> None:
    path = write(tmp_path, "hinged-blade", ("modes = 2", "modes = 3"))
    core = mechanism.subject(mechanisms.read(path)).references(())()
    failure = Failure("no reference", "compare.modes: 3: the mechanism has 2 modes: reduce it")
    assert core[ALL_EFFECTS] == [failure] * 4


def test_a_code_that_is_not_installed_is_not_run_where_core_has_no_reference_either() -> None:
    subject = mechanism.subject(library.mechanism("hinged-blade"))
    absent = Description("absent", "absent", mechanisms=True, blades=False, hint="pip install absent")
    column, *_ = subject.columns([absent], Limits(), ())
    (cell,) = column([10.0], [Failure("no reference", "no steady state")])[0]
    assert (cell.verdict, cell.reason) == ("not run", "not installed: pip install absent")


def verify(capsys, tmp_path: Path, path: Path) -> tuple[int, str]:
    options = ["--codes", "southwell-equation", "--faults", "none", "--workers", "1"]
    with pytest.raises(SystemExit) as exit_info:
        cli.main(["verify", str(path), *options, "--out", str(tmp_path / "out")])
    return int(exit_info.value.code or 0), capsys.readouterr().out


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "status", "message"),
    [
        ((), 0, "16 ✔ pass"),
        ((("lag_damper = 600.0", "lag_damper = 601.0"),), 1, "4 ✘ fail"),
        pytest.param((("first = 80.0 ", "first = 81.0 "),), 1, "8 ✘ fail", marks=pytest.mark.nightly),
        pytest.param((("offset = 0.3\n", ""),), 1, "✘ fail", marks=pytest.mark.nightly),
    ],
    ids=["right", "another damper", "another blade", "a parameter missing"],
)
def test_verify_judges_a_mechanism_by_its_file(capsys, tmp_path: Path, change, status: int, message: str) -> None:
    """The closed form's parameters are stated apart from the mechanism, so that one that is wrong is seen."""
    result, out = verify(capsys, tmp_path, write(tmp_path, "hinged-blade", *change))
    assert (result, message in out) == (status, True), out


def test_formulae_of_limiting_blades() -> None:
    """No offset: flap Ω; a lag spring alone: √(k/I); a stiff pitch link turns flap into pitch, δ3 = atan(x_h/y_h)."""
    _, M, _, K = blade_formulae.flap_lag(
        7.0, offset=0.0, first=1, flap_inertia=2, lag_inertia=2, own_inertia=0, lag_spring=8.0
    )
    np.testing.assert_allclose(np.diagonal(K) / np.diagonal(M), [49.0, 4.0])
    blade = {"offset": 0.3, "xx": 100.0, "yy": 0.2, "zz": 0.0, "xy": 0.0, "first_x": 50.0, "first_y": 0.0}
    horn = {"horn_x": -0.1, "horn_y": 0.2, "control_spring": 1e12, "control_damper": 0.0}
    solution = blade_formulae.solve("flap-pitch", 30.0, {**blade, **horn, "rod_mass": 0.0, "link_mass": 0.0})
    delta = np.array([1.0, 0.5])  # 0.2 θ = 0.1 β
    K = 900.0 * np.diag([0.3 * 50 + 100, 0.2])
    expected = np.sqrt(delta @ K @ delta / (delta @ np.diag([100.0, 0.2]) @ delta))
    assert solution.values[0].imag == pytest.approx(expected, rel=1e-6)
    np.testing.assert_allclose(solution.shapes[0, 1] / solution.shapes[0, 0], 0.5, rtol=1e-6)
