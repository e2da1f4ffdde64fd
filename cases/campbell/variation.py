"""Rise of a blade's frequencies with rotor speed: Fig. 3 of Park et al. (2010), for stand-ins of its unpublished blade.

The paper gives no frequency of its blade, only the largest variation: 8 % at 20 rpm and 16.5 % at 30 rpm.
"""

from dataclasses import dataclass

import numpy as np

from ...core.solve import mesh_modes
from ..input import library
from ..judge.pairing import Array
from .diagram import Campbell, CampbellRequest, campbell, rises

PRINTED = {20.0: 0.08, 30.0: 0.165}
"""Rotor speed, rpm → largest variation given in the paper."""

LOWEST = 5
"""Number of modes in the paper's figure."""


@dataclass(frozen=True)
class Variation:
    """Frequency rises of one blade.

    Attributes:
        diagram: Campbell diagram of the converged blade.
        rises: (2, t) at the speeds of ``PRINTED``, relative to rest.
        lumped: (2, t) the same with the paper's discretisation.
    """

    diagram: Campbell
    rises: Array
    lumped: Array


def variations(case: str = "park-blade", elements: int | None = None) -> tuple[Variation, ...]:
    """Variations of each blade of a case that specifies the paper's discretisation, over 0 to 30 rpm."""
    known = library.load(case)
    lumping = known.text.discretisation
    assert lumping is not None
    request = CampbellRequest(
        tuple(np.arange(0.0, 30.1, 2.5) * np.pi / 30), modes=LOWEST, per_rev=(), elements=elements
    )
    out = []
    for variant in known.variants:
        blade = variant.blade
        whole = campbell(blade, request)
        crude = campbell(
            blade,
            request,
            lambda omega, blade=blade: mesh_modes(
                blade,
                omega,
                lumping.elements,
                LOWEST + 4,
                mass=lumping.mass,
                stiffness=lumping.stiffness,
                effects=lumping.effects,
            ),
        )
        at = [rpm * np.pi / 30 for rpm in PRINTED]
        out.append(Variation(whole, *(np.stack([rises(d, omega) for omega in at]) for d in (whole, crude))))
    return tuple(out)
