"""A static site of a run and of its history: opens from the file system, without a server and without a network."""
