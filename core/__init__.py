"""Southwell's solver and the data types (``Blade``, ``Modes``) shared by all codes.

A ``Blade`` and a rotor speed come in; ``solve.modes`` divides the blade into elements, finds the steady state, linearises
about it and returns ``Modes``. ``multibody`` does the same for any mechanism. This floor imports none of the others.
"""
