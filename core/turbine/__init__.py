"""A turbine as a machine: tower, nacelle, drivetrain, hub and blades, their modes and the names of these."""
