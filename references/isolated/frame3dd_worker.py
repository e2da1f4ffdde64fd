"""Frame3DD's frame along x, rotating about z through the origin; run by ``answer`` in Frame3DD's environment.

Request: ``x`` (n,) positions of nodes, the first clamped; ``EA``, ``EI_y``, ``EI_z``, ``GJ``, ``mass`` per length,
``twist`` (n-1,) of the elements, in their axes; ``tip``, a mass; ``force`` (n,) along x and ``spring`` (n,) along z at
the nodes; ``count`` of modes.
Answer: ``frequencies`` (m,) rad/s, and ``shapes`` (m, 4, n): displacements, and rotation about x, at the nodes.
"""

import importlib.util
import sys
from pathlib import Path

import numpy as np

FIXED = 1e30
"""Stiffness that Frame3DD interprets as a rigid support."""

JACOBI, STODOLA = 1, 2
"""Subspace iteration, which fails for some blades; Stodola's, which may miss the modes of one plane if planes do not couple."""

MORE, ONE_PLANE = 3, 1e-6
"""Numbers of modes requested from subspace iteration, in turn, until it converges; motion across a plane that counts as
zero."""

CONSISTENT, TOLERANCE = 0, 1e-9


def solve(request):
    """Static solution, and modes with the geometric stiffness there."""
    # the folder only: WISDEM's other packages have requirements that are not installed
    spec = importlib.util.find_spec("wisdem")
    if spec is None or spec.origin is None:
        raise ImportError("wisdem is not in this environment")
    sys.path.insert(0, str(Path(spec.origin).parent))
    from pyframe3dd import pyframe3dd as f3  # pyright: ignore[reportMissingImports]

    x, force, spring = (np.array(request[name]) for name in ("x", "force", "spring"))
    EA, EI_y, EI_z, GJ, mass, twist = (
        np.array(request[name]) for name in ("EA", "EI_y", "EI_z", "GJ", "mass", "twist")
    )
    number, zero, unit = np.arange(1, len(x) + 1), np.zeros(len(x)), np.ones(len(EA))
    rotating = force.any()
    supports, springs = zero.copy(), spring.copy()
    supports[0] = springs[0] = FIXED
    rows = slice(None) if rotating else slice(1)
    reactions = [column[rows] for column in (number, supports, supports, springs, supports, supports, supports)]
    # a section of one square metre
    section = (unit, unit, unit, GJ / EA, EI_y / EA, EI_z / EA, EA, EA, np.degrees(twist), mass)
    elements = (number[:-1], number[:-1], number[1:], *section)
    frame = f3.Frame(
        f3.NodeData(number, x, zero, zero, zero),
        f3.ReactionData(*reactions, rigid=FIXED),
        f3.ElementData(*elements),
        f3.Options(False, True, -1.0),
    )
    load = f3.StaticLoadCase(0.0, 0.0, 0.0)
    if rotating:
        load.changePointLoads(number[1:], force[1:], *[zero[1:]] * 5)
    frame.addLoadCase(load)
    if request["tip"]:
        frame.changeExtraNodeMass(number[-1:], [request["tip"]], *[zero[:1]] * 9, False)
    return modes(frame, request["count"])


def modes(frame, count):
    """The answer.

    Raises:
        RuntimeError: neither method finds all modes.
    """
    for method, requested in (*((JACOBI, count + additional) for additional in range(MORE)), (STODOLA, count)):
        try:
            modal = run(frame, requested, method)
            break
        except RuntimeError:
            if method == STODOLA:
                raise
    shapes = np.stack([modal.xdsp, modal.ydsp, modal.zdsp, modal.xrot], axis=1)
    across, along = np.linalg.svd(shapes[:, 1:3].transpose(0, 2, 1).reshape(-1, 2), compute_uv=False)[::-1]
    if method == STODOLA and count > 1 and across < ONE_PLANE * along:
        raise RuntimeError("Stodola's iteration missed the modes of one plane, and subspace iteration failed")
    order = np.argsort(modal.freq)[:count]
    return {"frequencies": (2 * np.pi * np.array(modal.freq)[order]).tolist(), "shapes": shapes[order].tolist()}


def run(frame, count, method):
    """The modes by one of Frame3DD's methods.

    Raises:
        RuntimeError: the method fails.
    """
    frame.enableDynamics(count, method, CONSISTENT, TOLERANCE, 0.0)
    return frame.run()[-1]
