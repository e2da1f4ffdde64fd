"""Closed forms and series for rotating beams and hinged rigid blades.

Input: a straight blade. Output: its modes, by Rayleigh–Ritz (``ritz``), an exact spectral solution or a formula.
"""
