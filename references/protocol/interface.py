"""The interface of a code: the base classes of every adapter, for blades and for mechanisms.

An adapter declares class attributes and implements ``unsupported`` and ``modes``. The base class finds the installed
version and rejects unsupported problems. Rules for every adapter:

* it represents every property of a blade, or ``unsupported`` returns the reason why it cannot; no property is ignored;
* ``effects`` declares the effects it lacks by construction, and core is then compared without them;
* it converts axes and units; results are in the axes of ``core.blade`` and in SI units;
* ``modes`` is a pure function of its arguments: the same call gives the same result in any order and any process.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import metadata
from typing import TYPE_CHECKING, Annotated, Literal, get_args

import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from ...core.blade import Blade
from ...core.effects import ALL_EFFECTS, Effects
from ...core.modes import Modes
from .fingerprint import Fingerprint

if TYPE_CHECKING:
    from ...core.mechanism.description import Mechanism

Complex = NDArray[np.complex128]

PRINTABLE = r"^[^\x00-\x1f\x7f\ud800-\udfff]*$"

TextLine = Annotated[str, Meta(max_length=300, pattern=PRINTABLE)]
"""What a code declares in words: one printable line."""

SharedWithCore = Literal["nothing", "mechanical model", "discretisation", "undeclared"]

Motion = Literal["axial", "edgewise", "flapwise", "torsion"]

MOTIONS: tuple[Motion, ...] = get_args(Motion)
"""The four columns of a shape of a blade along x: displacement along x, y, z, and rotation about x."""

DIGITS = 9
"""Significant digits of a code that declares none."""

CORE = "Southwell's own solver"
"""An origin in ``Independence`` that is core."""

ADAPTERS = "made by the adapter"
"""Ending of the name of a theory whose weak forms, elements or hinges are the adapter's, not the program's."""

REFERENCE_LINE = "the adapters' reference line"
"""The origin of positions and axes that ``references.theories.reference_line`` integrates."""


@dataclass(frozen=True)
class Independence:
    """The origin of a code's results. The same origin must have the same name in every code.

    Two codes with the same ``engine``, ``theory`` or ``rotation`` count as one confirmation. A code with ``CORE``
    anywhere is not independent: it confirms only that core solves its model correctly. The same ``sections`` or
    ``eigensolver`` are shown but do not count: all codes read the same blade, and the adapters' eigensolver,
    ``references.matrices.quadratic``, is verified separately, against SciPy's dense eigenvalues of the state-space
    matrix in ``tests/cases/judge/test_groups.py``.

    Attributes:
        engine: the foreign program that computes the matrices or the forces, or part of them, e.g. ``Exudyn``.
        theory: the derivation and discretisation of the matrices, e.g. ``ANCF cable``. A part that the adapter makes itself,
            such as lumped masses, is named; weak forms or elements are called ``ADAPTERS``: a blade on which only such
            theories agree is reported as one without a foreign theory.
        rotation: origin of the centrifugal and gyroscopic terms.
        sections: origin of the sections' positions and axes: ``blade`` (a straight axis, twist and pitch as given),
            ``REFERENCE_LINE``, or core's frames. All but those with core's discretisation interpolate stiffness and mass
            between stations by ``references.sampling``, not by core; ``BladeAdapter.fingerprint`` checks the mass.
        eigensolver: what solves the eigenproblem.
    """

    engine: TextLine
    theory: TextLine
    rotation: TextLine
    sections: TextLine = "blade"
    eigensolver: TextLine = "the adapters' own"


def extra(name: str) -> str:
    """The command that installs an extra of this package; from a checkout, until the package is published."""
    return f"pip install '.[{name}]' in a checkout of Southwell"


def shares(independence: Independence | None) -> SharedWithCore:
    """What a code with these origins shares with core."""
    if independence is None:
        return "undeclared"
    if independence.theory == CORE:
        return "discretisation"
    return "mechanical model" if CORE in vars(independence).values() else "nothing"


class CodeError(RuntimeError):
    """A code could not solve the problem; the message gives the reason."""


class Adapter(ABC):
    """What adapters for blades and for mechanisms have in common.

    Attributes:
        name: short and stable, as typed on the command line, e.g. ``exudyn-ancf``.
        title: as printed in tables, e.g. ``Exudyn, ANCF cable``.
        independence: the origins of its results; without them it does not count as confirmation.
        effects: the physical effects it includes.
        hint: how to install what it needs.
        distribution: the installed package whose release is the version; workers of a cluster must have the same.
    """

    name: str
    title: str
    independence: Independence | None = None
    effects: Effects = ALL_EFFECTS
    hint: str = ""
    distribution: str = ""

    def version(self) -> str | None:
        """Version of the code, without importing it; None if it is not installed."""
        try:
            return metadata.version(self.distribution)
        except metadata.PackageNotFoundError:
            return None


@dataclass(frozen=True)
class Deck:
    """The files of a blade, for a code that reads them itself.

    Attributes:
        format: of the files, as named by Southwell's readers.
        files: paths; the one that the user names first.
        digest: of their contents, which determines the answers.
        length: of the blade, m, if the user states it; None: as in the files.
        hub_radius: m; None: as in the files, else 0.
        multipliers: of mass, flapwise and edgewise stiffness of an ElastoDyn table, in place of the file's.
    """

    format: str
    files: tuple[str, ...]
    digest: str
    length: float | None = None
    hub_radius: float | None = None
    multipliers: tuple[float, float, float] | None = None


class BladeAdapter(Adapter):
    """Base class of adapters that compute a blade's modes.

    Attributes:
        levels: refinements, coarse to fine (elements, or terms); each at least 1.4 times the one before.
        order: theoretical order of convergence of its frequencies (0: spectral).
        motions: the motions in its shapes. Modes dominated by another motion are not compared; any other mode must have a
            partner.
        digits: significant digits of its frequencies that are printed or converged. Results that should be equal, such as
            those of a blade in other units, are compared to this precision.
        bracket: whether ``Modes.uncertainty`` is a rigorous bracket, which refinement does not narrow.
        finest: the finest refinement at which it is run, limited by its time or memory; None: eight times the last level.
        max_elements: the largest number of elements of its mesh, of which a blade with many kinks needs more than the
            refinement asked for; None: no limit.
    """

    levels: tuple[int, ...]
    order: int
    motions: tuple[Motion, ...] = MOTIONS
    digits: int = DIGITS
    bracket: bool = False
    finest: int | None = None
    max_elements: int | None = None

    @abstractmethod
    def unsupported(self, blade: Blade) -> str | None:
        """The reason, in one line, why this code cannot solve this blade; None if it can."""

    @abstractmethod
    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The ``count`` lowest modes of a supported blade (fewer only if there are fewer) at ``omega`` (rad/s).

        Raises:
            CodeError: no steady state, or no convergence.
        """

    def solve(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """Check that the blade is supported, and compute its modes; arguments as for ``modes``.

        Raises:
            CodeError: unsupported blade, no steady state, or no convergence.
        """
        if reason := self.unsupported(blade):
            raise CodeError(f"{blade.name}: {reason}")
        return self.modes(blade, omega, elements, count)

    def with_deck(self, deck: Deck) -> "BladeAdapter":
        """Return an adapter that solves the blade of a deck, which the code reads itself."""
        raise CodeError("this code reads no files")

    def fingerprint(self, blade: Blade, elements: int) -> Fingerprint | None:
        """Mass and inertia of the model that the code assembles of a supported blade; None if they cannot be obtained.

        They are compared with a quadrature of the stations as a second reader sees them, so that an error in the sampling
        of the stations is found by name. Return numbers of the code's own matrices, not of ``blade``.
        """
        return None

    def limit(self, elements: int) -> None:
        """Check the number of elements of a mesh.

        Raises:
            CodeError: more than ``max_elements``.
        """
        if self.max_elements and elements > self.max_elements:
            raise CodeError(
                f"elements: {elements}: {self.name} allows {self.max_elements}, since its time or memory grows as their "
                "square or cube; use fewer"
            )


@dataclass(frozen=True)
class MechanismModes:
    """A mechanism's modes about its steady state.

    Attributes:
        coordinates: names of the code's k coordinates; those of cut joints may be missing.
        steady: (k,) their steady values, m or rad.
        values: (m,) eigenvalues λ, 1/s, sorted by modulus: one of each conjugate pair, and the real ones.
        shapes: (m, k) motion of the coordinates in each mode, any scale.
    """

    coordinates: tuple[str, ...]
    steady: NDArray[np.float64]
    values: Complex
    shapes: Complex

    def __post_init__(self) -> None:
        m, k = len(self.values), len(self.coordinates)
        if self.shapes.shape != (m, k) or self.steady.shape != (k,):
            raise ValueError(f"shapes: {self.shapes.shape}, steady: {self.steady.shape}, expected {(m, k)} and {(k,)}")
        if not (np.isfinite(self.values).all() and np.isfinite(self.shapes).all() and np.isfinite(self.steady).all()):
            raise ValueError("eigenvalues, shapes or steady state are not finite")


class MechanismAdapter(Adapter):
    """Base class of adapters that compute a mechanism's modes. A code may be a ``BladeAdapter`` as well."""

    @abstractmethod
    def unsupported_mechanism(self, mechanism: "Mechanism") -> str | None:
        """The reason, in one line, why this code cannot solve this mechanism; None if it can."""

    @abstractmethod
    def mechanism_modes(self, mechanism: "Mechanism", guess: Mapping[str, float]) -> MechanismModes:
        """All modes of a supported mechanism about the steady state near ``guess``.

        Raises:
            CodeError: no steady state, or no convergence.
        """

    def solve_mechanism(self, mechanism: "Mechanism", guess: Mapping[str, float]) -> MechanismModes:
        """Check that the mechanism is supported, and compute its modes; arguments as for ``mechanism_modes``.

        Raises:
            CodeError: unsupported mechanism, no steady state, or no convergence.
        """
        if reason := self.unsupported_mechanism(mechanism):
            raise CodeError(reason)
        return self.mechanism_modes(mechanism, guess)
