"""A static site of a run and of its history, which opens from the file system without a server or network."""
