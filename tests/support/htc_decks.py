"""A small turbine as HAWC2's htc file and as Southwell's TOML: 3 blades of 20 m on a tower of 30 m, nothing symmetric."""

from collections.abc import Sequence
from pathlib import Path

Point = tuple[float, float, float]

BLADE = """fraction [-],twist [deg],mass [kg/m],EI_flap [N m^2],EI_edge [N m^2]
0,8,120,4e8,6e8
0.5,8,60,6e7,2e8
1,8,15,3e6,2e7
"""
"""The blade's table, read with its length, hub radius and precone."""

TOML = """name = "small"
gravity = 9.81
rotor_speed = 20.0

[tower]
height = 30.0
stations = [0.0, 15.0, 30.0]
mass = [900.0, 700.0, 500.0]
EI_fore_aft = [9e9, 6e9, 4e9]
EI_side_side = [8e9, 5.5e9, 3.5e9]
GJ = [7e9, 5e9, 3e9]
top = {mass = 100.0, centre = [0.1, 0.2, 0.3], moments = [40.0, 50.0, 60.0]}

[nacelle]
mass = 9000.0
centre = [0.6, 0.2, 0.9]
moments = [9000.0, 12000.0, 16400.0]
shaft_height = 1.1
overhang = -2.5
tilt = -5.0

[hub]
mass = 3000.0
inertia = 2000.0
transverse_inertia = 1500.0
centre = 0.1

[rotor]
blade = "blade.csv"
length = 20.0
hub_radius = 1.0
precone = -3.0
pitch = 2.0

[drivetrain]
stiffness = 2.0e7
generator_inertia = 5.0e4
generator = "free"
"""

ROD = 1e-7
"""Mass per length of the bodies that weigh nothing, kg/m."""


def section(r: float, mass: float, flap: float, edge: float, torsion: float, offset: Point = (0.0, 0.0, 0.0)) -> str:
    """A row of a structural file: modulus 1, rigid in stretch and shear; ``offset`` is x_cg and y_cg, and both radii."""
    x, y, radius = offset
    return f"{r} {mass} {x} {y} {radius} {radius} 0 0 1 1 {flap} {edge} {torsion} 1 1 1e16 0 0 0"


def rigid(length: float, mass: float = ROD, offset: Point = (0.0, 0.0, 0.0), stiff: float = 1e16) -> list[str]:
    return [section(r, mass, stiff, stiff, stiff, offset) for r in (0.0, length)]


def shaft(length: float, stiffness: float, mass: float = ROD, bending: float = 1e16) -> list[str]:
    return [section(r, mass, bending, bending, stiffness * length) for r in (0.0, length)]


ROWS: dict[str, list[str]] = {
    "tower": [
        section(0.0, 900, 9e9, 8e9, 7e9),
        section(15.0, 700, 6e9, 5.5e9, 5e9),
        section(30.0, 500, 4e9, 3.5e9, 3e9),
    ],
    "towertop": rigid(1.1),
    "shaft": shaft(2.5, 2e7),
    "hub1": rigid(1.0),
    "blade1": [section(0.0, 120, 4e8, 6e8, 1e16), section(10.0, 60, 6e7, 2e8, 1e16), section(20.0, 15, 3e6, 2e7, 1e16)],
}
"""Sections of each body; the tables begin with 1, the shaft's with 2."""

POINTS: dict[str, list[Point]] = {
    "tower": [(0, 0, 0), (0, 0, -30)],
    "towertop": [(0, 0, 0), (0, 0, -1.1)],
    "shaft": [(0, 0, 0), (0, 0, 2.5)],
    "hub1": [(0, 0, 0), (0, 0, 1)],
    "blade1": [(0, 0, 0), (0, 0, 10), (0, 0, 20)],
}

MASSES: dict[str, list[str]] = {
    "tower": ["2 0.2 0.1 -0.3 100 50 40 60"],
    "towertop": ["2 0.2 0.6 0.2 9000 12000 9000 16400"],
    "shaft": ["1 0 0 0 0 0 0 5e4", "2 0 0 -0.1 3000 1500 1500 2000"],
}
"""Concentrated masses: HAWC2's x is to port, y downwind, z down; the shaft's z points upwind."""

ORIENTATION = """begin orientation;
begin base;
  body tower;
  inipos 0 0 0;
  body_eulerang 0 0 0;
end base;
begin relative;
  body1 tower last;
  body2 towertop 1;
  body2_eulerang 0 0 0;
end relative;
begin relative;
  mbdy1 towertop last;
  mbdy2 shaft 1;
  mbdy2_eulerang 90 0 0;
  mbdy2_eulerang 5 0 0;  the tilt
  mbdy2_ini_rotvec_d1 0 0 -1 2.0943951023931953;
end relative;
"""

HUB = """begin relative;
  body1 shaft last;
  body2 hub{n} 1;
  body2_eulerang -90 0 0;
  body2_eulerang 0 {azimuth} 0;
  body2_eulerang 3 0 0;  the cone
end relative;
begin relative;
  body1 hub{n} last;
  body2 blade{n} 1;
  body2_eulerang 0 0 {pitch};
end relative;
"""

CONSTRAINTS = [
    ("fix1", "tower", "towertop"),
    ("bearing1", "towertop", "shaft"),
    *(("fix1", "shaft", f"hub{n}") for n in (1, 2, 3)),
    *(("bearing2", f"hub{n}", f"blade{n}") for n in (1, 2, 3)),
]


def body(name: str, rows: str, points: Sequence[Point], masses: Sequence[str], twist: float = 0.0) -> str:
    sections = "".join(f"    sec {k + 1} {x} {y} {z} {twist} ;\n" for k, (x, y, z) in enumerate(points))
    weights = "".join(f"  concentrated_mass {mass} ;\n" for mass in masses)
    return (
        f"begin main_body;\n  name {name} ;\n  node_distribution c2_def ;\n  damping_posdef 0 0 0 1e-3 1e-3 1e-3 ;\n{weights}"
        f"  begin timoschenko_input;\n    filename {rows} ;\n    set 1 1 ;\n  end timoschenko_input;\n"
        f"  begin c2_def;\n    nsec {len(points)} ;\n{sections}  end c2_def ;\nend main_body;\n"
    )


def copy(name: str, original: str) -> str:
    return f"begin main_body;\n  name {name} ;\n  copy_main_body {original} ;\nend main_body;\n"


def htc(
    folder: Path,
    rows: dict[str, list[str]] | None = None,
    points: dict[str, list[Point]] | None = None,
    masses: dict[str, list[str]] | None = None,
    pitch: float = 2.0,
    extra: str = "",
) -> Path:
    """Write the htc and its structural files, some of them other than above; return the htc."""
    rows, points, masses = {**ROWS, **(rows or {})}, {**POINTS, **(points or {})}, {**MASSES, **(masses or {})}
    text = "begin new_htc_structure;\n"
    for name, table in rows.items():
        (folder / f"{name}.st").write_text(f"#1 {name}\n$1 {len(table)}\n" + "\n".join(table) + "\n")
        text += body(name, f"{name}.st", points[name], masses.get(name, ()), 8.0 if name == "blade1" else 0.0)
    text += "".join(copy(f"{what}{n}", f"{what}1") for what in ("hub", "blade") for n in (2, 3)) + ORIENTATION
    for n, azimuth in ((1, 180), (2, 60), (3, -60)):
        text += HUB.format(n=n, azimuth=azimuth, pitch=pitch)
    text += "end orientation;\nbegin constraint;\nbegin fix0;\n  body tower;\nend fix0;\n"
    for kind, first, second in CONSTRAINTS:
        text += f"begin {kind};\n  body1 {first} last;\n  body2 {second} 1;\n  bearing_vector 2 0 0 -1;\nend {kind};\n"
    path = folder / "small.htc"
    path.write_text(text + "end constraint;\n" + extra + "end new_htc_structure;\n")
    return path


def toml(folder: Path, text: str = TOML) -> Path:
    """Write the same turbine as TOML; return its file."""
    (folder / "blade.csv").write_text(BLADE)
    path = folder / "small.toml"
    path.write_text(text)
    return path
