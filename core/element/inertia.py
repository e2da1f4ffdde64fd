"""Inertial wrench of bodies in steady rotation, and its linearisation.

With V the frame's constant twist and M a body's 6×6 inertia, d/dt(MY) = M Ẏ + Y ×* M Y. For a small twist ξ(t) of the body
relative to the rotating frame this gives, about the steady motion Y = V,

    δg = M ξ̈ + C ξ̇ + K ξ,   C = M V× − V×ᵀ M − cross(MV)  (Coriolis, skew),
                             K = −V×ᵀ M V× − cross(MV) V×   (centrifugal),

in components that follow the body (Featherstone, *Rigid Body Dynamics Algorithms*, 2008, eq. 2.72, linearised).
"""

import numpy as np
from numpy.typing import NDArray

from ..compiled import apply, compiled, product
from ..space import rigid

Array = NDArray[np.float64]


@compiled
def carry(mass: Array, frame: Array, turn: Array, fall: Array, g: Array, C: Array, K: Array) -> None:
    """Wrench g (6,), C and K (6, 6) of one inertia (6, 6) carried at twist ``frame`` (6,), components following the body.

    ``turn`` is the ``ad`` of ``frame``, and ``fall`` (6,) the acceleration of free fall as a twist (zero angular part), turning
    with the frame. Axes and origin are arbitrary, but the same for all.
    """
    mt, transport, momentum = np.empty((6, 6)), np.empty((6, 6)), np.empty(6)
    apply(mass, frame, momentum)
    rigid.cross(momentum, transport)
    product(mass, turn, mt)
    for i in range(6):
        g[i] = 0.0
        for j in range(6):
            g[i] -= turn[j, i] * momentum[j] + mass[i, j] * fall[j]
            transport[i, j] += mt[j, i]
            C[i, j] = mt[i, j] - transport[i, j]
    product(transport, turn, K)
    for i in range(6):
        for j in range(6):
            K[i, j] = -K[i, j]
        # M fall×, whose angular part is zero
        K[i, 3] -= mass[i, 1] * fall[2] - mass[i, 2] * fall[1]
        K[i, 4] -= mass[i, 2] * fall[0] - mass[i, 0] * fall[2]
        K[i, 5] -= mass[i, 0] * fall[1] - mass[i, 1] * fall[0]


@compiled
def hold_components(g: Array, push: Array, follow: bool, K: Array) -> None:
    """Add steady forces ``push`` (3,), N, at the body's origin and fixed in the rotating frame, to g and K in the body's axes.

    Without ``follow`` all components of g stay fixed in the frame instead of turning with the body: an analysis without
    geometric stiffness.
    """
    for i in range(3):
        g[i] -= push[i]
    turn = np.empty((3, 3))
    rigid.put_skew(push[0], push[1], push[2], 0, 0, turn)
    for i in range(3):
        for j in range(3):
            K[i, 3 + j] -= turn[i, j]
    if not follow:
        for part in range(0, 6, 3):
            rigid.put_skew(g[part], g[part + 1], g[part + 2], 0, 0, turn)
            for i in range(3):
                for j in range(3):
                    K[part + i, 3 + j] -= turn[i, j]


@compiled
def carried(mass: Array, frame: Array, fall: Array, push: Array, follow: bool, g: Array, C: Array, K: Array) -> None:
    """``carry`` and ``hold_components`` for n bodies, each in its own axes: g (n, 6), C and K (n, 6, 6)."""
    turn = np.empty((6, 6))
    for k in range(len(mass)):
        rigid.ad(frame[k], turn)
        carry(mass[k], frame[k], turn, fall[k], g[k], C[k], K[k])
        hold_components(g[k], push[k], follow, K[k])
