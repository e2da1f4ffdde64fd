"""Codes for mechanisms pass their conformance checks, core itself does, and every fault made here fails by name."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
import pytest

from southwell import multibody as mb
from southwell.cases.conformance.suite import CHECKS, EVERY, FOR_MECHANISMS, judge
from southwell.cases.conformance.worker import outcomes
from southwell.core.effects import ALL_EFFECTS, Effects
from southwell.references.protocol import registry
from southwell.references.protocol.interface import CodeError, MechanismAdapter, MechanismModes
from southwell.tests.support.codes import MECHANISM_CODES

from ...reports.cli.test_cli import southwell


@pytest.mark.parametrize("name", MECHANISM_CODES)
def test_adapters_of_the_package_conform(name: str) -> None:
    code = registry.code(name)
    if code.version() is None:
        pytest.skip(f"not installed: {code.hint}")
    assert [(str(o.check), o.reason) for o in (judge(code, c) for c in FOR_MECHANISMS) if o.verdict != "pass"] == []


@dataclass
class Core(MechanismAdapter):
    """Core as a code for mechanisms, with a fault if wanted: in what it is given, or in what it returns."""

    given: Callable[[mb.Mechanism], mb.Mechanism] = lambda mechanism: mechanism
    returned: Callable[[MechanismModes], MechanismModes] = lambda modes: modes
    refused: Callable[[mb.Mechanism], str | None] = lambda _: None
    name: str = "southwell"
    title: str = "Core"
    effects: Effects = ALL_EFFECTS
    hint: str = ""
    answers_all: bool = False

    def version(self) -> str | None:
        return "1"

    def unsupported_mechanism(self, mechanism: mb.Mechanism) -> str | None:
        return self.refused(mechanism)

    def mechanism_modes(self, mechanism: mb.Mechanism, guess: Mapping[str, float]) -> MechanismModes:
        try:
            solution = mb.solve(self.given(mechanism), guess)
        except mb.MechanismError as error:
            if self.answers_all:
                return MechanismModes(("a",), np.zeros(1), np.array([1j]), np.ones((1, 1), complex))
            raise CodeError(str(error)) from error
        return self.returned(
            MechanismModes(solution.coordinates, solution.linear.state.q, np.asarray(solution.values), solution.shapes)
        )


class Answering(Core):
    """Answers what it declines."""

    def solve_mechanism(self, mechanism: mb.Mechanism, guess: Mapping[str, float]) -> MechanismModes:
        return self.mechanism_modes(mechanism, guess)


def failures(code: Core) -> set[str]:
    return {str(o.check) for o in (judge(code, c) for c in FOR_MECHANISMS) if o.verdict == "fail"}


def test_the_solver_conforms() -> None:
    result = {str(c): judge(Core(), c) for c in FOR_MECHANISMS}
    assert {n: o.reason for n, o in result.items() if o.verdict != "pass"} == {
        "mechanism refusals": "the code accepts all these mechanisms"
    }


def springs(**changes: float) -> Callable[[mb.Mechanism], mb.Mechanism]:
    return lambda m: replace(m, coordinate_springs=tuple(replace(s, **changes) for s in m.coordinate_springs))


def last_joint_first(m: mb.Mechanism) -> mb.Mechanism:
    """Its frames exchanged, as if it were given from child to parent."""
    j = m.joints[-1]
    return replace(m, joints=(*m.joints[:-1], replace(j, at_parent=j.at_child, at_child=j.at_parent)))


FAULTS: dict[str, tuple[Core, str]] = {
    "no gravity": (Core(given=lambda m: replace(m, gravity=(0.0, 0.0, 0.0))), "pendulum"),
    "no dampers": (Core(given=springs(damping=0.0)), "damped slide"),
    "no preload": (Core(given=springs(neutral=0.0)), "damped slide"),
    "no rotation": (
        Core(given=lambda m: replace(m, motions=tuple(replace(x, rate=0.0) for x in m.motions))),
        "flap and lag hinge",
    ),
    "twice the spin": (
        Core(given=lambda m: replace(m, motions=tuple(replace(x, rate=2 * x.rate) for x in m.motions))),
        "gyroscope",
    ),
    "no springs between points": (Core(given=lambda m: replace(m, springs=())), "stretched spring"),
    "frames exchanged": (Core(given=last_joint_first), "branching tree"),
    "loops left open": (Core(given=lambda m: replace(m, joints=tuple(j for j in m.joints if not j.cut))), "parallelogram"),
    "coordinates without their joints": (
        Core(returned=lambda a: replace(a, coordinates=tuple(f"q{k}" for k in range(len(a.coordinates))))),
        "pendulum",
    ),
    "frequencies in Hz": (Core(returned=lambda a: replace(a, values=a.values / (2 * np.pi))), "pendulum"),
    "a mode lost": (Core(returned=lambda a: replace(a, values=a.values[:1], shapes=a.shapes[:1])), "gyroscope"),
    "damping dropped": (Core(returned=lambda a: replace(a, values=1j * np.abs(a.values))), "damped slide"),
    "steady state dropped": (Core(returned=lambda a: replace(a, steady=0 * a.steady)), "damped slide"),
    "whatever is asked": (Core(answers_all=True), "no steady state"),
    "refuses and answers": (
        Answering(refused=lambda m: "bushings" if m.beams else None, answers_all=True),
        "mechanism refusals",
    ),
    "refuses a pendulum": (Core(refused=lambda m: "hinges" if len(m.bodies) == 1 else None), "mechanism declarations"),
}  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS)
def test_every_mistake_fails_a_check(fault: str) -> None:
    code, check = FAULTS[fault]
    assert check in failures(code)


def test_a_mistake_in_each_stage_of_the_reduction_is_detected(monkeypatch: pytest.MonkeyPatch) -> None:
    """The adapter with its reduction's derivative left out, and with its links in another order than Pinocchio needs."""
    linkages = pytest.importorskip("southwell.references.linkages.pinocchio_tree")
    spanning = pytest.importorskip("southwell.references.linkages.spanning")
    code = registry.code("pinocchio-loops")
    if code.version() is None:
        pytest.skip(code.hint)
    with monkeypatch.context() as patch:
        patch.setattr(linkages.Tangent, "curvature", lambda self, _: np.zeros_like(self.K))
        assert failures(code) == {"constraints' curvature"}
    with monkeypatch.context() as patch:
        patch.setattr(
            spanning, "_depth_first", lambda links, bodies, loops: spanning.Spanning(tuple(links), bodies, loops)
        )
        assert "branching tree" in failures(code)
    assert failures(code) == set()


@pytest.mark.slow
def test_the_command_runs_the_checks_of_the_kind_of_code(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = southwell("conform pinocchio-loops", capsys)
    if registry.code("pinocchio-loops").version() is None:
        assert status == 1
    else:
        assert (status, "14 pass" in out) == (0, True)
    assert "rotating beam" not in out
    assert outcomes("southwell-equation", CHECKS[:1])[0].verdict == "pass"
    assert len({str(c) for c in EVERY}) == len(EVERY)
