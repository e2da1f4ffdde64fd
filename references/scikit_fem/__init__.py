"""scikit-fem: a prestressed rotating beam by finite elements. Input: a blade. Output: its modes."""
