"""Conformance checks of a code for mechanisms: closed forms, symmetries, and consistent refusals."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core import multibody as mb
from ...references.protocol.interface import CodeError, MechanismAdapter, MechanismModes
from .asking import BrokenError, NotForItError, named, require

Array = NDArray[Any]
Ask = Callable[[MechanismAdapter], None]

TOLERANCE = 1e-7
"""Tolerance on eigenvalues, relative to the largest: no discretisation error, but a code may use finite differences."""

G, LENGTH, MASS = 9.81, 0.7, 3.0

DOWN = (0.0, -G, 0.0)
"""Gravity along −y, across the axes of hinges along z."""

POINT = mb.inertia(MASS, 0.0, (0.0, -LENGTH, 0.0))


def _ask(code: MechanismAdapter, mechanism: mb.Mechanism, guess: Mapping[str, float] | None = None) -> MechanismModes:
    if reason := code.unsupported_mechanism(mechanism):
        raise NotForItError(reason)
    return code.solve_mechanism(mechanism, guess or {})


def _are(modes: MechanismModes, expected: Any, label: str) -> None:
    """Check the eigenvalues, one of each conjugate pair, in any order."""
    exact = np.asarray(expected, np.complex128)
    message = f"{label}: {_list(modes.values)} 1/s, expected {_list(exact)}"
    require(len(modes.values) == len(exact), message)
    unmatched = [complex(v.real, abs(v.imag)) for v in modes.values]
    for value in exact:
        nearest = min(unmatched, key=lambda v: abs(v - value))
        require(abs(nearest - value) <= TOLERANCE * np.abs(exact).max(), message)
        unmatched.remove(nearest)


def _list(values: Array) -> str:
    return ", ".join(f"{v.real:.9g}{v.imag:+.9g}i" for v in values)


def _conjugate(M: Array, C: Array, K: Array) -> Array:
    """One of each conjugate pair of eigenvalues of λ² M + λ C + K."""
    n = len(M)
    state = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    values = np.linalg.eigvals(state)
    return values[values.imag > 0]


def pendulum() -> mb.Mechanism:
    """A point mass hanging from a hinge."""
    return mb.Mechanism((mb.Body("bob", POINT),), (mb.Joint("hinge", "revolute", "ground", "bob"),), gravity=DOWN)


def hinged(kind: str) -> mb.Mechanism:
    """A slender rod on a flap or lag hinge at half its length from the axis of a rotor at 5 rad/s."""
    end = mb.at(LENGTH / 2, axis="-y" if kind == "flap" else "z")
    rod = mb.inertia(MASS, (0.0, MASS * LENGTH**2 / 12, MASS * LENGTH**2 / 12), (LENGTH / 2, 0.0, 0.0))
    return mb.Mechanism(
        (mb.Body("hub"), mb.Body("rod", rod)),
        (
            mb.Joint("shaft", "revolute", "ground", "hub"),
            mb.Joint(kind, "revolute", "hub", "rod", end, mb.at(axis="-y" if kind == "flap" else "z")),
        ),
        (mb.Motion("shaft.rz", rate=5.0),),
    )


def declares(code: MechanismAdapter) -> None:
    """The declarations of the adapter are valid."""
    named(code)
    reason = code.unsupported_mechanism(pendulum())
    require(reason is None, f"unsupported_mechanism: {reason}: every code must accept a pendulum")


def refuses(code: MechanismAdapter) -> None:
    """``unsupported_mechanism`` and ``solve_mechanism`` agree."""
    base = pendulum()
    bushing = mb.Beam("ground", "bob", mb.bushing(np.eye(4), np.eye(6)))
    mechanisms = {
        "a bushing": replace(base, beams=(bushing,)),
        "an acceleration": replace(base, motions=(mb.Motion("hinge.rz", 0.0, 0.0, 1.0),)),
        "a loop with a spring on every joint": _parallelogram(springs=True),
    }
    declined = False
    for description, mechanism in mechanisms.items():
        reason = code.unsupported_mechanism(mechanism)
        if reason is None:
            continue
        declined = True
        require(
            reason.strip() and "\n" not in reason, f"{description}: unsupported_mechanism: {reason!r}: not one line"
        )
        try:
            code.solve_mechanism(mechanism, {})
        except CodeError:
            continue
        raise BrokenError(f"{description}: unsupported_mechanism returns {reason!r}, but solve_mechanism answers")
    if not declined:
        raise NotForItError("the code accepts all these mechanisms")


def hangs(code: MechanismAdapter) -> None:
    """√(g/l), and the steady state from a guess near it."""
    modes = _ask(code, pendulum(), {"hinge.rz": 0.3})
    _are(modes, [1j * np.sqrt(G / LENGTH)], "pendulum")
    require(modes.coordinates == ("hinge.rz",), f"coordinates: {modes.coordinates}, expected ('hinge.rz',)")
    require(abs(modes.steady[0]) < 1e-9, f"pendulum: it hangs at {modes.steady[0]:.3g} rad, expected 0")


def oscillates(code: MechanismAdapter) -> None:
    """A damped slide, preloaded: m λ² + c λ + k = 0 about m g/k."""
    k, c = 200.0, 12.0
    slide = mb.Mechanism(
        (mb.Body("mass", mb.inertia(MASS, 0.1)),),
        (mb.Joint("rail", "prismatic", "ground", "mass", mb.at(axis="y"), mb.at(axis="y")),),
        coordinate_springs=(mb.CoordinateSpring("rail.z", k, c, 0.05),),
        gravity=DOWN,
    )
    modes = _ask(code, slide)
    decay = c / (2 * MASS)
    _are(modes, [complex(-decay, np.sqrt(k / MASS - decay**2))], "damped slide")
    at = 0.05 - MASS * G / k
    require(abs(modes.steady[0] - at) < 1e-9, f"damped slide: it settles at {modes.steady[0]:.9g} m, expected {at:.9g}")


def flaps(code: MechanismAdapter) -> None:
    """Ω √(1 + e S/I) on a flap hinge, Ω √(e S/I) on a lag hinge (W. Johnson, *Helicopter Theory*, 1980, sec. 9-2)."""
    ratio = (LENGTH / 2) * (LENGTH / 2) / (LENGTH**2 / 3)
    _are(_ask(code, hinged("flap")), [5j * np.sqrt(1 + ratio)], "flap hinge at 5 rad/s")
    _are(_ask(code, hinged("lag")), [5j * np.sqrt(ratio)], "lag hinge at 5 rad/s")


def gyrates(code: MechanismAdapter) -> None:
    """A spinning disc on two gimbals with springs: I λ² ± H λ + k coupled, eigenvalues ±i (√(H² + 4 I k) ± H)/(2 I)."""
    transverse, polar, k, spin = 0.4, 0.5, 30.0, 20.0
    gimbals = mb.Mechanism(
        (mb.Body("ring"), mb.Body("fork"), mb.Body("disc", mb.inertia(1.0, (transverse, transverse, polar)))),
        (
            mb.Joint("outer", "revolute", "ground", "ring", mb.at(axis="x"), mb.at(axis="x")),
            mb.Joint("inner", "revolute", "ring", "fork", mb.at(axis="y"), mb.at(axis="y")),
            mb.Joint("spin", "revolute", "fork", "disc"),
        ),
        (mb.Motion("spin.rz", rate=spin),),
        (mb.CoordinateSpring("outer.rz", k), mb.CoordinateSpring("inner.rz", k)),
    )
    H = polar * spin
    root = np.sqrt(H**2 + 4 * transverse * k)
    _are(_ask(code, gimbals), [0.5j * (root - H) / transverse, 0.5j * (root + H) / transverse], "disc on gimbals")


def stretched(code: MechanismAdapter) -> None:
    """A mass on a rail across a stretched spring between points: √(T/(m l)) by its tension alone, and damped along it."""
    k, free, position = 90.0, 0.4, 1.0
    rail = mb.Mechanism(
        (mb.Body("mass", mb.inertia(MASS, 0.1)),),
        (mb.Joint("rail", "prismatic", "ground", "mass"),),
        springs=(mb.Spring("ground", "mass", np.array([position, 0.0, 0.0]), np.zeros(3), k, 5.0, free),),
    )
    _are(_ask(code, rail), [1j * np.sqrt(k * (position - free) / position / MASS)], "mass across a stretched spring")


def branches(code: MechanismAdapter) -> None:
    """A sprung slide from which a pendulum and a double pendulum hang, its joints given level by level."""
    k, l, m = 150.0, LENGTH, MASS
    sled = mb.Body("sled", mb.inertia(2 * m))
    bobs = tuple(mb.Body(name, POINT) for name in ("left", "right", "below"))
    below = mb.at(0.0, -l, 0.0)
    tree = mb.Mechanism(
        (sled, *bobs),
        (
            mb.Joint("rail", "prismatic", "ground", "sled", mb.at(axis="x"), mb.at(axis="x")),
            mb.Joint("a", "revolute", "sled", "left"),
            mb.Joint("b", "revolute", "sled", "right"),
            mb.Joint("c", "revolute", "left", "below", below),
        ),
        coordinate_springs=(mb.CoordinateSpring("rail.z", k),),
        gravity=DOWN,
    )
    moves = np.array([[1, l, 0, 0], [1, 0, l, 0], [1, 2 * l, 0, l]])  # of each bob, by sled, a, b and c
    M = 2 * m * np.diag([1.0, 0, 0, 0]) + m * moves.T @ moves
    K = np.diag([k, 2 * m * G * l, m * G * l, 0.0])
    K[1:, 1:] += m * G * l * np.outer([1, 0, 1], [1, 0, 1])
    _are(_ask(code, tree), _conjugate(M, np.zeros((4, 4)), K), "pendulums on a slide")


def _parallelogram(springs: bool = False) -> mb.Mechanism:
    """A horizontal bar on two massless cranks: three redundant constraints in space."""
    crossbar, vertical = mb.at(1.0), mb.at(0.0, -LENGTH, 0.0)
    names = ("A", "B", "C", "D")
    return mb.Mechanism(
        (mb.Body("one"), mb.Body("two"), mb.Body("bar", mb.inertia(MASS, (0.0, 0.3, 0.3), (0.4, -0.1, 0.2)))),
        (
            mb.Joint("A", "revolute", "ground", "one"),
            mb.Joint("B", "revolute", "ground", "two", crossbar),
            mb.Joint("C", "revolute", "one", "bar", vertical),
            mb.Joint("D", "revolute", "two", "bar", vertical, crossbar, cut=True),
        ),
        coordinate_springs=tuple(mb.CoordinateSpring(f"{j}.rz", 1.0) for j in names) if springs else (),
        gravity=DOWN,
    )


def closes(code: MechanismAdapter) -> None:
    """The bar of a parallelogram moves without rotation: √(g/l), for any position of its mass centre."""
    modes = _ask(code, _parallelogram(), {"A.rz": 0.2, "B.rz": 0.2, "C.rz": -0.2})
    _are(modes, [1j * np.sqrt(G / LENGTH)], "parallelogram")


def curves(code: MechanismAdapter) -> None:
    """A bar free in a plane, pinned by a loop joint: all its stiffness is the constraints' curvature, m g l/(I + m l²)."""
    moment = 0.5
    pinned = mb.Mechanism(
        (mb.Body("bar", mb.inertia(MASS, moment)),),
        (
            mb.Joint("plane", "planar", "ground", "bar"),
            mb.Joint("pin", "revolute", "ground", "bar", mb.at(y=LENGTH), mb.at(y=LENGTH), cut=True),
        ),
        gravity=DOWN,
    )
    modes = _ask(code, pinned, {"plane.x": 0.05, "plane.rz": 0.05})
    _are(modes, [1j * np.sqrt(MASS * G * LENGTH / (moment + MASS * LENGTH**2))], "bar on a loop joint")


def reversed_joint(code: MechanismAdapter) -> None:
    """A joint from child to parent and a different order of bodies: the coordinate changes sign, λ is the same."""
    answers = []
    for ends in (("ground", "bob"), ("bob", "ground")):
        joint = mb.Joint("hinge", "revolute", *ends)
        spring = mb.CoordinateSpring("hinge.rz", 5.0, 1.0, 0.2 if ends[0] == "ground" else -0.2)
        answers.append(_ask(code, replace(pendulum(), joints=(joint,), coordinate_springs=(spring,))))
    _are(
        answers[1],
        [complex(v.real, abs(v.imag)) for v in answers[0].values],
        "pendulum, its hinge given from child to parent",
    )
    require(
        abs(answers[0].steady[0] + answers[1].steady[0]) < 1e-9,
        "hinge given from child to parent: its angle is not reversed",
    )


def repeats(code: MechanismAdapter) -> None:
    """No state remains from another call."""
    first = _ask(code, hinged("flap"))
    _ask(code, hinged("lag"))
    second = _ask(code, hinged("flap"))
    is_equal = np.array_equal(first.values, second.values) and np.array_equal(first.shapes, second.shapes)
    require(is_equal, f"the same call before and after another: {_list(first.values)}, then {_list(second.values)}")


def periodic(code: MechanismAdapter) -> None:
    """Gravity across the rotor's axis: no steady state, and no answer."""
    sagging = replace(hinged("lag"), gravity=DOWN)
    if not code.unsupported_mechanism(sagging):
        _refused(code, sagging, "gravity across the axis of rotation", "it is periodic")


def falls(code: MechanismAdapter) -> None:
    """An unsupported mass under gravity has no steady state."""
    mechanism = mb.Mechanism(
        (mb.Body("mass", mb.inertia(MASS, 0.1)),),
        (mb.Joint("rail", "prismatic", "ground", "mass", mb.at(axis="y"), mb.at(axis="y")),),
        gravity=DOWN,
    )
    _refused(code, mechanism, "a mass that falls freely", "it has no steady state")


def _refused(code: MechanismAdapter, mechanism: mb.Mechanism, label: str, reason: str) -> None:
    """Check that a code refuses a mechanism without a constant steady state."""
    try:
        answer = code.solve_mechanism(mechanism, {})
    except CodeError:
        return
    raise BrokenError(f"{label}: {_list(answer.values)} 1/s, expected a refusal: {reason}")
