"""Style, units, tables and the console: what every kind of output uses."""
