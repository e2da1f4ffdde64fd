"""Verdicts on linearisations as text."""
