"""Frequencies and modes: eigenvalue solvers, completeness, refinement and uncertainty."""
