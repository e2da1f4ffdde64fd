"""Linearisations written by other programs: read, transformed to the fixed frame, named and judged."""
