"""Errors of the command line; imports nothing, for `southwell --help` to be fast."""


class UsageError(ValueError):
    """An argument that cannot be used: names it, its value, the likely cause, the remedy."""


class IncompleteError(ValueError):
    """A run that is not complete, where only a complete one will do: names it, says what is missing."""
