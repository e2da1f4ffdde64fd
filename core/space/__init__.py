"""Rigid-body motions: poses (SE(3)), twists, wrenches and inertias.

Poses (..., 4, 4), twists and wrenches (..., 6) and inertias (..., 6, 6) come in and go out, in batches. ``rigid.hpp`` has the
formulae for one motion. Nothing here depends on bodies or beams.
"""
