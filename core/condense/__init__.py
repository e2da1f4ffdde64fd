"""Finite element matrices to complex stiffness elements and rigid bodies (Park et al. 2010, figs 1 and 2).

A finite element model comes in, as matrices and the nodes of its sections; segments with 12×12 stiffness and 6×6 inertia
go out, and ``compressed`` solves the chain they form.
"""
