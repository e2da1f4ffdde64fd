"""Beam elements: from the sections of a blade to stiffness and mass between two frames.

A ``Blade`` comes in; a ``Mesh`` of nodes and beam elements goes out (``discretize.discretize``). ``StrainLaw`` defines the
strain of an element from the relative pose of its ends, ``beams.pencil`` gives its residual and M, C, K about any state.
"""
