"""Core's discretisation as a chain of joints in Pinocchio, Drake and MuJoCo.

These codes check the implementation: nodes, inertias and element stiffness are core's, kinematics and dynamics are theirs.
"""
