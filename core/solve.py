"""A blade's natural frequencies and mode shapes: the public door of the in-house solver."""

import time
from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from .blade import Blade, without_rotary_inertia
from .chain import pencil, steady
from .chain.lanczos import lanczos
from .chain.mode_shapes import mode_shapes
from .chain.pencil import Shape
from .chain.steady import Steady
from .effects import FULL, Model
from .eigen import UnstableError
from .element.discretize import Chain, Mass, discretize
from .element.measures import Measure
from .modes import Modes

Array = NDArray[np.float64]

NO_GRAVITY = np.zeros(3)


def modes(
    blade: Blade,
    omega: float,
    elements: int = 50,
    count: int = 10,
    *,
    mass: Mass = "consistent",
    stiffness: Measure = "corotational",
    model: Model = FULL,
    gravity: Array = NO_GRAVITY,
    load: Array | None = None,
) -> Modes:
    """The lowest modes of a blade turning steadily at ``omega``.

    Args:
        blade: the blade.
        omega: rotor speed, rad/s.
        elements: how many beam elements.
        count: how many modes (fewer if the discretisation has fewer).
        mass: ``consistent`` (fourth order) or ``half_end`` (lumped, Park et al. 2010; second order).
        stiffness: ``corotational``, or ``parent``: linear in the parent body's frame (Park et al. 2010).
        model: physical effects kept.
        gravity: (3,) m/s², in the hub's axes at the azimuth of interest.
        load: (n, 3) steady force per length at the blade's stations, N/m, in the hub's axes, turning with them.

    Raises:
        ValueError: elements or count below 1, omega not finite, a load of another form.
        SteadyStateError: no steady state at this speed.
        UnstableError: the steady state is not stable.
    """
    one = sweep(
        blade, [omega], elements, count, mass=mass, stiffness=stiffness, model=model, gravity=gravity, load=load
    )
    return next(one)


def sweep(
    blade: Blade,
    omegas: Iterable[float],
    elements: int = 50,
    count: int = 10,
    *,
    mass: Mass = "consistent",
    stiffness: Measure = "corotational",
    model: Model = FULL,
    gravity: Array = NO_GRAVITY,
    load: Array | None = None,
) -> Iterator[Modes]:
    """The modes at one speed after another, as they are had; arguments and errors as for ``modes``.

    The blade is divided once, and each steady state is sought from where those before lead to.
    """
    if count < 1:
        raise ValueError(f"count: {count}: ask for at least one mode")
    body = discretize(blade if model.rotary_inertia else without_rotary_inertia(blade), elements, mass, stiffness, load)
    return _along(body, omegas, count, model, gravity)


def chain_modes(
    body: Chain, omega: float, count: int = 10, *, model: Model = FULL, gravity: Array = NO_GRAVITY
) -> Modes:
    """The lowest modes of a chain; arguments and errors as for ``modes``."""
    return next(_along(body, [omega], count, model, gravity))


def _along(body: Chain, omegas: Iterable[float], count: int, model: Model, gravity: Array) -> Iterator[Modes]:
    known: list[tuple[float, Shape]] = []
    for omega in omegas:
        if not np.isfinite(omega):
            raise ValueError(f"omega: {omega}: give a finite rotor speed in rad/s")
        begun = time.perf_counter()
        state = balance(body, omega, gravity, model, steady.extrapolate(known, omega))
        try:
            found = lanczos(state.linear, count)
        except (UnstableError, ArithmeticError) as error:  # not positive definite, or too nearly not
            loose = "; or nothing holds a free hinge (at rest; lead–lag without offset)" if body.held.size else ""
            raise UnstableError(f"omega: {omega:.6g} rad/s: {error}{loose}") from error
        shapes = mode_shapes(body, state.shape, found.vectors)
        yield Modes(omega, found.frequencies, shapes, body.elements, seconds=time.perf_counter() - begun)
        known = [*known[-steady.ORDER :], (omega, state.shape)]


def balance(body: Chain, omega: float, gravity: Array, model: Model, guess: Shape | None = None) -> Steady:
    """The steady state that the model has, and the pencil about it."""
    if model.geometric and model.prestretch:
        state = steady.steady(body, omega, gravity, guess)
        return (
            state if model == FULL else Steady(state.shape, pencil.linearize(body, state.shape, omega, gravity, model))
        )
    still = pencil.rest(body)
    loaded = steady.prestress_at_rest(body, omega, gravity) if model.geometric else body
    return Steady(still, pencil.linearize(loaded, still, omega, gravity, model))
