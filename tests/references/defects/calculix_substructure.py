"""CalculiX: *SUBSTRUCTURE GENERATE fixes the nodes that are not retained instead of eliminating them.

Eight 20-node bricks end to end; the nodes of both end faces are retained. A condensed stiffness lets the block move as
a rigid body without force. CalculiX's resists it, because the nodes between are fixed.
Needs: ccx on the PATH, numpy.
"""

import re
import subprocess
import tempfile
from pathlib import Path

import numpy as np

BRICKS = 8
PLACES = [
    *[(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)],
    *[(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)],
    *[(0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)],
]


def deck():
    grid = [(x, y, z) for x in range(2 * BRICKS + 1) for y in range(3) for z in range(3) if x % 2 + y % 2 + z % 2 <= 1]
    number = {place: k for k, place in enumerate(grid, 1)}
    lines = ["*NODE,NSET=ALL", *(f"{k},{x / 2},{y / 2},{z / 2}" for (x, y, z), k in number.items())]
    lines += ["*ELEMENT,TYPE=C3D20,ELSET=ALL"]
    for element in range(BRICKS):
        own = [str(number[x + 2 * element, y, z]) for x, y, z in PLACES]
        lines += [f"{element + 1}," + ",".join(own[:10]) + ",", ",".join(own[10:])]
    ends = [k for (x, _, _), k in number.items() if x in (0, 2 * BRICKS)]
    lines += ["*MATERIAL,NAME=M", "*ELASTIC", "1.,0.3", "*DENSITY", "1.", "*SOLID SECTION,ELSET=ALL,MATERIAL=M"]
    lines += ["*NSET,NSET=ENDS", *map(str, ends), "*STEP", "*SUBSTRUCTURE GENERATE"]
    lines += ["*RETAINED NODAL DOFS,SORTED=NO", "ENDS,1,3"]
    lines += ["*SUBSTRUCTURE MATRIX OUTPUT,STIFFNESS=YES,OUTPUT FILE=USER DEFINED,FILE NAME=block", "*END STEP"]
    return lines, len(ends)


def main():
    version_text = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout
    print("ccx", *re.findall(r"Version\s+(\S+)", version_text))
    lines, ends = deck()
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "block.inp").write_text("\n".join(lines) + "\n")
        subprocess.run(["ccx", "-i", "block"], cwd=folder, capture_output=True, text=True, check=True)
        text = Path(folder, "block.mtx").read_text()
    numbers = " ".join(line for line in text.partition("*MATRIX")[2].splitlines()[1:] if not line.startswith("*"))
    half = np.array(re.findall(r"[-+]?\d+\.?\d*(?:[EeDd][-+]?\d+)?", numbers), float)
    size = 3 * ends
    stiffness = np.zeros((size, size))
    stiffness[np.tril_indices(size)] = half  # row by row
    stiffness += np.tril(stiffness, -1).T
    near, far = slice(size // 2), slice(size // 2, size)
    coupling = np.abs(stiffness[near, far]).max() / np.abs(stiffness).max()
    along = np.tile([1.0, 0.0, 0.0], ends)
    resisted = np.abs(stiffness @ along).max() / np.abs(stiffness).max()
    print(f"coupling of the two ends: {coupling:.1e} of the largest stiffness (expected: some)")
    print(f"force that a rigid translation along x needs: {resisted:.1e} of the largest stiffness (expected: rounding)")
    print("defect:", "present" if resisted > 1e-6 else "gone")


if __name__ == "__main__":
    main()
