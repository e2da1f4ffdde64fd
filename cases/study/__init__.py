"""Parameter studies: sampled properties of blades, solved by core at many speeds on one machine or a cluster."""
