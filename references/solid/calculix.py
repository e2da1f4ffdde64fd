"""CalculiX (``ccx``): rotating solid blades of 20-node hexahedra.

G. Dhondt, *The Finite Element Method for Three-Dimensional Thermomechanical Applications*, 2004. The static step is
geometrically nonlinear (St Venant–Kirchhoff), the frequencies are those about it, with stress stiffening and spin
softening, without Coriolis forces: ``*COMPLEX FREQUENCY, CORIOLIS`` works in a modal basis and loses modes.
Elements have reduced integration. A single element across a section has hourglass modes, so at least two are required.
"""

import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...core.effects import Effects
from ...core.modes import STATIONS, Modes
from ..protocol.interface import CodeError
from .materials import Material, Orthotropic
from .mesh import TWENTY, Bricks, Clamp, fixed_by, mean_motions, means, workless

FACE = TWENTY[[0, 3, 7, 4, 11, 19, 15, 16]][:, 1:]
"""The 8 nodes of an element's face towards the root, by lattice position across: corners, then mid-edges."""

Array = NDArray[np.float64]
Index = NDArray[np.intp]

NO_AXES = np.zeros((0, 3, 3))
"""Section axes of a straight blade: the material follows the blade's."""

HINT = "apt-get install calculix-ccx"

CONVERGED = ("*CONTROLS,PARAMETERS=FIELD", "1e-6,1e-7")
"""Newton's method ends at this residual and correction, relative. Smaller values change no digit of the output, and a
residual is rounded to 3e-9. With CalculiX's defaults, 5e-3 and 1e-2, frequencies of a curved blade are off by 1e-3 on fine
meshes."""

EFFECTS = Effects(coriolis=False)
"""The effects it includes."""


def version() -> str | None:
    """Version of ``ccx`` on the PATH; None if there is none."""
    if shutil.which("ccx") is None:
        return None
    output = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout
    match = re.search(r"Version\s+(\S+)", output)
    return match[1] if match else "unknown"


def modes(
    bricks: Bricks,
    material: Material | Orthotropic,
    omega: float,
    count: int,
    clamp: Clamp | Array,
    points: Array | None = None,
) -> Modes:
    """The lowest modes of a solid blade in steady rotation at ``omega`` (rad/s), as from ``hexahedra.modes``.

    ``points`` (21, 3), m, on the curve of a curved blade at ``STATIONS``; a straight blade needs none.

    Raises:
        CodeError: ``ccx`` is missing or failed, no stable steady state, or fewer than two elements across a section.
    """
    if min(bricks.counts[1:]) < 2:
        raise CodeError(
            f"across: {bricks.counts[1:]} elements: with reduced integration a section needs at least two each way"
        )
    places, nodes = numbered(bricks)
    fixed = _fixed(clamp, nodes) if callable(clamp) else _restrained(clamp, places)
    steps = [*fixed, "*STEP"]
    if omega:
        load = f"ALL,CENTRIF,{omega**2:.12g},0.,0.,0.,0.,0.,1."
        steps = [*fixed, "*STEP,NLGEOM", "*STATIC", *CONVERGED, "*DLOAD", load, "*END STEP", "*STEP,PERTURBATION"]
    steps += ["*FREQUENCY", str(count), "*NODE PRINT,NSET=ALL", "U", "*END STEP"]
    with run([*deck(places, nodes, material, bricks.axes), *steps]) as folder:
        frequencies, u = _printed((folder / "blade.dat").read_text(), omega)
    weights = np.ones(len(nodes))
    if points is None:
        shapes = mean_motions(nodes, weights, u)
    else:
        layers = places[:: (len(places) - 1) // (len(STATIONS) - 1)]
        sections = [(layer[layer >= 0], point) for layer, point in zip(layers, points, strict=True)]
        shapes = means(nodes, weights, u, sections)
    return Modes(omega, frequencies, shapes, bricks.counts[0])


def _fixed(clamp: Clamp, nodes: Array) -> list[str]:
    return ["*BOUNDARY", *(f"{node + 1},{d + 1},{d + 1}" for node, d in np.argwhere(fixed_by(clamp, nodes)))]


def _restrained(forces: Array, places: Index) -> list[str]:
    """Equations for a root on whose motion nodal forces (3n, 6) of the complete lattice do no work.

    The node in the middle of a face, which 20-node elements lack, moves by −¼ of the corners and ½ of the mid-edges.
    """
    root = forces.reshape(3, *places.shape, 6)[:, 0].copy()
    for j, k in np.argwhere(places[0] < 0):
        for dj, dk in FACE - 1:
            root[:, j + dj, k + dk] += root[:, j, k] * (0.5 if 0 in (dj, dk) else -0.25)
        root[:, j, k] = 0.0
    follow, lead, ratio = workless(root.reshape(-1, 6))
    node, directions = places[0].ravel() + 1, places[0].size
    lines = []
    for dependent, row in zip(follow, ratio, strict=True):
        terms = [
            (dependent, -1.0),
            *((lead_freedom, value) for lead_freedom, value in zip(lead, row, strict=True) if value),
        ]
        lines += ["*EQUATION", str(len(terms))]
        lines += [f"{node[k % directions]},{k // directions + 1},{value:.12g}" for k, value in terms]
    return lines


def numbered(bricks: Bricks) -> tuple[Index, Array]:
    """Index of the node at each lattice point, −1 where 20-node elements have none, and the nodes (n, 3), m."""
    lattice = bricks.lattice()
    odd = (np.indices(lattice.shape[:3]) % 2).sum(axis=0)
    places = np.full(odd.shape, -1)
    places[odd <= 1] = np.arange((odd <= 1).sum())
    return places, lattice[odd <= 1]


def deck(places: Index, nodes: Array, material: Material | Orthotropic, axes: Array = NO_AXES) -> list[str]:
    """Lines of mesh and material. CalculiX truncates fields at 20 characters, so numbers have 12 digits.

    An orthotropic material follows the section ``axes`` (2nx+1, 3, 3) in the middle of each layer of elements.
    """
    lines = ["*NODE,NSET=ALL", *(f"{k + 1},{x:.12g},{y:.12g},{z:.12g}" for k, (x, y, z) in enumerate(nodes))]
    lines += ["*ELEMENT,TYPE=C3D20R,ELSET=ALL"]
    first = np.stack(np.meshgrid(*(np.arange(0, n - 1, 2) for n in places.shape), indexing="ij"), axis=-1).reshape(
        -1, 3
    )
    for k, corner in enumerate(first):
        own = places[tuple((corner + TWENTY).T)] + 1
        lines += [f"{k + 1}," + ",".join(map(str, own[:10])) + ",", ",".join(map(str, own[10:]))]
    return [
        *lines,
        "*MATERIAL,NAME=SOLID",
        *_elastic(material),
        "*DENSITY",
        f"{material.density:.12g}",
        *_sections(first, material, axes),
    ]


def _sections(first: Index, material: Material | Orthotropic, axes: Array) -> list[str]:
    if isinstance(material, Material) or not len(axes):
        return ["*SOLID SECTION,ELSET=ALL,MATERIAL=SOLID"]
    lines = []
    for n, axes_of_layer in enumerate(axes[1::2] @ material.axes):
        a, b = (",".join(f"{v:.12g}" for v in axes_of_layer[:, k]) for k in (0, 1))
        own = np.flatnonzero(first[:, 0] == 2 * n) + 1
        lines += [f"*ORIENTATION,NAME=O{n},SYSTEM=RECTANGULAR", f"{a},{b}", f"*ELSET,ELSET=E{n}", *map(str, own)]
        lines += [f"*SOLID SECTION,ELSET=E{n},MATERIAL=SOLID,ORIENTATION=O{n}"]
    return lines


def _elastic(material: Material | Orthotropic) -> list[str]:
    if isinstance(material, Material):
        return ["*ELASTIC", f"{material.young:.12g},{material.poisson:.12g}"]
    first = (*material.young, *material.poisson, *material.shear[:2])
    return ["*ELASTIC,TYPE=ENGINEERING CONSTANTS", ",".join(f"{v:.12g}" for v in first), f"{material.shear[2]:.12g}"]


@contextmanager
def run(lines: Sequence[str]) -> Iterator[Path]:
    """Run a deck named ``blade`` in a temporary folder, which exists within the context.

    Raises:
        CodeError: ``ccx`` is missing or failed.
    """
    if version() is None:
        raise CodeError(f"ccx is not on the PATH: {HINT}")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "blade.inp").write_text("\n".join(lines) + "\n")
        completed = subprocess.run(
            ["ccx", "-i", "blade"],
            cwd=folder,
            capture_output=True,
            text=True,
            check=False,
            env={**os.environ, "OMP_NUM_THREADS": "1"},
        )
        error = re.search(r"\*ERROR[^\n]*\n?[^\n]*", completed.stdout)
        if completed.returncode or error:
            message = " ".join(error[0].split()) if error else completed.stderr.strip()
            raise CodeError(f"ccx ended with status {completed.returncode}: {message or 'no message'}")
        yield folder


def _printed(text: str, omega: float) -> tuple[Array, Array]:
    """Frequencies (m,), rad/s, and the displacements (3, n, m) printed for each mode.

    Raises:
        CodeError: a negative eigenvalue: the steady state is not stable.
    """
    text = re.sub(r"(?<=\d)([+-]\d{3})(?=\s)", r"E\1", text)  # Fortran drops the E before an exponent of three digits
    head, *prints = text.split(" displacements (vx,vy,vz)")
    rows = [line.split() for line in head.partition("P A R T I C I P A T I O N")[0].splitlines()]
    table = np.array([row for row in rows if len(row) == 5 and row[0].isdigit()], float)
    if not len(table) or (table[:, 1] <= 0).any():
        raise CodeError(f"omega: {omega:g} rad/s: ccx found no modes, or an unstable steady state; lower the speed")
    tables = [[line.split()[1:] for line in part.splitlines()[1:] if len(line.split()) == 4] for part in prints]
    return table[:, 2], np.array(tables, float).transpose(2, 1, 0)
