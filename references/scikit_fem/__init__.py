"""scikit-fem: a prestressed rotating beam by finite elements. A blade comes in; modes go out."""
