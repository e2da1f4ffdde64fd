"""Labels as names of files and folders: whatever a label says, it leads nowhere else, and no two share a name."""

import hashlib
import re

LONGEST = 80
"""Characters of a label in a name: file systems end at 255 bytes."""


def file_name(label: str) -> str:
    """A label as one part of a path: what is plain in it, and a number of its own where not all is."""
    plain = re.sub(r"[^A-Za-z0-9._-]+", "-", label.replace("/", "-"))[:LONGEST].strip(".-") or "unnamed"
    number = "" if plain == label.replace("/", "-") else "-" + hashlib.sha256(label.encode()).hexdigest()[:8]
    return plain + number
