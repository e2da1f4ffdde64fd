"""What a code must offer to take part: a name, a version, what it can do, and modes.

Laws every code keeps:

* it solves the blade it is given, all of it, or says in ``unsupported`` why it cannot: no property silently dropped;
* effects it lacks by construction are declared in ``effects``, so that core can leave out the same;
* frames and units are converted inside the adapter; what comes back is in the axes of ``core.blade``, SI;
* ``solve`` is a pure function of its arguments: the same call gives the same answer in any order, in any process.
"""

from dataclasses import dataclass
from typing import Literal, Protocol, get_args

from ...core.blade import Blade
from ...core.effects import Effects
from ...core.modes import Modes

Shares = Literal["nothing", "mechanical model", "discretisation"]

Motion = Literal["axial", "chordwise", "flapwise", "torsion"]

MOTIONS: tuple[Motion, ...] = get_args(Motion)
"""What the four columns of a shape are, in a blade that lies along x: motion along x, y, z, and rotation about x."""

DIGITS = 9
"""Of a code that declares none."""


@dataclass(frozen=True)
class Independence:
    """Where a code's answer comes from, in names that are equal where the origin is.

    Two codes with the same ``engine``, ``theory`` or ``rotation`` are one confirmation, not two. One that has ``CORE`` anywhere
    is no independent one: it confirms that core solves its own model. That ``sections`` or ``eigensolver`` are the same is
    shown and not counted: all codes read the same blade, and the adapters' eigensolver, ``references.quadratic``, is verified
    by itself, against SciPy's dense eigenvalues of the state-space matrix in ``tests/cases/judge/test_groups.py``.

    Attributes:
        engine: the program that assembles the equations of motion: ``Exudyn``.
        theory: whose derivation, discretised how, the matrices are: ``ANCF cable``.
        rotation: where centrifugal and gyroscopic terms come from.
        sections: where geometry and section data come from: ``blade`` (the adapter reads it itself) or core's frames.
        eigensolver: what solves the eigenproblem.
    """

    engine: str
    theory: str
    rotation: str
    sections: str = "blade"
    eigensolver: str = "references.quadratic"


CORE = "core"
"""Of a declaration: it is core's own."""


class CodeError(RuntimeError):
    """A code ran and could not answer; the message says why."""


class Code(Protocol):
    """One source of natural frequencies.

    Attributes:
        name: short and stable, as typed on the command line: ``exudyn-ancf``.
        title: as printed in a table: ``Exudyn, ANCF cable``.
        shares: what it shares with core; two codes that share their mechanical model are one witness, not two.
        effects: the physical effects it keeps.
        levels: refinements to use, coarse to fine (elements, or terms); each at least 1.4 times the one before.
        order: the theoretical order of convergence of its frequencies (0: spectral).
        hint: how to install what it needs.

    Three more are optional:

    * ``independence: Independence``, without which the code confirms nothing: see there;
    * ``motions: tuple[Motion, ...]``, those that its shapes have, if not all four; modes that mostly move otherwise are not
      compared, and nothing else excuses a mode without a partner;
    * ``bracket: bool``, true if ``Modes.uncertainty`` is a rigorous bracket of the code's own, not narrowed by refinement;
    * ``digits: int``, of a code that prints, or iterates to, fewer than nine significant digits of its frequencies. No more is
      then asked of two answers that should be the same, as of a blade in other units.
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
        """Why this code cannot solve this blade, or None if it can."""
        ...

    def solve(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The ``count`` lowest modes (fewer only if there are fewer) at rotor speed ``omega`` (rad/s).

        Raises:
            CodeError: if the code ran and could not answer (no steady state, no convergence).
        """
        ...


def digits(code: Code) -> int:
    """Significant digits that its frequencies have: its own declaration, if it has one."""
    return getattr(code, "digits", DIGITS)


def motions(code: Code) -> tuple[Motion, ...]:
    """Motions that its shapes have: its own declaration, or all."""
    return getattr(code, "motions", MOTIONS)


def brackets(code: Code) -> bool:
    """Whether it declares that it brackets its own answer."""
    return bool(getattr(code, "bracket", False))


def independence(code: object) -> Independence | None:
    """What it declares about itself; None if nothing."""
    return getattr(code, "independence", None)
