"""Inertial wrench of bodies carried steadily by a rotating frame, and its linearisation.

With V the frame's constant twist and M a body's 6×6 inertia, d/dt(MY) = M Ẏ + Y ×* M Y; letting the body move by a small
twist ξ(t) seen in the rotating frame gives, about the steady motion Y = V,

    δg = M ξ̈ + C ξ̇ + K ξ,   C = M V× − V×ᵀ M − cross(MV)  (Coriolis, skew),
                             K = −V×ᵀ M V× − cross(MV) V×   (centrifugal),

components taken along with the body (Featherstone 2008, eq. 2.72, varied once).
"""

import numpy as np
from numpy.typing import NDArray

from . import spatial as sp

Array = NDArray[np.float64]


def carried(
    mass: Array, frame: Array, gravity: Array, follow: bool = True, push: Array | None = None
) -> tuple[Array, Array, Array]:
    """Wrench g (n, 6), C and K (n, 6, 6) of inertias ``mass`` (n, 6, 6) carried at twist ``frame`` (n, 6).

    ``gravity`` (n, 6) is the acceleration of free fall as a twist (zero angular part), turning with the frame. With
    ``follow`` false the wrench's components are held in the frame, not taken along as the body turns: what a model without
    geometric stiffness does. ``push`` (n, 3) are steady forces at the bodies' origins, fixed in the rotating frame.
    """
    turn = sp.ad(frame)
    momentum = (mass @ frame[..., None])[..., 0]
    x = sp.cross(momentum)
    mt = mass @ turn
    g = -(np.swapaxes(turn, -1, -2) @ momentum[..., None])[..., 0] - (mass @ gravity[..., None])[..., 0]
    K = -np.swapaxes(turn, -1, -2) @ mt - x @ turn - mass @ sp.ad(gravity)
    if push is not None:
        g[..., :3] -= push
        K[..., :3, 3:] -= sp.skew(push)
    if not follow:
        K[..., :3, 3:] -= sp.skew(g[..., :3])
        K[..., 3:, 3:] -= sp.skew(g[..., 3:])
    return g, mt - np.swapaxes(mt, -1, -2) - x, K


def moved(mass: Array, x: Array) -> Array:
    """Inertias (n, 6, 6) given in frames ``x`` (n, 4, 4), expressed in the frame the poses are given in."""
    a = sp.adjoint(sp.inverse(x))
    return np.swapaxes(a, -1, -2) @ mass @ a
