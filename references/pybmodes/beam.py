"""pyBModes: the finite elements of NREL's BModes again in Python, driven as its user drives it, by an input file.

A linear Euler–Bernoulli beam in axes that turn with the rotor, with the tension of the undeformed blade (G. S. Bir, "User's
Guide to BModes", NREL/TP-500-39133, 2005; pyBModes: J. H. Seo, Inha University). Elements have the properties of their middle,
except the twist, which varies: of second order where a blade tapers, of fourth where it does not.

What it leaves out, as its element matrices and results show: the gyroscopic term; the steady stretch; the inertia of the
sections in bending, though not in torsion; displacements along the blade in what it returns, and with them the axial modes
(whose spin softening it lacks too); precone and pitch, which its input file has and nothing reads. Pitch is twist here.
A mass at the tip is in its mass matrix but neither pulls the blade nor is softened by the rotation, hence refused. So are mass
centres off the axis, for which its input file has a column: right at rest, but turning it leaves out the steady moment that
they make, up to 2.7 % in ``defects/pybmodes_mass_centre.py``; a shear centre off the axis is half applied, at rest too
(``defects/pybmodes_shear_centre.py``).
"""

import time
from importlib import metadata
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from ...core.blade import Blade, clamped, coupled, sample, straight
from ...core.effects import Effects
from ...core.modes import STATIONS, Modes
from ..protocol import install
from ..protocol.interface import CodeError, Independence, Motion, Shares
from ..theories.grading import element_ends

Array = NDArray[np.float64]

SECTIONS = 20
"""Intervals between stations that the coarsest level can follow without more elements."""

ZERO_SHAPE = 1e-9
"""Largest lateral motion, of a vector of norm one, that counts as none: an axial mode, of which pyBModes shows nothing."""

MAIN = """==== pyBModes main input file ====
{name}

---- General parameters ----
f  Echo
1  beam_type  1: blade
{rpm!r}  rot_rpm
1.0  rpm_mult
{radius!r}  radius  of the tip, m
{hub!r}  hub_rad  m
0.0  precone  deg
0.0  bl_thp  deg
1  hub_conn  1: clamped
{count}  modepr
t  TabDelim
f  mid_node_tw

---- Tip mass ----
{tip}

---- Distributed-property identifiers ----
1  id_mat  1: isotropic
'sections.dat'  sec_props_file

Property scaling factors
{scaling}

---- Finite element discretization ----
{elements}  nselt
Ends of the elements over the blade's length
{ends}
"""

TABLE = """{name}
{count}  n_secs

sec_loc str_tw tw_iner mass_den flp_iner edge_iner flp_stff edge_stff tor_stff axial_stff cg_offst sc_offst tc_offst
(-) (deg) (deg) (kg/m) (kg-m) (kg-m) (Nm^2) (Nm^2) (Nm^2) (N) (m) (m) (m)
{rows}
"""


class PyBModes:
    """See the module; straight blades, uncoupled, shear-free and clamped, with twist, taper and pitch."""

    name = "pybmodes"
    title = "pyBModes, linear beam"
    shares: Shares = "nothing"
    independence = Independence("pyBModes", "BModes", "pyBModes", eigensolver="pyBModes")
    motions: tuple[Motion, ...] = ("chordwise", "flapwise", "torsion")
    effects = Effects(prestretch=False, coriolis=False, rotary_inertia=False)
    levels = (SECTIONS, 2 * SECTIONS, 4 * SECTIONS)
    order = 2
    hint = install.extra("codes")

    def version(self) -> str | None:
        """Version of pyBModes, without importing it."""
        try:
            return metadata.version("pybmodes")
        except metadata.PackageNotFoundError:
            return None

    def unsupported(self, blade: Blade) -> str | None:
        """A reason if pyBModes's beam or its input file has no place for something of this blade's."""
        if coupled(blade):
            return (
                "sections couple (off-diagonal entries): of mass centres off the axis pyBModes leaves out the steady moment "
                "when turning, shear centres it applies by half, and other couplings its input file has none of"
            )
        if not straight(blade):
            return "prebend or sweep: the elements lie on a straight line"
        if not clamped(blade):
            return "the root is not clamped: the input file has no springs for a blade's root"
        if blade.precone:
            return f"precone = {blade.precone:g} rad: the input file has it, but pyBModes does nothing with it"
        if blade.tip_mass.any():
            return (
                "tip_mass: pyBModes adds it to the mass matrix only, so that turning it neither pulls nor spin-softens"
            )
        section = sample(blade, blade.stations)
        if np.ptp(np.diagonal(blade.mass, axis1=1, axis2=2)[:, :3], axis=1).any():
            return "mass differs with direction: the section table has one mass per length"
        if np.isfinite([section.GA_y, section.GA_z]).any():
            return "finite shear stiffness: the elements are shear-free (Euler–Bernoulli)"
        for name in ("EA", "GJ", "EI_y", "EI_z"):
            if np.isinf(getattr(section, name)).any():
                return f"{name} is infinite: the section table needs it finite"
        return None

    def solve(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes of bending and torsion; see ``interface.Code``.

        A blade of more than ``SECTIONS`` intervals between kinks has more elements in proportion (see ``grading``), which
        ``Modes.elements`` says.

        Raises:
            CodeError: an unsupported blade, or a stiffness that is not positive at this speed.
        """
        if reason := self.unsupported(blade):
            raise CodeError(f"{blade.name}: {reason}")
        begun = time.perf_counter()
        s = element_ends(blade, elements, SECTIONS)
        with TemporaryDirectory() as folder:
            rotor = _pybmodes().RotatingBlade(_write(Path(folder), blade, omega, s, count))
            frequencies, shapes = _moving(rotor, blade, count, most=_most(blade, len(s) - 1))
        return Modes(omega, frequencies, shapes, len(s) - 1, seconds=time.perf_counter() - begun)


def _pybmodes() -> Any:
    from pybmodes import models

    return models


def _write(folder: Path, blade: Blade, omega: float, s: Array, count: int) -> Path:
    """The input file; its section table lies beside it.

    Their axes: v and w as our y and z, twist counted the other way. Polar inertia is the sum of a section's two, and its
    spin softening goes by their difference; they are chosen so that both are the blade's.
    """
    at = sample(blade, blade.stations)
    difference = at.I_z - at.I_y
    none = np.zeros(len(blade.stations))
    angle = -np.degrees(at.twist + blade.pitch)
    flap, edge = (at.I_x - difference) / 2, (at.I_x + difference) / 2
    columns = (
        *(blade.stations / blade.length, angle, angle, at.mass, flap, edge),
        *(at.EI_y, at.EI_z, at.GJ, at.EA, none, none, none),
    )
    rows = "\n".join(" ".join(f"{v:.17g}" for v in row) for row in zip(*columns, strict=True))
    table = TABLE.format(name=blade.name, count=len(blade.stations), rows=rows)
    (folder / "sections.dat").write_text(table, encoding="latin-1", errors="replace")
    main = MAIN.format(
        name=blade.name,
        rpm=float(omega) * 30 / np.pi,
        radius=float(blade.hub_radius + blade.length),
        hub=float(blade.hub_radius),
        count=count,
        tip="\n".join(["0.0  -"] * 9),
        scaling="\n".join(["1.0  -"] * 10),
        elements=len(s) - 1,
        ends=" ".join(f"{v:.17g}" for v in s / blade.length),
    )
    path = folder / "blade.bmi"
    path.write_text(main, encoding="latin-1", errors="replace")
    return path


def _most(blade: Blade, elements: int) -> int:
    """How many modes pyBModes can be asked for: nine an element; past half of them it factorises the mass matrix.

    Where sections have no polar inertia it cannot, so that of the upper half none are to be had.
    """
    polar = (blade.mass[:, 3, 3] > 0).any()
    return 9 * elements if polar else 9 * elements // 2


def _moving(rotor: Any, blade: Blade, count: int, most: int) -> tuple[Array, NDArray[np.complex128]]:
    """Frequencies (m,), rad/s, and shapes (m, 21, 4) of the lowest modes that move sideways or twist.

    Raises:
        CodeError: if one of pyBModes's eigenvalues is not positive (it reports zero for those).
    """
    asked, moving = min(count, most), []
    while True:
        found = rotor.run(asked, check_model=False)
        if not (found.frequencies > 0).all():
            raise CodeError("stiffness: not positive definite: no stable steady state at this rotor speed; lower it")
        pairs = zip(found.frequencies, found.shapes, strict=True)
        moving = [(2 * np.pi * f, _shape(shape, blade)) for f, shape in pairs if _moves(shape)][:count]
        if len(moving) == count or asked == most:
            break
        asked = min(2 * asked, most)
    frequencies, shapes = zip(*moving, strict=True)
    return np.array(frequencies), np.array(shapes, complex)


def _moves(shape: Any) -> bool:
    return max(np.abs(part).max() for part in (shape.lag_disp, shape.flap_disp, shape.twist)) > ZERO_SHAPE


def _shape(shape: Any, blade: Blade) -> Array:
    """(21, 4) at the common stations, by the element's own cubics in bending; displacements come in tip radii."""
    radius = blade.hub_radius + blade.length
    s, at = shape.span_loc * blade.length, STATIONS * blade.length
    out = np.zeros((len(at), 4))
    for axis, moved, slope in ((1, shape.lag_disp, shape.lag_slope), (2, shape.flap_disp, shape.flap_slope)):
        out[:, axis] = CubicHermiteSpline(s, moved * radius, slope)(at)
    out[:, 3] = CubicSpline(s, shape.twist)(at)
    return out


CODE = PyBModes()
