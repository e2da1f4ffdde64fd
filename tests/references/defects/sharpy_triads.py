"""SHARPy: sections of curved three-node elements have wrong axes, middle and end exchanged.

algebra.tangent_vector returns tangents in the order of the nodes along the element (first end, middle, other end), and
Element.get_triad reads them in the order of the connectivities (first end, other end, middle), like
frame_of_reference_delta. One element on an arc of one radian: its sections' x axes should lie along the arc. Out of the
plane of the arc such beams then have wrong frequencies, by 2 % for an arc of half a radian.
Needs: ic-sharpy, numpy.
"""

from importlib.metadata import version

import numpy as np
from sharpy.structure.models.beamstructures import Element  # pyright: ignore[reportMissingImports]
from sharpy.utils.algebra import crv2rotation  # pyright: ignore[reportMissingImports]


def main():
    print(f"SHARPy {version('ic-sharpy')}")
    angle = np.array([0.0, 1.0, 0.5])  # first end, other end, middle
    place = np.stack([np.sin(angle), 1 - np.cos(angle), 0 * angle], axis=1)
    across = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], axis=1)
    element = Element(0, 3, np.array([0, 2, 1]), place, across, np.zeros(3), 0, 0, 0)
    worst = 0.0
    for node, psi, expected in zip(("first end", "other end", "middle"), element.psi_ini, angle, strict=True):
        x = crv2rotation(psi)[:, 0]
        result = np.arctan2(x[1], x[0])
        print(f"{node:9}: x at {result:.3f} rad (expected {expected:.3f}, a parabola through three nodes aside)")
        worst = max(worst, abs(result - expected))
    print("defect:", "present" if worst > 0.1 else "gone")


if __name__ == "__main__":
    main()
