"""Three-dimensional solid blades: scikit-fem hexahedra and CalculiX.

Input: a box or a blade of one material. Output: its modes, or matrices for ``core.condense``.
"""
