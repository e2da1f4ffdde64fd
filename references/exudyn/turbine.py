"""Exudyn's kinematic tree of a whole turbine: tower and blades as rigid segments on elastic hinges.

The segments are those of ``hinged_segments``: the data of the deck, divided here, without core's elements, frames or reduction
to few motions. Exudyn computes kinematics and inertia forces and linearises the whole machine at three azimuths; Fourier
coordinates of the blades remove the azimuth (``matrices.rotating``). The blades are in balance at the rotor speed, and the
tower under the weight of all that it carries, as if the rotor were rigid: gravity does not act on the blades' own motions,
which it would make periodic.
"""

import numpy as np
from numpy.typing import NDArray

from ...core.blade import BEND_Y, BEND_Z, Blade
from ...core.effects import ALL_EFFECTS
from ...core.turbine.turbine import Turbine
from ..matrices import rotating
from ..matrices.quadratic import gyroscopic_modes
from ..protocol.fingerprint import Fingerprint
from ..protocol.interface import Independence
from ..protocol.turbines import TurbineAdapter, TurbineModes
from ..theories import turbine_motion, turbine_tree
from ..theories.reference_line import line
from ..theories.turbine_tree import NOTHING, PLACING, Body, Chain, TurbineTree
from . import system as ex
from . import tower_weight
from .hinged_segments import SEGMENTS, HingedSegments, hinge_segments, root_segment
from .tree import JOINT, linearize

Array = NDArray[np.float64]


class ExudynTurbine(TurbineAdapter):
    """See the module."""

    name = "exudyn-turbine"
    title = "Exudyn, kinematic tree of the turbine"
    independence = Independence(
        "Exudyn",
        SEGMENTS,
        "Exudyn",
        sections=PLACING,
        eigensolver="the adapters' own, in Fourier coordinates of the blades",
    )
    effects = ALL_EFFECTS
    levels = (12, 18, 27)
    order = 2
    finest = 60
    hint = ex.HINT
    distribution = ex.DISTRIBUTION

    def unsupported_turbine(self, turbine: Turbine) -> str | None:
        """A reason if ``turbine_tree.outside`` gives one, or if a beam is rigid in bending."""
        tower, blade = turbine.tower, turbine.blade
        if reason := turbine_tree.outside(turbine):
            return reason
        if any(np.isinf(b.stiffness[:, [BEND_Y, BEND_Z], [BEND_Y, BEND_Z]]).any() for b in (tower, blade)):
            return "rigid in bending: a hinge needs finite EI_y and EI_z"
        return None

    def turbine_modes(self, turbine: Turbine, omega: float, elements: int, count: int) -> TurbineModes:
        """The lowest modes; see ``protocol.turbines``.

        Raises:
            CodeError: no stable steady state at this speed, or equations that change with the azimuth.
        """
        segments = hinge_segments(turbine.blade, elements, omega, equal=True)
        tree = _tree(turbine, segments, elements)
        M, C, K, at_blade = linearize(segments, omega)
        q = np.zeros(len(tree.strain))
        q[tree.tower], weight = tower_weight.standing(tree)
        q[tree.blades] = at_blade

        def at(psi: float) -> tuple[Array, Array, Array]:
            M, C, K = _linearized(tree, q, omega, psi)
            K[np.ix_(tree.tower, tree.tower)] += weight
            return turbine_motion.with_generator(tree, q, M, C, K)

        groups = [[int(k) - 1 for k in joint] for joint in tree.blades.T]  # without the azimuth
        lowest = float(gyroscopic_modes(M, C, K, 1)[0][0])
        values, x = rotating.lowest(at, omega, groups, count, lowest, turbine.drivetrain.free)
        full = np.insert(x, tree.spin, 0.0, axis=0)[: len(q)]
        return TurbineModes(values, turbine_motion.shapes(tree, q, full), elements)

    def turbine_fingerprint(self, turbine: Turbine, elements: int) -> Fingerprint:
        """Of Exudyn's mass matrix at rest."""
        segments = hinge_segments(turbine.blade, elements, equal=True)
        tree = _tree(turbine_tree.floating(turbine), segments, elements)
        M, _, _ = _linearized(tree, np.zeros(len(tree.strain)), 0.0, 0.0)
        return turbine_tree.weighed(tree, M, elements)


def _tree(turbine: Turbine, segments: HingedSegments, elements: int) -> TurbineTree:
    tower = hinge_segments(turbine.tower, elements, equal=True)
    return turbine_tree.build(turbine, chain(turbine.tower, tower), chain(turbine.blade, segments))


def chain(blade: Blade, segments: HingedSegments) -> Chain:
    """Hinged segments as a chain of joints."""
    bodies = [NOTHING] * len(segments.strain)
    for link, mass, centre, moments in zip(
        segments.segment, segments.mass, segments.centre, segments.inertia, strict=True
    ):
        bodies[link] = Body(float(mass), centre, moments)
    mass, centre, moments = root_segment(blade, segments.start)
    return Chain(
        strain=segments.strain,
        stiffness=np.diag(segments.stiffness) + segments.coupling.toarray(),
        offset=segments.offset,
        axes=segments.rotation,
        bodies=tuple(bodies),
        root=Body(float(mass), centre, moments),
        base=line(blade, np.zeros((1, 1))).position[0, 0],
        nodes=segments.segment,
        reach=segments.reach,
        arc=segments.ends[1:],
        tip=(segments.reach[-1], np.eye(3)),
    )


def _linearized(tree: TurbineTree, q: Array, omega: float, psi: float) -> tuple[Array, Array, Array]:
    """Exudyn's M, C, K (n, n) at an azimuth, with the springs of all joints."""
    exu, _container, mbs = ex.system()
    at, rates = q.copy(), np.zeros(len(q))
    at[tree.spin], rates[tree.spin] = psi, omega
    links = ex.Links(
        joints=[JOINT[strain] for strain in tree.strain],
        parents=tree.parent,
        axes=tree.axes,
        offset=tree.offset,
        mass=np.array([body.mass for body in tree.bodies]),
        centre=np.array([body.centre for body in tree.bodies]),
        moments=np.array([body.moments for body in tree.bodies]),
    )
    ex.add_tree(exu, mbs, links, at, rates)
    mbs.Assemble()
    M, C, K = ex.linearized(exu, mbs, at_rest=not omega, full=True)
    return M, C, K + tree.stiffness


CODE = ExudynTurbine()
