"""Text files as editors and spreadsheets save them: marks of byte order, UTF-16, other separators than a comma.

What is not a text file after all is told from one: an empty file, a binary one, a web page, a pointer in a file's stead.
Files that a file names are read only from the folder of the file that the user named, see ``reading``.
"""

import codecs
import csv
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from ...core.regular_files import read_bytes
from .errors import CaseError

NOT_THE_FILE = (
    ("version https://git-lfs", "Git's pointer to a large file, not the file: fetch it by `git lfs pull`"),
    ("<!doctype html", "a web page, not the file: download the raw file"),
    ("<html", "a web page, not the file: download the raw file"),
)
"""How a file begins that stands where another should: what it is and what to do."""

_folders: ContextVar[tuple[Path, ...]] = ContextVar("folders", default=())
"""Where files must lie; empty: anywhere."""

_outside: ContextVar[bool] = ContextVar("outside", default=False)


@contextmanager
def outside_allowed(allowed: bool = True) -> Iterator[None]:
    """Within this, files may name files anywhere (``--allow-outside``)."""
    token = _outside.set(allowed)
    try:
        yield
    finally:
        _outside.reset(token)


@contextmanager
def reading(*named: Path) -> Iterator[None]:
    """Within this, files are read only from the folders of those that the user named.

    HAWC2 looks for files from the model's folder: the one above an htc file's, if that is called ``htc``. Inside another
    ``reading`` this one is of a file that another one names, and changes nothing.
    """
    folders = [path.parent.parent if _resolved(path.parent).name == "htc" else path.parent for path in named]
    with _only(_folders.get() or tuple(map(_resolved, (*folders, *named)))):  # a named file may be a link to anywhere
        yield


@contextmanager
def reading_also(folder: Path) -> Iterator[None]:
    """Within this, files may lie in ``folder`` as well: one that the user named otherwise than by a file."""
    with _only((*_folders.get(), _resolved(folder))):
        yield


@contextmanager
def _only(folders: tuple[Path, ...]) -> Iterator[None]:
    token = _folders.set(folders)
    try:
        yield
    finally:
        _folders.reset(token)


def _resolved(path: Path) -> Path:
    try:
        return path.resolve()
    except (OSError, ValueError, RuntimeError):  # a loop of links, an impossible name: reading it says so
        return path.absolute()


def inside(path: Path) -> None:
    """Refuse a file that lies elsewhere, ``..`` and links followed.

    Raises:
        CaseError: naming the option that allows it.
    """
    folders = _folders.get()
    if folders and not _outside.get() and not any(_resolved(path).is_relative_to(folder) for folder in folders):
        raise CaseError(
            f"{path}: outside {folders[0]}: files that a file names are read from its folder only: "
            "move it there, or give --allow-outside if you trust the file that names it"
        )


def text(path: Path, absent: str = "correct the path", older: bool = False) -> str:
    """A file's text: UTF-8, or UTF-16 with its mark.

    Args:
        path: of the file.
        absent: what to do where there is none.
        older: whether bytes that are not UTF-8 are Latin-1, in which every byte is a character.

    Raises:
        CaseError: if it cannot be read, is empty, or no text; or lies outside the folder of the file that names it.
    """
    inside(path)
    try:
        raw = read_bytes(path)
    except FileNotFoundError:
        raise CaseError(f"{path}: no such file: {absent}") from None
    except OSError as error:
        raise CaseError(f"{path}: cannot be read ({error.strerror}): give a file that can") from error
    marked = raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) and not raw.startswith(codecs.BOM_UTF32_LE)
    if b"\0" in raw and not marked:
        raise CaseError(f"{path}: not a text file: is it the right one? if it is in UTF-16 or UTF-32, save it as UTF-8")
    try:
        found = raw.decode("utf-16" if marked else "utf-8-sig")
    except UnicodeDecodeError as error:
        if not older or marked:
            line = raw.count(b"\n", 0, error.start) + 1
            raise CaseError(f"{path}: line {line}: not UTF-8: another encoding, or no text? save it as UTF-8") from None
        found = raw.decode("latin-1")
    if not found.strip():
        raise CaseError(f"{path}: empty: was it written to the end?")
    for begins, what in NOT_THE_FILE:
        if found.lstrip()[: len(begins)].lower() == begins:
            raise CaseError(f"{path}: {what}")
    return found


def table(path: Path, absent: str) -> list[tuple[int, list[str]]]:
    """The rows of a CSV file and the lines they are on: ``#`` starts a comment; the header says whether commas, semicolons or
    tabs separate.

    Raises:
        CaseError: as ``text``; and if there are only comments.
    """
    lines = [(k, line.partition("#")[0]) for k, line in enumerate(text(path, absent).splitlines(), 1)]
    lines = [(k, line) for k, line in lines if line.strip()]
    if not lines:
        raise CaseError(f"{path}: only comments: give a header and rows")
    header = lines[0][1]
    separator = next((mark for mark in ",;\t" if mark in header), ",")
    return [(k, _cells(f"{path}: line {k}", line, separator)) for k, line in lines]


def _cells(where: str, line: str, separator: str) -> list[str]:
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=separator))]
    except csv.Error as error:  # also a field of more than 131,072 characters
        raise CaseError(f"{where}: not CSV: {error}: is it the right file? correct the line") from None
