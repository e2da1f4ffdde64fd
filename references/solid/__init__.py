"""Three-dimensional solid blades: scikit-fem hexahedra and CalculiX.

A box or a blade of one material comes in; modes go out, or the matrices that ``core.condense`` takes.
"""
