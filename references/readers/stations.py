"""What a second reader returns, what it is asked, and why it may return nothing."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

HINT = "pip install '.[readers]' in a checkout of Southwell"
"""How to install the parsers."""


class NotReadError(Exception):
    """A second reader did not read a file; the message gives the reason in one line."""


class NotInstalledError(NotReadError):
    """The parser of a format is not installed; the message says how to install it."""


@dataclass(frozen=True)
class ReadingOptions:
    """What a user states besides the file, and the files that belong to it.

    Attributes:
        siblings: files that belong to it: ElastoDyn's or BeamDyn's main file of a blade file, the htc of a structural file.
        length: from root to tip, m; needed by formats that contain only fractions of it.
        subset: set and subset of a HAWC2 structural file.
        multipliers: of mass, flapwise and edgewise stiffness: of a CSV, or of an ElastoDyn table in place of the file's.
        offsets: whether the offset columns of a CSV or of a FAST 7 table are used.
    """

    siblings: tuple[Path, ...] = ()
    length: float | None = None
    subset: tuple[int, int] | None = None
    multipliers: tuple[float, float, float] | None = None
    offsets: bool = True


@dataclass(frozen=True)
class Stations:
    """A blade's stations as a second reader sees them: axes, order and units of ``core.blade``.

    NaN stands for a number that the parser does not read, which is then not compared.

    Attributes:
        reader: parser and version.
        s: (n,) arc length from the root, m.
        stiffness: (n, 6, 6) in section axes; ``inf`` on the diagonal is a rigid strain.
        mass: (n, 6, 6) in section axes.
        twist: (n,) rad.
        curve: (n, 3) reference curve from the root, m.
        mounting: hub_radius (m), precone (rad), pitch (rad) and tip_mass (kg), where the files state them.
        violations: what the file violates of its format's schema, one line for each field.
    """

    reader: str
    s: Array
    stiffness: Array
    mass: Array
    twist: Array
    curve: Array
    mounting: Mapping[str, float] = field(default_factory=dict)
    violations: tuple[str, ...] = ()


def straight(s: Array) -> Array:
    """A reference curve (n, 3) along x."""
    return np.stack([s, np.zeros_like(s), np.zeros_like(s)], axis=1)


def parser(distribution: str, import_: Callable[[], Any]) -> tuple[Any, str]:
    """The imported parser, and its name with its version.

    Raises:
        NotInstalledError: if it is not installed.
    """
    try:
        return import_(), f"{distribution} {metadata.version(distribution)}"
    except (ImportError, metadata.PackageNotFoundError) as error:
        raise NotInstalledError(f"{distribution} is not installed: {HINT}") from error
