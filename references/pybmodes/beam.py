"""pyBModes: NREL's BModes finite elements in Python, run through its input file.

A linear Euler–Bernoulli beam in axes that rotate with the rotor, with the tension of the undeformed blade (G. S. Bir,
"User's Guide to BModes", NREL/TP-500-39133, 2005; pyBModes: J. H. Seo, Inha University). Elements have the properties
at their middle, except the twist, which varies: second order for a tapered blade, fourth order for a uniform one.

Its element matrices and results show that it leaves out the gyroscopic term; the steady stretch; the inertia of the
sections in bending, but not in torsion; displacements along the blade in its results, and with them the axial modes
(whose spin softening it also lacks); precone and pitch, which are in its input file but are not used. This adapter
includes pitch in the twist.

Blades with a tip mass are declined, because it is added to the mass matrix only: it causes no tension and no spin
softening. Blades with mass centres off the axis are declined too. The input file has a column for them, which is
correct at zero speed, but in rotation their steady moment is missing, up to 2.7 % in
``tests/references/defects/pybmodes_mass_centre.py``. A shear centre off the axis is only partly applied, even at zero speed
(``pybmodes_shear_centre.py`` there).
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from ...core.blade import Blade, clamped, coupled, straight
from ...core.effects import Effects
from ...core.modes import STATIONS, Modes
from ..protocol.fingerprint import Fingerprint, of_points
from ..protocol.interface import BladeAdapter, CodeError, Independence, Motion, extra
from ..sampling import sample
from ..theories.grading import element_ends
from .input_file import write

Array = NDArray[np.float64]

SECTIONS = 20
"""Largest number of intervals between stations for which the coarsest level needs no more elements."""

SPARE = 2
"""Additional modes to compute, since the axial ones among them are left out."""

FREEDOMS = 9
"""Freedoms of an element, those it shares counted once."""

ITERATED = 500
"""Number of freedoms above which pyBModes computes eigenvalues iteratively, from a random vector (see ``reproducible``)."""

NEAR = 1e-3
"""Relative difference between frequencies of a coarse mesh below which iteration may miss one of the two modes."""

AGREEMENT = 1e-6
"""Relative difference between two iterated answers that is rounding."""

ZERO_SHAPE = 1e-9
"""Largest lateral motion, of a vector of norm one, that counts as zero: an axial mode, whose motion pyBModes does not
return."""


class PyBModes(BladeAdapter):
    """See the module; straight blades, uncoupled, shear-free and clamped, with twist, taper and pitch."""

    name = "pybmodes"
    title = "pyBModes, linear beam"
    independence = Independence("pyBModes", "BModes", "pyBModes", eigensolver="pyBModes")
    motions: tuple[Motion, ...] = ("edgewise", "flapwise", "torsion")
    effects = Effects(prestretch=False, coriolis=False, rotary_inertia=False)
    levels = (SECTIONS, 2 * SECTIONS, 4 * SECTIONS)
    order = 2
    finest = 320  # the matrices are dense
    hint = extra("codes")
    distribution = "pybmodes"

    def unsupported(self, blade: Blade) -> str | None:
        """A reason if pyBModes's beam or its input file does not support a property of the blade."""
        if coupled(blade):
            return (
                "sections couple (off-diagonal entries): for mass centres off the axis pyBModes omits the steady moment in "
                "rotation, shear centres are only partly applied, and its input file has no other couplings"
            )
        if not straight(blade):
            return "prebend or sweep: the elements lie on a straight line"
        if not clamped(blade):
            return "the root is not clamped: the input file has no springs for a blade's root"
        if blade.precone:
            return f"precone = {blade.precone:g} rad: it is in the input file, but pyBModes does not use it"
        if blade.tip_mass.any():
            return "tip_mass: pyBModes adds it to the mass matrix only, without tension and spin softening"
        section = sample(blade, blade.stations)
        if np.ptp(np.diagonal(blade.mass, axis1=1, axis2=2)[:, :3], axis=1).any():
            return "mass differs with direction: the section table has one mass per length"
        if np.isfinite([section.GA_y, section.GA_z]).any():
            return "finite shear stiffness: the elements are rigid in shear (Euler–Bernoulli)"
        for name in ("EA", "GJ", "EI_y", "EI_z"):
            if np.isinf(getattr(section, name)).any():
                return f"{name} is infinite: the section table needs it finite"
        return None

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes of bending and torsion; see ``interface.BladeAdapter``.

        A blade with more than ``SECTIONS`` intervals between kinks has proportionally more elements (see ``grading``);
        ``Modes.elements`` gives the number.

        Raises:
            CodeError: a stiffness that is not positive at this speed.
        """
        s = element_ends(blade, elements, SECTIONS)
        with _rotor(blade, omega, s, count) as rotor, reproducible():
            doubted = FREEDOMS * (len(s) - 1) > ITERATED and _doubled(blade, omega, count)
            frequencies, shapes = moving(
                rotor, (blade.hub_radius + blade.length, blade.length), count, doubted, _most(blade, len(s) - 1)
            )
        return Modes(omega, frequencies, shapes, len(s) - 1)

    def fingerprint(self, blade: Blade, elements: int) -> Fingerprint:
        """From the masses that pyBModes gives to its elements; see ``interface.BladeAdapter``."""
        with TemporaryDirectory() as folder:
            return _element_masses(write(Path(folder), blade, 0.0, element_ends(blade, elements, SECTIONS), 1))


def _pybmodes() -> Any:
    from pybmodes import models

    return models


@contextmanager
def _rotor(blade: Blade, omega: float, s: Array, count: int) -> Iterator[Any]:
    """pyBModes's model of a blade on elements that end at ``s`` (n+1,), m; its input file exists meanwhile."""
    with TemporaryDirectory() as folder:
        yield _pybmodes().RotatingBlade(write(Path(folder), blade, omega, s, count))


@contextmanager
def reproducible() -> Iterator[None]:
    """Let pyBModes' iteration begin at the same vectors in every call, another one each time that it begins."""
    from scipy.sparse import linalg

    eigsh, random = linalg.eigsh, np.random.default_rng(0)

    def from_a_known_vector(matrix: Any, *args: Any, **options: Any) -> Any:
        return eigsh(matrix, *args, **{"v0": random.uniform(-1.0, 1.0, matrix.shape[0]), **options})

    linalg.eigsh = from_a_known_vector
    try:
        yield
    finally:
        linalg.eigsh = eigsh


def _element_masses(path: Path) -> Fingerprint:
    """The elements of an input file as pyBModes samples them: each has its mass at, and spread evenly about, its middle."""
    from pybmodes.fem.assembly import compute_element_props
    from pybmodes.io.bmi import read_bmi
    from pybmodes.io.sec_props import read_sec_props

    main = read_bmi(path)
    table = read_sec_props(main.resolve_sec_props_path())
    hub = main.hub_rad / main.radius
    table.span_loc = table.span_loc * (1 - hub) + hub
    length, start, *properties = compute_element_props(main.n_elements, np.asarray(main.el_loc), table, hub)
    length, start = length * main.radius, start * main.radius
    mass = properties[5] * length
    position = np.zeros((len(mass), 3))
    position[:, 0] = start + length / 2
    masses = of_points(mass, position, len(mass))
    return replace(masses, rotor_inertia=masses.rotor_inertia + float(mass @ length**2) / 12)


def _doubled(blade: Blade, omega: float, count: int) -> bool:
    """Whether two of the lowest modes have nearly the same frequency, or may have: by a coarse mesh, solved directly."""
    s = element_ends(blade, SECTIONS, SECTIONS)
    if FREEDOMS * (len(s) - 1) > ITERATED:
        return True
    with _rotor(blade, omega, s, count) as rotor:
        f = rotor.run(min(count + SPARE, _most(blade, len(s) - 1)), check_model=False).frequencies
    return bool((np.diff(f) <= NEAR * f[1:]).any())


def _most(blade: Blade, elements: int) -> int:
    """The largest number of modes pyBModes can compute; above half of its freedoms it factorises the mass matrix.

    Without polar inertia the mass matrix is singular, so only the lower half is available.
    """
    polar = (blade.mass[:, 3, 3] > 0).any()
    return FREEDOMS * elements if polar else FREEDOMS * elements // 2


def moving(
    rotor: Any, size: tuple[float, float], count: int, doubted: bool, limit: int
) -> tuple[Array, NDArray[np.complex128]]:
    """Frequencies (m,), rad/s, and shapes (m, 21, 4) of the lowest modes with lateral motion or twist.

    Args:
        rotor: pyBModes's model.
        size: radius of the tip and length of the blade, m.
        count: number of modes.
        doubted: whether two modes may have nearly the same frequency.
        limit: the largest number of modes that pyBModes can compute.

    With more than ``ITERATED`` freedoms, pyBModes iterates from one vector, and at times misses one of two modes with
    the same frequency. Where there may be such modes (``doubted``), more modes are requested until two answers agree.

    Raises:
        CodeError: if an eigenvalue is not positive (pyBModes then reports a zero frequency).
    """
    requested = min(count + SPARE, limit)
    last_frequencies = np.zeros(0)
    while True:
        spectrum = rotor.run(requested, check_model=False)
        if not (spectrum.frequencies > 0).all():
            raise CodeError("stiffness: not positive definite: no stable steady state at this rotor speed; lower it")
        pairs = zip(spectrum.frequencies, spectrum.shapes, strict=True)
        lateral = [(f, shape) for f, shape in pairs if _moves(shape)][:count]
        frequencies = 2 * np.pi * np.array([f for f, _ in lateral])
        confirmed = not doubted or (
            len(last_frequencies) == len(frequencies)
            and np.allclose(last_frequencies, frequencies, rtol=AGREEMENT, atol=0.0)
        )
        if (len(lateral) == count and confirmed) or requested == limit:
            break
        last_frequencies, requested = frequencies, min(2 * requested, limit)
    return frequencies, _at_stations([shape for _, shape in lateral], *size)


def _moves(shape: Any) -> bool:
    return max(np.abs(part).max() for part in (shape.lag_disp, shape.flap_disp, shape.twist)) > ZERO_SHAPE


def _at_stations(shapes: Sequence[Any], radius: float, length: float) -> NDArray[np.complex128]:
    """(m, 21, 4) at the common stations, by the element's cubics in bending; pyBModes's displacements are in tip radii."""
    s, at = shapes[0].span_loc * length, STATIONS * length
    out = np.zeros((len(shapes), len(at), 4), complex)
    for axis, name in ((1, "lag"), (2, "flap")):
        displacement, slope = (
            np.array([getattr(shape, f"{name}_{motion}") for shape in shapes]) for motion in ("disp", "slope")
        )
        out[:, :, axis] = CubicHermiteSpline(s, displacement * radius, slope, axis=1)(at)
    out[:, :, 3] = CubicSpline(s, np.array([shape.twist for shape in shapes]), axis=1)(at)
    return out


CODE = PyBModes()
