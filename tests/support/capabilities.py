"""What each code can do, and what each case's blades ask for: the one table that drives the verification matrix.

It is written by hand and independently of the adapters' own declarations, so that an adapter that starts to drop a property,
or to refuse a blade it used to solve, is seen.
"""

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Can:
    """What a code solves, and what it leaves out by construction.

    Attributes:
        taper: sections that vary along the span.
        twist: structural twist.
        unlike: different bending stiffness in the two planes.
        stretch: has axial motion, so axial modes too.
        lacks: physical effects it leaves out.
        estimate: gives a bracket instead of a converged number.
        twin: is given core's own discretisation and held to rounding.
        coupled: sections whose mass centres lie off the axis.
        anisotropic: sections whose strains couple.
        hinged: a root that is not clamped.
        tip: a mass at the tip.
        thin: sections without moments of inertia.
        sheared: sections that are flexible in shear.
        curved: prebend or sweep.
        coned: precone.
        stations: properties that change their slope at a dozen stations or more.
        solid: solves the solid of a blade that is known as one, whatever else it can.
    """

    taper: bool = True
    twist: bool = True
    unlike: bool = True
    stretch: bool = True
    lacks: tuple[str, ...] = ()
    estimate: bool = False
    twin: bool = False
    coupled: bool = False
    anisotropic: bool = False
    hinged: bool = False
    tip: bool = True
    thin: bool = True
    sheared: bool = False
    curved: bool = False
    coned: bool = False
    stations: bool = True
    solid: bool = False


CODES = {
    "exudyn-ancf": Can(taper=False, unlike=False, twist=False, tip=False, lacks=("rotary inertia",)),
    "exudyn-tree": Can(coupled=True, anisotropic=True, hinged=True, sheared=True, curved=True, coned=True),
    "exudyn-beam": Can(coupled=True, sheared=True, curved=True, coned=True),
    "scikit-fem": Can(hinged=True),
    "scikit-fem-reissner": Can(coupled=True, anisotropic=True, hinged=True, sheared=True, curved=True, coned=True),
    "pinocchio": Can(twin=True, coupled=True, anisotropic=True, sheared=True, curved=True, coned=True),
    "drake": Can(twin=True, coupled=True, anisotropic=True, sheared=True, curved=True, coned=True),
    "mujoco": Can(twin=True, coupled=True, anisotropic=True, sheared=True, curved=True, coned=True),
    "pybmodes": Can(stretch=False, tip=False, lacks=("prestretch", "coriolis", "rotary inertia")),
    "scikit-fem-solid": Can(taper=False, twist=False, tip=False, thin=False, solid=True),
    "calculix": Can(taper=False, twist=False, tip=False, thin=False, lacks=("coriolis",), solid=True),
    "sharpy": Can(coupled=True, anisotropic=True, sheared=True, curved=True, coned=True),
    "frame3dd": Can(stretch=False, lacks=("prestretch", "coriolis", "rotary inertia"), stations=False),
    "yoo-shin": Can(twist=False, lacks=("prestretch", "rotary inertia")),
    "assumed-modes": Can(stretch=False, lacks=("prestretch", "coriolis", "rotary inertia")),
    "southwell-equation": Can(stretch=False, lacks=("prestretch", "coriolis", "rotary inertia"), estimate=True),
    "exact-beam": Can(twist=False),
}


@dataclass(frozen=True)
class Asks:
    """What a case's blade needs of a code.

    Attributes:
        coupled: sections whose mass centres lie off the axis.
        anisotropic: sections whose strains couple.
        hinged: a hinge or spring at the root.
        tip: a mass at the tip.
        thin: sections without moments of inertia.
        sheared: sections that are flexible in shear.
        curved: prebend or sweep.
        coned: precone.
        stations: a dozen or more, where properties change their slope.
        solid: a solid is known whose beam it is.
        axial: axial modes are compared.
        gentle: rad/s; up to this speed no effect that a code may leave out shifts any mode by more than 0.1 %; negative: at
            none, moments of inertia matter at rest.
    """

    taper: bool = False
    twist: bool = False
    unlike: bool = False
    coupled: bool = False
    anisotropic: bool = False
    hinged: bool = False
    tip: bool = False
    thin: bool = False
    sheared: bool = False
    curved: bool = False
    coned: bool = False
    stations: bool = False
    solid: bool = False
    axial: bool = False
    gentle: float = math.inf


BLADES = {
    "park-cantilever": Asks(gentle=25.0),
    "park-blade/windpact": Asks(taper=True, twist=True, unlike=True, stations=True),
    "park-blade/surrogate": Asks(taper=True, twist=True, unlike=True, stations=True),
    "park-blade/surrogate-untwisted": Asks(taper=True, unlike=True, stations=True),
    "yoo-shin-chordwise/delta-0": Asks(thin=True, axial=True, gentle=0.0),
    "yoo-shin-chordwise/delta-0.1": Asks(thin=True, axial=True, gentle=0.0),
    "yoo-shin-chordwise/delta-1": Asks(thin=True, axial=True, gentle=0.0),
    "yoo-shin-chordwise/delta-5": Asks(thin=True, axial=True, gentle=0.0),
    "wright-flapwise": Asks(thin=True),
    "nrel-5mw": Asks(taper=True, twist=True, unlike=True, gentle=-1.0, stations=True),
    "nrel-5mw-beamdyn": Asks(taper=True, twist=True, unlike=True, sheared=True, stations=True),
    "iea-15": Asks(
        taper=True, twist=True, unlike=True, coupled=True, anisotropic=True, sheared=True, curved=True, stations=True
    ),
    "windpact-1.5/centred": Asks(taper=True, twist=True, unlike=True, gentle=-1.0, stations=True),
    "windpact-1.5/offset": Asks(taper=True, twist=True, unlike=True, coupled=True, stations=True),
    "windpact-1.5/bmodes": Asks(taper=True, twist=True, unlike=True, coupled=True, stations=True),
    "articulated/flap": Asks(hinged=True),
    "articulated/both": Asks(hinged=True),
    "articulated/sprung": Asks(hinged=True),
    "rotating-cable": Asks(unlike=True, hinged=True),
    "tip-mass": Asks(tip=True),
    "tip-mass-in-plane/straight": Asks(taper=True, unlike=True, tip=True, gentle=0.0),
    "tip-mass-in-plane/coned": Asks(taper=True, unlike=True, tip=True, coned=True, gentle=0.0),
    "tapered-beam": Asks(taper=True, unlike=True, gentle=0.0),
    "hodges-rutkowski": Asks(taper=True, stations=True),
    "curved-solid": Asks(
        taper=True,
        twist=True,
        unlike=True,
        coupled=True,
        anisotropic=True,
        sheared=True,
        curved=True,
        stations=True,
        solid=True,
    ),
    "prebent-beam": Asks(twist=True, unlike=True, sheared=True, curved=True),
    "pretwisted-beam": Asks(twist=True, unlike=True, gentle=0.0),
}

TABLES = {
    "park2010/present": "park-cantilever",
    "park2010/ref-3": "park-cantilever",
    "wright1982/four-decimals": "wright-flapwise",
    "wright1982/bir2009": "wright-flapwise",
    "yoo_shin1998/p-version": "yoo-shin-chordwise/delta-0",
    "yoo_shin1998/coupled": "yoo-shin-chordwise/delta-0",
    "yoo_shin1998/uncoupled": "yoo-shin-chordwise/delta-0",
    "openfast/elastodyn": "nrel-5mw",
    "bmodes3/cert-1": "windpact-1.5/bmodes",
    "southwell1921/cable": "rotating-cable",
    "bir2010/analytical": "tip-mass",
    "hodges_rutkowski1981/taper": "hodges-rutkowski",
}
"""Printed series, and the blade they are about."""


NEEDS = (
    "taper",
    "twist",
    "unlike",
    "coupled",
    "anisotropic",
    "hinged",
    "tip",
    "thin",
    "sheared",
    "curved",
    "coned",
    "stations",
)


def solves(can: Can, asks: Asks) -> bool:
    """Whether a code can be expected to solve a blade."""
    return (can.solid and asks.solid) or all(getattr(can, need) or not getattr(asks, need) for need in NEEDS)


def allowed(can: Can, asks: Asks, omega: float) -> set[str]:
    """Verdicts that are right for a code that solves the blade; ``fail`` and ``inconclusive`` never are."""
    verdicts = {"pass"}
    if can.estimate and omega > 0:
        verdicts.add("estimate")
    if can.lacks and omega > asks.gentle:
        verdicts.add("known difference")
    if asks.axial and not can.stretch:
        verdicts.add("not applicable")
    return verdicts
