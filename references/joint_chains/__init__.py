"""Southwell's discretisation as a chain of joints in Pinocchio, Drake and MuJoCo.

These codes check the implementation only: nodes, inertias and element stiffness come from core, kinematics and dynamics
from the code.
"""
