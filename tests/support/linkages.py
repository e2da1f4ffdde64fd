"""Mechanisms with closed loops, each with a guess near its steady state."""

from dataclasses import replace

import numpy as np

from southwell import multibody as mb
from southwell.core.mechanism.joints import SCREWS, Kind
from southwell.core.space import spatial as sp
from southwell.core.tree.kinematics import kinematics
from southwell.core.tree.spanning import compile_tree

G = 9.81


def bar(name: str, length: float, mass: float) -> mb.Body:
    across = mass * length**2 / 12
    return mb.Body(name, mb.inertia(mass, (0.01 * across, across, across), (length / 2, 0, 0)))


def four_bar(cut: str = "") -> mb.Mechanism:
    """Crank 1, coupler 3, rocker 2, ground 3; y is up; three times overdetermined in space."""
    joints = (
        mb.Joint("A", "revolute", "ground", "crank"),
        mb.Joint("B", "revolute", "crank", "coupler", mb.at(1.0)),
        mb.Joint("C", "revolute", "coupler", "rocker", mb.at(3.0), mb.at(2.0)),
        mb.Joint("D", "revolute", "ground", "rocker", mb.at(3.0)),
    )
    return mb.Mechanism(
        (bar("crank", 1, 2.0), bar("coupler", 3, 3.0), bar("rocker", 2, 1.0)),
        tuple(replace(j, cut=j.name == cut) for j in joints),
        coordinate_springs=(mb.CoordinateSpring("A.rz", 80.0, 3.0, 1.0),),
        gravity=(0, -3.0, 0),
    )


FOUR = {"A.rz": 0.9, "B.rz": -0.32, "C.rz": 1.34, "D.rz": 1.92}


def slider_crank() -> tuple[mb.Mechanism, dict[str, float]]:
    """The whole turns on a table about the vertical; the slider is pulled by a damped spring fixed to the table."""
    m = mb.Mechanism(
        (mb.Body("table"), bar("crank", 0.5, 3.0), bar("rod", 2.0, 2.0), mb.Body("slider", mb.inertia(5.0, 0.1))),
        (
            mb.Joint("turn", "revolute", "ground", "table", mb.at(axis="y"), mb.at(axis="y")),
            mb.Joint("O", "revolute", "table", "crank"),
            mb.Joint("P", "revolute", "crank", "rod", mb.at(0.5)),
            mb.Joint("Q", "revolute", "rod", "slider", mb.at(2.0)),
            mb.Joint("guide", "prismatic", "table", "slider", mb.at(axis="x"), mb.at(axis="x"), cut=True),
        ),
        (mb.Motion("turn.rz", 0.0, 1.2),),
        springs=(mb.Spring("table", "slider", np.array([1.0, 0.3, 0]), np.array([0.1, 0, 0.2]), 60.0, 4.0, 0.5),),
        gravity=(0, -G, 0),
    )
    return m, {"O.rz": 0.8, "P.rz": -0.98, "Q.rz": 0.18, "guide.z": 2.3}


def spatial_loop() -> tuple[mb.Mechanism, dict[str, float]]:
    """Revolute, ball, ball, revolute (the rod's spin held by a universal joint across it): nothing lies in one plane."""
    swept, lifted = (
        mb.at(0.2, 1.0, 0.3, axis=np.array([0.2, 1.0, 0.4])),
        mb.at(0.1, 0, 0, axis=np.array([1.0, 0.1, 0.3])),
    )
    m = mb.Mechanism(
        (mb.Body("hub"), bar("crank", 0.6, 1.0), bar("rod", 1.2, 0.7), bar("rocker", 0.8, 1.5)),
        (
            mb.Joint("shaft", "revolute", "ground", "hub"),
            mb.Joint("in", "revolute", "hub", "crank", lifted),
            mb.Joint("ball", "spherical", "crank", "rod", mb.at(0.6)),
            mb.Joint("out", "revolute", "hub", "rocker", swept),
            mb.Joint("cardan", "universal", "rod", "rocker", mb.at(1.2, axis="x"), mb.at(0.8, axis="y"), cut=True),
        ),
        (mb.Motion("shaft.rz", 0.3, 5.0),),
        coordinate_springs=(
            mb.CoordinateSpring("in.rz", 30.0, 0.4, 0.3),
            mb.CoordinateSpring("out.rz", 20.0, 0.0, 0.5),
        ),
        gravity=(0.0, 0, -G),
    )
    guess = {"shaft.rz": 0.3, "in.rz": 0.7, "ball.rx": -0.3, "ball.ry": -1.7, "ball.rz": -1.3, "out.rz": 0.8}
    return m, {**guess, "cardan.rx": -0.4, "cardan.ry": -1.5}


KINDS: list[Kind] = ["revolute", "prismatic", "cylindrical", "universal", "spherical", "planar"]
LOOPS: list[Kind] = ["revolute", "cylindrical", "universal", "spherical", "planar", "prismatic"]


def random_loop(kinds: list[Kind], loop: Kind, turned: list[bool], seed: int) -> tuple[mb.Mechanism, dict[str, float]]:
    """A chain with joints of any kind on a turning hub, some given from child to parent, its end tied to hub or first body."""
    rng = np.random.default_rng(seed)
    bodies, joints, springs, guess = [mb.Body("hub")], [mb.Joint("hub", "revolute", "ground", "hub")], [], {}
    for i, (kind, reverse) in enumerate(zip(kinds, turned, strict=False)):
        a = rng.normal(size=(3, 3)) * 0.3
        bodies.append(
            mb.Body(
                f"b{i}",
                mb.inertia(
                    rng.uniform(0.5, 2), (np.trace(a @ a.T) + 0.1) * np.eye(3) - a @ a.T, rng.normal(size=3) * 0.2
                ),
            )
        )
        ends = ("hub" if i == 0 else f"b{i - 1}", f"b{i}")
        frames = sp.exp(rng.normal(size=(2, 6)) * 0.6)
        near, far = ends[::-1] if reverse else ends
        joints.append(mb.Joint(f"j{i}", kind, near, far, frames[0], frames[1]))
        for name, _ in SCREWS[kind]:
            guess[f"j{i}.{name}"] = float(rng.normal() * 0.3)
            springs.append(
                mb.CoordinateSpring(f"j{i}.{name}", rng.uniform(200, 400), rng.uniform(0, 2), guess[f"j{i}.{name}"])
            )
    gravity = (0.0, 0.0, float(rng.normal() * 2))  # along the hub's axis, or the equations would be periodic
    hub = (mb.Motion("hub.rz", 0.0, 2.0),)
    chain = compile_tree(mb.Mechanism(tuple(bodies), tuple(joints), hub))
    q = np.array([guess.get(c, 0.0) for c in chain.coordinates])
    poses = kinematics(chain, q, 0 * q, 0 * q).poses
    start, end = ("hub", "b0")[int(rng.integers(2))], f"b{len(kinds) - 1}"
    place = sp.exp(rng.normal(size=6) * 0.5)
    ends = [sp.inverse(poses[chain.body(name)]) @ place for name in (start, end)]
    joints.append(mb.Joint("loop", loop, start, end, ends[0], ends[1], cut=True))
    m = mb.Mechanism(tuple(bodies), tuple(joints), hub, tuple(springs), gravity=gravity)
    return m, guess


def ground_resonance() -> mb.Mechanism:
    """A lagging blade on a rotor whose support is sprung: its inertia seen from the support turns with the rotor (periodic)."""
    return mb.Mechanism(
        (mb.Body("slide", mb.inertia(20.0)), mb.Body("rotor", mb.inertia(2.0, 0.1)), bar("blade", 1.0, 3.0)),
        (
            mb.Joint("X", "prismatic", "ground", "slide", mb.at(axis="x"), mb.at(axis="x")),
            mb.Joint("shaft", "revolute", "slide", "rotor"),
            mb.Joint("lag", "revolute", "rotor", "blade", mb.at(0.3)),
        ),
        (mb.Motion("shaft.rz", rate=5.0),),
        (mb.CoordinateSpring("X.z", 800.0), mb.CoordinateSpring("lag.rz", 20.0)),
    )


def falling() -> mb.Mechanism:
    """A mass on an upright rail: it has no steady state."""
    rail = mb.Joint("rail", "prismatic", "ground", "mass")
    return mb.Mechanism((mb.Body("mass", mb.inertia(1.0, 0.1)),), (rail,), gravity=(0, 0, -G))
