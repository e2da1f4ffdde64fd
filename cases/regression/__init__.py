"""One run against an earlier one: the history of runs and the gate."""
