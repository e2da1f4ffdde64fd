"""What a frequency costs: core and the other codes side by side."""
