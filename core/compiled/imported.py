"""From which folder the package is imported, and which entry of ``sys.path`` leads to it."""

import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[2]


def remedy(otherwise: str) -> str:
    """What to do if the folder cannot be used: name a checkout that hides the installed package, or say ``otherwise``."""
    entry = next((entry for entry in sys.path if Path(entry or ".").resolve() == FOLDER.parent), None)
    if entry is None or FOLDER.name != __name__.partition(".")[0] or not (FOLDER / "pyproject.toml").is_file():
        return otherwise
    where = "the current folder" if FOLDER.parent == Path.cwd() else "a folder"
    return (
        f"{FOLDER} is imported, a checkout, because {FOLDER.parent} is {where} on sys.path and comes before installed "
        f"packages: start Python in another folder, or build the checkout: pip install --editable {FOLDER}"
    )
