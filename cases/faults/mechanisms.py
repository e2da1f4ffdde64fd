"""Faults in the solver of mechanisms, in adapters for them and in their pairing."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...core import multibody
from ...core.mechanism.description import Mechanism, inertia
from ...core.rotor import multiblade
from ...core.spectrum import modal
from ...core.steady import periodic
from ...core.tree.linearization import Linearization
from ...references.protocol.interface import MechanismModes
from ..judge import same
from ..judge.pairing import Pair
from ..judge.spectrum import Spectrum
from ..solve import mechanism
from .alterations import answered, returned, sent
from .seeding import Fault, Seam, Trial

HINGED = Trial("hinged-blade", (30.0,), ())
"""Only the closed form: its parameters are given separately from the mechanism."""

LINKED = Trial("pitch-link", (30.0,), ())

ASKED = Trial("pitch-link", (30.0,), ("pinocchio-loops",))
THICK = inertia(30.0, (20.0, 45.0, 30.0), (2.0, -0.02, 0.0))


def _thick(m: Mechanism) -> Mechanism:
    return replace(m, bodies=tuple(replace(b, inertia=THICK) if b.name == "blade" else b for b in m.bodies))


WHIRLING = Trial("coleman-feingold", (1.6,), ("pinocchio-loops",))

SPINNING = replace(ASKED, change=_thick)
"""A blade so thick that gyroscopic forces couple flap and pitch."""

DAMPED = Trial("hinged-blade", (30.0,), ("pinocchio-loops",))


def _about(alter: Callable[[Linearization], Linearization]) -> tuple[Seam, ...]:
    """Core's linearised equations of motion are altered at every azimuth."""
    return (modal, "about", returned(alter)), (periodic, "about", returned(alter))


def _given(alter: Callable[[Mechanism], Mechanism]) -> Callable[[Any], Any]:
    """The code solves a different mechanism."""
    return sent(lambda mechanisms: [alter(mechanism) for mechanism in mechanisms])


def _by_number(original: Any) -> Any:
    def faulty(reference: Spectrum, spectrum: Spectrum, indices: Sequence[int], min_mac: float = 0.8) -> list[Pair]:
        return [Pair(k if k < len(spectrum.values) else None, 1.0) for k in indices]

    return faulty


def _open(mechanism: Mechanism) -> Mechanism:
    return replace(mechanism, joints=tuple(j for j in mechanism.joints if not j.cut))


def _without_motion(mechanism: Mechanism) -> Mechanism:
    return replace(mechanism, motions=tuple(replace(m, rate=0.0) for m in mechanism.motions))


def _backwards(mechanism: Mechanism) -> Mechanism:
    return replace(mechanism, equal_blades=tuple(group[::-1] for group in mechanism.equal_blades))


def _not_gyroscopic(original: Any) -> Any:
    """Multi-blade coordinates without the term 2 Ω M R."""

    def faulty(M: Any, C: Any, K: Any, psi: Any, omega: float, blades: Any) -> Any:
        mass, damping, stiffness = original(M, C, K, psi, omega, blades)
        return mass, damping - 2.0 * omega * mass @ blades.rate(), stiffness

    return faulty


def _frozen(original: Any) -> Any:
    return lambda mechanism: None


def _unchecked(original: Any) -> Any:
    return lambda linear: None


def _exchanged(modes: MechanismModes) -> MechanismModes:
    return replace(modes, shapes=modes.shapes[::-1])


def _mixed(modes: MechanismModes) -> MechanismModes:
    sizes = np.linalg.norm(modes.shapes, axis=1, keepdims=True)
    a, b = modes.shapes[:2] / sizes[:2]
    return replace(modes, shapes=np.stack([a + b, a - b]), values=modes.values[:2])


FAULTS = (
    Fault("mechanism: no damper", "solver", "the damper on a joint is dropped", "damping ratio 0.14",
          _about(lambda linear: replace(linear, C=0.5 * (linear.C - linear.C.T))), HINGED),
    Fault("mechanism: gyroscopic sign", "solver", "gyroscopic terms have the other sign", "no frequency; no partner",
          _about(lambda linear: replace(linear, C=linear.C.T)), SPINNING),
    Fault("loop: mass", "solver", "the mass on the loop is 0.2 % too small", "+0.1 %",
          _about(lambda linear: replace(linear, M=0.998 * linear.M)), LINKED),
    Fault("loop: coupling", "solver", "the stiffness by which a loop couples two coordinates is dropped", "percents",
          _about(lambda linear: replace(linear, K=np.diag(np.diag(linear.K)))), LINKED),
    Fault("mechanism: damping lost", "adapter", "only the moduli of the eigenvalues are returned", "damping ratio 0.14",
          ((mechanism, "answers", answered(lambda m: replace(m, values=1j * np.abs(m.values)))),), DAMPED),
    Fault("mechanism: sixth digit", "adapter", "six digits of a code with the same equations", "1e-6",
          ((mechanism, "answers", answered(lambda m: replace(m, values=m.values * (1 + 1e-6)))),), ASKED),
    Fault("mechanism: one mode", "adapter", "the code returns only its first mode", "no answer",
          ((mechanism, "answers", answered(lambda m: replace(m, values=m.values[:1], shapes=m.shapes[:1]))),), ASKED),
    Fault("mechanism: shapes exchanged", "adapter", "shapes belong to other eigenvalues", "factors",
          ((mechanism, "answers", answered(_exchanged)),), DAMPED),
    Fault("loop left open", "adapter", "the joint that closes the loop is dropped", "factors; no partner",
          ((mechanism, "answers", _given(_open)),), ASKED),
    Fault("mechanism: rotor at rest", "adapter", "the rotor's rate does not reach the code", "no frequency",
          ((mechanism, "answers", _given(_without_motion)),), ASKED),
    Fault("rotor: frozen azimuth", "solver", "a rotor on a support is linearised at one azimuth", "31 %",
          ((multibody, "turning", _frozen), (periodic, "check_constant", _unchecked)), WHIRLING),
    Fault("rotor: transformation", "solver", "multi-blade coordinates lack their gyroscopic term", "factors",
          ((multiblade, "second_order", _not_gyroscopic),), WHIRLING),
    Fault("rotor: blades backwards", "adapter", "blades are numbered against the rotation", "no answer",
          ((mechanism, "answers", _given(_backwards)),), WHIRLING),
    Fault("mechanism: paired by number", "pairing", "modes are paired by their number", "a wrong shape counts",
          ((same, "pair", _by_number),), blinds="mechanism: mixed shapes"),
    Fault("mechanism: mixed shapes", "adapter", "every shape is a mixture of two", "MAC 0.5",
          ((mechanism, "answers", answered(_mixed)),), DAMPED),
)  # fmt: skip
