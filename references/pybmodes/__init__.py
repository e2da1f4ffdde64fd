"""pyBModes: NREL's BModes beam element. A blade comes in; modes go out."""
