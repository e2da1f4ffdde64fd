"""scikit-fem: rotating, prestressed beams by finite elements."""
