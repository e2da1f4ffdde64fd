"""Why the frequencies of another program differ from the solver's: arithmetic, offset and slope, and solved hypotheses."""
