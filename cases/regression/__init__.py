"""Comparison of a run with an earlier one: the history of runs and the gate."""
