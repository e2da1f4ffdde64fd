"""The modes of a subject at one point, in the form in which they are paired and judged, whatever the subject is.

A blade's shapes have four motions at 21 stations, a mechanism's have its joint coordinates at one station. Pairing needs the
shapes and their inner product; verdicts need the eigenvalues and their uncertainties.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...core.modes import Modes
from ...references.protocol.interface import MOTIONS, MechanismModes
from ...references.protocol.process import Failure

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

CLOSE = 1e-12
"""Relative distance above the reference's highest mode up to which a mode of an answer counts among its modes."""


@dataclass(frozen=True)
class Spectrum:
    """Modes at one point.

    Attributes:
        values: (m,) eigenvalues λ, 1/s, in ascending order of their moduli: one of each conjugate pair, and the real ones.
        shapes: (m, s, k) complex motion of k degrees of freedom at each of s stations, at any scale.
        names: (k,) names of the degrees of freedom.
        weight: (s, k, k) inner product of two shapes: the mass at each station; None for an answer, to which the weight of
            the reference is applied.
        labels: (m,) names of the modes, such as ``flapwise 1``; empty for an answer.
        elements: refinement: number of elements or of terms; 0 without a discretisation.
        uncertainty: (m,) relative uncertainty of the moduli, if the code states it; else empty.
        rounding: (m,) the part of it that is due to rounding, if the code states it; else empty.
        complete: whether the subject has no other modes.
    """

    values: Complex
    shapes: Complex
    names: tuple[str, ...]
    weight: Array | None = None
    labels: tuple[str, ...] = ()
    elements: int = 0
    uncertainty: Array = field(default_factory=lambda: np.zeros(0))
    rounding: Array = field(default_factory=lambda: np.zeros(0))
    complete: bool = False

    @property
    def frequencies(self) -> Array:
        """(m,) natural frequencies |λ|, rad/s."""
        return np.abs(self.values)

    @property
    def damping(self) -> Array:
        """(m,) damping ratios −Re λ/|λ|; zero for λ = 0."""
        size = self.frequencies
        return np.divide(0.0 - self.values.real, size, out=np.zeros_like(size), where=size > 0)

    def of(self, quantity: str) -> Array:
        """(m,) values of a quantity, by its name in ``quantities``."""
        return {"frequency": self.frequencies, "damping": self.damping}[quantity]


Answer = Spectrum | Failure


def of_blade(modes: Modes, weight: Array | None = None) -> Spectrum:
    """The spectrum of a blade's modes: λ = ω (−ζ + i √(1 − ζ²))."""
    ratio = modes.damping
    values = modes.frequencies * (-ratio + 1j * np.sqrt(1.0 - ratio**2))
    accuracy = {"elements": modes.elements, "uncertainty": modes.uncertainty, "rounding": modes.rounding}
    return Spectrum(values, modes.shapes, MOTIONS, weight, **accuracy)


def of_mechanism(modes: MechanismModes) -> Spectrum:
    """The spectrum of a mechanism's modes, which are all of them."""
    return Spectrum(modes.values, modes.shapes[:, None, :], modes.coordinates, complete=True)


def of_blades(answers: Iterable[Modes | Failure]) -> list[Answer]:
    """The spectra of a code's answers on a blade."""
    return [answer if isinstance(answer, Failure) else of_blade(answer) for answer in answers]


def of_mechanisms(answers: Iterable[MechanismModes | Failure]) -> list[Answer]:
    """The spectra of a code's answers on a mechanism."""
    return [answer if isinstance(answer, Failure) else of_mechanism(answer) for answer in answers]


def on_common(reference: Spectrum, answer: Spectrum) -> tuple[Complex, Complex, Array]:
    """The shapes of both over the degrees of freedom that they share, and the weight of the reference over these.

    Raises:
        ValueError: if the reference has no weight.
    """
    if reference.weight is None:
        raise ValueError("a spectrum without a weight cannot be a reference")
    if reference.names == answer.names:
        return reference.shapes, answer.shapes, reference.weight
    reference_indices = [k for k, name in enumerate(reference.names) if name in answer.names]
    answer_indices = [answer.names.index(reference.names[k]) for k in reference_indices]
    weight = reference.weight[:, reference_indices][:, :, reference_indices]
    return reference.shapes[:, :, reference_indices], answer.shapes[:, :, answer_indices], weight


def fault(reference: Spectrum, answer: Spectrum) -> str:
    """Why the modes of a complete reference have no definite partners in an answer; empty if they have.

    The answer must name enough degrees of freedom to tell the modes apart, and it must have no more modes than the reference
    up to the highest of these.
    """
    if not reference.complete:
        return ""
    shapes_in_common, _, _ = on_common(reference, answer)
    count = len(reference.values)
    rank, full_rank = (
        np.linalg.matrix_rank(shapes.reshape(count, -1)) for shapes in (shapes_in_common, reference.shapes)
    )
    if rank < full_rank:
        return f"coordinates {', '.join(answer.names)}: these do not distinguish the {count} modes: name all"
    highest = reference.frequencies.max(initial=0.0)
    has_more = len(answer.values) > count
    if has_more and np.sum(answer.frequencies <= highest * (1.0 + CLOSE)) > count:
        return (
            f"values: {len(answer.values)} modes, and Southwell's own solver has {count}: give each conjugate "
            "pair once, and no spurious mode"
        )
    return ""
