"""Models of measured rotors against their measurements, as a page."""
