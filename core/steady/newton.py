"""Damped Newton's method for steady states: one loop, for which a blade and a mechanism supply the balance of forces."""

from typing import Protocol, Self, TypeVar

_MAX_ITERATIONS = 60


class Iterate(Protocol):
    """A configuration with its unbalanced forces and their derivative.

    The balance of a blade (``blade_state``) is linear in the number of elements; that of a mechanism (``balance``) is dense
    and has closed loops. docs/engine.md explains why they judge convergence and steps differently.
    """

    def converged(self, previous: Self | None) -> bool:
        """Whether the forces balance up to rounding; ``previous``: the iterate before."""
        ...

    def following(self) -> Self | None:
        """The iterate after Newton's step, which may be damped; None if the step does not lead towards a solution."""
        ...


Point = TypeVar("Point", bound=Iterate)


def newton(start: Point) -> Point | None:
    """The converged iterate; None if the iteration fails."""
    previous, current = None, start
    for _ in range(_MAX_ITERATIONS):
        if current.converged(previous):
            return current
        previous, current = current, current.following()
        if current is None:
            return None
    return None
