"""Errors of the command line. Imports nothing, so that `southwell --help` is fast."""


class UsageError(ValueError):
    """An invalid argument; the message has its name, its value, the likely cause and the remedy."""


class IncompleteError(ValueError):
    """A run is incomplete where a complete one is required; the message has its name and what is missing."""
