"""Every adapter of ours passes the conformance suite, core itself does, and every fault that one can make fails it."""

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

from southwell.cases.conformance.blades import PROPERTIES
from southwell.cases.conformance.suite import CHECKS, Check, judge
from southwell.core import solve
from southwell.core.blade import Blade
from southwell.core.effects import ALL_EFFECTS, Effects
from southwell.core.modes import Modes
from southwell.core.space.spatial import rotation
from southwell.references.protocol import registry
from southwell.references.protocol.interface import CORE, DIGITS, BladeAdapter, CodeError, Independence
from southwell.tests.support.codes import BLADE_CODES

LONG = ("exudyn-tree", "pinocchio", "scikit-fem-reissner", "scikit-fem-solid")
"""Codes whose checks take 15 s and more; every push has them in the matrix."""


@pytest.mark.slow
@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.nightly) if n in LONG else n for n in BLADE_CODES])
def test_adapters_of_the_package_conform(name: str) -> None:
    """Passes, or declines with a reason; one that declined everything would be caught by the capabilities' table."""
    code = registry.code(name)
    if code.version() is None:
        pytest.skip(f"not installed: {code.hint}")
    outcomes = [judge(code, check) for check in CHECKS]
    assert [(str(o.check), o.reason) for o in outcomes if o.verdict not in ("pass", "not applicable")] == []
    assert all(o.reason for o in outcomes if o.verdict != "pass")
    passed = {str(o.check) for o in outcomes if o.verdict == "pass"}
    assert passed >= {"declarations", "cantilever at rest", "counts", "repeatable", "shapes", "units"}
    assert ("refusals" in passed) == any(code.unsupported(p.blade) for p in PROPERTIES)


@dataclass
class Core(BladeAdapter):
    """Core as a code, with a fault if wanted: in the blade it is given, in the modes it returns, in what it says."""

    given: Callable[[Blade], Blade] = lambda blade: blade
    returned: Callable[[Modes], Modes] = lambda modes: modes
    refused: Callable[[Blade], str | None] = lambda _: None
    solved: Callable[[Blade], str | None] = lambda _: None
    kept: Effects = ALL_EFFECTS
    name: str = "southwell"
    title: str = "Core"
    independence: Independence = Independence("Southwell", CORE, "Southwell")  # noqa: RUF009
    effects: Effects = ALL_EFFECTS
    levels: tuple[int, ...] = (8, 12, 18)
    order: int = 4
    hint: str = ""
    installed: bool = True
    digits: int = DIGITS

    def version(self) -> str | None:
        return "1.0" if self.installed else None

    def unsupported(self, blade: Blade) -> str | None:
        return self.refused(blade)

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        if reason := self.solved(blade):
            raise CodeError(reason)
        return self.returned(solve.modes(self.given(blade), omega, elements, count, effects=self.kept))


class Answering(Core):
    """Answers what it declines."""

    def solve(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        return self.modes(blade, omega, elements, count)


def failures(code: Any, *, among: str = "") -> dict[str, str]:
    """Check → what it said, of those that fail; ``among`` names the only ones to ask."""
    checks: tuple[Check, ...] = tuple(c for c in CHECKS if re.search(among, c.name))
    return {str(o.check): o.reason for o in (judge(code, c) for c in checks) if o.verdict == "fail"}


@pytest.mark.slow
def test_the_solver_conforms() -> None:
    outcomes = {str(check): judge(Core(), check) for check in CHECKS}
    assert {name for name, o in outcomes.items() if o.verdict != "pass"} == {"refusals"}
    assert outcomes["refusals"].reason == "the code accepts all these blades"


def shapes(change: Callable[[np.ndarray], np.ndarray]) -> Callable[[Modes], Modes]:
    return lambda modes: replace(modes, shapes=change(modes.shapes.copy()))


def drop(**plain: Any) -> Callable[[Blade], Blade]:
    return lambda blade: replace(blade, **plain)


def masses(change: Callable[[np.ndarray], np.ndarray]) -> Callable[[Blade], Blade]:
    return lambda blade: replace(blade, mass=change(blade.mass.copy()))


def diagonal(matrices: np.ndarray) -> np.ndarray:
    return np.where(np.eye(6, dtype=bool), matrices, 0.0)


def sections_of_the_root(blade: Blade) -> Blade:
    n = len(blade.stations)
    first = {name: np.repeat(getattr(blade, name)[:1], n, axis=0) for name in ("stiffness", "mass", "twist")}
    return replace(blade, **first)


def straightened(blade: Blade) -> Blade:
    return replace(blade, curve=np.outer(blade.stations, [1.0, 0.0, 0.0]))


def rounded(blade: Blade) -> Blade:
    """The right angle between two pieces as a quarter of a circle as long."""
    if not blade.kinks:
        return blade
    s, radius = np.linspace(0.0, blade.length, 13), blade.length / (np.pi / 2)
    curve = radius * np.stack([np.sin(s / radius), 1.0 - np.cos(s / radius), 0.0 * s], axis=1)
    same = {name: np.repeat(getattr(blade, name)[:1], 13, axis=0) for name in ("stiffness", "mass", "twist")}
    return replace(blade, stations=s, curve=curve, kinks=(), **same)


def rigid_in_shear(blade: Blade) -> Blade:
    stiffness = blade.stiffness.copy()
    stiffness[:, [1, 2], [1, 2]] = np.inf
    return replace(blade, stiffness=stiffness)


def shears_exchanged(blade: Blade) -> Blade:
    stiffness = blade.stiffness.copy()
    stiffness[:, [1, 2], [1, 2]] = stiffness[:, [2, 1], [2, 1]]
    return replace(blade, stiffness=stiffness)


def one_more(m: Modes) -> Modes:
    return Modes(m.omega, np.append(m.frequencies, 1e6), np.append(m.shapes, m.shapes[:1], axis=0), m.elements)


def printed(m: Modes, digits: int) -> Modes:
    """As a code prints them."""
    return replace(m, frequencies=np.array([float(f"{f:.{digits}g}") for f in m.frequencies]))


def first_column_of_tip_mass(blade: Blade) -> Blade:
    m = blade.tip_mass[0, 0]
    return replace(blade, tip_mass=np.diag([m, m, m, 0.0, 0.0, 0.0]))


def tip_mass_in_the_axes_of_the_blade(blade: Blade) -> Blade:
    R = np.kron(np.eye(2), rotation(0, blade.twist[-1]))
    return replace(blade, tip_mass=R.T @ blade.tip_mass @ R)


FAULTS: dict[str, tuple[Core, set[str]]] = {
    "hertz": (Core(returned=lambda m: replace(m, frequencies=m.frequencies / (2 * np.pi))), {"cantilever at rest"}),
    "descending": (
        Core(returned=lambda m: replace(m, frequencies=m.frequencies[::-1], shapes=m.shapes[::-1])),
        {"counts"},
    ),
    "one mode too many": (Core(returned=one_more), {"counts"}),
    "millimetres": (Core(given=lambda b: replace(b, hub_radius=b.hub_radius * 1000)), {"keeps hub radius"}),
    "y and z exchanged": (Core(returned=shapes(lambda s: s[:, :, [0, 2, 1, 3]])), {"rotating beam", "pitch's sense"}),
    "flap counted down": (Core(returned=shapes(lambda s: s * [1, 1, -1, 1])), {"pitch's sense", "twist's sense"}),
    "rotation in the first column": (Core(returned=shapes(lambda s: s[:, :, [3, 1, 2, 0]])), {"torsion"}),
    "tip first": (Core(returned=shapes(lambda s: s[:, ::-1])), {"shapes"}),
    "other stations": (Core(returned=shapes(lambda s: s[:, np.arange(21) ** 2 // 20])), {"shapes"}),
    "Coriolis the other way": (Core(returned=shapes(np.conj)), {"Coriolis's sense"}),
    "real parts of the shapes": (Core(returned=shapes(lambda s: np.real(s) + 0j)), {"Coriolis's sense"}),
    "pitch the other way": (Core(given=lambda b: replace(b, pitch=-b.pitch)), {"pitch's sense"}),
    "twist the other way": (Core(given=lambda b: replace(b, twist=-b.twist)), {"twist's sense"}),
    "pitch dropped": (Core(given=drop(pitch=0.0)), {"quarter pitch", "pitch's sense", "keeps pitch"}),
    "twist dropped": (Core(given=lambda b: replace(b, twist=0 * b.twist)), {"twist's sense", "keeps twist"}),
    "precone dropped": (Core(given=drop(precone=0.0)), {"precone's sense", "keeps precone"}),
    "precone the other way": (Core(given=lambda b: replace(b, precone=-b.precone)), {"precone's sense"}),
    "hub dropped": (Core(given=drop(hub_radius=0.0)), {"keeps hub radius"}),
    "tip mass dropped": (
        Core(given=drop(tip_mass=np.zeros((6, 6)))),
        {"tip mass at rest", "tip mass rotating", "keeps tip mass"},
    ),
    "tip mass in the blade's axes": (Core(given=tip_mass_in_the_axes_of_the_blade), {"tip mass's axes"}),
    "tip mass a point": (
        Core(given=first_column_of_tip_mass),
        {"keeps tip mass's offset", "keeps tip mass's moments of inertia"},
    ),
    "root clamped anyway": (Core(given=drop(root=np.full(6, np.inf))), {"hinged root", "keeps springs at the root"}),
    "sections of the root": (Core(given=sections_of_the_root), {"keeps taper", "keeps twist"}),
    "couplings dropped": (
        Core(given=lambda b: replace(b, stiffness=diagonal(b.stiffness))),
        {"coupled planes", "keeps bend–twist coupling", "keeps extension–bending coupling"},
    ),
    "mass on the axis": (Core(given=masses(diagonal)), {"keeps mass off the axis"}),
    "curve dropped": (Core(given=straightened), {"keeps sweep", "keeps prebend"}),
    "a corner rounded off": (Core(given=rounded), {"kink"}),
    "shear dropped": (Core(given=rigid_in_shear), {"shear", "keeps shear flexibility"}),
    "shear stiffnesses exchanged": (Core(given=shears_exchanged), {"shear"}),
    "rotary inertia dropped": (
        Core(given=masses(lambda m: m * np.diag([1, 1, 1, 0, 0, 0]))),
        {"keeps rotary inertia", "effects"},
    ),
    "no Coriolis, unsaid": (Core(kept=Effects(coriolis=False)), {"effects"}),
    "no prestretch, unsaid": (Core(kept=Effects(prestretch=False)), {"effects"}),
    "Coriolis, though said to lack it": (Core(effects=Effects(coriolis=False)), {"effects"}),
    "no geometric stiffness": (Core(kept=Effects(geometric=False)), {"rotating beam"}),
    "an order too high": (Core(order=8), {"order"}),
    "levels too close": (Core(levels=(8, 9, 10)), {"declarations"}),
    "a name with a blank": (Core(name="my code"), {"declarations"}),
    "not installed, and no hint": (Core(installed=False), {"declarations"}),
    "a constant in newtons": (
        Core(given=lambda b: replace(b, stiffness=b.stiffness + np.diag([0, 0, 0, 0, 1.0, 1.0]))),
        {"units"},
    ),
    "a constant that does a millionth": (
        Core(given=lambda b: replace(b, stiffness=b.stiffness + np.diag([0, 0, 0, 0, 1e-4, 1e-4]))),
        {"units"},
    ),
    "six digits, unsaid": (Core(returned=lambda m: printed(m, 6)), {"units"}),
    "five digits, six said": (Core(returned=lambda m: printed(m, 5), digits=6), {"units"}),
    "too few digits to judge": (Core(returned=lambda m: printed(m, 4), digits=4), {"declarations"}),
    "declines, and answers": (Answering(refused=lambda b: "coned" if b.precone else None), {"refusals"}),
    "declines without a word": (
        Core(refused=lambda b: " " if b.precone else None, solved=lambda b: "coned" if b.precone else None),
        {"refusals"},
    ),
    "declines what is least": (Core(refused=lambda _: "too little"), {"declarations"}),
}  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS)
def test_every_mistake_fails_a_check(fault: str) -> None:
    code, by = FAULTS[fault]
    names = "|".join(f"^{re.escape(name)}$" for name in by)
    result = failures(code, among=names)
    assert set(result) == by
    assert all(reason.strip() and "\n" not in reason for reason in result.values())


FINDINGS = {
    "hertz": ("cantilever at rest", "beam at 0 rad/s, in pairs, mode "),
    "pitch the other way": ("pitch's sense", "plank pitched by 0.3 rad at 0 rad/s, mode 1: "),
    "Coriolis the other way": ("Coriolis's sense", "stubby beam at 10 rad/s, mode "),
    "hub dropped": ("keeps hub radius", "hub radius: at 3 rad/s, mode "),
    "no Coriolis, unsaid": ("effects", "effects.prestretch = True: stubby beam at 10 rad/s, mode "),
    "tip first": ("shapes", "beam at 3 rad/s, mode 1: "),
    "six digits, unsaid": ("units", "beam at 3 rad/s, in ft, lb and min, mode "),
    "one mode too many": ("counts", "beam at 3 rad/s: 3 modes requested, 4 returned"),
}
"""Fault → a check, and the parameter, speed and mode that its finding starts with."""


@pytest.mark.parametrize("fault", FINDINGS)
def test_a_finding_names_parameter_speed_and_mode(fault: str) -> None:
    check, start = FINDINGS[fault]
    reason = failures(FAULTS[fault][0], among=f"^{check}$")[check]
    assert reason.startswith(start)
    assert not start.endswith("mode ") or reason.removeprefix(start)[0].isdigit()


@pytest.mark.slow
@pytest.mark.parametrize("digits", [5, 7])
def test_declared_digits_are_the_tolerance(digits: int) -> None:
    """A code that prints few is asked for no more, and keeps every law."""
    assert failures(Core(returned=lambda m: printed(m, digits), digits=digits)) == {}


@pytest.mark.slow
def test_state_kept_from_another_call_is_detected() -> None:
    """A speed left over from the call before."""
    before = [0.0]

    def solved(blade: Blade) -> None:
        before[0] += 1e-9

    result = failures(Core(solved=solved, given=lambda b: replace(b, hub_radius=b.hub_radius + before[0])))
    assert set(result) == {"repeatable"}


def test_whatever_a_code_raises_is_a_failure_in_one_line() -> None:
    def break_down(blade: Blade) -> str | None:
        raise ZeroDivisionError("division\nby zero")

    result = failures(Core(solved=break_down), among="rotating beam")
    assert result == {"rotating beam": "ZeroDivisionError: division by zero"}


def test_a_missing_code_is_not_run() -> None:
    outcomes = [judge(Core(installed=False, hint="pip install it"), check) for check in CHECKS]
    assert outcomes[0].verdict == "pass"
    assert {(o.verdict, o.reason) for o in outcomes[1:]} == {("not run", "not installed: pip install it")}


def test_weight_and_centrifugal_force_of_a_tip_mass_are_separate_checks() -> None:
    """pyBModes 1.19.1 puts a tip mass into its mass matrix alone: right at rest, 2.48 instead of Bir's 4.543 at speed 4."""
    pytest.importorskip("pybmodes")
    from southwell.references.pybmodes import beam as pybmodes_beam

    class Credulous(pybmodes_beam.PyBModes):
        def unsupported(self, blade: Blade) -> str | None:
            return None

    written, mass = pybmodes_beam.write, []

    def with_tip_mass(folder, blade, omega, s, count):
        path = written(folder, blade, omega, s, count)
        text = path.read_text().replace(
            "---- Tip mass ----\n0.0", f"---- Tip mass ----\n{float(blade.tip_mass[0, 0])!r}"
        )
        mass.append(blade.tip_mass[0, 0])
        path.write_text(text)
        return path

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pybmodes_beam, "write", with_tip_mass)
        result = failures(Credulous(), among="^tip mass (at rest|rotating)")
    assert set(result) == {"tip mass rotating"}
    assert "2.478" in result["tip mass rotating"]
    assert set(mass) == {6.0}
