"""Mechanisms in Pinocchio: bodies and joints as described come in; modes about the steady state go out.

The spanning tree, the loop closure and the reduction are this package's own; nothing of core's solver is imported.
"""
