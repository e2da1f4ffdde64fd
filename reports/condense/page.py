"""Condensation as Markdown: segments and modes of a condensed blade."""

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from tabulate import tabulate

from ...cases.campbell.sweep import NamedMode
from ...cases.condense.condensed import Condensed, body, names
from ...cases.condense.condensing import Condensation
from ...core.modes import Modes
from ...core.regular_files import read_bytes
from ..shared.certain import certain, relative, remarks
from ..shared.units import Units

FILE = "condensation.md"

FORCES = ("axial", "along y", "along z", "torsion", "about y", "about z")


def include_page(folder: Path) -> str:
    """The page of ``southwell condense`` in a report's folder, one heading level lower; empty if there is none."""
    path = folder / FILE
    return re.sub(r"^#", "##", read_bytes(path).decode(errors="replace"), flags=re.MULTILINE) if path.exists() else ""


def own(
    blade: Condensed, solved: Sequence[tuple[float, Modes]], units: Units, spec: Condensation | None, command: str
) -> str:
    """The page of a user's blade: the input, the segments, and the modes."""
    n = len(blade.segments)
    total = sum(body(s)[0] for s in blade.segments)
    length = sum(np.linalg.norm(s.undeformed[:3, 3]) for s in blade.segments)
    text = f"# {blade.name}: {n} rigid bodies and complex stiffness elements\n\n"
    if spec:
        lines = [spec.spec.title, f"Source: {spec.spec.source}." if spec.spec.source else ""]
        text += "".join(f"{line}\n\n" for line in lines if line)
        how = "each condensed from its own model" if spec.spec.segments else "condensed in place from one model"
        text += (
            f"{spec.freedoms} degrees of freedom condensed to {6 * n}; segments {how}. "
            f"Residual force of the finite element model in a rigid motion: {spec.resisted:.0e}, relative.\n\n"
        )
    text += f"Mass {total:.6g} kg, length {length:.6g} m, first section at {blade.root[0, 3]:.6g} m from the rotor's axis.\n\n"
    text += """## Segments

Centre of mass and stiffness in the axes of each segment's first frame. Stiffness: the diagonal of the 6×6 matrix that
maps the motion of the second frame relative to the first to the wrench on the second; N/m, then N m/rad.

"""
    text += _table([_segment(k, blade) for k in range(n)])
    text += (
        "\n\nEvery 6×6 matrix is symmetric and positive definite: the six relative motions are resisted, the six rigid motions "
        "are free.\n\n"
    )
    text += f"## Modes, {units.frequency}\n\n"
    text += _table(_modes(blade, solved, units))
    text += "".join(f"\n\n{line}" for line in _remarks(blade, solved, units))
    return f"{text}\n\n`{command}`\n"


def _modes(blade: Condensed, solved: Sequence[tuple[float, Modes]], units: Units) -> list[dict[str, str]]:
    rows = []
    for omega, modes in solved:
        mode_rows = zip(names(blade.segments, modes), modes.frequencies, modes.uncertainty, strict=True)
        for k, (name, f, uncertainty) in enumerate(mode_rows, 1):
            speed = f"{omega * units.speeds:.6g}"
            rows.append(
                {
                    f"speed, {units.speed}": speed,
                    "mode": f"{k}",
                    "name": name,
                    "frequency": certain(float(f * units.frequencies), float(uncertainty)),
                    "± relative": relative(float(uncertainty)),
                }
            )
    return rows


def _remarks(blade: Condensed, solved: Sequence[tuple[float, Modes]], units: Units) -> list[str]:
    """Remarks on the uncertainty of the modes, and on large steady strains."""
    rows = [
        NamedMode(omega, k, name, float(f), float(uncertainty), modes.strain)
        for omega, modes in solved
        for k, (name, f, uncertainty) in enumerate(
            zip(names(blade.segments, modes), modes.frequencies, modes.uncertainty, strict=True), 1
        )
    ]
    advice = " It cannot be estimated from fewer than four segments." if len(blade.segments) < 4 else ""
    return [
        "± relative: uncertainty due to the number of segments, estimated from a half and a quarter of them. Errors of the "
        f"finite element model, its mesh and its ties are not included.{advice}",
        *(f"{line}." for line in remarks(rows, None, units)),
    ]


def _segment(k: int, blade: Condensed) -> dict[str, str]:
    s = blade.segments[k]
    mass, centre, _ = body(s)
    size = np.sqrt(np.diagonal(s.stiffness))
    lowest = np.linalg.eigvalsh(s.stiffness / np.outer(size, size))[0]
    row = {"segment": f"{k + 1}", "length, m": f"{np.linalg.norm(s.undeformed[:3, 3]):.5g}", "mass, kg": f"{mass:.5g}"}
    row["centre, m"] = ", ".join(f"{v:.4g}" for v in np.where(np.abs(centre) < 1e-9, 0.0, centre))
    row |= {name: f"{v:.4g}" for name, v in zip(FORCES, np.diagonal(s.stiffness), strict=True)}
    return row | {"lowest eigenvalue (scaled to unit diagonal)": f"{lowest:.1e}"}


def _table(rows: list[dict[str, str]]) -> str:
    return tabulate(rows, headers="keys", tablefmt="pipe", disable_numparse=True)
