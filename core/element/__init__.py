"""Beam elements: from a blade's sections to stiffness and mass between two frames.

A ``Blade`` comes in; a ``Chain`` of nodes and beam elements goes out (``discretize``). ``measures`` defines the strain of two
frames, ``pencil`` the compiled M, C and K of an element.
"""
