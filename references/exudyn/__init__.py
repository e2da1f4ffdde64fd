"""Exudyn: ANCF cable, geometrically exact beam, kinematic tree, and mechanisms with closed loops.

Input: a blade or a mechanism. Output: its modes. The four models share one engine.
"""
