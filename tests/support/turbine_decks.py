"""A small OpenFAST deck of a turbine: 3 blades of 20 m on a tower of 30 m, nothing symmetric."""

from pathlib import Path

MAIN = """------- ELASTODYN INPUT FILE
small
3 NumBl
21 TipRad
1 HubRad
-3 PreCone(1)
-3 PreCone(2)
-3 PreCone(3)
0.1 HubCM
-2.5 OverHang
-5 ShftTilt
0.6 NacCMxn
0.2 NacCMyn
0.9 NacCMzn
1.1 Twr2Shft
30 TowerHt
0 TowerBsHt
0 TipMass(1)
3000 HubMass
2000 HubIner
20 GenIner
9000 NacMass
20000 NacYIner
100 YawBrMass
{blade} BldFile(1)
50 GBRatio
2.0E+07 DTTorSpr
1.0E+04 DTTorDmp
{tower} TwrFile
20 RotSpeed
{yaw} YawDOF
{free} GenDOF
True DrTrDOF
False PtfmPDOF
"""

TOWER = """------- ELASTODYN TOWER INPUT FILE
small
3 NTwInpSt
1 TwrFADmp(1)
1 AdjTwMa
1.1 AdjFASt
1 AdjSSSt
HtFract TMassDen TwFAStif TwSSStif
(-) (kg/m) (Nm^2) (Nm^2)
0.0 900 9.0E+09 8.0E+09
0.5 700 6.0E+09 5.5E+09
1.0 500 4.0E+09 3.5E+09
0.7 TwFAM1Sh(2)
"""

BLADE = """------- ELASTODYN BLADE INPUT FILE
small
3 NBlInpSt
1 AdjBlMs
1 AdjFlSt
1 AdjEdSt
BlFract PitchAxis StrcTwst BMassDen FlpStff EdgStff
(-) (-) (deg) (kg/m) (Nm^2) (Nm^2)
0.0 0.3 10 120 4.0E+08 6.0E+08
0.5 0.3 5 60 6.0E+07 2.0E+08
1.0 0.3 0 15 3.0E+06 2.0E+07
"""

SERVO = "------- SERVODYN INPUT FILE\nsmall\n3.0E+07 YawSpr\n2.0E+04 YawDamp\n"

PRIMARY = """------- OPENFAST INPUT FILE
small
1 CompElast
9.81 Gravity
"main.dat" EDFile
"servo.dat" ServoFile
"""


TEETER = """True TeetDOF
0.2 UndSling
0 Delta3
1 TeetMod
9.0E+03 TeetDmp
0 TeetSStP
5.0E+05 TeetSSSp
"""


def deck(folder: Path, free: bool = False, yaw: bool = True, two: bool = False) -> Path:
    """Write the deck, also that of a teetering rotor of ``two`` blades; return its primary file."""
    text = MAIN.format(blade='"blade.dat"', tower='"tower.dat"', free=free, yaw=yaw)
    if two:
        text = text.replace("3 NumBl", "2 NumBl").replace("-3 PreCone(3)\n", "") + TEETER
    for name, content in (
        ("main.dat", text),
        ("tower.dat", TOWER),
        ("blade.dat", BLADE),
        ("servo.dat", SERVO),
        ("small.fst", PRIMARY),
    ):
        (folder / name).write_text(content)
    return folder / "small.fst"
