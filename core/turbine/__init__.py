"""A turbine as a machine: tower, nacelle, drivetrain, hub and blades, and the names of their modes."""
