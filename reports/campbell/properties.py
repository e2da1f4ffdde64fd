"""A blade's properties as facts and as a table along the span."""

import numpy as np
from numpy.typing import NDArray

from ...cases.input.properties import Mass, SectionProperties, about_hub, about_root, farthest, tip
from ...core.blade import Blade, straight

Array = NDArray[np.float64]

ROWS = 13
"""Number of stations in a table, unless all are requested."""

COLUMNS = (
    *("s [m]", "mass [kg/m]", "EI flap [N m²]", "EI edge [N m²]", "GJ [N m²]", "EA [N]", "twist [deg]"),
    *("mass y [m]", "mass z [m]", "tension y [m]", "tension z [m]", "shear y [m]", "shear z [m]"),
)
PROPERTIES = 7
"""Number of columns before those of the centres."""

MORE = ("principal axes [deg]", "mass axes [deg]", "axis x [m]", "axis y [m]", "axis z [m]")
"""Further columns of the CSV: angles of axes from the section's y and z, empty if undefined; reference axis."""

CONVENTIONS = (
    "x along the blade, z the rotor axis, y the direction of motion (to the leading edge); sections turn with twist and "
    "pitch from y towards z (leading edge downwind)"
)


def facts(blade: Blade) -> dict[str, str]:
    """Facts on a blade by name, including its tip mass."""
    hub, root = about_hub(blade), about_root(blade)
    x, y, z = np.where(np.abs(hub.centre) < 1e-9 * blade.length, 0.0, hub.centre)
    springs = zip(("x", "y", "z", "torsion", "flap", "lag"), blade.root, strict=True)
    springs_text = [f"{name} {f'spring {k:.6g}' if k else 'free'}" for name, k in springs if np.isfinite(k)]
    bends = f"prebend {farthest(blade.curve[:, 2]):.5g} m, sweep {farthest(blade.curve[:, 1]):.5g} m (largest)"
    end, pitch = tip(blade), float(np.degrees(blade.pitch))
    return {
        "mass": f"{hub.mass:.6g} kg" + (f", of which {end.mass:.6g} kg at the tip" if end else ""),
        "tip mass": _body(end) if end else "",
        "centre of mass": f"x {x:.6g}, y {y:.4g}, z {z:.4g} m in the hub's axes",
        "first moment": (
            f"{np.hypot(*hub.first[:2]):.7g} kg m about the rotor's axis, {root.first[0]:.7g} kg m about the root"
        ),
        "second moment": (
            f"{hub.moments[2, 2]:.7g} kg m² about the rotor's axis, {root.moments[2, 2]:.7g} kg m² about the root, edgewise"
        ),
        "length": f"{blade.length:.6g} m along the reference axis",
        "hub radius": f"{blade.hub_radius:.6g} m",
        "precone": f"{np.degrees(blade.precone):.5g}° (positive downwind)",
        "pitch": f"{pitch:.5g}° (positive with the leading edge downwind; as OpenFAST's BlPitch: {0.0 - pitch:.5g}°)",
        "root": "clamped" if not springs_text else f"{', '.join(springs_text)}; otherwise clamped",
        "reference axis": f"{'straight' if straight(blade) else bends}; {len(blade.stations)} stations",
        "axes": CONVENTIONS,
    }


def _body(body: Mass) -> str:
    (x, y, z), own = body.centre + 0.0, body.own
    moments = ", ".join(f"{k:.5g}" for k in np.where(np.abs(own) < 1e-9 * np.abs(own).max(), 0.0, own).diagonal())
    return f"centre x {x:.5g}, y {y:.5g}, z {z:.5g} m from the tip; moments of inertia about it {moments} kg m²; section axes"


def rows(blade: Blade, sampled: SectionProperties) -> Array:
    """(n, columns) numbers of all stations, columns as in ``COLUMNS``."""
    stiff = (blade.mass[:, 0, 0], sampled.EI_flap, sampled.EI_edge, sampled.GJ, sampled.EA, np.degrees(blade.twist))
    return np.column_stack([blade.stations, *stiff, sampled.mass_centre, sampled.tension_centre, sampled.shear_centre])


def picked(stations: int, limit: int | None = ROWS) -> NDArray[np.intp]:
    """At most ``limit`` evenly spaced stations, including both ends."""
    return np.unique(np.linspace(0, stations - 1, min(stations, limit or stations)).round().astype(int))


def cell(column: int, x: float) -> str:
    """A number of a column of ``COLUMNS`` as text."""
    if np.isinf(x):
        return "rigid"
    return f"{x:.4g}" if 0 < column < 6 else f"{round(x, 3) + 0.0:.3f}"
