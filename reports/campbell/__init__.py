"""A Campbell diagram as figures, tables and CSV."""
