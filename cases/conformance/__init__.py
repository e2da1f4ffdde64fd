"""Conformance checks that an adapter must pass before its answers are compared.

A code comes in; a list of failed checks goes out.
"""
