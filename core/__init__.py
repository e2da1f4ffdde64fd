"""Southwell's own solver and the data types (``Blade``, ``Modes``) that all codes share.

A ``Blade`` and a rotor speed come in; ``solve.modes`` divides the blade into elements, finds the steady state, linearises
about it and returns ``Modes``. ``multibody`` does the same for any mechanism. Nothing here imports from the other floors.
"""
