"""Linearisations against the machine of their deck: modes paired by shape, differences split into their parts."""
