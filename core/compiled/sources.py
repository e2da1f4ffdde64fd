"""Digest of the C++ sources, which is compiled into the modules: an older module is not loaded. Also run by ``setup.py``."""

from hashlib import sha256
from pathlib import Path

CORE = Path(__file__).resolve().parents[1]


def digest() -> str:
    """SHA-256 of names and contents of all C++ files of core."""
    checksum = sha256()
    for path in sorted(path for pattern in ("*/*.hpp", "*/*.cpp") for path in CORE.glob(pattern)):
        checksum.update(path.relative_to(CORE).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    return checksum.hexdigest()
