"""Modes of a turbine at a speed, named by where their elastic energy is.

The elastic motions of tower and blades are orthogonal in stiffness, so the energy of a mode is a sum over them, the shaft and
the yaw bearing. The motion with the largest part names the mode, and that part is the confidence. For blades, the parts of
collective, cosine and sine motion are added, and the whirl follows from the phase of sine against cosine.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .. import participation
from ..modes import Modes
from ..rotor import multiblade
from ..rotor.whirl import whirl
from ..spectrum import eigen
from ..threads import one_thread
from . import stations
from .assembly import Assembled, assemble
from .machine import Machine
from .motion import Motion, displacements, flattened
from .tower_modes import NAMES, PLATFORM, ordinal
from .two_blades import periodic_modes

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

CONFIDENT = 0.5
"""Smallest part of the elastic energy that names a mode without a question mark."""

RIGID = 1e-6
"""Frequency, relative to the lowest of the blade, below which a mode is the rotor that turns freely."""

BLADE_NAMES = ("flap", "edge", "torsion", "axial")

TURNS = "rotor turns freely"
SHAFT = "drivetrain torsion"
TEETER = "teeter"


@dataclass(frozen=True)
class TurbineModes:
    """The lowest modes of a turbine at a speed.

    Attributes:
        omega: rad/s.
        frequencies: (m,) rad/s, ascending, in the ground's frame; of two blades, those of blades in the rotor's. The free
            rotation of the rotor is left out.
        growth: (m,) real parts, 1/s: rounding, unless gyroscopic or periodic forces destabilise the machine.
        names: (m,) as ``1st flap forward whirl``.
        confidence: (m,) part of the elastic energy in the motion that names each mode; of two blades, at its frequency.
        energies: (m, g) parts of the groups ``groups``; each row adds up to 1.
        groups: (g,) names of the motions.
        shapes: (m, k) displacements of tower, shaft and blades by multi-blade coordinate, for tracking; the largest is 1.
        parts: positions and displacements of tower, hub and blades, by multi-blade coordinate.
        directions: (m,) whirl of the blades' motion, from −1, backward, to 1, forward.
        motions: (m, 21 (1 + N), 4) motion of the stations of tower and blades, see ``stations``; no stations of two blades.
    """

    omega: float
    frequencies: Array
    growth: Array
    names: tuple[str, ...]
    confidence: Array
    energies: Array
    groups: tuple[str, ...]
    shapes: Complex
    parts: Motion
    directions: Array
    motions: Complex


def turbine_modes(machine: Machine, omega: float, count: int = 12) -> TurbineModes:
    """The ``count`` lowest modes of a turbine at a speed, rad/s.

    Raises:
        PeriodicError: the equations of three or more blades vary with the azimuth; those of two are not solved with certainty,
            or the rotor stands still.
        SteadyStateError: the blades have no steady state.
        EigenError: the eigenvalue solver fails.
    """
    if machine.turbine.blades >= multiblade.MIN_BLADES:
        return _constant_modes(machine, omega, count)
    a, solved = periodic_modes(machine, omega, count)
    labels, numbers = _labels(machine, a)
    values, shapes, energies, parts = solved.values.copy(), [], [], []
    for k, harmonics in enumerate(solved.harmonics):
        energy = _energies(machine, a, harmonics.T, numbers, len(labels))
        group = energy.sum(0).argmax()
        largest = int(energy[:, group].argmax())  # where the motion that names the mode moves most
        values[k] += 1j * omega * (largest - len(harmonics) // 2)
        forward = values[k].imag >= 0
        values[k], shape = (values[k], harmonics[largest]) if forward else (values[k].conj(), harmonics[largest].conj())
        shapes.append(shape)
        energies.append(energy.sum(0))
        parts.append(energy[largest, group] / energy.sum())
    order = np.argsort(values.imag, kind="stable")
    modes = _named(machine, a, values[order], np.array(shapes)[order].T, np.array(energies)[order])
    return replace(modes, confidence=np.array(parts)[order])


def _constant_modes(machine: Machine, omega: float, count: int) -> TurbineModes:
    """The modes of constant equations."""
    a = assemble(machine, omega)
    free = machine.turbine.drivetrain.free
    rigid = np.zeros((len(a.M), 0))
    if free:  # hub and generator turn together
        rigid = np.zeros((len(a.M), 1))
        rigid[list(a.shaft)] = 1.0
    with one_thread():
        eigenpairs = eigen.damped(a.M, a.C, a.K, None, (rigid, rigid) if free else None)
    elastic = np.flatnonzero(np.abs(eigenpairs.values) > RIGID * a.blade.frequencies[0])[:count]
    values, vectors = eigenpairs.values[elastic], eigenpairs.vectors[:, elastic]
    labels, numbers = _labels(machine, a)
    modes = _named(machine, a, values, vectors, _energies(machine, a, vectors, numbers, len(labels)))
    return replace(modes, motions=stations.motions(machine.turbine, a, vectors))


def _named(machine: Machine, a: Assembled, values: Complex, vectors: Complex, energies: Array) -> TurbineModes:
    """Modes with eigenvalues (m,), shapes (n, m) and elastic energies (m, g)."""
    total = energies.sum(1, keepdims=True)
    energies = energies / np.where(total > 0, total, 1.0)
    labels, numbers = _labels(machine, a)
    names, directions = [], np.zeros(len(values))
    for k, x in enumerate(vectors.T):
        group = int(energies[k].argmax())
        label = labels[group]
        motions = np.flatnonzero(numbers["blade"] == group)
        if len(motions):
            label, directions[k] = _turned(a, label, x, motions)
        names.append(label)
    motion = _motion(machine, a, vectors)
    return TurbineModes(
        omega=a.omega,
        frequencies=np.abs(values),
        growth=values.real,
        names=tuple(names),
        confidence=energies.max(1),
        energies=energies,
        groups=labels,
        shapes=flattened(motion, vectors[list(a.shaft)].T, a.meshes[1].scale),
        parts=motion,
        directions=directions,
        motions=np.zeros((len(values), 0, 4), np.complex128),
    )


def _turned(a: Assembled, label: str, x: Complex, motions: NDArray[np.intp]) -> tuple[str, float]:
    """A blade's label with the motion around the rotor, and its direction."""
    names = multiblade.names(len(a.blades))
    energy = a.blade.frequencies[motions] ** 2
    parts = np.array([float(energy @ np.abs(x[row[motions]]) ** 2) for row in a.blades])
    if parts[0] >= 0.5 * parts.sum():
        return f"{label} collective", 0.0
    if names[-1] == "differential" and parts[-1] >= 0.5 * parts.sum():
        return f"{label} differential", 0.0
    order = 1 + int(np.array([parts[m : m + 2].sum() for m in range(1, len(parts) - 1, 2)]).argmax())
    pairs = np.stack([a.blades[2 * order - 1, motions], a.blades[2 * order, motions]], axis=-1)
    turning = whirl(x, pairs, a.omega, energy)
    if a.omega and turning.name != "neither":
        kind = f"{turning.name} whirl"
    elif order == 1:
        kind = "tilt" if parts[1] >= parts[2] else "yaw"
    else:
        kind = "standing wave"
    return f"{label} {kind}{f' of {order} diameters' if order > 1 else ''}", turning.direction


def _labels(machine: Machine, a: Assembled) -> tuple[tuple[str, ...], dict[str, NDArray[np.intp]]]:
    """Names of the groups, and the group of each elastic motion of ``tower`` and ``blade``."""
    out: list[str] = ["yaw", SHAFT, *(f"platform {name}" for name in PLATFORM), *([TEETER] if a.teeter else [])]
    numbers: dict[str, NDArray[np.intp]] = {}
    parts = (
        ("tower", machine.turbine.tower, a.tower, a.meshes[0], a.shapes[0], NAMES),
        ("blade", machine.turbine.blade, a.blade, a.meshes[1], a.shapes[1], BLADE_NAMES),
    )
    for part, beam, component, mesh, shape, words in parts:
        p = a.tower_links if part == "tower" else a.blade_links
        modes = Modes(0.0, component.frequencies, stations.elastic(component, mesh, shape, p), mesh.elements)
        fractions = participation.participation(modes, beam)
        families = [words[int(row.argmax())] for row in fractions]
        occurrences: dict[str, int] = {}
        group: list[int] = []
        base = (
            machine.base_energy(np.eye(component.size, dtype=complex))
            if part == "tower"
            else np.zeros((6, component.size))
        )
        for k, family in enumerate(families):
            if base[:, k].sum() > 0.5 * component.frequencies[k] ** 2:
                group.append(out.index(f"platform {PLATFORM[int(base[:, k].argmax())]}"))
                continue
            occurrences[family] = occurrences.get(family, 0) + 1
            prefix = "tower " if part == "tower" else ""
            out.append(f"{ordinal(occurrences[family])} {prefix}{family}")
            group.append(len(out) - 1)
        numbers[part] = np.array(group, dtype=np.intp)
    return tuple(out), numbers


def _energies(
    machine: Machine, a: Assembled, vectors: Complex, numbers: dict[str, NDArray[np.intp]], count: int
) -> Array:
    """(m, g) elastic energy in each group; that of a teeter hinge includes its centrifugal stiffness."""
    t = a.tower.size
    out = np.zeros((vectors.shape[1], count))
    squared = np.abs(vectors) ** 2
    tower = a.tower.frequencies[:, None] ** 2 * squared[:t]
    total = tower.sum(0)
    yawing = np.minimum(machine.yaw_energy(vectors[:t]), total)
    base = machine.base_energy(vectors[:t])
    springs = np.minimum(yawing + base.sum(0), total)
    np.add.at(out.T, numbers["tower"], tower * (1.0 - springs / np.where(total > 0, total, 1.0)))
    out[:, 0] = yawing
    out[:, 2:8] = base.T
    if a.shaft and np.isfinite(machine.turbine.drivetrain.stiffness):
        shaft_twist = vectors[a.shaft[0]] - (vectors[a.shaft[1]] if len(a.shaft) > 1 else 0.0)
        out[:, 1] = machine.turbine.drivetrain.stiffness * np.abs(shaft_twist) ** 2
    if a.teeter:
        (hinge,) = a.teeter
        out[:, 2 + len(PLATFORM)] = a.K[hinge, hinge] * squared[hinge]
    for index, row in enumerate(a.blades):
        weight = _weight(index, len(a.blades))
        np.add.at(out.T, numbers["blade"], weight * a.blade.frequencies[:, None] ** 2 * squared[row])
    return out


def _weight(index: int, blades: int) -> float:
    """Sum over the blades of the square of a multi-blade coordinate's factor."""
    return float((multiblade.transformation(0.0, blades)[:, index] ** 2).sum())


def _motion(machine: Machine, a: Assembled, vectors: Complex) -> Motion:
    """The motion of tower, hub and blades in modes (n, m)."""
    tower = displacements(a.shapes[0], a.tower_links, a.tower.vectors)
    blade = displacements(a.shapes[1], a.blade_links, a.blade.vectors)
    blades = np.einsum("nrm,rqi->mnqi", vectors[a.blades], blade)
    for angle, twist in zip(a.teeter, machine.turbine.hinge.T, strict=True):
        displacement = twist[:3] + np.cross(twist[3:], a.shapes[1].nodes[:, :3, 3])
        blades[:, 1] += vectors[angle][:, None, None] * displacement  # of blade 0; blade 1 moves the other way
    return Motion(
        tower=a.shapes[0].nodes[:, :3, 3],
        shaft=a.shapes[0].nodes[-1] @ machine.turbine.shaft,
        blade=a.shapes[1].nodes[:, :3, 3],
        tower_motion=np.einsum("rm,rpi->mpi", vectors[: a.tower.size], tower),
        hub=vectors.T @ a.hub.T,
        blades=blades,
    )
