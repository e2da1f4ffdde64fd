"""Closed forms and series for rotating beams and hinged rigid blades.

A straight blade comes in; modes go out, from Rayleigh–Ritz (``ritz``), an exact spectral solution or a formula.
"""
