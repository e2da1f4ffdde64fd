"""The commands on one blade: its modes, diagram, properties, conversion, condensation and variation."""
