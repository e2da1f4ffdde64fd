"""Pages of the documentation site and the tables of the README, generated from a run."""
