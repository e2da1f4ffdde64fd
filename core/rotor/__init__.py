"""Periodic systems: parts that spin on a support, linearised at azimuths; multi-blade coordinates, Floquet, Hill, whirl.

The equations are ``M(ψ) ẍ + C(ψ) ẋ + K(ψ) x = 0`` with the azimuth ψ = Ω t.
"""
