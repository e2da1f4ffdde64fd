--------------------------------------------------------------------------------
------- FAST INPUT FILE --------------------------------------------------------
Invented two-bladed, teetering machine for tests
---------------------- SIMULATION CONTROL --------------------------------------
   2        NumBl       - Number of blades (-)
---------------------- TURBINE CONTROL -----------------------------------------
---------------------- FEATURE FLAGS -------------------------------------------
True        TeetDOF     - Rotor-teeter DOF (flag) [unused for 3 blades]
---------------------- INITIAL CONDITIONS --------------------------------------
   2.6      BlPitch(1)  - Blade 1 initial pitch (degrees)
   2.6      BlPitch(2)  - Blade 2 initial pitch (degrees)
   9.9      BlPitch(3)  - Blade 3 initial pitch (degrees) [unused for 2 blades]
  20.5      RotSpeed    - Initial or fixed rotor speed (rpm)
---------------------- TURBINE CONFIGURATION -----------------------------------
  41.5      TipRad      - The distance from the rotor apex to the blade tip (meters)
   1.5      HubRad      - The distance from the rotor apex to the blade root (meters)
  -0.4      UndSling    - Undersling length [distance from teeter pin to the rotor apex] (meters)
   3.0      PreCone(1)  - Blade 1 cone angle (degrees)
   3.5      PreCone(2)  - Blade 2 cone angle (degrees)
   9.9      PreCone(3)  - Blade 3 cone angle (degrees) [unused for 2 blades]
  15.0      Delta3      - Delta-3 angle for teetering rotors (degrees)
---------------------- MASS AND INERTIA ----------------------------------------
   0.0      TipMass(1)  - Tip-brake mass, blade 1 (kg)
   0.0      TipMass(2)  - Tip-brake mass, blade 2 (kg)
---------------------- BLADE ---------------------------------------------------
"fast7_blade.dat"       BldFile(1)  - Name of file containing properties for blade 1 (quoted string)
"fast7_blade.dat"       BldFile(2)  - Name of file containing properties for blade 2 (quoted string)
"unused"                BldFile(3)  - Name of file containing properties for blade 3 (quoted string)
---------------------- ROTOR-TEETER --------------------------------------------
   1        TeetMod     - Rotor-teeter spring/damper model (switch) [unused for 3 blades]
4.0E4       TeetDmp     - Rotor-teeter damping constant (N-m/(rad/s)) [unused for 3 blades]
