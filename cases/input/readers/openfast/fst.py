"""OpenFAST's primary file (.fst), which references the files of the blade; these have separate readers.

``CompElast`` selects the blade: 1 ElastoDyn's (``EDFile``), 2 BeamDyn's (``BDBldFile(1)``) on the hub of ``EDFile``; it
is missing in files of FAST 8.00 to 8.02, which means 1.
FAST 7's .fst holds the turbine itself and is an ElastoDyn main file here.
Source: OpenFAST documentation, *glue code input files*.
"""

import os
from dataclasses import replace
from pathlib import Path

from ...errors import CaseError
from ..source import Mount, Reading
from ..text import Text, integer, keys, load, path_named
from . import beamdyn, elastodyn, elastodyn_unused


def matches_format(text: Text) -> bool:
    """Whether these are lines of a primary file."""
    return "edfile" in keys(text)


def read(path: Path, mount: Mount | None = None) -> Reading:
    """Read the first blade of the turbine in a primary file.

    Args:
        path: path of the file.
        mount: data that override the files; ``main`` is rejected, as the file references it.

    Raises:
        CaseError: naming the file and line at fault.
    """
    text, mount = load(path), mount or Mount()
    entries = keys(text)
    if mount.main is not None:
        raise CaseError(f"{path}: --main {mount.main}: the .fst file names its main file itself: leave out --main")
    kind = integer(text, entries, "CompElast") if "compelast" in entries else 1
    if kind not in (1, 2):
        raise CaseError(
            f"{text.at(entries['compelast'][0])}: CompElast: {kind}: only blades of ElastoDyn (1) and BeamDyn (2) are read"
        )
    hub = file_named(text, "EDFile")
    blade_reading = (
        elastodyn.read(hub, mount)
        if kind == 1
        else beamdyn.read(file_named(text, "BDBldFile1"), replace(mount, main=hub))
    )
    source = replace(blade_reading.source, files=(path, *blade_reading.source.files))
    if kind == 2:
        main = load(hub)
        others = elastodyn_unused.other_blades(text, "BDBldFile", integer(main, keys(main), "NumBl"))
        source = replace(source, notes=(*source.notes, *others))
    return replace(blade_reading, source=source)


def file_named(text: Text, name: str) -> Path:
    """The path under a name in a primary file.

    Raises:
        CaseError: if it is missing, or no file is there.
    """
    path = path_named(text, name, name.rstrip("1"))
    if not os.path.isfile(path):  # also False for an invalid name
        entries = keys(text)
        line = entries[name.lower() if name.lower() in entries else name.rstrip("1").lower()][0]
        raise CaseError(f"{text.at(line)}: {name}: {path}: no such file: correct the name, or put the file there")
    return path
