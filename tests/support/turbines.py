"""A small turbine, and the same as a general mechanism: every element a beam between two bodies."""

import numpy as np

from southwell import multibody as mb
from southwell.core.blade import Blade, section_mass, section_stiffness
from southwell.core.element.discretize import discretize
from southwell.core.element.mesh import Mesh
from southwell.core.space import spatial as sp
from southwell.core.space.inertia import transformed
from southwell.core.tree.as_mechanism import single_element
from southwell.core.turbine.machine import Resolution
from southwell.core.turbine.turbine import Drivetrain, Turbine, shaft_pose

SMALL = Resolution(tower_elements=2, blade_elements=2, tower_modes=6, blade_modes=8)


def beam(name: str, length: float, EI: tuple[float, float], mass: float, **options) -> Blade:
    """A uniform beam whose sections have rotary inertia, and no rigid strains."""
    return Blade(
        name=name,
        stations=np.array([0.0, length]),
        stiffness=np.repeat(section_stiffness(1e9, 3e7, *EI), 2, axis=0),
        mass=np.repeat(section_mass(mass, 0.1 * mass, 0.12 * mass), 2, axis=0),
        twist=np.zeros(2),
        **options,
    )


def small(yaw: float = np.inf, drivetrain: Drivetrain | None = None, blades: int = 3) -> Turbine:
    """A turbine of 20 m with tilted shaft, overhang, cone, pitch and an eccentric nacelle, without gravity."""
    nacelle = mb.inertia(800.0, (300.0, 500.0, 400.0), (0.6, 0.1, 0.5))
    return Turbine(
        name="small",
        tower=beam("tower", 20.0, (3.0e7, 2.5e7), 90.0),
        blade=beam("blade", 9.0, (5e5, 1.1e6), 12.0, hub_radius=0.5, precone=-0.04, pitch=0.1),
        blades=blades,
        nacelle=nacelle,
        hub=mb.inertia(200.0, (30.0, 30.0, 50.0)),
        shaft=shaft_pose(0.7, -1.5, -0.09),
        yaw=yaw,
        drivetrain=drivetrain or Drivetrain(),
        gravity=0.0,
    )


def as_mechanism(turbine: Turbine, how: Resolution, omega: float) -> mb.Mechanism:
    """The same machine; the generator is locked."""
    tower, blade = discretize(turbine.tower, how.tower_elements), discretize(turbine.blade, how.blade_elements)
    bodies, joints, beams = [], [], []

    def add(name: str, mesh: Mesh, on: str, at: np.ndarray) -> str:
        bodies.append(mb.Body(f"{name}0", mesh.lumps[0]))
        joints.append(mb.Joint(f"{name}root", "fixed", on, f"{name}0", at))
        for k in range(len(mesh.parent)):
            a, b = f"{name}{k}", f"{name}{k + 1}"
            bodies.append(mb.Body(b, mesh.lumps[k + 1]))
            joints.append(mb.Joint(f"{name}e{k}", "elastic", a, b, mesh.between[k]))
            beams.append(mb.Beam(a, b, single_element(mesh.beams, k), at_b=mesh.corner[k]))
        return f"{name}{len(mesh.parent)}"

    top = add("t", tower, "ground", np.eye(4))
    bodies += [mb.Body("nacelle", turbine.nacelle), mb.Body("shaft"), mb.Body("hub", turbine.hub)]
    yaw_axis = mb.at(axis="x")
    springs = []
    if np.isinf(turbine.yaw):
        joints.append(mb.Joint("yaw", "fixed", top, "nacelle"))
    else:
        joints.append(mb.Joint("yaw", "revolute", top, "nacelle", yaw_axis, yaw_axis))
        springs.append(mb.CoordinateSpring("yaw.rz", turbine.yaw))
    stiffness = turbine.drivetrain.stiffness
    joints.append(
        mb.Joint("torsion", "fixed" if np.isinf(stiffness) else "revolute", "nacelle", "shaft", turbine.shaft)
    )
    if not np.isinf(stiffness):
        springs.append(mb.CoordinateSpring("torsion.rz", stiffness))
    if turbine.teeter is None:
        joints.append(mb.Joint("spin", "revolute", "shaft", "hub"))
    else:
        pin = mb.at(z=turbine.teeter.undersling, axis="y")
        bodies.append(mb.Body("spinning"))
        joints.append(mb.Joint("spin", "revolute", "shaft", "spinning"))
        joints.append(mb.Joint("teeter", "revolute", "spinning", "hub", pin, pin))
        springs.append(mb.CoordinateSpring("teeter.rz", turbine.teeter.stiffness))
    for k in range(turbine.blades):
        turn = sp.pose(sp.rotation(2, np.array(2 * np.pi * k / turbine.blades)), np.zeros(3))
        add("pqrs"[k], blade, "hub", turn @ blade.nodes[0])
    return mb.Mechanism(
        bodies=tuple(bodies),
        joints=tuple(joints),
        motions=(mb.Motion("spin.rz", rate=omega),),
        coordinate_springs=tuple(springs),
        beams=tuple(beams),
    )


def rigid_nacelle_and_rotor(turbine: Turbine, rotor: np.ndarray) -> np.ndarray:
    """(6, 6) inertia at the tower's top of nacelle and rotor."""
    return np.ascontiguousarray(turbine.nacelle + transformed(rotor, turbine.shaft))
