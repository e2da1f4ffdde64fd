"""Mechanisms in Pinocchio. Input: bodies and joints. Output: modes about the steady state.

The spanning tree, the loop closure and the reduction are implemented here; nothing of core's solver is imported.
"""
