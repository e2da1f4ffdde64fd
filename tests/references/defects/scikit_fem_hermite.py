"""scikit-fem: an ElementLineHermite used on a second mesh keeps the first mesh's functions, silently.

Bending stiffness of two elements, on a line of length 1 and then on one of length 2, by one element instance and by a
new one. The diagonal entry of the middle deflection is 2 · 12 / h³.
Needs: scikit-fem, numpy.
"""

from importlib.metadata import version

import numpy as np
import skfem as fem


@fem.BilinearForm
def bending(u, v, w):
    return u.hess[0, 0] * v.hess[0, 0]


def middle(length, element):
    basis = fem.Basis(fem.MeshLine(np.linspace(0.0, length, 3)), element)
    stiffness = bending.assemble(basis).toarray()
    deflections = np.array(basis.nodal_dofs)[0]
    return stiffness[deflections, deflections].max()


def main():
    print(f"scikit-fem {version('scikit-fem')}")
    element = fem.ElementLineHermite()
    first, second, new = middle(1.0, element), middle(2.0, element), middle(2.0, fem.ElementLineHermite())
    print(f"length 1:                       {first:g} (expected 192)")
    print(f"length 2, the same element:     {second:g} (expected 24)")
    print(f"length 2, a new element:        {new:g} (expected 24)")
    print("defect:", "gone" if np.isclose(second, 24.0) else "present")


if __name__ == "__main__":
    main()
