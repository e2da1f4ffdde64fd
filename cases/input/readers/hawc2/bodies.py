"""HAWC2's htc file: the blade's main_body, the files it references, and its half-chord line (c2_def).

A command ends at ``;``, case is ignored, and ``continue_in_file`` continues in another file. Paths are relative to the
model's folder, which is that of the htc or its parent. c2_def is x, y, z and twist in degrees at sections, from a root
at z = 0 where the half-chord line may be offset from the blade's axis, with Akima splines in z between them.
"""

import os
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import Akima1DInterpolator, CubicSpline

from ...errors import CaseError
from ..source import Unused, unused
from ..text import ROUNDING, Text, believable, load, number

Array = NDArray[np.float64]

FINE = 2001
"""Number of points of the polygon that measures the length of the half-chord line."""

LENGTHS = 5e-3
"""Largest distance of the last station from the end of c2_def, as a fraction of the length, for the same blade."""

MIN_SPACING = 1e-6
"""Distance, as a fraction of the length, within which a section of c2_def coincides with a station."""

_DEEP = 10

MOST_FILES = 100
"""Maximum number of files reached by ``continue_in_file``, counting repetitions."""

MOST_LINES = 200_000
"""Maximum number of lines of all these files."""

_BODIES = re.compile(r"\s*begin\s+(new_htc_structure|main_body)\b", re.IGNORECASE)


class Command(NamedTuple):
    """The words of a command, the first in lower case, and its line."""

    text: Text
    line: int
    words: tuple[str, ...]

    @property
    def at(self) -> str:
        """Its position, for a message."""
        return self.text.at(self.line)


Body = list[Command]


class HalfChords(NamedTuple):
    """The half-chord line at the stations of both files: arc length (n,) m, curve (n, 3) m and twist (n,) rad.

    Axes are those of ``core.blade``. ``at`` (n,) are the same stations in the structural file's r. ``strays`` is the
    deviation (m, rad) of the line from c2_def between the stations, due to the different splines.
    """

    s: Array
    curve: Array
    twist: Array
    at: Array
    strays: tuple[float, float]


def matches_format(text: Text) -> bool:
    """Whether these are lines of an htc file with bodies."""
    return any(_BODIES.match(line) for line in text.lines)


def commands(htc: Text) -> Body:
    """The commands of a file and of those that it continues in.

    Raises:
        CaseError: if a continuation file is missing, or there are too many.
    """
    return list(_commands(htc, htc.path, 0, []))


def body_named(htc: Text, commands: Body, beginning: str) -> Body:
    """The commands of the first main_body with sections and a name that begins so.

    Raises:
        CaseError: if there is none.
    """
    for name, body in main_bodies(commands).items():
        if name.startswith(beginning) and any(c.words[0] == "sec" for c in body):
            return body
    raise CaseError(
        f"{htc.path}: no main_body whose name begins with {beginning} and that has c2_def: give the {beginning}'s htc"
    )


def blocks(commands: Sequence[Command], *kinds: str) -> list[tuple[str, Body]]:
    """Kind and commands of each ``begin kind … end kind``, for these kinds."""
    out: list[tuple[str, Body]] = []
    inside = ""
    for command in commands:
        words = tuple(word.lower() for word in command.words[:2])
        if len(words) == 2 and words[0] == "begin" and words[1] in kinds:
            inside = words[1]
            out.append((inside, []))
        elif words == ("end", inside):
            inside = ""
        elif inside:
            out[-1][1].append(command)
    return out


def main_bodies(commands: Sequence[Command]) -> dict[str, Body]:
    """The commands of each main_body by its name in lower case; those of a copy are the commands of what it copies."""
    out: dict[str, Body] = {}
    for _, body in blocks(commands, "main_body"):
        values = {c.words[0]: c.words[1].lower() for c in body if len(c.words) > 1}
        original = out.get(values.get("copy_main_body", ""))
        if "name" in values:
            out.setdefault(values["name"], original or body)
    return out


def properties(htc: Text, body: Body) -> tuple[Path, tuple[int, int] | None]:
    """Path of the structural file of a body, and its set and subset.

    Raises:
        CaseError: if the body references none, or the file does not exist.
    """
    by_keyword = {c.words[0]: c for c in body}
    if "filename" not in by_keyword or len(by_keyword["filename"].words) < 2:
        raise CaseError(f"{htc.path}: timoschenko_input: no filename in the main_body: add it")
    file, subset_command = by_keyword["filename"], by_keyword.get("set")
    numbers = [number(w) for w in subset_command.words[1:]] if subset_command else []
    if subset_command and (len(numbers) != 2 or not all(n and n.is_integer() for n in numbers)):
        raise CaseError(
            f"{subset_command.at}: set: {' '.join(subset_command.words[1:])}: not set and subset, as in `set 1 1`: correct it"
        )
    subset = (int(numbers[0] or 1), int(numbers[1] or 1)) if subset_command else None
    return _near(htc.path, file), subset


UNUSED = {
    "damping": ("s", "modes are undamped"),
    "damping_posdef": ("s", "modes are undamped"),
    "damping_aniso": ("s", "modes are undamped"),
    "concentrated_mass": (
        "kg",
        "concentrated masses are not supported: distribute them in the structural file's m",
    ),
}
"""Commands of a main_body that affect its modes and are not used: unit and reason."""


def unused_quantities(body: Body, masses: bool = True) -> tuple[Unused, ...]:
    """Unused non-zero quantities of a body; for a concentrated mass (node, x, y, z, mass, …) the mass, if they are unused."""
    out: list[Unused] = []
    for command in body:
        if command.words[0] in UNUSED and (masses or command.words[0] != "concentrated_mass"):
            unit, why = UNUSED[command.words[0]]
            numbers = [n for n in map(number, command.words[1:]) if n is not None and np.isfinite(n)]
            values = numbers[4:5] if command.words[0] == "concentrated_mass" else numbers
            out += unused(command.words[0], values, unit, command.text.path, why)
    return tuple(out)


def points(body: Body) -> Array:
    """The sections of c2_def: x, y, z in m and twist in degrees (n, 4), from a root at z = 0.

    Raises:
        CaseError: naming the line of the section at fault.
    """
    sections = [c for c in body if c.words[0] == "sec"]
    c2 = np.array([section(c) for c in sections])
    for count in (c for c in body if c.words[0] == "nsec"):
        if number(count.words[-1]) != len(c2):
            raise CaseError(
                f"{count.at}: nsec: {count.words[-1]}: c2_def has {len(c2)} sections: make the numbers equal"
            )
    if len(c2) < 2:
        raise CaseError(f"{sections[0].at}: 1 section: c2_def needs at least a root and a tip")
    c2[0, 2] = 0.0 if abs(c2[0, 2]) <= ROUNDING * abs(c2[-1, 2]) else c2[0, 2]
    if c2[0, 2] != 0:
        raise CaseError(f"{sections[0].at}: sec: z = {c2[0, 2]:g} m: the first section is the root; begin at z = 0")
    falls = np.flatnonzero(np.diff(c2[:, 2]) <= ROUNDING * abs(c2[-1, 2])) + 1
    if len(falls):
        k = int(falls[0])
        raise CaseError(
            f"{sections[k].at}: sec: z = {c2[k, 2]:g} m: not beyond the previous one: sort them and remove duplicates"
        )
    return c2


def half_chords(body: Body, r: Array) -> HalfChords:
    """The half-chord line at the stations ``r`` m of a structural file and at the sections of c2_def.

    Raises:
        CaseError: naming the line of the section at fault.
    """
    c2 = points(body)
    spline = Akima1DInterpolator(c2[:, 2], c2)
    z = np.unique(np.concatenate([np.linspace(0, c2[-1, 2], FINE), c2[:, 2]]))
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(spline(z)[:, :3], axis=0), axis=1))])
    if abs(r[-1] - arc[-1]) > LENGTHS * arc[-1]:
        at = next(c.at for c in reversed(body) if c.words[0] == "sec")
        raise CaseError(
            f"{at}: c2_def is {arc[-1]:g} m long, the stations end at {r[-1]:g} m: check that both are of the "
            "same blade"
        )
    s = r * (arc[-1] / r[-1])
    own = np.interp(c2[:, 2], z, arc)
    distance = np.abs(own[:, None] - s).min(axis=1)
    s = np.union1d(s, own[distance > MIN_SPACING * arc[-1]])
    at = spline(np.interp(s, arc, z))
    curve, twist = at[:, [2, 0, 1]], np.radians(at[:, 3])
    fine = spline(z)
    deviation = np.linalg.norm(CubicSpline(s, curve)(arc) - fine[:, [2, 0, 1]], axis=1).max()
    angle = np.abs(np.interp(arc, s, twist) - np.radians(fine[:, 3])).max()
    return HalfChords(s, curve, twist, s * (r[-1] / arc[-1]), (float(deviation), float(angle)))


def section(command: Command) -> list[float]:
    """x, y, z, m, and twist, degrees, of a ``sec`` of c2_def.

    Raises:
        CaseError: it has other words.
    """
    values = [number(w) for w in command.words[2:6]]
    if len(values) != 4 or any(v is None or not believable(v) for v in values):
        raise CaseError(f"{command.at}: sec: not x, y, z and twist: {' '.join(command.words)}: correct it")
    return [float(v) for v in values if v is not None]


def _commands(text: Text, main: Path, depth: int, lengths: list[int]) -> Iterator[Command]:
    """The commands of a file and its continuation files; the number of lines of each is appended to ``lengths``."""
    lengths.append(len(text.lines))
    for k, line in enumerate(text.lines):
        words = line.partition(";")[0].split()
        if not words:
            continue
        command = Command(text, k, (words[0].lower(), *words[1:]))
        if command.words[0] == "exit":
            return
        if command.words[0] != "continue_in_file":
            yield command
        elif depth == _DEEP:
            raise CaseError(
                f"{command.at}: continue_in_file: files are nested more than {depth} deep: check that none includes itself"
            )
        elif len(lengths) > MOST_FILES or sum(lengths) > MOST_LINES:
            raise CaseError(
                f"{command.at}: continue_in_file: {len(lengths)} files, {sum(lengths)} lines: at most {MOST_FILES} files and "
                f"{MOST_LINES} lines are read: check that none includes itself"
            )
        else:
            yield from _commands(load(_near(main, command)), main, depth + 1, lengths)


def _near(main: Path, command: Command) -> Path:
    """Path of the file that a command of an htc references."""
    keyword, *names = command.words
    if not names:
        raise CaseError(f"{command.at}: {keyword}: no name: add it")
    path = Path(names[0].replace("\\", "/"))
    for folder, name in ((main.parent, path), (main.parent.parent, path), (main.parent, Path(path.name))):
        if os.path.isfile(folder / name):
            return folder / name
    raise CaseError(
        f"{command.at}: {keyword}: {names[0]}: not found from the htc's folder or the one above: put it there"
    )
