"""Parameter studies: sampled properties of blades, solved at many speeds on one machine or a cluster."""
