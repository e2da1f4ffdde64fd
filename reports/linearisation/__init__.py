"""Judgements of linearisations as text."""
