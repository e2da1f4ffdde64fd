"""Finite element matrices to complex stiffness elements and rigid bodies (Park et al. 2010, figs 1 and 2).

A finite element model comes in, as matrices (``read_matrix``, ``stored``) and the nodes of its sections; segments with 6×6
stiffness and inertia go out (``segments_in_place``). ``mesh_from_segments`` joins them to a mesh, of which ``chain_modes`` of
``core.solve`` gives the modes.
"""
