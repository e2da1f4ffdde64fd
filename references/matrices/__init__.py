"""Numerical methods that adapters share: modes of matrices, rotors with equal blades, mechanisms in other units.

For codes that return matrices instead of frequencies. Core has its own methods and never uses these.
"""
