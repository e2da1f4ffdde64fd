"""Mechanisms in Pinocchio: bodies and joints, closed loops, and the modes about the steady state.

The spanning tree, the loop closure and the reduction are implemented here; nothing of core's solver is imported.
"""
