"""The cases that come with the package, and any other by its file."""

from importlib.resources import as_file, files
from pathlib import Path

from .errors import CaseError, nearest
from .schema import Case, read


def names() -> tuple[str, ...]:
    """Names of the cases that come with the package, sorted."""
    return tuple(sorted(Path(f.name).stem for f in files(f"{__package__}.data").iterdir() if f.name.endswith(".toml")))


def load(name: str) -> Case:
    """A case by its name, or by the path of its TOML file.

    Raises:
        CaseError: if there is no such case (the nearest is suggested), or its file is at fault.
    """
    if name in names():
        with as_file(files(f"{__package__}.data")) as folder:
            return read(folder / f"{name}.toml")
    if name.endswith(".toml"):
        return read(Path(name))
    raise CaseError(f"case: {name!r} is not known: {nearest(name, names())}; or give the path of a .toml file")
