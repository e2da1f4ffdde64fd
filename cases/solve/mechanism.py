"""A mechanism's references by core, and the answers of codes and closed forms against them.

A mechanism has no discretisation to refine: codes solve the same equations, so the target is at rounding level, and damping
ratios must agree as closely as frequencies.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

from ...core import multibody as mb
from ...core.effects import ALL_EFFECTS
from ...core.mechanism.description import at_rate
from ...core.participation import numbered
from ...core.spectrum.eigen import EigenError
from ...core.tree.dynamics import reduced_mass
from ...references.protocol.interface import MechanismModes
from ...references.protocol.process import Failure, Limits
from ...references.protocol.worker import MechanismAnswer
from ...references.protocol.worker import mechanism_answers as answers
from ...references.theories import blade_formulae
from ..input.mechanism_schema import ClosedForm
from ..input.mechanisms import Described
from ..judge.cells import Head, Rows, joined
from ..judge.convergence import RefinedMode
from ..judge.pairing import Pair
from ..judge.reference import Converged, Reference
from ..judge.same import same_discretisation_cells
from ..judge.spectrum import of_mechanism, of_mechanisms
from ..judge.uncertainty import ROUNDING, Estimate
from .reference import References
from .works import References as AtSpeeds

QUANTITIES = ("frequency", "damping")
"""What is compared of each mode."""

Ask = Callable[[Described, Sequence[float]], list[MechanismAnswer]]
"""A solver: a mechanism and rotor speeds (rad/s) → an answer at each."""


def references(described: Described, speeds: Sequence[float], count: int) -> References:
    """Core's modes at each speed; a failure where core cannot solve it, or finds fewer than the ``count`` compared modes."""
    return {ALL_EFFECTS: [_reference(described, omega, count) for omega in speeds]}


def _reference(described: Described, omega: float, count: int) -> Reference | Failure:
    """Core's modes, named by the joint that moves most; the weight is the mass matrix over the coordinates."""
    independent = described.text.independent or None
    try:
        solved = mb.solve(_turning(described, omega), described.guess, independent=independent)
    except (mb.MechanismError, EigenError) as error:
        return Failure("no reference", f"speeds: {omega:g} rad/s: {error}")
    if len(solved.values) < count:
        reason = f"compare.modes: {count}: the mechanism has {len(solved.values)} modes: reduce it"
        return Failure("no reference", reason)
    state = solved.linear.state
    joints = [name.partition(".")[0] for name in solved.leading]
    spectrum = replace(
        of_mechanism(MechanismModes(solved.coordinates, state.q, solved.values, solved.shapes)),
        weight=reduced_mass(state.kinematics, state.cartesian)[None],
        labels=numbered(joints),
    )
    frequencies = spectrum.frequencies[:count].tolist()
    modes = tuple(RefinedMode(Estimate(f, ROUNDING), Pair(k, 1.0), ()) for k, f in enumerate(frequencies))
    core = Converged(spectrum, tuple(range(count)), modes, tuple(joints[:count]))
    return Reference(core, tuple(frequencies), (1.0,) * count, ((),) * count, QUANTITIES)


def _turning(described: Described, omega: float) -> mb.Mechanism:
    """The mechanism with its rotor at ``omega`` (rad/s)."""
    return at_rate(described.mechanism, described.text.rotor, omega)


def answers_at(
    name: str, version: str, limits: Limits, described: Described, speeds: Sequence[float]
) -> list[MechanismAnswer]:
    """The answers of a code."""
    mechanisms = [_turning(described, omega) for omega in speeds]
    return answers(name, mechanisms, described.guess, limits, version)


def formula(form: ClosedForm, _: Described, speeds: Sequence[float]) -> list[MechanismAnswer]:
    """The answers of a closed form, whose parameters are given apart from the mechanism."""
    try:
        return [blade_formulae.solve(form.formula, omega, form.parameters) for omega in speeds]
    except TypeError as error:
        return [Failure("refused", f"closed_form.parameters: {error}")] * len(speeds)


def compared(head: Head, described: Described, ask: Ask, core: AtSpeeds) -> Rows:
    """Rows of a solver at the speeds at which core has a reference."""
    spectra = of_mechanisms(ask(described, [omega for omega, _ in core]))
    return joined(
        same_discretisation_cells(head, omega, r, a, r.core.spectrum)
        for (omega, r), a in zip(core, spectra, strict=True)
    )
