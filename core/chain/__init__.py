"""The fast solver for a blade: a chain of elements with block-tridiagonal matrices.

A ``Chain`` comes in. ``steady`` finds its rotating equilibrium, ``pencil`` linearises about it, ``lanczos`` finds the lowest
modes, and ``mode_shapes`` reads their shapes. ``as_mechanism`` hands the same chain to ``multibody``.
"""
