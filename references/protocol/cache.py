"""The cache folder: isolated environments and stored answers."""

import os
from pathlib import Path


def cache() -> Path:
    """Folder of everything this package keeps: ``SOUTHWELL_CACHE``, or ``southwell`` in the user's cache folder."""
    if own := os.environ.get("SOUTHWELL_CACHE"):
        return Path(own)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "southwell"
