"""Periodic steady state of a mechanism by harmonic balance, and its matrices at azimuths.

Coordinates are trigonometric polynomials of ψ, given by their values at equal azimuths; rates and accelerations follow by
exact differentiation. Newton's method with the analytic M*, C*, K* at each azimuth makes the forces balance there; azimuths are
doubled until the forces balance between them too. (Nakhla and Vlach, IEEE Trans. Circuits Syst. 23, 1976, 85; Trefethen,
*Spectral Methods in MATLAB*, 2000, ch. 3.)
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..mechanism.description import Mechanism, MechanismError, check_mechanism
from ..mechanism.motion import Motion
from ..steady.equilibrium import steady_state
from ..tree import dynamics
from ..tree.kinematics import Kinematics, kinematics
from ..tree.partition import free_coordinates
from ..tree.scales import coordinate_units
from ..tree.spanning import compile_tree
from ..tree.topology import Tree
from .periodic import Periodic, PeriodicError, sampled

Array = NDArray[np.float64]

BALANCED = 1e-10
"""Unbalanced force on a coordinate, as a fraction of the forces of which it is the sum, that counts as zero."""

MAX_STEPS = 30
"""Largest number of Newton's steps."""

_STILL = 1e-13  # amplitude, rad or fractions of the mechanism's length, that is rounding

MAX_UNKNOWNS = 6000
"""Largest number of coordinates times azimuths."""


@dataclass(frozen=True)
class Orbit:
    """A periodic state of a mechanism.

    Attributes:
        tree: the mechanism.
        spin: index of the coordinate whose position is the azimuth.
        omega: its rate, rad/s.
        ratios: (n,) rates of prescribed coordinates as multiples of Ω.
        offsets: (n,) their positions at ψ = 0.
        q: (k, n) coordinates at the equal azimuths 2πj/k.
    """

    tree: Tree
    spin: int
    omega: float
    ratios: Array
    offsets: Array
    q: Array

    @property
    def free(self) -> NDArray[np.intp]:
        """(f,) indices of the coordinates that are not prescribed."""
        return free_coordinates(self.tree)

    @property
    def amplitude(self) -> Array:
        """(f,) largest departure of each free coordinate from its mean, m or rad."""
        q = self.q[:, self.free]
        return np.abs(q - q.mean(0)).max(0)

    def motion(self, psi: float) -> Kinematics:
        """The kinematics at an azimuth, rad."""
        count = len(self.q)
        spectrum = np.fft.fft(self.q, axis=0) / count
        order = np.fft.fftfreq(count, 1.0 / count)
        spectrum, order = spectrum[np.abs(order) < 0.5 * count], order[np.abs(order) < 0.5 * count]
        wave = np.exp(1j * order * psi)
        q, v, a = (np.real(((1j * self.omega * order) ** power * wave) @ spectrum) for power in range(3))
        turning = self.ratios != 0.0
        q[turning] = (self.offsets + self.ratios * psi)[turning]
        v[turning] = self.ratios[turning] * self.omega
        a[turning] = 0.0
        return kinematics(self.tree, q, v, a)

    def matrices(self, psi: float) -> tuple[Array, Array, Array]:
        """M*, C*, K* (f, f) of the free coordinates at an azimuth, rad."""
        k = self.motion(psi)
        at = np.ix_(self.free, self.free)
        M, C, K = (part[at] for part in dynamics.tangent(self.tree, k, dynamics.cartesian(self.tree, k)))
        return M, C, K

    def unbalanced(self, psi: float) -> tuple[Array, Array]:
        """(f,) forces that remain on the free coordinates at an azimuth, and the size of those that add up to them."""
        k = self.motion(psi)
        c = dynamics.cartesian(self.tree, k)
        v = np.zeros(len(self.offsets)) + self.ratios * self.omega
        M, _, K = (np.abs(np.diagonal(part)) for part in dynamics.tangent(self.tree, k, c))
        size = np.einsum("in,ni->n", np.abs(k.J), dynamics.carried(self.tree, c.size[: len(k.poses)]))
        size += (K + self.omega**2 * M) * coordinate_units(self.tree, self.tree.length)
        return dynamics.unbalanced(self.tree, k, c, k.q, v)[self.free], size[self.free]


def linearize(mechanism: Mechanism, spin: str, guess: Mapping[str, float] | None = None) -> tuple[Periodic, Orbit]:
    """M(ψ), C(ψ), K(ψ) of a mechanism whose parts spin on a support, about its periodic steady state.

    Args:
        mechanism: the mechanism; joints do not close loops, and beams between parts that move relative to each other in the
            steady state have their mass lumped.
        spin: the coordinate that turns the rotor, with a motion at a rate; its position is the azimuth ψ = Ω t. Other
            motions have rates that are whole multiples of Ω.
        guess: coordinates to start from, by name.

    Raises:
        MechanismError: the mechanism is not accepted, or has no periodic steady state near that at ψ = 0.
    """
    orbit = orbit_of(mechanism, spin, guess)
    names = tuple(orbit.tree.coordinates[j] for j in orbit.free)
    try:
        return sampled(orbit.matrices, orbit.omega, names), orbit
    except PeriodicError as error:
        raise MechanismError(f"coordinate {spin!r}: {error}") from error


def orbit_of(mechanism: Mechanism, spin: str, guess: Mapping[str, float] | None = None) -> Orbit:
    """The periodic steady state; arguments and errors as for ``linearize``."""
    check_mechanism(mechanism)
    turning = [m for m in mechanism.motions if m.rate]
    motion = next((m for m in turning if m.coordinate == spin), None)
    if motion is None:
        raise MechanismError(f"coordinate {spin!r}: no motion at a rate is given: add one")
    tree = compile_tree(replace(mechanism, motions=tuple(_at_rest(m) for m in mechanism.motions)))
    moving = compile_tree(mechanism)
    if tree.welds:
        raise MechanismError(
            f"joints {', '.join(tree.weld_names)}: they close loops, which have no periodic steady state here"
        )
    ratios, offsets = np.zeros(len(tree.coordinates)), np.zeros(len(tree.coordinates))
    for m in mechanism.motions:
        j = tree.coordinate(m.coordinate)
        ratio = m.rate / motion.rate
        if m.acceleration or not m.prescribed or abs(ratio - round(ratio)) > 1e-12 * max(1.0, abs(ratio)):
            raise MechanismError(
                f"coordinate {m.coordinate!r}: its motion is not periodic with {spin!r}: give a prescribed rate that is a "
                "whole multiple, and no acceleration"
            )
        ratios[j], offsets[j] = ratio, 0.0 if m.coordinate == spin else (m.position or 0.0)
    start = _frozen(mechanism, moving, spin, guess)
    orbit = Orbit(moving, tree.coordinate(spin), motion.rate, ratios, offsets, np.tile(start, (1, 1)))
    count = 1
    while True:
        orbit = _balanced(_resampled(orbit, count))
        between = [orbit.unbalanced(2.0 * np.pi * (j + 0.5) / count) for j in range(count)]
        if (
            count > 1
            and max(float((np.abs(f) / np.where(s > 0, s, 1.0)).max(initial=0.0)) for f, s in between) < BALANCED
        ):
            return orbit
        if 2 * count * len(orbit.free) > MAX_UNKNOWNS:
            raise MechanismError(
                f"coordinate {spin!r}: the steady state needs more than {count} azimuths: reduce the elements"
            )
        count = 2 * count + 1 if count == 1 else 2 * count - 1


def _frozen(mechanism: Mechanism, tree: Tree, spin: str, guess: Mapping[str, float] | None) -> Array:
    """(n,) coordinates of the equilibrium at ψ = 0, from which harmonic balance starts; the guess if there is none."""
    motions = tuple(replace(m, position=0.0) if m.coordinate == spin else m for m in mechanism.motions)
    try:
        return steady_state(compile_tree(replace(mechanism, motions=motions)), guess).q
    except MechanismError:
        q = np.zeros(len(tree.coordinates))
        for name, value in (guess or {}).items():
            q[tree.coordinate(name)] = value
        return q


def _at_rest(motion: Motion) -> Motion:
    return replace(motion, rate=0.0)


def _resampled(orbit: Orbit, count: int) -> Orbit:
    """The same state at another number of azimuths."""
    values = np.array([orbit.motion(2.0 * np.pi * j / count).q for j in range(count)])
    return replace(orbit, q=values)


def _balanced(orbit: Orbit) -> Orbit:
    """Newton's method for the free coordinates at all azimuths together.

    Raises:
        MechanismError: if it does not converge.
    """
    count, free = len(orbit.q), orbit.free
    D = orbit.omega * _differentiation(count)
    DD = D @ D
    units = coordinate_units(orbit.tree, orbit.tree.length)[free]
    previous = np.inf
    for _ in range(MAX_STEPS):
        force, jacobian = np.zeros((count, len(free))), np.zeros((count, len(free), count, len(free)))
        for j in range(count):
            k = orbit.motion(2.0 * np.pi * j / count)
            c = dynamics.cartesian(orbit.tree, k)
            force[j] = dynamics.unbalanced(orbit.tree, k, c, k.q, _rates(orbit, D, j))[free]
            M, C, K = (part[np.ix_(free, free)] for part in dynamics.tangent(orbit.tree, k, c))
            jacobian[j] = np.einsum("k,ab->akb", DD[j], M) + np.einsum("k,ab->akb", D[j], C)
            jacobian[j, :, j] += K
        size = count * len(free)
        step = np.linalg.lstsq(jacobian.reshape(size, size), -force.ravel(), rcond=1e-13)[0].reshape(count, -1)
        q = orbit.q.copy()
        length = float(np.abs(step / units).max(initial=0.0))
        q[:, free] += step * min(1.0, 0.5 / max(length, 0.5))
        orbit = replace(orbit, q=q)
        if length < 1e-13 or (length < 1e-9 and length > 0.5 * previous):
            mean = orbit.q.mean(0)
            is_constant = np.abs(orbit.q - mean).max(0) <= _STILL * coordinate_units(orbit.tree, orbit.tree.length)
            is_constant &= orbit.ratios == 0.0
            return replace(orbit, q=np.where(is_constant, mean, orbit.q))
        previous = length
    raise MechanismError(
        f"no periodic steady state was found near that at ψ = 0: the last step is {previous:.1e} of the mechanism's length "
        "or rad: give a better guess, or check for a speed at which the support resonates"
    )


def _rates(orbit: Orbit, D: Array, j: int) -> Array:
    """(n,) rates of all coordinates at the azimuth j."""
    periodic = np.where(orbit.ratios != 0.0, 0.0, orbit.q)
    return D[j] @ periodic + orbit.ratios * orbit.omega


def _differentiation(count: int) -> Array:
    """(k, k) derivative with respect to ψ of trigonometric polynomials at k (odd) equal azimuths."""
    if count == 1:
        return np.zeros((1, 1))
    j = np.arange(count)
    difference = j[:, None] - j
    with np.errstate(divide="ignore"):
        D = 0.5 * (-1.0) ** difference / np.sin(np.pi * difference / count)
    D[j, j] = 0.0
    return D
