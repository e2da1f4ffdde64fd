"""Writers of blade files for other programs: BeamDyn and ElastoDyn."""
