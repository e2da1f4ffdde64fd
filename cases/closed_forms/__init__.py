"""Mechanisms whose eigenvalues are known in closed form, compared with core."""
