"""Steady states of blades and mechanisms."""
