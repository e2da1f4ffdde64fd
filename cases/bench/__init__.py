"""Cost of a frequency: core compared with the other codes."""
