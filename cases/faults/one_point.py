"""The beam of scikit-fem with one Gauss point per element; imported only by a worker process."""

from ...references.scikit_fem import beam

beam.QUADRATURE = 1

CODE = beam.CODE
