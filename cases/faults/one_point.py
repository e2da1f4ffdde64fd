"""The beam of scikit-fem, its weak form integrated with one Gauss point an element; only ever imported by a worker process."""

from ...references.scikit_fem import beam

beam.QUADRATURE = 1

CODE = beam.CODE
