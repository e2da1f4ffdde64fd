"""A plane four-bar linkage on a turning table, and its closure in closed form."""

import numpy as np

from southwell.core.mechanism.description import Body, CoordinateSpring, Mechanism, Motion
from southwell.core.mechanism.joints import Joint, at
from southwell.tests.support.closed_forms.linkages import bar

A_, B_, C_, D_ = 1.0, 3.0, 2.0, 3.0


def pose_of(theta: float) -> tuple[float, float]:
    """Directions of coupler and rocker for a crank angle, from the loop's closure, the elbow up."""
    p = A_ * np.exp(1j * theta)
    d = D_ - p
    cosine = (B_**2 + abs(d) ** 2 - C_**2) / (2 * B_ * abs(d))
    coupler = np.angle(d) + np.arccos(cosine)
    rocker = np.angle(p + B_ * np.exp(1j * coupler) - D_)
    return float(coupler), float(rocker)


def four_bar(cut: str = "C", order=(0, 1, 2, 3), table_rate: float = 0.0, turned=None) -> Mechanism:
    """Crank 1, coupler 3, rocker 2, ground 3, a torsion spring at the crank's pivot; in a vertical plane, or on a table."""
    turned = np.eye(4) if turned is None else turned
    joints = [
        Joint("A", "revolute", "base", "crank"),
        Joint("B", "revolute", "crank", "coupler", at(A_)),
        Joint("C", "revolute", "coupler", "rocker", at(B_), at(C_)),
        Joint("D", "revolute", "base", "rocker", at(D_)),
    ]
    joints = [Joint(j.name, j.kind, j.parent, j.child, j.at_parent, j.at_child, cut=j.name == cut) for j in joints]
    return Mechanism(
        (Body("base"), bar("crank", A_, 2.0), bar("coupler", B_, 3.0), bar("rocker", C_, 1.0)),
        (Joint("base", "revolute", "ground", "base", turned, at(axis="y")), *(joints[k] for k in order)),
        (Motion("base.rz", 0.0, table_rate),),
        coordinate_springs=(CoordinateSpring("A.rz", 80.0, 0.0, 1.0),),
        gravity=tuple(turned[:3, :3] @ np.array([0, 0, -3.0])),
    )


def guess() -> dict[str, float]:
    coupler, rocker = pose_of(0.9)
    return {"A.rz": 0.9, "B.rz": coupler - 0.9, "C.rz": rocker - coupler, "D.rz": rocker}
