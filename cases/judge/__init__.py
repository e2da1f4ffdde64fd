"""Pairing of modes, uncertainty, verdicts and results.

Modes of two codes come in; cells with a difference, its uncertainty and a verdict go out.
"""
