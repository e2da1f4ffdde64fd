"""pyBModes: NREL's BModes beam element."""
