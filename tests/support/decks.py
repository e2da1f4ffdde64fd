"""Small decks without symmetry, so that an exchange, a sign or a missing transfer changes a number."""

import shutil
from pathlib import Path

import numpy as np

BLADES = Path(__file__).parents[1] / "data" / "blades"

PLAIN = "r m x_cg y_cg ri_x ri_y x_sh y_sh E G I_x I_y I_p k_x k_y A pitch x_e y_e"
HTC = """begin new_htc_structure;
  begin main_body;
    name blade1 ;
    begin timoschenko_input ;
      filename ./{file} ;
      set 1 1 ;
    end timoschenko_input;
    begin c2_def;
      nsec 4 ;
      sec 1 0.0 0.0 0.0 -12.0 ;
      sec 2 -0.02 -0.05 7.0 -8.0 ;
      sec 3 -0.06 -0.20 14.0 -3.0 ;
      sec 4 -0.10 -0.50 20.0 1.0 ;
    end c2_def ;
  end main_body;
end new_htc_structure ;
"""
MESH = """
--------- Finite element discretization --------------------------------------------------
4         nselt:     no of blade or tower elements (-)
Distance of element boundary nodes from blade or flexible-tower root (normalized wrt blade or tower length)
0.0 0.25 0.5 0.75 1.0
"""


def hawc2(folder: Path, full: bool = False) -> Path:
    """A structural file of 19 columns, or of 30 with a full matrix, and the htc that is returned."""
    rows = []
    for k, r in enumerate((0.0, 9.0, 20.0)):
        scale = 1.0 / (1 + k)
        shared = [r, 90.0 * scale, 0.21 - 0.02 * k, -0.06, 0.35, 0.62]
        if full:
            a = np.eye(6) + 0.03 * np.add.outer(np.arange(6), np.arange(6))
            d = np.sqrt(scale * np.array([2e8, 1e8, 1e9, 1.2e7, 8e7, 2e7]))
            matrix = d[:, None] * (0.2 * a @ a.T + np.eye(6)) * d
            rows.append([*shared, 6.0 + k, 0.12, -0.03, *matrix[np.triu_indices(6)]])
        else:
            rows.append([*shared, 0.08, 0.05, 1e10, 4e9, 1e-3, 8e-3, 3e-3, 0.6, 0.4, 0.1 * scale, 6.0 + k, 0.12, -0.03])
    name = "full_st.dat" if full else "plain_st.dat"
    lines = [
        "1 ; number of sets",
        "#1 ; invented",
        f"$1 {len(rows)}",
        *(" ".join(f"{v:.9e}" for v in row) for row in rows),
    ]
    (folder / name).write_text("\n".join(lines) + "\n")
    path = folder / name.replace("_st.dat", ".htc")
    path.write_text(HTC.format(file=name))
    return path


def bmodes(folder: Path) -> Path:
    """The sample of BModes with the lines that BModes itself requires, and axes of inertia rotated from the chord."""
    main = (BLADES / "bmodes.bmi").read_text()
    head = "t         TabDelim    (true: tab-delimited output tables)"
    assert head in main
    path = folder / "bmodes.bmi"
    path.write_text(main.replace(head, f"{head}\nf         mid_node_tw  (true: twist at mid-nodes)") + MESH)
    shutil.copy(BLADES / "bmodes_sections.dat", folder)
    return path


def csv(folder: Path) -> Path:
    """A table of stations with inertia and mass centres off the axis."""
    path = folder / "blade.csv"
    path.write_text(
        "# invented\n"
        "fraction [-],twist [deg],mass [kg/m],EI_flap [N m^2],EI_edge [N m^2],GJ [N m^2],EA [N],"
        "I_flap [kg m],I_edge [kg m],cg_edge [m]\n"
        "0,8,100,3e7,9e7,1e7,1e9,4,16,0.1\n0.5,3,60,1e7,4e7,4e6,6e8,2,9,0.15\n1,0,20,2e6,1e7,1e6,2e8,0.5,3,0.05\n"
    )
    return path


def openfast(folder: Path) -> None:
    """The samples of ElastoDyn, BeamDyn and FAST 7, with a tip mass that differs between blades."""
    for path in BLADES.glob("*.*"):
        if path.name != "beamdyn_old_main.dat":
            shutil.copy(path, folder)
