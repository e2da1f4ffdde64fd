"""Exudyn: ANCF cable, kinematic tree, and mechanisms with closed loops.

Input: a blade or a mechanism. Output: its modes. The three models share one engine.
"""
