"""File and folder names for labels: safe in a path, and unique."""

import hashlib
import re

MAX_NAME = 80
"""Largest number of characters of a label in a name; file systems allow 255 bytes."""


def file_name(label: str) -> str:
    """A label as one part of a path.

    Characters other than letters, digits and ``._-`` are replaced. A changed label gets part of its hash, so that names
    are unique.
    """
    plain = re.sub(r"[^A-Za-z0-9._-]+", "-", label.replace("/", "-"))[:MAX_NAME].strip(".-") or "unnamed"
    number = "" if plain == label.replace("/", "-") else "-" + hashlib.sha256(label.encode()).hexdigest()[:8]
    return plain + number
