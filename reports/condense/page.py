"""Condensation as Markdown: the example's comparison with its figure, or a user's segments and modes."""

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from tabulate import tabulate

from ...cases.campbell.sweep import Named
from ...cases.condense.condensed import Condensed, body, names
from ...cases.condense.condensing import Condensation
from ...cases.condense.example import EXACT_TARGET, TARGET, Drawn, Example, Speed, cantilever, differences, largest
from ...cases.input import atomic
from ...core.modes import Modes
from ...core.regular_files import read_bytes
from ..shared.certain import certain, relative, remarks
from ..shared.style import house, save
from ..shared.units import RAD_S, Units

FILE = "condensation.md"

DPI = 150

HOW = {
    "rigid": "rigid (RBE2), alone",
    "average": "average (RBE3), alone",
    "in place": "in place between its neighbours",
}

FORCES = ("axial", "along y", "along z", "torsion", "about y", "about z")


def beside(folder: Path) -> str:
    """The page of ``southwell condense`` in a report's folder, one heading level lower; empty if there is none."""
    path = folder / FILE
    return re.sub(r"^#", "##", read_bytes(path).decode(errors="replace"), flags=re.MULTILINE) if path.exists() else ""


def picture(found: Example, drawn: Drawn, folder: Path) -> list[Path]:
    """Write the figure of the three stages as SVG and PNG; return the paths.

    Raises:
        OSError: if a file cannot be written.
    """
    from .figure import stages  # Matplotlib, which the text does not need

    (folder / "figures").mkdir(parents=True, exist_ok=True)
    vector, raster = (folder / "figures" / f"condensation.{kind}" for kind in ("svg", "png"))
    figure = stages(drawn.bricks, drawn.cuts, drawn.segments, drawn.root, found.freedoms)
    save(figure, vector)
    with house():
        atomic.through(
            raster, lambda file: figure.savefig(file, format="png", dpi=DPI, metadata={"Software": "southwell"})
        )
    return [vector, raster]


def example(found: Example, figure: str, command: str) -> str:
    """The example's page; ``figure`` is the figure's path relative to the page."""
    n = found.segments
    worst = max(largest(s) for s in found.speeds)
    bar = cantilever(found, "average")
    codes = ", ".join(f"{name} {said}" for name, said in found.versions.items())
    text = f"""# From a solid to {n} rigid bodies and springs

Park et al. (2010) start from finite elements: the model is cut at sections, all degrees of freedom except the motions of those
sections are eliminated, and each part between two sections becomes one complex stiffness element (6×6, fully coupled) and one
rigid body.

- {_verdict(worst <= TARGET)} The {n} elements reproduce the five lowest frequencies of a tapered, twisted solid blade within
  **{_size(worst)}**, at rest and rotating (target {_size(TARGET)}).
- {_verdict(bar <= EXACT_TARGET)} The frequencies of a prismatic solid cantilever are within **{_size(bar)}** of Timoshenko's
  exact ones (target {_size(EXACT_TARGET)}).

![A solid blade, its sections, and the compressed model]({figure})

## The blade against the whole solid

Steel, 1 m long on a hub of 0.3 m, chord 160 to 80 mm, thickness 24 to 8 mm, twist 30° to 0. The whole solid is solved twice:
with {found.hexahedra} hexahedra of 27 nodes ({found.freedoms} degrees of freedom) by scikit-fem, and of 20 nodes by CalculiX.
CalculiX neglects Coriolis forces, so its column is compared with the compressed model without them. Frequencies are in
rad/s; the differences are those of the compressed model.
"""
    for s in found.speeds:
        text += f"\n**{RAD_S.at(s.omega).capitalize()}**\n\n{_table(_blade(s, found.versions))}\n"
    text += f"""
{_torsion(found)}

## Rigid or average ties

A rigid tie makes a section follow its frame. It suppresses warping and Poisson contraction, so a short segment becomes too
stiff. An average tie makes the frame follow the mean motion of the section. A segment condensed alone is then too soft, because
its ends are not loaded as they are by neighbouring segments; the error grows as the segment becomes shorter relative to its
chord. A segment condensed in place, between its neighbours, has neither error. For a flat bar (4 : 1) one chord long, the
torsional stiffness with rigid ties is {_ratio(found)} times that with average ties.

{_table(_ties(found))}

Use rigid ties where the section is stiffened: at the clamped root, a flange or a bulkhead. Use average ties everywhere else,
and condense in place if the whole model is available.

## The cantilever against Timoshenko

The paper's cantilever as a square solid bar at rest, with {n} segments, each condensed alone. Exact: Huang (1961) with Cowper's
(1966) shear coefficient. Each frequency occurs twice, once in each plane; the larger difference is shown.

{_table(_cantilever(found))}

Codes: {codes}. `{command}`
"""
    return text


def own(
    blade: Condensed, found: Sequence[tuple[float, Modes]], units: Units, spec: Condensation | None, command: str
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
    text += _table(_modes(blade, found, units))
    text += "".join(f"\n\n{line}" for line in _remarks(blade, found, units))
    return f"{text}\n\n`{command}`\n"


def _modes(blade: Condensed, found: Sequence[tuple[float, Modes]], units: Units) -> list[dict[str, str]]:
    rows = []
    for omega, modes in found:
        known = zip(names(blade.segments, modes), modes.frequencies, modes.uncertainty, strict=True)
        for k, (name, f, sure) in enumerate(known, 1):
            speed = f"{omega * units.speeds:.6g}"
            rows.append(
                {
                    f"speed, {units.speed}": speed,
                    "mode": f"{k}",
                    "name": name,
                    "frequency": certain(float(f * units.frequencies), float(sure)),
                    "± relative": relative(float(sure)),
                }
            )
    return rows


def _remarks(blade: Condensed, found: Sequence[tuple[float, Modes]], units: Units) -> list[str]:
    """Remarks on the uncertainty of the modes, and on large steady strains."""
    rows = [
        Named(omega, k, name, float(f), float(sure), modes.strain)
        for omega, modes in found
        for k, (name, f, sure) in enumerate(
            zip(names(blade.segments, modes), modes.frequencies, modes.uncertainty, strict=True), 1
        )
    ]
    few = " It cannot be estimated from fewer than four segments." if len(blade.segments) < 4 else ""
    return [
        "± relative: uncertainty due to the number of segments, estimated from a half and a quarter of them. Errors of the "
        f"finite element model, its mesh and its ties are not included.{few}",
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


def _blade(s: Speed, versions: dict[str, str]) -> list[dict[str, str]]:
    off = differences(s.condensed, s.whole)
    theirs = differences(s.without, s.calculix) if s.calculix else None
    rows = []
    for k, name in enumerate(s.names):
        row = {"mode": name, "whole, scikit-fem": f"{s.whole[k]:.2f}", "compressed": f"{s.condensed[k]:.2f}"}
        row["difference"] = f"{_verdict(abs(off[k]) <= TARGET)} {_percent(off[k])}"
        if theirs is None:
            rows.append(row | {"whole, CalculiX": f"○ {versions['CalculiX']}", "difference from it": ""})
            continue
        row["whole, CalculiX"] = f"{s.calculix[k]:.2f}"
        rows.append(row | {"difference from it": f"{_verdict(abs(theirs[k]) <= TARGET)} {_percent(theirs[k])}"})
    return rows


def _ties(found: Example) -> list[dict[str, str]]:
    rest = found.speeds[0]
    torsion = [k for k, name in enumerate(rest.names) if name.startswith("torsion")]
    others = [k for k in range(len(rest.names)) if k not in torsion]
    rows = []
    for how, label in HOW.items():
        off = differences(rest.apart.get(how, rest.condensed), rest.whole)
        row = {"segment tied": label}
        for n, value in zip(found.lengths, found.torsion[how], strict=True):
            row[f"bar of {n} chord{'s' * (n > 1)}: GJ / St Venant's"] = f"{value:.3f}"
        row["cantilever"] = (
            _percent(_extreme(differences(found.cantilever[how], np.repeat(found.exact, 2))))
            if how in found.cantilever
            else ""
        )
        row["blade, bending"] = _percent(_extreme(off[others]))
        row["blade, torsion"] = _percent(_extreme(off[torsion])) if torsion else ""
        rows.append(row)
    return rows


def _cantilever(found: Example) -> list[dict[str, str]]:
    rows = []
    for k, exact in enumerate(found.exact):
        row = {"bending": f"{k + 1}", "Timoshenko, rad/s": f"{exact:.4f}"}
        for kind, values in found.cantilever.items():
            pair = differences(values[2 * k : 2 * k + 2], [exact, exact])
            row[f"{kind} ties"] = _percent(_extreme(pair))
        rows.append(row)
    return rows


def _torsion(found: Example) -> str:
    """The effect of rotation on torsion, in the solid and in the compressed model."""
    first, last = found.speeds[0], found.speeds[-1]
    at = [[k for k, name in enumerate(s.names) if name.startswith("torsion")][:1] for s in (first, last)]
    if not all(at):
        return ""
    (a,), (b,) = at
    solid, ours = last.whole[b] - first.whole[a], last.condensed[b] - first.condensed[a]
    return (
        "A complex stiffness element is linear in its own axes: unlike in a solid, steady tension stiffens its bending, but\n"
        f"not its torsion. Rotation raises the first torsional frequency of the solid by {solid:.1f} rad/s, that of the\n"
        f"elements by {ours:.1f}."
    )


def _ratio(found: Example) -> str:
    return f"{found.torsion['rigid'][0] / found.torsion['average'][0]:.1f}"


def _extreme(values: np.ndarray) -> float:
    return float(values[np.abs(values).argmax()])


def _verdict(good: bool) -> str:
    return "✔" if good else "✘"


def _size(value: float) -> str:
    return f"{100 * value:.2g} %"


def _percent(value: float) -> str:
    return f"{100 * value:+.3f} %".replace("-", "−")


def _table(rows: list[dict[str, str]]) -> str:
    return tabulate(rows, headers="keys", tablefmt="pipe", disable_numparse=True)
