"""HAWC2: structural files, and the blade, the tower and the turbine of an htc."""
