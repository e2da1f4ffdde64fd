"""Measured rotors: a model written before its measurements were looked at, and the comparison of the two.

In: a model's data, and frequencies that a test rig gave, with their uncertainty. Out: E = S − D against u_val, line by line.
"""
