"""Exudyn: ANCF cable, kinematic tree, and mechanisms with closed loops.

A blade or a mechanism comes in; modes go out. The three models share one engine.
"""
