"""What a code must offer to take part: a name, a version, what it can do, and modes.

Laws every code keeps:

* it solves the blade it is given, all of it, or says in ``unsupported`` why it cannot: no property silently dropped;
* effects it lacks by construction are declared in ``model``, so that core can leave out the same;
* frames and units are converted inside the adapter; what comes back is in the axes of ``core.blade``, SI;
* ``solve`` is a pure function of its arguments: the same call gives the same answer in any order, in any process.
"""

from typing import Literal, Protocol

from ...core.blade import Blade
from ...core.effects import Model
from ...core.modes import Modes

Shares = Literal["nothing", "mechanical model", "discretisation"]


DIGITS = 9
"""Of a code that declares none."""


class CodeError(RuntimeError):
    """A code ran and could not answer; the message says why."""


class Code(Protocol):
    """One source of natural frequencies.

    Attributes:
        name: short and stable, as typed on the command line: ``exudyn-ancf``.
        title: as printed in a table: ``Exudyn, ANCF cable``.
        shares: what it shares with core; two codes that share their mechanical model are one witness, not two.
        model: the physical effects it keeps.
        levels: refinements to use, coarse to fine (elements, or terms); each at least 1.4 times the one before.
        order: the theoretical order of convergence of its frequencies (0: spectral).
        hint: how to install what it needs.

    A code that prints, or iterates to, fewer than nine significant digits of its frequencies says so: ``digits: int``. No more
    is then asked of two answers that should be the same, as of a blade in other units.
    """

    name: str
    title: str
    shares: Shares
    model: Model
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
