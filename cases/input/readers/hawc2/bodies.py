"""HAWC2's htc file: its commands, the bodies that they describe, and the files that they reference.

A command ends at ``;``, case is ignored, and ``continue_in_file`` continues in another file. Paths are relative to the
model's folder, which is that of the htc or its parent.
"""

import os
import re
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...errors import CaseError
from ..source import Unused, unused
from ..text import Text, load, number

ALTERING = {"filename", "set", "sec", "concentrated_mass"}
"""Commands that a copy of a main_body must not have: whether they replace those of the original is not documented."""

_DEEP = 10

MOST_FILES = 100
"""Maximum number of files reached by ``continue_in_file``, counting repetitions."""

MOST_LINES = 200_000
"""Maximum number of lines of all these files."""

_BODIES = re.compile(r"\s*(begin\s+(new_htc_structure|main_body)|continue_in_file)\b", re.IGNORECASE)


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


def matches_format(text: Text) -> bool:
    """Whether these are lines of an htc file with bodies, or that continues in another."""
    return any(_BODIES.match(line) for line in text.lines)


def commands(htc: Text) -> Body:
    """The commands of a file and of those that it continues in.

    Raises:
        CaseError: if a continuation file is missing, or there are too many.
    """
    return list(_commands(htc, htc.path, 0, []))


def body_named(htc: Text, commands: Body, beginning: str, preferred: Collection[str]) -> tuple[str, Body]:
    """Name and commands of the first main_body with sections and a name that begins so, if possible a ``preferred`` one.

    Raises:
        CaseError: if there is none.
    """
    named = {
        name: body
        for name, body in main_bodies(commands).items()
        if name.startswith(beginning) and any(c.words[0] == "sec" for c in body)
    }
    if not named:
        raise CaseError(
            f"{htc.path}: no main_body whose name begins with {beginning} and that has c2_def: give the {beginning}'s htc"
        )
    name = next((name for name in named if name in preferred), next(iter(named)))
    return name, named[name]


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
    """The commands of each main_body by its name in lower case; those of a copy are the commands of what it copies.

    Raises:
        CaseError: if two have the same name.
    """
    out: dict[str, Body] = {}
    for _, body in blocks(commands, "main_body"):
        values = {c.words[0]: c.words[1].lower() for c in body if len(c.words) > 1}
        original = out.get(values.get("copy_main_body", ""))
        if (name := values.get("name")) in out:
            raise CaseError(f"{body[0].at}: main_body: there already is one whose name is {name}: rename or remove it")
        if name is not None:
            out[name] = original or body
    return out


def altered_copy(commands: Sequence[Command]) -> str:
    """A main_body that is a copy but has commands of its own, in words; empty if there is none."""
    for _, body in blocks(commands, "main_body"):
        words = {c.words[0]: c.words[-1] for c in body}
        if "copy_main_body" in words and (own := words.keys() & ALTERING):
            return f"{words.get('name', 'main_body')}, a copy_main_body with its own {min(own)}, is not supported"
    return ""


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
