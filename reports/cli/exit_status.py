"""Exit statuses, and the error of an argument; imports nothing, for `southwell --help` to be fast."""

PASSED, BAD_INPUT, INTERRUPTED = 0, 2, 130


class UsageError(ValueError):
    """An argument that cannot be used: names it, its value, the likely cause, the remedy."""
