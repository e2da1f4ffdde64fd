"""The models between core's turbine and a linearisation, each with the modes that it has.

Core's turbine, which has the elastic modes of tower and blades; the same restricted to the deck's assumed shapes; ElastoDyn's
equations, which integrate these shapes over its nodes; the same with gravity on the blades; and at the deflections of the
operating point. Each has the degrees of freedom that the linearisation's states have, and no aerodynamics.
"""

from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import NDArray

from ....core.blade import straight
from ....core.effects import ALL_EFFECTS
from ....core.element.discretize import discretize
from ....core.spectrum import eigen
from ....core.spectrum.mesh_solver import balance
from ....core.threads import one_thread
from ....core.turbine import component
from ....core.turbine.assembly import assemble
from ....core.turbine.assumed import Assumed, Field, restricted_motions
from ....core.turbine.machine import Machine, Resolution, machine
from ...diagnosis.elastodyn_blade import OperatingPoint, field_of
from ...input.errors import CaseError
from ...input.readers.openfast.mode_shapes import Shape
from ..modes import MIN_OSCILLATION
from ..multiblade import fixed_frame
from ..sets import AzimuthSet
from . import elastodyn, fields
from .deck import Deck, for_states
from .elastodyn import Matrices, Structure, equations
from .fields import Points, Shapes
from .tower import tower

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

HUB = ("yaw", "generator", "drivetrain")


@dataclass(frozen=True)
class Degrees:
    """Degrees of freedom of a linearisation: motions of blades and tower with their assumed shapes, and of the hub.

    Attributes:
        blade: shapes of the blades' states; empty if these are not ElastoDyn's.
        tower: shapes of the tower's states.
        hub: which of ``HUB``.
        order: of BeamDyn's only element in each blade; None if there is none, or several.
    """

    blade: dict[str, Shape]
    tower: dict[str, Shape]
    hub: tuple[str, ...]
    order: int | None = None


def degrees(deck: Deck, azimuth_set: AzimuthSet) -> Degrees:
    """The degrees of freedom of a set.

    Raises:
        CaseError: the set moves in a way that the machine does not, or has another number of blades.
    """
    rate_of = dict(azimuth_set.pairs)
    moving = [state for k, state in enumerate(azimuth_set.states) if k in rate_of]
    names = {state.family for state in moving if not state.blade}
    unsupported = sorted(names - {*deck.tower_shapes, *HUB})
    if unsupported:
        raise CaseError(
            f"--fst: {azimuth_set.name}: state {unsupported[0]!r}: Southwell's turbine stands on rigid ground and has no such "
            "motion: leave out --fst"
        )
    if azimuth_set.blades != deck.turbine.blades or azimuth_set.blades == 2:
        raise CaseError(
            f"--fst: {azimuth_set.name}: {azimuth_set.blades} blades with states, {deck.turbine.blades} in the deck: give the "
            "deck of this linearisation, with one blade or three"
        )
    if azimuth_set.blades == 1 and names:
        raise CaseError(
            f"--fst: {azimuth_set.name}: one blade on a hub that moves is not constant in any frame: leave out --fst"
        )
    flexible = {state.family for state in moving if state.blade and state.module == "ED"}
    missing = sorted(flexible - set(deck.blade_shapes))
    if missing:
        raise CaseError(
            f"--fst: {azimuth_set.name}: state {missing[0]!r}: the deck's blades have no such shape: give its own deck"
        )
    return Degrees(
        {name: shape for name, shape in deck.blade_shapes.items() if name in flexible},
        {name: shape for name, shape in deck.tower_shapes.items() if name in names},
        tuple(name for name in HUB if name in names),
        next((state.element_order for state in moving if state.module == "BD" and state.blade), None),
    )


@dataclass(frozen=True)
class Models:
    """A deck as a set needs it.

    Attributes:
        deck, azimuth_set: the deck and the set.
        free: its degrees of freedom.
        at: points at which shapes are compared.
    """

    deck: Deck
    azimuth_set: AzimuthSet
    free: Degrees
    at: Points

    def core(self, restricted: bool) -> Shapes:
        """Modes of core's machine, free or restricted to the assumed shapes."""
        if self.azimuth_set.blades == 1:
            return _single(self, self.blade_field() if restricted else None)
        a = assemble(self.machine(restricted), self.azimuth_set.omega)
        rigid = np.zeros((len(a.M), 0))
        if "generator" in self.free.hub:
            rigid = np.zeros((len(a.M), 1))
            rigid[list(a.shaft)] = 1.0
        with one_thread():
            pairs = eigen.damped(a.M, a.C, a.K, None, (rigid, rigid) if rigid.size else None)
        return _shapes(pairs.values, pairs.vectors.T @ fields.of_core(self.deck, self.at, a))

    def machine(self, restricted: bool) -> Machine:
        """The machine on the degrees of freedom of the set."""
        turbine = for_states(self.deck, set(self.free.hub))
        flexible = None if self.free.tower and not restricted else field_of(turbine.tower, self.free.tower)
        return machine(turbine, Resolution(), Assumed(flexible, self.blade_field() if restricted else None))

    def blade_field(self) -> Field | None:
        """ElastoDyn's shapes or BeamDyn's element; None if neither is known, or the element is curved."""
        blade = self.deck.turbine.blade
        if self.free.blade:
            return field_of(blade, self.free.blade)
        return fields.element(blade.length, self.free.order) if self.free.order and straight(blade) else None

    def structure(self) -> Structure:
        """ElastoDyn's equations."""
        turbine = self.machine(True) if self.azimuth_set.blades > 1 else None
        part = tower(self.deck, turbine, self.free.tower, "yaw" in self.free.hub)
        return elastodyn.structure(self.deck, part, self.azimuth_set)


def matrices(model: Structure, azimuth_set: AzimuthSet, gravity: bool, deflected: bool) -> list[Matrices]:
    """ElastoDyn's M, C, K at each azimuth, with or without gravity on the blades and at its operating point."""
    out: list[Matrices] = []
    r = len(model.nodes.stiffness)
    blade_states, blade_rates = (
        index[len(model.families) :].reshape(model.blades, r) for index in (model.coordinates, model.rates)
    )
    factor = 1.0 if deflected else 0.0
    for k, file in enumerate(azimuth_set.files):
        at = tuple(
            OperatingPoint(
                factor * azimuth_set.values[k][q],
                factor * azimuth_set.values[k][v],
                factor * np.nan_to_num(azimuth_set.accelerations[k][v]),
            )
            for q, v in zip(blade_states, blade_rates, strict=True)
        )
        weight = model.deck.turbine.gravity if gravity else 0.0
        out.append(equations(model, float(azimuth_set.azimuths[k]), file.rotor_speed, weight, at))
    return out


def of_states(models: Models, A: Array) -> Shapes:
    """Modes of state matrices (azimuth, s, s) in the states of the set, of their mean in the fixed frame."""
    mean = fixed_frame(models.azimuth_set, A).mean(axis=0)
    values, vectors = cast("tuple[Complex, Complex]", np.linalg.eig(mean.astype(np.complex128)))
    kept_indices = np.flatnonzero(values.imag > MIN_OSCILLATION)
    kept_indices = kept_indices[np.argsort(np.abs(values[kept_indices]), kind="stable")]
    shapes: Complex = vectors[:, kept_indices].T @ fields.of_states(models.deck, models.at, models.azimuth_set).astype(
        np.complex128
    )
    return Shapes(values[kept_indices], shapes)


def _single(models: Models, restricted: Field | None) -> Shapes:
    """Modes of one blade on a hub that turns steadily."""
    blade = models.deck.turbine.blade
    with one_thread():
        mesh = discretize(blade, Resolution().blade_elements)
        state = balance(mesh, models.azimuth_set.omega, np.zeros(3), ALL_EFFECTS)
        if restricted is None:
            part = component.reduced_component(mesh, state, Resolution().blade_modes)
        else:
            part = component.restricted(mesh, state, restricted_motions(blade, mesh, restricted))
        r = part.size
        pairs = eigen.damped(part.M[:r, :r], part.C[:r, :r], part.K[:r, :r])
    displacements = fields.of_blade(models.deck, models.at, mesh, state.pencil.links, part.vectors)
    field = np.zeros((r, models.at.size))
    start = 2 * len(models.at.tower) + 1
    field[:, start : start + 2 * len(models.at.blade)] = displacements.reshape(r, -1)
    return _shapes(pairs.values, pairs.vectors.T @ field)


def _shapes(values: Complex, shapes: Complex) -> Shapes:
    kept_indices = np.flatnonzero((values.imag > 0) & (np.abs(shapes) ** 2).sum(1).astype(bool))
    return Shapes(values[kept_indices], shapes[kept_indices])
