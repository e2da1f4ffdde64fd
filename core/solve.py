"""A blade's natural frequencies and mode shapes: the public interface of the solver."""

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from inspect import Parameter, signature
from typing import Concatenate, ParamSpec

import numpy as np
from numpy.typing import NDArray

from .blade import Blade, without_rotary_inertia
from .effects import ALL_EFFECTS, Effects
from .element.discretize import Mass, discretize
from .element.measures import LARGEST_STRAIN, Measure
from .element.mesh import Mesh
from .modes import Modes
from .spectrum import mesh_solver
from .spectrum.mesh_solver import Options, Start
from .spectrum.refinement import AtSpeed, Key, Meshes, Starts, as_given, refined, without_bias
from .steady.blade_state import LargeStrainError
from .threads import one_thread

Array = NDArray[np.float64]

NO_GRAVITY = np.zeros(3)

P = ParamSpec("P")


def sweep(
    blade: Blade,
    omegas: Iterable[float],
    elements: int | None = None,
    count: int = 10,
    *,
    accuracy: float = 1e-6,
    mass: Mass = "consistent",
    stiffness: Measure = "corotational",
    effects: Effects = ALL_EFFECTS,
    gravity: Array = NO_GRAVITY,
    load: Array | None = None,
    allow_large_strain: bool = False,
) -> Iterator[Modes]:
    """Yield the lowest modes of a blade in steady rotation at one speed after another, with their relative uncertainties.

    Meshes are kept until |omega| exceeds the power of two for which they were graded. Newton's method starts from an
    extrapolation of the previous steady states.

    Args:
        blade: the blade.
        omegas: rotor speeds, rad/s.
        elements: number of beam elements, of equal length. By default a mesh graded towards the root is refined until
            ``accuracy`` is met, and the frequencies are extrapolated (Richardson).
        count: number of modes (fewer if the discretisation has fewer).
        accuracy: largest relative uncertainty of a frequency if ``elements`` is not given; ``AccuracyWarning`` if it cannot
            be met with ``MAX_ELEMENTS`` elements or because of rounding.
        mass: ``consistent`` (fourth order) or ``half_end`` (lumped, Park et al. 2010; second order).
        stiffness: ``corotational``, or ``body_fixed``: linear in the parent body's frame (Park et al. 2010).
        effects: physical effects included.
        gravity: (3,) m/s², in the hub's axes at the azimuth of interest.
        load: (n, 3) steady force per length at the blade's stations, N/m, in the rotating axes of the hub.
        allow_large_strain: accept steady strains above ``LARGEST_STRAIN``.

    Raises:
        ValueError: elements or count below 1, omega not finite, accuracy not positive, or a load of the wrong shape.
        SteadyStateError: no steady state at this speed.
        LargeStrainError: steady strains above ``LARGEST_STRAIN``.
        UnstableError: the steady state is not stable.
        EigensolverError, MissedModesError: the eigensolver failed.
    """
    if not accuracy > 0:
        raise ValueError(f"accuracy: {accuracy}: give a positive relative number, such as 1e-6")
    body = blade if effects.rotary_inertia else without_rotary_inertia(blade)
    meshes = Meshes(body, Options(count, effects, gravity), mass, stiffness, load)
    starts: Starts = {}
    for omega in _checked(omegas, count):
        start_time = time.perf_counter()
        if abs(omega) > meshes.grading_speed:  # the graded mesh is made for a range of speeds, up to a power of two
            meshes, starts = replace(meshes, grading_speed=2.0 ** np.ceil(np.log2(abs(omega)))), {}
        with one_thread():
            result, starts = (
                refined(meshes, omega, accuracy, starts)
                if elements is None
                else as_given(meshes, omega, elements, starts)
            )
        if result.strain > LARGEST_STRAIN and not allow_large_strain:
            raise LargeStrainError(
                f"omega: {omega:.6g} rad/s: steady strain {result.strain:.0%}: too large for linear elastic sections: the "
                "speed is too high or the blade too soft; check units, or allow large strains"
            )
        yield replace(result, seconds=time.perf_counter() - start_time)


def mesh_sweep(
    blade: Blade,
    omegas: Iterable[float],
    elements: int,
    count: int = 10,
    *,
    mass: Mass = "consistent",
    stiffness: Measure = "corotational",
    effects: Effects = ALL_EFFECTS,
    gravity: Array = NO_GRAVITY,
    load: Array | None = None,
) -> Iterator[Modes]:
    """Yield the modes of one mesh, without uncertainties and at any strain, for refinement; otherwise as ``sweep``."""
    speeds = _checked(omegas, count)
    body = discretize(
        blade if effects.rotary_inertia else without_rotary_inertia(blade), elements, mass, stiffness, load
    )
    return _swept(body, speeds, Options(count, effects, gravity))


def _swept(mesh: Mesh, speeds: Iterator[float], options: Options) -> Iterator[Modes]:
    start = None
    for omega in speeds:
        with one_thread():
            solved = mesh_solver.solve(mesh, omega, options, start)
        start = solved.start
        yield solved.modes


def _checked(omegas: Iterable[float], count: int) -> Iterator[float]:
    """Yield the speeds lazily, validating each: the caller may choose the next one from earlier results."""
    if count < 1:
        raise ValueError(f"count: {count}: ask for at least one mode")
    for omega in omegas:
        if not np.isfinite(omega):
            raise ValueError(f"omega: {omega}: give a finite rotor speed in rad/s")
        yield float(omega)


def _at_one_speed(
    swept: Callable[Concatenate[Blade, Iterable[float], P], Iterator[Modes]],
) -> Callable[Concatenate[Blade, float, P], Modes]:
    """The function of a blade and one speed (rad/s) with the other arguments of ``swept``, shown by ``help`` with these."""

    def modes(blade: Blade, omega: float, /, *args: P.args, **kwargs: P.kwargs) -> Modes:
        return next(swept(blade, [omega], *args, **kwargs))

    original = signature(swept)
    blade, _, *rest = original.parameters.values()
    speed = Parameter("omega", Parameter.POSITIONAL_OR_KEYWORD, annotation=float)
    modes.__dict__["__signature__"] = original.replace(parameters=(blade, speed, *rest), return_annotation=Modes)
    modes.__doc__ = f"The modes at one speed ``omega``, rad/s; other arguments and errors as for ``{swept.__name__}``."
    return modes


modes = _at_one_speed(sweep)
"""The modes at one speed; arguments and errors as for ``sweep``."""

mesh_modes = _at_one_speed(mesh_sweep)
"""The modes of one mesh at one speed; arguments as for ``mesh_sweep``."""


def chain_modes(
    body: Mesh, omega: float, count: int = 10, *, effects: Effects = ALL_EFFECTS, gravity: Array = NO_GRAVITY
) -> Modes:
    """The lowest modes of a mesh, with ``rounding`` as the only error estimate; arguments and errors as for ``sweep``."""
    options = Options(count, effects, gravity)
    solved = mesh_solver.solve(body, next(_checked([omega], count)), options)
    return replace(solved.modes, rounding=mesh_solver.rounding(body, solved, options))


def rigid_strain_bias(
    blade: Blade,
    runs: Iterable[tuple[float, tuple[int, int]]],
    count: int,
    effects: Effects = ALL_EFFECTS,
) -> list[tuple[Array, Array]]:
    """Factor (m,) that removes the bias of rigid strains from the frequencies, and its relative uncertainty (m,), of each run.

    Rigid axial and torsional strains have a small compliance (``element.sections``), also in ``mesh_modes``. The bias is
    computed at a speed (rad/s) on two meshes, the finer one last; without rigid strains there is none.
    """
    meshes = Meshes(blade, Options(count, effects))
    if meshes.softened is None:
        return [(np.ones(count), np.zeros(count)) for _ in runs]
    starts: dict[Key, Start] = {}
    at = ((AtSpeed(meshes, omega, starts), elements) for omega, elements in runs)
    return [without_bias(*(speed.bias(Key(n), speed.solved(Key(n))) for n in elements)) for speed, elements in at]
