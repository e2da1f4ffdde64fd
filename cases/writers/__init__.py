"""Blades written for other programs: BeamDyn and ElastoDyn. A ``Blade`` comes in; text goes out, with what it cannot hold."""
