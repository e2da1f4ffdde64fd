"""The interface of a code: name, version, declarations and modes.

Rules for every code:

* it represents every property of a blade, or ``unsupported`` returns the reason why it cannot; no property is ignored;
* ``effects`` declares the effects it lacks by construction, and core is then compared without them;
* the adapter converts axes and units; results are in the axes of ``core.blade`` and in SI units;
* ``solve`` is a pure function of its arguments: the same call gives the same result in any order and any process.
"""

from dataclasses import dataclass
from typing import Literal, Protocol, get_args

from ...core.blade import Blade
from ...core.effects import Effects
from ...core.modes import Modes

Shares = Literal["nothing", "mechanical model", "discretisation"]

Motion = Literal["axial", "edgewise", "flapwise", "torsion"]

MOTIONS: tuple[Motion, ...] = get_args(Motion)
"""The four columns of a shape of a blade along x: displacement along x, y, z, and rotation about x."""

DIGITS = 9
"""Significant digits of a code that declares none."""


@dataclass(frozen=True)
class Independence:
    """The origin of a code's results. The same origin must have the same name in every code.

    Two codes with the same ``engine``, ``theory`` or ``rotation`` count as one confirmation. A code with ``CORE``
    anywhere is not independent: it confirms only that core solves its model correctly. The same ``sections`` or
    ``eigensolver`` are shown but do not count: all codes read the same blade, and the adapters' eigensolver,
    ``references.protocol.quadratic``, is verified separately, against SciPy's dense eigenvalues of the state-space
    matrix in ``tests/cases/judge/test_groups.py``.

    Attributes:
        engine: the program that assembles the equations of motion, e.g. ``Exudyn``.
        theory: the derivation and discretisation of the matrices, e.g. ``ANCF cable``.
        rotation: origin of the centrifugal and gyroscopic terms.
        sections: origin of geometry and section data: ``blade`` (the adapter reads them) or core's frames.
        eigensolver: what solves the eigenproblem.
    """

    engine: str
    theory: str
    rotation: str
    sections: str = "blade"
    eigensolver: str = "the adapters' own"


CORE = "core"
"""An origin in ``Independence`` that is core."""


class CodeError(RuntimeError):
    """A code could not solve the blade; the message gives the reason."""


class Code(Protocol):
    """One source of natural frequencies.

    Attributes:
        name: short and stable, as typed on the command line, e.g. ``exudyn-ancf``.
        title: as printed in tables, e.g. ``Exudyn, ANCF cable``.
        shares: what it shares with core.
        effects: the physical effects it includes.
        levels: refinements, coarse to fine (elements, or terms); each at least 1.4 times the one before.
        order: theoretical order of convergence of its frequencies (0: spectral).
        hint: how to install what it needs.

    Optional attributes:

    * ``independence: Independence``; without it the code does not count as confirmation;
    * ``motions: tuple[Motion, ...]``, the motions in its shapes, if not all four. Modes dominated by another motion are
      not compared; any other mode must have a partner;
    * ``bracket: bool``, true if ``Modes.uncertainty`` is a rigorous bracket, which refinement does not narrow;
    * ``distribution: str``, the installed package whose release is ``version()``; workers of a cluster must have the same;
    * ``digits: int``, for a code that prints, or converges to, fewer than nine significant digits of its frequencies.
      Results that should be equal, such as those of a blade in other units, are then compared to this precision.
    """

    name: str
    title: str
    shares: Shares
    effects: Effects
    levels: tuple[int, ...]
    order: int
    hint: str

    def version(self) -> str | None:
        """Version of the foreign code, or None if it is not installed."""
        ...

    def unsupported(self, blade: Blade) -> str | None:
        """The reason why this code cannot solve this blade; None if it can."""
        ...

    def solve(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The ``count`` lowest modes (fewer only if there are fewer) at rotor speed ``omega`` (rad/s).

        Raises:
            CodeError: unsupported blade, no steady state, or no convergence.
        """
        ...


def digits(code: Code) -> int:
    """Significant digits of its frequencies: as declared, or ``DIGITS``."""
    return getattr(code, "digits", DIGITS)


def motions(code: Code) -> tuple[Motion, ...]:
    """Motions in its shapes: as declared, or all."""
    return getattr(code, "motions", MOTIONS)


def brackets(code: Code) -> bool:
    """Whether it declares that its uncertainty is a rigorous bracket."""
    return bool(getattr(code, "bracket", False))


def distribution(code: object) -> str:
    """The installed package that gives its version; empty if it declares none."""
    return getattr(code, "distribution", "")


def independence(code: object) -> Independence | None:
    """Its declared origins; None if it declares none."""
    return getattr(code, "independence", None)
