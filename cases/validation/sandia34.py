"""The Sandia 34 m vertical-axis test bed: two curved blades and four struts on a tower, seen in the rotating frame.

In the frame that rotates with the rotor about the tower's axis z, gravity along z included, all coefficients are constant.
Every member is a chain of straight elements between nodes on its axis; the nodes' frames are parallel to the rotor's at
rest. Loops close where the blades and struts meet the tower, and at the bearing of its top. The data are in ``sandia34.toml``.

**Mass centre.** The source's mass matrices place the mass centre 0.17 to 0.20 m from the axis *across* the chord, which is
more than half the profile's thickness; according to their moments of inertia, the chord lies along axis 2. The ratio of
stiffness to mass is the same for stretch and for bending in both directions, E/ρ = 2.55e7 m²/s²: the section is of one
material, and its mass centre is its tension centre, on axis 2. The simulated frequencies S use this (``Centre =
"tension"``). The printed offset, across or along the chord, enters the uncertainty of the inputs. In both cases the printed
moments of inertia are taken about the mass centre; about the axis, that about axis 2 would be less than m z², which is
impossible.
"""

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import Akima1DInterpolator

from ...core import multibody as mb
from ...core.blade import Blade
from ...core.element.beams import Beams
from ...core.element.discretize import discretize
from ...core.space import spatial as sp

Array = NDArray[np.float64]
Centre = Literal["tension", "across the chord", "along the chord"]


@dataclass(frozen=True)
class Variation:
    """Difference of a model from the nominal one.

    Attributes:
        refine: factor on the number of elements of every member.
        stiffness, mass: factors on the stiffness and the mass of all sections.
        centre: position of the blades' mass centre.
        mirrored: whether axis 2 of the left blade is −y, the right blade's axis 2 after half a turn, instead of y as in the
            source.
    """

    refine: int = 1
    stiffness: float = 1.0
    mass: float = 1.0
    centre: Centre = "tension"
    mirrored: bool = False


@cache
def data() -> dict[str, Any]:
    """The data in ``sandia34.toml``."""
    return tomllib.loads((files(str(__package__)) / "sandia34.toml").read_text(encoding="utf-8"))


def section(name: str, how: Variation) -> tuple[Array, Array]:
    """Section stiffness and mass (6, 6) in the section's axes: along the member, 2 along the chord, 3 across it."""
    s = data()["sections"][name]
    K = np.diag(s["stiffness"])
    K[0, 5] = K[5, 0] = s["coupling"]
    M = np.diag([s["mass"]] * 3 + s["inertia"])
    m = s["mass"]
    y = z = 0.0  # mass centre along axes 2 and 3
    if how.centre == "tension":
        y = -s["coupling"] / s["stiffness"][0]  # N = EA (ε − y κ₃)
    else:
        y, z = (0.0, s["printed"] / m) if how.centre == "across the chord" else (s["printed"] / m, 0.0)
        M[3:, 3:] += m * np.diag([y * y + z * z, z * z, y * y])  # moments of inertia about the mass centre
    M[0, 4] = M[4, 0] = m * z
    M[1, 3] = M[3, 1] = -m * z
    M[0, 5] = M[5, 0] = -m * y
    M[2, 3] = M[3, 2] = m * y
    return how.stiffness * K, how.mass * M


def _element(length: float, K: Array, M: Array) -> Beams:
    blade = Blade("member", np.array([0.0, length]), np.stack([K, K]), np.stack([M, M]), np.zeros(2))
    return discretize(blade, 1).beams


@dataclass(frozen=True)
class Member:
    """Nodes (n+1, 3) of a member, m, the section of each of its n elements, and their common axis 2 (3,)."""

    name: str
    nodes: Array
    sections: tuple[str, ...]
    second: Array


def _between(ends: list[float], elements: list[int]) -> tuple[Array, list[int]]:
    """Positions that divide the intervals between ``ends`` into ``elements`` pieces, and the interval of each piece."""
    pieces = [np.linspace(a, b, n + 1)[:-1] for a, b, n in zip(ends[:-1], ends[1:], elements, strict=True)]
    return np.concatenate([*pieces, ends[-1:]]), np.repeat(np.arange(len(elements)), elements).tolist()


def members(how: Variation) -> tuple[Member, ...]:
    """The tower, both blades and the four struts."""
    d = data()
    top, (low, high) = d["height"], d["struts"]
    y = np.array([0.0, 1.0, 0.0])
    inner_elements = d["tower"]["elements"] - 2
    z, _ = _between([0.0, low, high, top], [how.refine, inner_elements * how.refine, how.refine])
    out = [Member("tower", np.outer(z, [0.0, 0.0, 1.0]), ("tower",) * (len(z) - 1), y)]

    def radius(z: Array) -> Array:
        return Akima1DInterpolator(d["blade"]["z"], d["blade"]["x"])(z).real

    a, b, c, e, f = d["blade"]["elements"]
    ends = [0.0, low, *d["changes"], high, top]
    s, piece = _between(ends, [how.refine * n for n in (1, a - 1, b, c, e, f - 1, 1)])
    names = (d["blade"]["sections"][0], *d["blade"]["sections"], d["blade"]["sections"][-1])
    for name, side in (("right", 1.0), ("left", -1.0)):
        nodes = np.stack([side * radius(s), np.zeros_like(s), s], axis=1)
        nodes[[0, -1], 0] = 0.0
        second = -y if how.mirrored and side < 0 else y
        out.append(Member(name, nodes, tuple(names[k] for k in piece), second))
        for where, at in (("low", low), ("high", high)):
            x = side * np.linspace(0.0, float(radius(np.array(at))), how.refine * d["strut"]["elements"] + 1)
            strut = np.stack([x, np.zeros_like(x), np.full_like(x, at)], axis=1)
            out.append(Member(f"{where} {name} strut", strut, (d["strut"]["section"],) * (len(x) - 1), second))
    return tuple(out)


def mechanism(omega: float, how: Variation | None = None) -> mb.Mechanism:
    """The rotor at ``omega`` (rad/s) about its tower, whose base is clamped and whose top is free only in yaw."""
    how = how or Variation()
    all_ = {m.name: m for m in members(how)}
    tower = all_["tower"]
    low, high = (int(np.abs(tower.nodes[:, 2] - z).argmin()) for z in data()["struts"])
    last = len(tower.nodes) - 1
    bodies, joints, beams = (
        [mb.Body("rotor"), mb.Body("tower 0")],
        [mb.Joint("bearing", "revolute", "ground", "rotor")],
        [],
    )
    joints.append(mb.Joint("base", "fixed", "rotor", "tower 0"))

    def node(member: Member, k: int) -> str:
        """The body at the k-th node of a member; the tower's body where the member begins at the tower."""
        if member.name != "tower" and k == 0:
            return {"low": f"tower {low}", "high": f"tower {high}"}.get(member.name.split()[0], "tower 0")
        return f"{member.name} {k}"

    for member in all_.values():
        for k in range(len(member.sections)):
            step = member.nodes[k + 1] - member.nodes[k]
            length = float(np.linalg.norm(step))
            first = step / length
            R = np.stack([first, member.second, np.cross(first, member.second)], axis=1).astype(float)
            frame = sp.pose(R, np.zeros(3))
            parent, child = node(member, k), node(member, k + 1)
            bodies.append(mb.Body(child))
            joints.append(mb.Joint(f"{member.name} {k + 1}", "elastic", parent, child, at_parent=mb.at(*step)))
            element = _element(length, *section(member.sections[k], how))
            beams.append(mb.Beam(parent, child, element, at_a=frame, at_b=frame, axes_of="rotor"))

    top = mb.at(z=data()["height"])
    joints.append(mb.Joint("top bearing", "revolute", "rotor", f"tower {last}", at_parent=top, cut=True))
    for name in ("right", "left"):
        blade = all_[name]
        joints.append(mb.Joint(f"{name} top", "fixed", f"tower {last}", f"{name} {len(blade.sections)}", cut=True))
        for where, z in zip(("low", "high"), data()["struts"], strict=True):
            strut = all_[f"{where} {name} strut"]
            nearest = int(np.abs(blade.nodes[:, 2] - z).argmin())
            joints.append(
                mb.Joint(
                    f"{where} {name} end", "fixed", f"{name} {nearest}", f"{strut.name} {len(strut.sections)}", cut=True
                )
            )
    return mb.Mechanism(
        bodies=tuple(bodies),
        joints=tuple(joints),
        motions=(mb.Motion("bearing.rz", 0.0, omega),),
        beams=tuple(beams),
        gravity=tuple(data()["gravity"]),
    )
